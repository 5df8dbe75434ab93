// A farm built again from its records, and what must be the same in it.
#pragma once
#include <vector>

#include "master/farm_record.h"

namespace rayfarm {

/// The records must outlive the farm.
FarmPast past_of(const std::vector<FarmRecord>& records);
/// Jobs, frames, films, who delivered them, scenes, and who is banned; but of a job how long it will still take.
void expect_same(const Farm& before, const Farm& after, FarmTime now);

}  // namespace rayfarm

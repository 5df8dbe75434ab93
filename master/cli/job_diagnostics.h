// How the picture of a job came about, asked of the master: what the commands otherwise make of a scene.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "master/cli/master_api.h"

namespace rayfarm {

/// --job ID, instead of SCENE and what else the command does not need of all that it has so far, but for --frame. One of
/// the two is needed.
void add_job_option(CLI::App& command, std::optional<JobNumber>& job);

/// The shortest that reads back as the same number.
std::string number_text(double number);

/// Names and values for a request; empty values are left out.
using Query = std::vector<std::pair<std::string, std::string>>;

/// The bytes at jobs/ID/what, once they are made; how far they are is shown with the word. Interrupted, it says
/// that nothing was written.
std::string made_for_job(JobNumber job, const std::string& what, const Query& query, const char* doing);
void write_made_for_job(JobNumber job, const std::string& what, const Query& query, const char* doing,
                        const std::string& file);

/// What is there of it; unless it is all, throws CommandError with partly_done after it is written.
void write_partly_made_for_job(JobNumber job, const std::string& what, Query query, const std::string& file);

/// In a request: empty for the first frame, or for all.
std::string frame_text(const std::optional<std::uint32_t>& frame);

struct StatisticsWishes {
  bool as_json = false;
  bool whole = false;  // also of a job that still renders, and then waited for
};
/// The counters at once; of a job that has ended, or as wished, the rest when it is counted.
void print_job_statistics(JobNumber job, const std::optional<std::uint32_t>& frame,
                          const StatisticsWishes& wishes);
/// As lines, or as JSON.
void print_job_trace(JobNumber job, const Query& query, bool as_json);

}  // namespace rayfarm

// The maps that only a farm has: who rendered the pixels, and what they took.
#pragma once
#include <array>
#include <optional>

#include "master/diagnostics/layer.h"
#include "master/diagnostics/map.h"
#include "master/farm.h"

namespace rayfarm {

/// Whether the values of a job's map come from its deliveries.
bool is_of_deliveries(const MapKind& kind);

// The kind must be of deliveries, which are those of a film of that size. A label is the place of a name in
// Deliveries::names; a cost the mean seconds of the pixels of its tile that are there.

/// As a LayerSource gives it; `order`: of the tiles, those to be told first first.
LayerNews delivery_news(const Deliveries& deliveries, Size size, const MapKind& kind,
                        const std::vector<std::uint32_t>& order, const std::vector<PassSet>& known,
                        std::uint32_t most_tiles);
/// Of all pixels; infinite where nobody has delivered yet.
Map delivery_map(const Deliveries& deliveries, Size size, const MapKind& kind);

}  // namespace rayfarm

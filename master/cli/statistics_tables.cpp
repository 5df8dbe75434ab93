#include "master/cli/statistics_tables.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "master/cli/text.h"

namespace rayfarm {
namespace {

using nlohmann::json;
using Rows = std::vector<std::vector<std::string>>;

std::string thousandths(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", number);
  return text;
}

}  // namespace

std::string table_of_rays(const json& statistics) {
  const json &totals = statistics.at("counters"), &means = statistics.at("mean_per_pixel");
  Rows rows{{"RAYS", "TOTAL", "PER PIXEL"}};
  const auto add = [&](const char* words, std::initializer_list<const char*> names) {
    std::uint64_t total = 0;
    double mean = 0;
    for (const char* name : names)
      total += totals.at(name).get<std::uint64_t>(), mean += means.at(name).get<double>();
    rows.push_back({words, std::to_string(total), thousandths(mean)});
  };
  add("primary", {"primary"}), add("reflected", {"reflected"}), add("refracted", {"refracted"});
  add("shadow", {"shadow"}), add("all", {"rays"});
  add("hits", {"primary_hits", "secondary_hits"}), add("misses", {"misses"});
  add("lost rays", {"lost"}), add("bad samples", {"bad_samples"});
  return table(rows);
}

std::string table_of_tests(const json& tests) {
  Rows rows{{"PER RAY", "BOXES TESTED", "SOLIDS TESTED", "CROSSINGS FOUND"}};
  for (const char* kind : {"nearest", "shadow"}) {
    std::vector<std::string>& row = rows.emplace_back(1, kind);
    for (const char* mean : {"boxes_per_ray", "leaves_per_ray", "crossings_per_ray"})
      row.push_back(thousandths(tests.at(kind).at(mean)));
  }
  return table(rows);
}

std::string table_of_hits(const json& hits) {
  std::uint64_t all = 0;
  for (const json& leaf : hits) all += leaf.at("hits").get<std::uint64_t>();
  Rows rows{{"SOLID", "HITS", "SHARE"}};
  for (const json& leaf : hits)
    rows.push_back({printable(leaf.at("name")), leaf.at("hits").dump(), share(leaf.at("hits"), all)});
  return table(rows);
}

std::string table_of_times(const json& seconds, std::span<const char* const> phases) {
  Rows rows{{"PHASE", "SECONDS"}};
  for (const char* phase : phases) rows.push_back({phase, thousandths(seconds.at(phase))});
  return table(rows);
}

std::string headline(const std::string& pixels, double samples_per_pixel) {
  return pixels + " pixels, " + thousandths(samples_per_pixel) + " samples per pixel";
}

}  // namespace rayfarm

// What the stability suite measured: its CSV, and a chart for each of its cases.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "master/charts/chart.h"

namespace rayfarm {

/// A cell: one method of one case at one value of what drives it.
struct StabilityRow {
  std::string name, title;  // "S13 sphere", "A xor A ... are empty"
  std::string driver_name;  // what is driven, with its unit
  std::string method, number;
  double driver = 0;
  std::uint64_t rays = 0, failures = 0;
  std::optional<double> allowed;  // the failure rate up to which it passes; ours only

  double rate() const { return static_cast<double>(failures) / static_cast<double>(rays); }
  /// What the true rate is below with 95 % confidence when no failure was seen. Source: J. A. Hanley and A.
  /// Lippman-Hand, If Nothing Goes Wrong, Is Everything All Right?, JAMA 249, 1983 (the rule of three).
  double bound() const { return rays < 3 ? 1 : 3 / static_cast<double>(rays); }
  bool passes() const { return !allowed || rate() <= *allowed; }
  bool operator==(const StabilityRow&) const = default;
};

std::string stability_csv(const std::vector<StabilityRow>& rows);
/// Throws CsvError.
std::vector<StabilityRow> stability_rows(std::string_view csv);

/// "<= 3e-06" for a zero, else the rate.
std::string rate_text(const StabilityRow& row);

/// One chart a case, in the order of the rows: failures a ray against the driver, a line a method. A zero stands
/// at its bound with an open mark.
std::vector<Chart> stability_charts(const std::vector<StabilityRow>& rows);

}  // namespace rayfarm

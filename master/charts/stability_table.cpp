#include "master/charts/stability_table.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "master/charts/csv.h"

namespace rayfarm {
namespace {

const CsvRow header{"case", "title",    "driver_name", "method",   "number", "driver",
                    "rays", "failures", "rate",        "upper_95", "allowed"};

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

template <class Number>
Number number_of(const std::string& text, std::size_t line) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size())
    throw CsvError("line " + std::to_string(line) + ": a number is wanted where there is \"" +
                   text.substr(0, 40) + "\"");
  return number;
}

ChartLine& line_of(Chart& chart, const StabilityRow& row) {
  const std::string name = row.method + (row.number.empty() ? "" : ", " + row.number);
  for (ChartLine& line : chart.lines)
    if (line.name == name) return line;
  return chart.lines.emplace_back(ChartLine{name, {}, row.allowed.has_value()});
}

}  // namespace

std::string stability_csv(const std::vector<StabilityRow>& rows) {
  std::string csv = csv_line(header);
  for (const StabilityRow& r : rows)
    csv += csv_line({r.name, r.title, r.driver_name, r.method, r.number, shortest(r.driver),
                     std::to_string(r.rays), std::to_string(r.failures), shortest(r.rate()),
                     r.failures == 0 ? shortest(r.bound()) : "", r.allowed ? shortest(*r.allowed) : ""});
  return csv;
}

std::vector<StabilityRow> stability_rows(std::string_view csv) {
  const std::vector<CsvRow> lines = csv_rows(csv);
  if (lines.empty() || lines[0] != header)
    throw CsvError("this is not the table of the stability suite: its header is another");
  std::vector<StabilityRow> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const CsvRow& f = lines[i];
    const auto number = [&](std::size_t field) { return number_of<double>(f[field], i + 1); };
    const auto count = [&](std::size_t field) { return number_of<std::uint64_t>(f[field], i + 1); };
    rows.push_back({f[0], f[1], f[2], f[3], f[4], number(5), count(6), count(7),
                    f[10].empty() ? std::nullopt : std::optional(number(10))});
  }
  return rows;
}

std::string rate_text(const StabilityRow& row) {
  return row.failures == 0 ? "<= " + short_number(row.bound()) : short_number(row.rate());
}

std::vector<Chart> stability_charts(const std::vector<StabilityRow>& rows) {
  std::vector<Chart> charts;
  for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
    Chart chart{
        rows[first].name + ": " + rows[first].title, {rows[first].driver_name}, {"failures a ray"}, {}};
    std::vector<double> drivers;
    for (; last < rows.size() && rows[last].name == rows[first].name; ++last) {
      const StabilityRow& row = rows[last];
      const bool is_bound = row.failures == 0;
      line_of(chart, row).points.push_back({row.driver, is_bound ? row.bound() : row.rate(), is_bound});
      drivers.push_back(row.driver);
    }
    chart.x.scale = scale_for(drivers);
    for (ChartLine& line : chart.lines)
      std::sort(line.points.begin(), line.points.end(),
                [](const auto& a, const auto& b) { return a.x < b.x; });
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace rayfarm

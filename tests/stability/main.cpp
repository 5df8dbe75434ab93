// rayfarm_stability: runs the suite, writes what it measured, fails when ours misses what is promised.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/stability/cases.h"

namespace rayfarm::stability {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// "S13 sphere" -> "S13_sphere.svg".
std::string chart_file(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name + ".svg";
}

void write_results(const fs::path& folder, const std::vector<StabilityRow>& rows) {
  fs::create_directories(folder);
  write(folder / "stability.csv", stability_csv(rows));
  for (const Chart& chart : stability_charts(rows))
    write(folder / chart_file(chart.title.substr(0, chart.title.find(':'))), svg_of({&chart, 1}));
}

/// A line for each method of a case: all its cells together, and the worst of them.
void print_summary(const std::vector<StabilityRow>& rows) {
  std::printf("%-18s %-22s %-7s %14s %12s  %-10s %-12s\n", "CASE", "METHOD", "NUMBER", "RAYS", "FAILURES",
              "WORST RATE", "AT");
  for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
    const StabilityRow* worst = &rows[first];
    unsigned long long rays = 0, failures = 0;
    bool passes = true;
    const auto is_same = [&](const StabilityRow& r) {
      return r.name == worst->name && r.method == worst->method && r.number == worst->number;
    };
    for (; last < rows.size() && is_same(rows[last]); ++last) {
      rays += rows[last].rays, failures += rows[last].failures;
      passes = passes && rows[last].passes();
      if (rows[last].rate() > worst->rate()) worst = &rows[last];
    }
    std::printf("%-18s %-22s %-7s %14llu %12llu  %-10s %-12g %s\n", worst->name.c_str(),
                worst->method.c_str(), worst->number.c_str(), rays, failures, rate_text(*worst).c_str(),
                worst->driver,
                !worst->allowed ? ""
                : passes        ? "pass"
                                : "FAIL");
  }
}

void show_progress(const StabilityRow& r) {
  std::fprintf(stderr, "%s, %s at %g: %s\n", r.name.c_str(), r.method.c_str(), r.driver,
               rate_text(r).c_str());
}

int run(const SuiteOptions& options, const fs::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<StabilityRow> rows = run_suite(all_cases(), options, show_progress);
  write_results(folder, rows);
  print_summary(rows);
  std::size_t judged = 0, passed = 0;
  for (const StabilityRow& r : rows) judged += r.allowed.has_value(), passed += r.allowed && r.passes();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("%zu of %zu cells of ours pass; %.0f s; charts and stability.csv are in %s\n", passed, judged,
              took.count(), folder.c_str());
  return passed == judged && judged > 0 ? 0 : 1;
}

int run_command_line(int argc, char** argv) {
  CLI::App app("The stability suite: failures of ours and other methods, against what drives them");
  SuiteOptions options;
  options.threads = std::max(1u, std::thread::hardware_concurrency());
  std::string folder = "stability";
  app.add_flag("--long", options.is_long, "10^8 rays a cell of ours instead of a CI-sized run");
  app.add_option("--only", options.only, "Only cases whose names begin so, as S13");
  app.add_option("--threads", options.threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  app.add_option("-o,--output", folder, "Folder for stability.csv and a chart a case (default: stability)");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options, folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rayfarm_stability: %s\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace rayfarm::stability

int main(int argc, char** argv) { return rayfarm::stability::run_command_line(argc, argv); }

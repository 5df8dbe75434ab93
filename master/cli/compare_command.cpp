// rayfarm compare: how far two pictures are apart.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/print_json.h"
#include "master/files/difference.h"

namespace rayfarm {
namespace {

struct CompareArguments {
  std::string a, b, output, metric = "rmse";
  bool json = false;
};

ExitCode compare(const CompareArguments& arguments) {
  if (!arguments.output.empty()) check_writable(arguments.output);
  for (const std::string& input : {arguments.a, arguments.b}) {
    std::error_code is_new;
    if (std::filesystem::equivalent(arguments.output, input, is_new))
      throw SettingsError("-o would overwrite " + input + ", which is compared; name another file");
  }
  const Metric metric = *metric_named(arguments.metric);
  const Difference result = difference(read_linear(arguments.a), read_linear(arguments.b), metric);
  if (!arguments.output.empty()) write_picture(arguments.output, result.picture);
  if (arguments.json)
    print_json({{"metric", arguments.metric}, {"value", result.value}});
  else
    std::printf("%s %.9g\n", arguments.metric.c_str(), result.value);
  return ExitCode::done;
}

}  // namespace

void add_compare_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Say how far two pictures of the same size are apart");
  command->add_option("A", arguments->a, "Picture, .exr or .png")->required();
  command->add_option("B", arguments->b, "Picture, .exr or .png")->required();
  command->add_option("--metric", arguments->metric, "rmse (default), mae, max (of linear values) or flip")
      ->check(CLI::IsMember({"rmse", "mae", "max", "flip"}));
  command->add_option("-o,--output", arguments->output, "Write a picture of where they differ, .exr or .png");
  command->add_flag("--json", arguments->json, "Result as JSON");
  command->footer("Example: rayfarm compare local.exr farm.exr --metric max");
  command->callback([arguments, &chosen] { chosen = [arguments] { return compare(*arguments); }; });
}

}  // namespace rayfarm

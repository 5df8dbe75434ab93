#include "common/daemon/command_line.h"

#include <toml++/toml.h>

#include <iostream>
#include <optional>
#include <sstream>

namespace rayfarm {
namespace {

constexpr int bad_usage = 2;

[[noreturn]] void fail(const toml::source_region& where, const std::string& what) {
  throw CLI::FileError("configuration file, line " + std::to_string(where.begin.line) + ", column " +
                           std::to_string(where.begin.column) + ": " + what,
                       CLI::ExitCodes::FileError);
}

std::string text_of(const toml::node& value) {
  if (const auto* text = value.as_string()) return text->get();
  if (!value.is_value()) fail(value.source(), "a single value is needed");
  std::ostringstream text;
  value.visit([&](const auto& v) { text << v; });
  return text.str();
}

CLI::ConfigItem item_of(std::string_view key, const toml::node& value) {
  CLI::ConfigItem item;
  item.name = std::string(key);
  if (const auto* list = value.as_array())
    for (const toml::node& element : *list) item.inputs.push_back(text_of(element));
  else
    item.inputs.push_back(text_of(value));
  return item;
}

/// CLI11's own reader guesses where this one knows: it takes a broken line for a value.
class TomlConfig : public CLI::ConfigTOML {
 public:
  std::vector<CLI::ConfigItem> from_config(std::istream& file) const override try {
    std::vector<CLI::ConfigItem> items;
    for (const auto& [key, value] : toml::parse(file)) items.push_back(item_of(key.str(), value));
    return items;
  } catch (const toml::parse_error& error) {
    fail(error.source(), std::string(error.description()));
  }
};

/// The program's exit code, if it ends here.
std::optional<int> parse(CLI::App& app, int argc, char** argv) try {
  app.parse(argc, argv);
  return std::nullopt;
} catch (const CLI::ConfigError& error) {
  std::cerr << "configuration file: an unknown option (" << error.what()
            << "); its keys are those of --help\n";
  return bad_usage;
} catch (const CLI::Success& error) {
  return app.exit(error);  // --help, --version
} catch (const CLI::ParseError& error) {
  app.exit(error);
  return bad_usage;
}

}  // namespace

void declare_common_options(CLI::App& app, Openness& openness, const std::string& examples) {
  app.set_version_flag("--version", app.get_name() + " " RAYFARM_VERSION);
  app.footer(examples);
  app.config_formatter(std::make_shared<TomlConfig>());
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.set_config("--config", "", "Read options from a TOML file; the command line stands above it")
      ->type_name("FILE");
  CLI::Option* insecure = app.add_flag("--insecure", openness.insecure,
                                       "Talk over the network without encryption: anybody on it may listen");
  app.add_flag("--closed", openness.closed,
               "Encrypt everything and ask everybody who they are, also on this PC")
      ->excludes(insecure);
}

int run_daemon(CLI::App& app, int argc, char** argv, const std::function<int()>& serve) {
  if (const std::optional<int> ended = parse(app, argc, argv)) return *ended;
  try {
    return serve();
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << "\n";
    return bad_usage;
  }
}

}  // namespace rayfarm

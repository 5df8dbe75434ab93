#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "master/http/api.h"
#include "master/http/assets.h"
#include "master/http/farm_json.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

json openapi() { return json::parse(openapi_json); }

template <class Object>
std::set<std::string> names_in(const Object& object) {
  std::set<std::string> names;
  for (const auto& [name, ignored] : object.items()) names.insert(name);
  return names;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

TEST(OpenApi, DescribesEachRouteAndNoOther) {
  std::set<std::string> served, described;
  for (const ApiRoute& route : api_routes()) served.insert(route.method + " " + route.path);
  const json document = openapi();
  for (const auto& [path, methods] : document["paths"].items())
    for (const auto& [method, ignored] : methods.items()) described.insert(upper(method) + " " + path);
  EXPECT_EQ(served, described);
}

TEST(OpenApi, DescribesWhatMayStandInEachQuery) {
  const json document = openapi();
  for (const ApiRoute& route : api_routes()) {
    std::set<std::string> described;
    const json& method = document["paths"][route.path][lower(route.method)];
    for (const json& parameter : method.value("parameters", json::array()))
      if (parameter["in"] == "query") described.insert(parameter["name"]);
    EXPECT_EQ(route.query, described) << route.method << " " << route.path;
  }
}

TEST(OpenApi, DescribesTheMembersThatAreSent) {
  const json document = openapi();
  const auto described = [&](const char* name) {
    return names_in(document["components"]["schemas"][name]["properties"]);
  };
  std::set<std::string> job = names_in(to_json(JobView{}, FarmTime{}));
  job.insert("revision");
  EXPECT_EQ(described("Settings"), names_in(to_json(RenderSettings{})));
  EXPECT_EQ(described("Counters"), names_in(to_json(RayCounters{})));
  EXPECT_EQ(described("Worker"), names_in(to_json(WorkerView{}, FarmTime{})));
  EXPECT_EQ(described("Job"), job);
  EXPECT_EQ(described("Frame"), names_in(to_json(FrameView{})));
}

TEST(OpenApi, DefaultsOfTheSettingsAreTheirs) {
  const json document = openapi(), defaults = to_json(RenderSettings{});
  for (const auto& [name, member] : document["components"]["schemas"]["Settings"]["properties"].items())
    EXPECT_EQ(member["default"], defaults[name]) << name;
}

}  // namespace
}  // namespace rayfarm

#include "master/diagnostics/map_file.h"

#include "master/files/picture_facts.h"

namespace rayfarm {
namespace {

std::string words_of(const MapRequest& request) {
  return std::string(request.kind->name) +
         (request.kind->reduces ? " " + std::string(name_of(request.reduction)) : "") +
         (request.compatible ? " compatible" : "");
}

/// "0: lab1, 1: lab2".
std::string list_of(const std::vector<std::string>& labels) {
  std::string list;
  for (std::size_t i = 0; i < labels.size(); ++i)
    list += (i == 0 ? "" : ", ") + std::to_string(i) + ": " + labels[i];
  return list;
}

}  // namespace

std::string title_of(const MapOrigin& origin) {
  const MapKind& kind = *origin.request.kind;
  const RenderSettings& s = origin.settings;
  return "rayfarm map " + words_of(origin.request) + " (" + std::string(kind.unit) + "), " +
         std::to_string(s.width) + "x" + std::to_string(s.height) + " pixels, " + std::to_string(s.spp) +
         " samples per pixel; a line is a row from the top" +
         (kind.channels.size() == 3 ? "; x, y and z of a pixel are columns" : "") +
         (origin.labels.empty() ? "; inf: no surface" : "; " + list_of(origin.labels));
}

std::map<std::string, std::string> facts_of(const MapOrigin& origin) {
  std::map<std::string, std::string> facts = facts_of(origin.scene_hash, origin.settings);
  facts["rayfarm:map"] = words_of(origin.request);
  if (!origin.labels.empty()) facts["rayfarm:labels"] = list_of(origin.labels);
  return facts;
}

}  // namespace rayfarm

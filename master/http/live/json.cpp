#include "master/http/live/json.h"

#include <array>
#include <nlohmann/json.hpp>

#include "master/http/api_error.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr std::array progress_names{"making", "done", "failed"};

template <class Value>
Value member(const json& object, const char* name, const Value& otherwise) {
  try {
    return object.value(name, otherwise);
  } catch (const json::exception&) {
    throw ApiError(400, std::string(name) + " cannot be " + object[name].dump());
  }
}

LayerName layer_from_json(const json& value) {
  const json* job = value.is_object() && value.contains("job") ? &value["job"] : nullptr;
  if (!job || !job->is_number_unsigned()) throw ApiError(400, "what is watched has a job, a whole number");
  LayerName name{
      JobId{job->get<std::uint64_t>()}, {}, member<std::string>(value, "layer", "picture"), "", false};
  if (value.contains("frame")) {
    const json& frame = value["frame"];
    if (!frame.is_number_unsigned() || frame.get<std::uint64_t>() > UINT32_MAX)
      throw ApiError(400, "frame cannot be " + frame.dump());
    name.frame = frame.get<std::uint32_t>();
  }
  if (name.layer == "picture") return name;
  name.reduce = member<std::string>(value, "reduce", "majority");
  name.compat = member(value, "compat", false);
  return name;
}

}  // namespace

SharedMessage text_message(const json& value) {
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end());
}

json to_json(const LogLine& line, FarmTime now) {
  return {{"number", line.number},
          {"age_seconds", std::chrono::duration<double>(now - line.when).count()},
          {"warning", line.event.warning},
          {"worker", line.event.worker},
          {"text", line.event.text}};
}

SharedMessage log_message(std::span<const LogLine> lines, FarmTime now) {
  json shown = json::array();
  for (const LogLine& line : lines) shown.push_back(to_json(line, now));
  return text_message({{"type", "log"}, {"lines", std::move(shown)}});
}

SharedMessage layer_message(const LayerFeed& feed, std::size_t watch) {
  const LayerState& state = *feed.state();
  const std::uint32_t step = feed.step();
  json message{{"type", "layer"},
               {"watch", watch},
               {"id", feed.id()},
               {"job", static_cast<std::uint64_t>(feed.name().job)},
               {"layer", feed.name().layer},
               {"width", (state.size.width + step - 1) / step},
               {"height", (state.size.height + step - 1) / step},
               {"step", step},
               {"channels", state.channels},
               {"state", progress_names.at(static_cast<std::size_t>(state.state))},
               {"progress", state.share_done},
               {"message", state.message},
               {"range", state.range ? json(*state.range) : json()}};
  if (feed.name().frame) message["frame"] = *feed.name().frame;
  if (!state.labels.empty()) message["labels"] = state.labels;
  return text_message(message);
}

std::vector<LayerName> layers_to_watch(const std::string& text) {
  const json wish = parse_json(text);
  if (wish.size() != 1 || !wish.contains("watch") || !wish["watch"].is_array())
    throw ApiError(400, "say {\"watch\": [...]}");
  if (wish["watch"].size() > most_layers_watched) throw ApiError(400, "at most 8 layers can be watched");
  std::vector<LayerName> layers;
  for (const json& layer : wish["watch"]) layers.push_back(layer_from_json(layer));
  return layers;
}

}  // namespace rayfarm

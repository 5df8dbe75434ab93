#include "master/objection.h"

#include "common/work/engine.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t most_threads = 4096;

std::string words_for(const Versions& v) {
  if (v.newest == v.oldest) return "protocol " + std::to_string(v.newest);
  return "protocols " + std::to_string(v.oldest) + " to " + std::to_string(v.newest);
}

}  // namespace

std::string objection_to(const Versions& theirs, const std::string& software) {
  if (common_versions(theirs, {})) return "";
  return "rayfarm " + software + " speaks " + words_for(theirs) + ", this master (" RAYFARM_VERSION ") " +
         words_for({}) + ": install the same version on both PCs";
}

std::string objection_to(const ToMaster& first) {
  if (const auto* goodbye = std::get_if<Goodbye>(&first)) return "it said goodbye: " + goodbye->reason;
  const auto* hello = std::get_if<Hello>(&first);
  if (!hello) return "the first message must be Hello";
  if (std::string objection = objection_to(hello->versions, hello->software); !objection.empty())
    return objection;
  if (const std::string& engine = engine_fingerprint(); hello->engine != engine)
    return "rayfarm " + hello->software + " there renders other bits (engine " + hello->engine.substr(0, 8) +
           ") than this master (" RAYFARM_VERSION ", engine " + engine.substr(0, 8) +
           "), and one picture would show both: install the same build on both PCs";
  if (hello->name.empty()) return "a worker needs a name: give it one with --name";
  if (hello->threads == 0 || hello->threads > most_threads)
    return "a worker has 1 to " + std::to_string(most_threads) + " threads, not " +
           std::to_string(hello->threads);
  return "";
}

}  // namespace rayfarm

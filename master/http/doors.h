// What the handlers of HTTP requests may ask, from any thread.
#pragma once
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "master/dialling.h"
#include "master/event_log.h"
#include "master/http/app_files.h"
#include "master/http/asset_store.h"
#include "master/http/farm_door.h"
#include "master/http/frame_feeder.h"
#include "master/http/scene_library.h"

namespace rayfarm {

class Access;
class Diagnostics;

/// What of the master is not the farm's. All functions but tell() and note() are called on the farm's thread.
struct MasterDoor {
  /// NAME=HOST[:PORT], from now on. Throws AddressError and NameInUse.
  std::function<void(const std::string& target)> dial;
  std::function<std::vector<Dialling>()> dialling;
  /// The lines of the log after this number.
  std::function<std::vector<LogLine>(std::uint64_t after)> log;
  /// False: the name is not dialled.
  std::function<bool(const std::string& name)> stop_dialling{};
  /// Ends the connections of workers with these certificates.
  std::function<void(const std::set<std::string>& certificates)> cut_off;
  /// Whom we refuse, for the log, which has room for so many; from any thread.
  std::function<void(const std::string& line)> tell;
  std::string farm_address{};  // HOST:PORT where workers of other PCs come
  /// What was done, for the log that only the PC's admins read; from any thread.
  std::function<void(const std::string& line)> note = [](const std::string&) {};
};

/// All of it outlives the server.
struct Doors {
  FarmDoor& farm;
  FrameFeeder& feeder;
  Diagnostics& diagnostics;
  const MasterDoor& master;
  const AppFiles& app;
  const SceneLibrary& scenes;
  AssetStore& assets;
  Access* access = nullptr;  // none: the master keeps no keys, and gives nobody a code or token
};

}  // namespace rayfarm

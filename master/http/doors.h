// What the handlers of HTTP requests may ask, from any thread.
#pragma once
#include "master/http/app_files.h"
#include "master/http/farm_door.h"

namespace rayfarm {

/// All of it outlives the server.
struct Doors {
  FarmDoor& farm;
  const AppFiles& app;
};

}  // namespace rayfarm

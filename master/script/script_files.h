// The files that a script names, read for it.
#pragma once
#include "master/script/exchange.h"

namespace rayfarm {

/// Adds the named files of the request's folder. Throws SceneError for one that cannot be read, is too large, or lies
/// elsewhere: names go down from the folder only, whatever links are on the way.
void add_files(ScriptFiles& files, const ScriptRequest& request, const std::vector<std::string>& names);

}  // namespace rayfarm

// Evaluates a script in this very process, under limits that a script can be held to from within. The rest (a
// library call that never returns, a crash) is what the child process is for: see script.h.
#pragma once
#include "master/script/script.h"

namespace rayfarm {

/// Throws SceneError. The limits on memory and processor time hold; wall clock is not looked at.
ScriptResult run_script(const ScriptRequest& request, const ScriptLimits& limits);

}  // namespace rayfarm

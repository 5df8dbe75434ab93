// Evaluates a script in this very process, under limits that a script can be held to from within. The rest (a
// library call that never returns, a crash) is what the child process is for: see script.h.
#pragma once
#include "master/script/exchange.h"

namespace rayfarm {

/// Throws SceneError. The limits on memory and processor time hold; wall clock is not looked at, nor any file but those
/// of the task.
ScriptReply run_script(const ScriptTask& task);

}  // namespace rayfarm

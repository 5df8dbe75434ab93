#!/usr/bin/env bash
# Runs the tests under a sanitizer. Takes hours; without the browser and the stability sweeps, which it tells nothing of.
# deploy/setup.sh tests installs what it takes.
#   tests/sanitize.sh thread | address,undefined [CTEST-OPTION...]     e.g. tests/sanitize.sh thread -R Farm
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: tests/sanitize.sh thread | address,undefined [CTEST-OPTION...]" >&2; exit 2; }
sanitizer=$1
build=$top/build/sanitize-${sanitizer//,/-}
"$top/deploy/build.sh" "$build" -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DRAYFARM_SANITIZE="$sanitizer" -DRAYFARM_WEB=OFF

export TSAN_OPTIONS="suppressions=$top/tests/tsan_suppressions.txt second_deadlock_stack=1"
export UBSAN_OPTIONS=print_stacktrace=1
ctest --test-dir "$build" --output-on-failure -E '^(Web\.|stability$)' "${@:2}"

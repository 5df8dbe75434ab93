#!/usr/bin/env bash
# Runs the tests under a sanitizer. Takes hours; without the browser and the stability sweeps, which it tells nothing of.
# deploy/setup.sh tests installs what it takes.
#   tests/sanitize.sh thread | address,undefined [CTEST-OPTION...]     e.g. tests/sanitize.sh thread -R Farm
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: tests/sanitize.sh thread | address,undefined [CTEST-OPTION...]" >&2; exit 2; }
sanitizer=$1
build=$top/build/sanitize-${sanitizer//,/-}
"$top/deploy/build.sh" "$build" -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DRAYFARM_SANITIZE="$sanitizer" \
  -DCMAKE_UNITY_BUILD=ON -DRAYFARM_WEB=OFF

# To files: nobody reads the standard error of a program that its test kills.
reports=$build/reports
rm -rf -- "$reports"
mkdir -- "$reports"
export TSAN_OPTIONS="suppressions=$top/tests/tsan_suppressions.txt print_suppressions=0 second_deadlock_stack=1 log_path=$reports/thread"
export ASAN_OPTIONS="log_path=$reports/address"
export UBSAN_OPTIONS="print_stacktrace=1 log_path=$reports/undefined"
failed=0
ctest --test-dir "$build" -j "$(nproc)" --output-on-failure -E '^(Web\.|stability$)' "${@:2}" || failed=1
for report in "$reports"/*; do
  [ -e "$report" ] || continue
  echo "--- ${report##*/}"
  cat -- "$report"
  failed=1
done
exit $failed

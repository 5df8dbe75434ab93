#!/usr/bin/env bash
# Runs every test: installs what is missing, builds with warnings as errors, runs ctest, then builds for other CPU
# levels and by Clang and compares their pictures byte by byte, and fuzzes each door for 30 s. The last line sums up;
# the exit code is 0 only if all is well.
set -uo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=$top/build/tests

"$top/deploy/setup.sh" tests || exit 1
"$top/deploy/build.sh" "$build" -DRAYFARM_WERROR=ON || { echo "tests/run.sh: FAILED, it does not build"; exit 1; }

ctest --test-dir "$build" -j "$(nproc)" --output-on-failure 2>&1 | tee "$build/ctest.log"
ctest_code=${PIPESTATUS[0]}
tests=$(grep -E '^[0-9]+% tests passed' "$build/ctest.log" | tail -n 1)

"$top/tests/builds.sh" "$build" 2>&1 | tee "$build/builds.log"
builds_code=${PIPESTATUS[0]}

RAYFARM_FUZZ_SEED=1 "$top/tests/fuzz.sh" 30 2>&1 | tee "$build/fuzz.log"
fuzz_code=${PIPESTATUS[0]}

if [ "$ctest_code" = 0 ] && [ "$builds_code" = 0 ] && [ "$fuzz_code" = 0 ]; then verdict=PASSED; else verdict=FAILED; fi
echo "tests/run.sh: $verdict; ${tests:-no test ran}; $(tail -n 1 "$build/builds.log"); $(tail -n 1 "$build/fuzz.log")"
[ $verdict = PASSED ]

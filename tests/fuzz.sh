#!/usr/bin/env bash
# Fuzzes the doors, each for so many seconds, two side by side, under ASan and UBSan: whatever bytes come from outside,
# they are read in little time and memory, or refused.
#   tests/fuzz.sh [SECONDS] [DOOR...]     30 s; all doors, which are the files tests/fuzz/*_fuzz.cpp
# deploy/setup.sh tests installs what it takes. What leads further is kept in build/fuzz/corpus, where the next run goes
# on; what breaks a door is put into build/fuzz/found. Other inputs at each run, unless RAYFARM_FUZZ_SEED is set.
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=$top/build/fuzz
seconds=${1:-30}
doors=("${@:2}")
if [ ${#doors[@]} = 0 ]; then
  for file in "$top"/tests/fuzz/*_fuzz.cpp; do doors+=("$(basename "$file" _fuzz.cpp)"); done
fi

"$top/deploy/build.sh" "$build" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DRAYFARM_FUZZ=ON \
  -DRAYFARM_SANITIZE=address,undefined -DCMAKE_UNITY_BUILD=ON -DRAYFARM_TESTS=OFF -DRAYFARM_WEB=OFF "${doors[@]/#/fuzz_}"

export top build seconds
[ -w /dev/shm ] && export TMPDIR=/dev/shm  # the journal's files
mkdir -p "$build/corpus" "$build/found"

fuzz() {  # DOOR
  local seeds=() options=() log=$build/found/$1.log
  [ -d "$top/tests/fuzz/corpus/$1" ] && seeds+=("$top/tests/fuzz/corpus/$1")
  case $1 in
    image) export ASAN_OPTIONS=detect_leaks=0 ;;  # OpenImageIO's, of damaged files; they end with the limited child
    frame | message) seeds+=("$top/tests/common/net/golden") ;;
    script)
      options+=(-close_fd_mask=2 "-seed_inputs=$(printf '%s,' "$top"/scenes/*.lua | sed 's/,$//')") ;;  # 2: what scripts print
  esac
  mkdir -p "$build/corpus/$1"
  local result=held
  "$build/bin/fuzz_$1" -max_total_time="$seconds" -seed="${RAYFARM_FUZZ_SEED:-0}" \
    -timeout=20 -rss_limit_mb=2048 -max_len=32768 -print_final_stats=1 \
    -artifact_prefix="$build/found/$1-" "${options[@]}" "$build/corpus/$1" "${seeds[@]}" >"$log" 2>&1 || result=BROKEN
  echo "$1: $result, $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
  [ $result = held ] || { tail -n 60 "$log"; return 1; }
}
export -f fuzz

if printf '%s\n' "${doors[@]}" | xargs -P 2 -I{} bash -c 'fuzz {}'; then
  echo "${#doors[@]} doors held for $seconds s each"
else
  echo "a fuzzer broke a door: what it sent is in $build/found"
  exit 1
fi

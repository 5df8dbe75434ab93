#!/usr/bin/env bash
# The same bits from every build: renders the bundled scenes with builds of the whole tree at -O1 and -O3, by Clang and
# for each CPU level that this PC can run, and compares the EXR files byte by byte.
#   tests/builds.sh [FOLDER]     with the folder of a finished -O3 build; made when absent
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
first=${1:-$top/build/tests}
targets=(rayfarm rayfarm-script rayfarm-images)
scenes=(sphere_plane hedgehog_in_the_cage circus "sphere_flake -p depth=4" "sphere_flake -p mat=glass -p depth=3"
  "test_scene -p light=point" "test_scene -p light=rectangle" cylinders_glow glasshenge toroids "animated_scene --frame 77")

pictures=$(mktemp -d)
trap 'rm -rf -- "$pictures"' EXIT

render_all() {  # BUILD-FOLDER NAME
  mkdir -p "$pictures/$2"
  local scene number=0
  for scene in "${scenes[@]}"; do
    local words=($scene)
    "$1/bin/rayfarm" render "$top/scenes/${words[0]}.lua" "${words[@]:1}" --size 120x90 --spp 4 --threads "$(nproc)" \
      -o "$pictures/$2/$((number++)).exr" >/dev/null
  done
}

can_run() { /lib64/ld-linux-x86-64.so.2 --help | grep -q "^  $1 (supported"; }

"$top/deploy/build.sh" "$first" "${targets[@]}"
render_all "$first" O3
same=(O3) skipped=() differ=()

try() {  # NAME -DOPTION=VALUE...
  local folder=$top/build/bits-$1
  "$top/deploy/build.sh" "$folder" "${@:2}" -DCMAKE_UNITY_BUILD=ON -DRAYFARM_TESTS=OFF -DRAYFARM_WEB=OFF "${targets[@]}"
  render_all "$folder" "$1"
  local picture
  for picture in "$pictures/O3"/*.exr; do
    if ! cmp "$picture" "$pictures/$1/$(basename "$picture")"; then
      differ+=("$1: ${scenes[$(basename "$picture" .exr)]}")
    fi
  done
  same+=("$1")
}

try O1-x86-64-v2 -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DRAYFARM_MARCH=x86-64-v2
try clang -DCMAKE_CXX_COMPILER=clang++
for level in x86-64-v3 x86-64-v4; do
  if can_run $level; then try $level -DRAYFARM_MARCH=$level; else skipped+=("$level"); fi
done

note=${skipped[*]:+ (this CPU cannot run ${skipped[*]})}
if [ ${#differ[@]} = 0 ]; then
  echo "the same bytes of ${#scenes[@]} pictures from the builds ${same[*]}$note"
else
  echo "builds differ: $(printf '%s; ' "${differ[@]}")$note"
  exit 1
fi

#!/usr/bin/env bash
# Builds rayfarm: deploy/build.sh FOLDER [-DOPTION=VALUE...] [TARGET...]. Release unless an option says otherwise.
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: deploy/build.sh FOLDER [-DOPTION=VALUE...] [TARGET...]" >&2; exit 2; }
folder=$1
shift
options=() targets=()
for argument; do
  case $argument in -D*) options+=("$argument") ;; *) targets+=("$argument") ;; esac
done

log=$(mktemp)
trap 'rm -f -- "$log"' EXIT
cmake -G Ninja -S "$top" -B "$folder" "${options[@]}" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
ninja -C "$folder" -j "$(nproc)" "${targets[@]}"

#!/usr/bin/env bash
# A render farm on this PC: installs what is missing, builds, starts a master and two workers, renders a scene through
# them and says where the picture and the web page are. The farm stays until Ctrl-C; with --once, or without a
# terminal, it ends with the picture.
#   deploy/demo.sh [--once] [SCENE.lua]
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

once=no
[ -t 1 ] || once=yes
scene=$top/scenes/sphere_flake.lua
for argument; do
  case $argument in
    --once) once=yes ;;
    -h | --help) sed -n '2,5s/^# //p' "${BASH_SOURCE[0]}"; exit 0 ;;
    -*) echo "demo: unknown option $argument; see deploy/demo.sh --help" >&2; exit 2 ;;
    *) scene=$argument ;;
  esac
done
[ -r "$scene" ] || { echo "demo: cannot read the scene $scene" >&2; exit 2; }

"$top/deploy/setup.sh"
build=$top/build
"$top/deploy/build.sh" "$build" rayfarm rayfarm-master rayfarm-worker rayfarm-script rayfarm-images
bin=$build/bin
demo=$build/demo
mkdir -p "$demo"
exec 9>"$demo/lock"
flock -n 9 || { echo "demo: another demo of this build is running; end it first" >&2; exit 1; }
rm -rf -- "$demo/state"

# A port that nobody on this PC listens on, from $1 on.
free_port() {
  local port=$1
  while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
  echo "$port"
}
farm_port=$(free_port 5411)
http_port=$(free_port $((farm_port + 1)))
export RAYFARM_MASTER=http://127.0.0.1:$http_port

programs=()
stop_all() {
  trap - EXIT INT TERM
  [ ${#programs[@]} = 0 ] || kill -TERM "${programs[@]}" 2>/dev/null || true
  wait
}
trap stop_all EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

start() {  # NAME PROGRAM ARGUMENTS...
  local name=$1
  shift
  "$bin/$1" "${@:2}" >"$demo/$name.log" 2>&1 9>&- &
  programs+=($!)
}
start master rayfarm-master --state "$demo/state" --listen "127.0.0.1:$farm_port" --http "127.0.0.1:$http_port" \
  --threads 0
start worker-1 rayfarm-worker --master "127.0.0.1:$farm_port" --name worker-1 --threads "$((($(nproc) + 1) / 2))"
start worker-2 rayfarm-worker --master "127.0.0.1:$farm_port" --name worker-2 --threads "$((($(nproc) + 1) / 2))"

# Ready when both workers have come.
tries=0
until [ "$("$bin/rayfarm" workers --json 2>/dev/null | grep -o 'worker-[12]' | sort -u | wc -l)" = 2 ]; do
  tries=$((tries + 1))
  if [ $tries = 100 ]; then
    echo "demo: the farm did not come up; what its programs said:" >&2
    tail -n 20 "$demo"/*.log >&2
    exit 1
  fi
  sleep 0.2
done

picture=$demo/$(basename -- "$scene" .lua).png
"$bin/rayfarm" submit "$scene" -o "$picture" --wait >/dev/null  # the job number

echo
echo "The picture:   $picture"
echo "The web page:  $RAYFARM_MASTER/"
echo "Their logs:    $demo"
[ $once = yes ] && exit 0
echo "Render more:   RAYFARM_MASTER=$RAYFARM_MASTER '$bin/rayfarm' submit SCENE.lua -o PICTURE.exr --watch"
echo "The farm runs until Ctrl-C."
trap 'exit 0' INT
wait

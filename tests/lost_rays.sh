#!/usr/bin/env bash
# Counts lost rays: tests/lost_rays.sh [RAYS] (1e8) renders each bundled scene and its variants in its own size with as
# many samples as give that many rays, and prints for each how many rays there were and how many got lost.
# RAYFARM is the program. The exit code is 0 if none got lost.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
rayfarm=${RAYFARM:-$here/../build/tests/bin/rayfarm}
wanted=$(printf '%.0f' "${1:-1e8}")
lost_any=0

# RAYS LOST of a render.
counted() {
  "$rayfarm" stats "$@" --json | tr -d ' \n' | grep -o '"counters":{[^}]*}' | tr '{,}' '\n' | awk -F: '
    { gsub(/"/, "") }
    /^(primary|reflected|refracted|shadow):/ { rays += $2 }
    /^lost:/ { lost = $2 }
    END { printf "%.0f %.0f\n", rays, lost }'
}

count() {  # NAME [OPTIONS]
  local rays lost spp
  read -r rays lost < <(counted "$here/../scenes/$1.lua" "${@:2}" --spp 1)
  spp=$(((wanted + rays - 1) / rays))
  read -r rays lost < <(counted "$here/../scenes/$1.lua" "${@:2}" --spp "$spp")
  printf '%-50s %5d spp %14d rays  lost %d\n' "$*" "$spp" "$rays" "$lost"
  if [ "$lost" != 0 ]; then lost_any=1; fi
}

count animated_scene
count animated_scene --frame 125
count bezier
count circus
for mat in diffuse mirror glass; do
  count cubes -p "mat=$mat"
  count sphere_flake -p "mat=$mat"
  count two_spheres -p "mat=$mat"
done
count cylinders
count cylinders_glow
count five_balls
count flags
count glasshenge
count hedgehog_in_the_cage
count optics
count optics -p rc=true
count sphere_plane
count test_scene -p light=point
count test_scene -p light=rectangle
count toroids
count toroids_orienteering
exit $lost_any

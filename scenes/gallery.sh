#!/usr/bin/env bash
# Renders the pictures of the gallery in README.md: scenes/gallery.sh [FOLDER] (scenes/pictures). RAYFARM is the program.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
rayfarm=${RAYFARM:-$here/../build/bin/rayfarm}
folder=${1:-$here/pictures}
mkdir -p "$folder"

picture() {  # NAME SIZE [OPTIONS]
  local name=$1 size=$2
  shift 2
  "$rayfarm" render "$here/$name.lua" -o "$folder/$name.png" --size "$size" --spp 25 "$@"
}

picture animated_scene 320x180
picture bezier 320x240
picture circus 320x240
picture cubes 320x240 -p mat=glass
picture cylinders 320x240
picture cylinders_glow 360x240
picture five_balls 320x240
picture flags 320x240
picture glasshenge 320x320
picture hedgehog_in_the_cage 320x240
picture optics 320x240
picture sphere_flake 960x540
picture sphere_plane 320x240
picture test_scene 320x240 -p light=rectangle
picture toroids 320x240
picture toroids_orienteering 320x240
picture two_spheres 320x240

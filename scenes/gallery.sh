#!/usr/bin/env bash
# Draws the figures of the paper, and a few more, into scenes/gallery.
# Usage: gallery.sh [VOX [FOLDER]]
set -euo pipefail
scenes=$(cd "$(dirname "$0")" && pwd)
vox=${1:-$scenes/../build/release/apps/vox/vox}
out=${2:-$scenes/gallery}
mkdir -p "$out"

draw() {
  local name=$1 input=$2 size=$3
  shift 3
  "$vox" render "$scenes/$input" -o "$out/$name.png" --force --quiet --view 25,20 --size "$size" \
    --occlusion 8 "$@"
}

# A pixel is about a voxel. The jack shrinks as it is smoothed, and each picture is filled.
draw figure05_polygons toy_jack.toml 400x400 --dim 384 --until levels=0 --shading congradient
draw figure06_one_iteration toy_jack.toml 400x400 --dim 384 --until levels=1 --shading congradient
draw figure07_three_iterations toy_jack.toml 400x400 --dim 384 --until levels=3 --shading congradient
draw figure08_normals toy_jack.toml 400x400 --dim 384 --shading normals
draw figure08_congradient toy_jack.toml 400x400 --dim 384 --shading congradient
draw figure09_puffed puffed.toml 720x280
draw figure10_texture textured_before.toml 260x260
draw figure11_smoothed_texture textured_after.toml 260x260
draw voxels toy_jack.toml 400x400 --dim 48 --shading flat
draw marble marble_jack.toml 320x320
draw football football.toml 320x320 --dim 320
draw creases creases.toml 720x440 --dim 720

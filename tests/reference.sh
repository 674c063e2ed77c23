#!/usr/bin/env bash
# Converts every scene, and one per family of options, and compares the voxels with the reviewed
# grids of tests/reference. Usage: reference.sh VOX SOURCE [--renew]
# With --renew, the grids that differ are replaced, and what has changed in them is printed: look at
# it, and at the grids, before you commit them.
set -uo pipefail
vox=$(realpath "$1")
source=$(realpath "$2")
renew=${3:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong=0
count=0

# reference NAME SCENE OPTIONS...: one grid.
reference() {
  local name=$1 scene=$2 kept="$source/tests/reference/$1.vdb"
  shift 2
  count=$((count + 1))
  if ! "$vox" convert "$source/scenes/$scene" -o "$folder/$name.vdb" --grids mask --quiet --verify "$@"; then
    wrong=$((wrong + 1))
    return
  fi
  if [ -e "$kept" ]; then
    # Metadata hold the version of vox; whole files are compared by the test of the command line.
    "$vox" diff "$kept" "$folder/$name.vdb" --no-metadata >"$folder/$name.txt" && return
    sed "s/^/$name: /" "$folder/$name.txt"
  else
    echo "$name: there is no reference yet"
  fi
  if [ "$renew" = --renew ]; then
    cp "$folder/$name.vdb" "$kept"
  else
    wrong=$((wrong + 1))
  fi
}

for scene in "$source"/scenes/*.toml; do
  name=$(basename "$scene" .toml)
  reference "$name" "$name.toml" --dim 80
done
reference jack_interior toy_jack.toml --dim 40 --interpolate interior
reference sheet_free sheet.toml --dim 40 --boundary free
reference sheet_boundary sheet.toml --dim 40 --interpolate boundary
reference sheet_both sheet.toml --dim 40 --interpolate both
reference jack_polygons toy_jack.toml --dim 40 --until levels=0
reference jack_polygons_26 toy_jack.toml --dim 40 --until levels=0 --separating 26
reference polyhedron_levels polyhedron.toml --dim 40 --until levels=2
reference cube_large cube.toml --voxel-size 0.11

echo "$count grids, $wrong wrong"
[ "$wrong" -eq 0 ]

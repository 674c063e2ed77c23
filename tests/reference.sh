#!/usr/bin/env bash
# Converts every scene, and one per family of options, and compares the voxels with the reviewed
# grids of tests/reference. Usage: reference.sh VOX SOURCE REPORT|--renew
# In the folder REPORT there is then a page for people, and a report for CI.
# With --renew, the grids that differ are replaced, with the pictures beside them, and what has changed
# is printed: look at all of that before you commit it.
set -uo pipefail
vox=$(realpath "$1")
source=$(realpath "$2")
report=$3
kept=$source/tests/reference
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong=0

# compare A B OPTIONS...: Metadata hold the version of vox; whole files are compared by the test of
# the command line. Values are rounded as libraries do.
compare() { "$vox" diff "$@" --no-metadata --tolerance 1e-5; }

# reference NAME SCENE OPTIONS...: one grid.
reference() {
  "$vox" convert "$source/scenes/$2" -o "$folder/$1.vdb" --quiet "${@:3}" || wrong=$((wrong + 1))
}

# surface_of NAME SCENE OPTIONS...: its mask, held against the surface, too.
surface_of() {
  reference "$@" --grids mask --verify
}

for scene in "$source"/scenes/*.toml; do
  name=$(basename "$scene" .toml)
  surface_of "$name" "$name.toml" --dim 80
done
surface_of jack_interior toy_jack.toml --dim 40 --interpolate interior
surface_of sheet_free sheet.toml --dim 40 --boundary free
surface_of sheet_boundary sheet.toml --dim 40 --interpolate boundary
surface_of sheet_both sheet.toml --dim 40 --interpolate both
surface_of jack_polygons toy_jack.toml --dim 40 --until levels=0
surface_of jack_polygons_26 toy_jack.toml --dim 40 --until levels=0 --separating 26
surface_of polyhedron_levels polyhedron.toml --dim 40 --until levels=2
surface_of cube_large cube.toml --voxel-size 0.11

reference solid toy_jack.toml --dim 32 --grids density --fill solid --gain 1
reference level_set toy_jack.toml --dim 32 --grids surface
reference level_set_unsigned sheet.toml --dim 32 --grids surface --open-mesh unsigned --band 2
reference normals toy_jack.toml --dim 32 --grids density,normal --half
reference colors textured_after.toml --dim 32 --grids density,color
reference houdini toy_jack.toml --dim 32 --grids density,normal,color --target houdini --up z \
  --texture 'stripes:scale=0.2'

if [ "$report" = --renew ]; then
  for grid in "$folder"/*.vdb; do
    name=$(basename "$grid" .vdb)
    if [ ! -e "$kept/$name.vdb" ]; then
      echo "$name: there is no reference yet"
    elif compare "$kept/$name.vdb" "$grid" >"$folder/text"; then
      continue
    else
      sed "s/^/$name: /" "$folder/text"
    fi
    cp "$grid" "$kept"
    "$vox" render "$grid" -o "$kept/$name.png" --force --quiet --views front,iso --size 160x160
  done
else
  mkdir -p "$report"
  compare "$kept" "$folder" --force --report "$report/report.html" --junit "$report/junit.xml" ||
    wrong=$((wrong + 1))
fi
[ "$wrong" -eq 0 ]

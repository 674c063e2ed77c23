#!/usr/bin/env bash
# NanoVDB's own tools read what vox writes, and vox reads what they write. Usage: nanovdb.sh VOX SCENES
set -euo pipefail
for tool in print validate convert; do
  command -v nanovdb_$tool >/dev/null || { echo "skipped: libnanovdb-tools is not installed"; exit 77; }
done
vox=$(realpath "$1")
scenes=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
all=mask,density,surface,normal,color,part
"$vox" convert -q "$scenes/toy_jack.toml" -o jack.vdb --dim 60 --grids $all
for compression in blosc zip none; do
  "$vox" convert -q "$scenes/toy_jack.toml" -o jack.nvdb --dim 60 --grids $all --compression $compression -f
  nanovdb_validate -v jack.nvdb 2>&1 | tee validated
  [ "$(grep -c ': passed' validated)" -eq 6 ]  # a grid each; the exit code does not tell
  nanovdb_print jack.nvdb >printed
  for grid in ${all//,/ }; do
    grep -qE "^[0-9]+ +$grid .* 32\.[0-9.]+ +${compression^^} " printed || { cat printed; exit 1; }
  done
  nanovdb_convert -f jack.nvdb back.vdb
  "$vox" diff --no-metadata jack.vdb back.vdb
  "$vox" diff --no-metadata jack.vdb jack.nvdb
  "$vox" check -q jack.nvdb
done
# The same grids, encoded by others: with other checksums, statistics and types.
for option in --blosc --zip '--checksum none' '--checksum full --stats none'; do
  # shellcheck disable=SC2086  # words
  nanovdb_convert -f $option jack.vdb theirs.nvdb
  "$vox" diff --no-metadata jack.vdb theirs.nvdb
done
for quantised in --fp8 --fp16 --fpN; do
  nanovdb_convert -f $quantised -g surface jack.vdb theirs.nvdb
  "$vox" diff --no-metadata --grids surface --tolerance 0.01 jack.vdb theirs.nvdb
done
"$vox" info theirs.nvdb

# Nodes without active voxels, to which NanoVDB gives empty boxes.
code=0
/usr/bin/python3 - <<'PY' || code=$?
import sys
try:
    import pyopenvdb
except ImportError:
    print("pyopenvdb is not installed: nodes without active voxels are not tried")
    sys.exit(77)
grid = pyopenvdb.FloatGrid()
grid.name = "density"
grid.fill((0, 0, 0), (20, 20, 20), 1.0)
voxels = grid.getAccessor()
for place in ((500, 0, 0), (9000, 0, 0)):  # a lower and an upper node
    voxels.setValueOff(place, 3.0)
pyopenvdb.write("off.vdb", grids=[grid])
PY
[ $code -ne 77 ] || exit 0
[ $code -eq 0 ]
nanovdb_convert -f off.vdb off.nvdb
"$vox" diff --no-metadata off.vdb off.nvdb

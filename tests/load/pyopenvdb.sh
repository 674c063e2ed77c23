#!/usr/bin/env bash
# Debian's own OpenVDB bindings read what vox writes. Usage: pyopenvdb.sh VOX SCENES
set -euo pipefail
python=/usr/bin/python3
$python -c 'import pyopenvdb' 2>/dev/null || { echo "skipped: python3-openvdb is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" convert "$2/toy_jack.toml" -o "$folder/jack.vdb" --dim 100
"$1" convert "$2/toy_jack.toml" -o "$folder/both.vdb" --dim 100 --grids density,mask

$python - "$folder/jack.vdb" "$folder/both.vdb" <<'PY'
import sys
import pyopenvdb as vdb

grids, metadata = vdb.readAll(sys.argv[1])
names = [grid.name for grid in grids]
assert names == ["density"], names
assert metadata["creator"].startswith("vox "), metadata
(density,) = grids
assert density.gridClass == vdb.GridClass.FOG_VOLUME
assert density.activeVoxelCount() > 1000
assert abs(density.transform.voxelSize()[0] - 2 / 100) < 1e-15
assert density.background == 0
values = {item.value for item in density.citerOnValues()}
assert values == {300.0}, values  # opaque in Blender: 6 / voxel size
assert density["vox_gain"] == 300 and metadata["vox_gain"] == 300, metadata
low, high = density.evalActiveVoxelBoundingBox()
assert low == (-50, -50, -50) and high == (50, 50, 50), (low, high)  # arm caps stay in place
assert density["vox_guarantee"] == "6-separating"
# Debian's bindings do not know mask grids; the other grids of such a file load by name.
assert vdb.read(sys.argv[2], "density").activeVoxelCount() == density.activeVoxelCount()
print(names, density.activeVoxelCount(), low, high)
PY

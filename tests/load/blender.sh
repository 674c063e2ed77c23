#!/usr/bin/env bash
# Headless Blender reads what vox writes. Usage: blender.sh VOX SCENES
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: blender is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" convert "$2/toy_jack.toml" -o "$folder/jack.vdb" --dim 100 --grids density,mask

cat >"$folder/load.py" <<'PY'
import sys
import bpy

bpy.ops.object.volume_import(filepath=sys.argv[-1])
volume = bpy.context.object
assert volume.type == "VOLUME"
grids = volume.data.grids
assert grids.load(), grids.error_message
found = {grid.name: (grid.data_type, grid.channels) for grid in grids}
assert found == {"density": ("FLOAT", 1), "mask": ("MASK", 1)}, found
bpy.context.view_layer.update()
box = [tuple(round(x, 2) for x in corner) for corner in volume.bound_box]
sides = [max(c[i] for c in box) - min(c[i] for c in box) for i in range(3)]
# The jack is 2 units wide; Blender rounds up to whole leaves of 8 voxels on either side.
assert all(2 <= side <= 2 + 16 * 0.02 for side in sides), sides
print("vox-blender-ok", bpy.app.version_string, found, sides)
PY
# Blender exits with 0 even when its script fails; the last line is what counts.
blender --background --factory-startup --python "$folder/load.py" -- "$folder/jack.vdb" 2>&1 |
  tee "$folder/log"
grep -q '^vox-blender-ok' "$folder/log"

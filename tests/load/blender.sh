#!/usr/bin/env bash
# Headless Blender reads what vox writes, and renders it. Usage: blender.sh VOX SCENES PICTURE
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: blender is not installed"; exit 77; }
script=$(realpath "$2/../apps/blender/vox_import.py")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" convert "$2/toy_jack.toml" -o "$folder/jack.vdb" --dim 100 --grids density,mask,color \
  --texture 'checker:scale=0.5,colors=1:0.02:0.02/0.02:0.02:1'


# Every scene as it is, and a file of every kind of grid.
mkdir "$folder/scenes"
for scene in "$2"/*.toml; do
  "$1" convert "$scene" -o "$folder/scenes/$(basename "$scene" .toml).vdb"
done
"$1" convert "$2/toy_jack.toml" -o "$folder/scenes/every_grid.vdb" --dim 64 --fill solid \
  --grids density,mask,surface,normal,color,part

# Two cubes that overlap, as parts.
cube="mesh = '$(realpath "$2/cube.obj")'"
printf '[[object]]\nname = "left"\n%s\n[[object]]\nname = "right"\n%s\ntransform = { translate = [1.2, 0.4, 0.6] }\n' \
  "$cube" "$cube" >"$folder/cubes.toml"
"$1" convert "$folder/cubes.toml" -o "$folder/part.vdb" --dim 48 --grids density,part
"$1" convert "$folder/cubes.toml" -o "$folder/split.vdb" --dim 48 --target blender --split part

cat >"$folder/load.py" <<'PY'
import glob
import importlib.util
import os
import sys

import bpy

script, vdb, picture = sys.argv[-3:]
spec = importlib.util.spec_from_file_location("vox_import", script)
vox_import = importlib.util.module_from_spec(spec)
spec.loader.exec_module(vox_import)
addon = vox_import.load_addon()
addon.register()
addon.framing.make_way()
assert "Cube" not in bpy.data.objects
volume = addon.import_volume.import_vdb(vdb)
assert volume.type == "VOLUME"
grids = volume.data.grids
found = {grid.name: (grid.data_type, grid.channels) for grid in grids}
assert found == {"density": ("FLOAT", 1), "mask": ("MASK", 1), "color": ("VECTOR_FLOAT", 3)}, found
for grid in grids:  # 2 units are 100 voxels
    scale = [grid.matrix_object[i][i] for i in range(3)]
    assert all(abs(s - 0.02) < 1e-6 for s in scale), (grid.name, scale)
    assert grid.matrix_object.to_translation().length < 1e-6, grid.name
box = [tuple(round(x, 2) for x in corner) for corner in volume.bound_box]
sides = [max(c[i] for c in box) - min(c[i] for c in box) for i in range(3)]
# The jack is 2 units wide; Blender rounds up to whole leaves of 8 voxels on either side.
assert all(2 <= side <= 2 + 16 * 0.02 for side in sides), sides

def close(a, b):
    return all(abs(x - y) < 1e-6 for x, y in zip(a, b))


# What Blender itself imports, with no script of ours: all grids load, at one place in space.
kinds = set()
files = sorted(glob.glob(os.path.join(os.path.dirname(vdb), "scenes", "*.vdb")))
for path in files:
    bpy.ops.object.volume_import(filepath=path)
    loaded = bpy.context.object
    grids = loaded.data.grids
    assert grids.load() and not grids.error_message, (path, grids.error_message)
    assert "density" in grids, path
    for grid in grids:
        kinds.add((grid.name, grid.data_type))
        assert grid.load(), (path, grid.name)
        for row, first in zip(grid.matrix_object, grids[0].matrix_object):
            assert close(row, first), (path, grid.name)
    box = [max(c[i] for c in loaded.bound_box) - min(c[i] for c in loaded.bound_box) for i in range(3)]
    assert 0.5 < max(box) < 12, (path, box)
    bpy.data.objects.remove(loaded)
assert kinds >= {
    ("density", "FLOAT"),
    ("mask", "MASK"),
    ("surface", "FLOAT"),
    ("normal", "VECTOR_FLOAT"),
    ("color", "VECTOR_FLOAT"),
    ("part", "INT"),
}, kinds

addon.framing.frame(volume)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = 320, 240
scene.render.film_transparent = True
scene.cycles.samples = 16
scene.cycles.use_denoising = False


def rendered(path):
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return list(bpy.data.images.load(path).pixels)


def solid_in(pixels):
    return [pixels[i : i + 3] for i in range(0, len(pixels), 4) if pixels[i + 3] > 0.9]


# Without a material of ours, at the same place, the jack is as solid.
volume.hide_render = True
bpy.ops.object.volume_import(filepath=vdb)
plain = solid_in(rendered(os.path.join(os.path.dirname(vdb), "plain.png")))
bpy.data.objects.remove(bpy.context.object)
volume.hide_render = False

# Red and blue are there in about equal parts, each pure, and much of the picture is neither.
pixels = rendered(picture)
solid = solid_in(pixels)
red = sum(r > 2 * b and r > 2 * g for r, g, b in solid)
blue = sum(b > 2 * r and b > 2 * g for r, g, b in solid)
total = len(pixels) // 4
assert 0.8 * len(solid) < len(plain) < 1.25 * len(solid), (len(plain), len(solid))
assert 0.03 * total < len(solid) < 0.6 * total, (len(solid), total)
assert red + blue > 0.7 * len(solid) and min(red, blue) > 0.2 * len(solid), (red, blue, len(solid))

# Each part has a colour of its own, blue and green, with the grid part and without.
volume.hide_render = True
for name in "part", "split":
    parts = addon.import_volume.import_vdb(os.path.join(os.path.dirname(vdb), name + ".vdb"))
    addon.framing.frame(parts)
    shown = solid_in(rendered(os.path.join(os.path.dirname(vdb), name + ".png")))
    blue = sum(b > 1.3 * r and b > 1.2 * g for r, g, b in shown)
    green = sum(g > 1.1 * r and g > 1.3 * b for r, g, b in shown)
    assert len(shown) > 0.1 * total and min(blue, green) > 0.25 * len(shown), (name, len(shown), blue, green)
    assert blue + green > 0.85 * len(shown), (name, len(shown), blue, green)
    bpy.data.objects.remove(parts)
print("vox-blender-ok", bpy.app.version_string, len(files), "scenes", found, sides, len(solid), red)
PY
# Blender exits with 0 even when its script fails; the last line is what counts.
blender --background --factory-startup --python "$folder/load.py" -- \
  "$script" "$folder/jack.vdb" "$(realpath "${3:-$folder/jack.png}")" 2>&1 | tee "$folder/log"
grep -q '^vox-blender-ok' "$folder/log"
# No complaint about any file. (Audio and displays are not what this is about.)
if grep -i 'vdb\|volume\|grid' "$folder/log" | grep -i 'warn\|error\|fail\|cannot'; then exit 1; fi

#!/usr/bin/env bash
# Headless Blender reads the meshes that vox subdivide writes as .glb.
# Usage: blender_mesh.sh VOX SCENES
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: blender is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A torus of 24 x 12 quads, red where x > 0, its texture coordinates the numbers of rows and columns.
cat >"$folder/make.py" <<'PY'
import math
import sys

major, minor = 24, 12
with open(sys.argv[1], "w") as out:
    for i in range(major):
        for j in range(minor):
            u, v = 2 * math.pi * i / major, 2 * math.pi * j / minor
            r = 2 + 0.5 * math.cos(v)
            red = 0.5 + 0.5 * math.cos(u)  # stored as sRGB
            print("v", r * math.cos(u), r * math.sin(u), 0.5 * math.sin(v), red, 0, 0, file=out)
    for i in range(major + 1):
        for j in range(minor + 1):
            print("vt", i / major, j / minor, file=out)
    for i in range(major):
        for j in range(minor):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            print("f", *(f"{a % major * minor + b % minor + 1}/{a * (minor + 1) + b + 1}" for a, b in corners), file=out)
PY
python3 "$folder/make.py" "$folder/torus.obj"
"$1" subdivide "$folder/torus.obj" -o "$folder/torus.glb" --levels 2
"$1" subdivide "$2/toy_jack.toml" -o "$folder/jack.glb" --levels 2

cat >"$folder/load.py" <<'PY'
import math
import os
import sys

import bpy
import numpy

numpy.bool = bool  # Blender 3.4 uses the old name, which Debian's NumPy has no more
folder = sys.argv[-1]


def imported(name):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=os.path.join(folder, name))
    return [one for one in bpy.data.objects if one.type == "MESH"]


(torus,) = imported("torus.glb")
mesh = torus.data
assert len(mesh.polygons) == 2 * 24 * 12 * 16, len(mesh.polygons)
mesh.calc_normals_split()
colors = mesh.color_attributes[0]
uv = mesh.uv_layers[0].data
worst = worst_red = worst_uv = 0
for loop in mesh.loops:
    # glTF has y up: Blender's x, y, z are x, -z, y of the file, which has those of the input.
    x, z, y = mesh.vertices[loop.vertex_index].co
    z = -z
    away = math.hypot(x, y)
    # The normal of the true torus; the spline is close to it.
    ring = (x / away * 2, y / away * 2, 0)
    nx, nz, ny = loop.normal
    nz = -nz
    d = math.dist((x, y, z), ring)
    dot = sum(n * (p - r) / d for n, p, r in zip((nx, ny, nz), (x, y, z), ring))
    worst = max(worst, 1 - dot)
    index = loop.index if colors.domain == "CORNER" else loop.vertex_index
    u, v = uv[loop.index].uv
    turns = math.atan2(y, x) / (2 * math.pi)
    # Faces across the seam at u = 0 end there: half a side, 1/8 of a quad, before their vertices.
    allowed = 1 / (8 * 24) if abs(turns) < 1 / (7 * 24) else 0
    worst_uv = max(worst_uv, abs((u - turns + 0.5) % 1 - 0.5) - allowed)
    red = 0.5 + 0.5 * x / away
    linear = red / 12.92 if red <= 0.04045 else ((red + 0.055) / 1.055) ** 2.4
    worst_red = max(worst_red, abs(colors.data[index].color[0] - linear))
assert worst < 2e-3, worst
assert worst_red < 0.03, worst_red
assert worst_uv < 5e-4, worst_uv

objects = imported("jack.glb")
assert objects and all(len(one.data.polygons) > 100 for one in objects)
assert all(not one.data.validate() for one in objects)  # nothing had to be corrected
print("vox-blender-ok", bpy.app.version_string, worst, worst_red, worst_uv)
PY
blender --background --factory-startup --python "$folder/load.py" -- "$folder" 2>&1 | tee "$folder/log"
grep -q '^vox-blender-ok' "$folder/log"

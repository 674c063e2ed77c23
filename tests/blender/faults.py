"""Mistakes are reported in one line, and neither they nor a cancel leave a file."""

import os
import time

import bpy
from meshes import empty_scene, refused, suzanne

convert = bpy.ops.object.vox_convert
preferences = bpy.context.preferences.addons["vox_addon"].preferences
empty_scene()
thing = suzanne()

preferences.program = "/nowhere/vox"
assert refused(convert, "/nowhere/vox", "Preferences")
preferences.program = ""
path, os.environ["PATH"] = os.environ["PATH"], "/nowhere"
assert refused(convert, "not on PATH")
os.environ["PATH"] = path

thing.vox.more = "--speed 3"
assert refused(convert, "--speed")
thing.vox.more = "--weld '"
assert refused(convert, "More options")
thing.vox.more = ""
thing.vox.grids = {"mask"}
assert refused(convert, "Density")
thing.vox.grids = {"density", "color"}
thing.vox.color = "ATTRIBUTE"
assert refused(convert, "colour attribute")
thing.vox.color = "IMAGE"
assert refused(convert, "image")
thing.vox.grids = {"density"}
thing.vox.dim = 10**9
assert refused(convert, "voxel size")
thing.vox.dim = 80
thing.vox.folder = "/proc/nowhere"
assert refused(convert, "/proc/nowhere")
thing.vox.folder = os.getcwd()
assert refused(lambda: bpy.ops.export_scene.vox(filepath=os.path.abspath("a.obj")), ".vdb or .nvdb")
assert refused(lambda: bpy.ops.import_scene.vox(filepath=os.path.abspath("a.vdb")), "no such file")
with open("text.vdb", "w") as file:
    file.write("no voxels")
assert refused(lambda: bpy.ops.import_scene.vox(filepath=os.path.abspath("text.vdb")), "no OpenVDB file")
os.remove("text.vdb")

mesh = thing.data
mesh.vertices[0].co.x = float("nan")
assert refused(convert, "Suzanne")
mesh.clear_geometry()
assert refused(convert, "no faces")
assert os.listdir() == [] and not bpy.data.volumes, os.listdir()

# Cancelled while vox runs: the file that was there stays.
from vox_addon.conversion import Conversion
from vox_addon.preferences import program

empty_scene()
thing = suzanne()
thing.vox.dim = 3000
with open("Suzanne.vdb", "w") as file:
    file.write("old")
steps = Conversion(thing, program(bpy.context), os.path.abspath("Suzanne.vdb")).steps()
fraction, stage = next(steps)
while fraction == 0:
    time.sleep(0.01)
    fraction, stage = next(steps)
assert 0 < fraction < 1 and stage in ("prepare", "surface", "grids", "write"), (fraction, stage)
steps.close()
assert os.listdir() == ["Suzanne.vdb"] and open("Suzanne.vdb").read() == "old"
print("refused in one line")

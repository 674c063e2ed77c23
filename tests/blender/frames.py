"""The operator Convert Frames makes the sequence that the command line makes of the same meshes."""

import glob
import os

import bpy
from meshes import empty_scene, faces_of, moved, same, suzanne, vox, write_obj

FIRST, LAST = 5, 24
empty_scene()
scene = bpy.context.scene
scene.frame_start, scene.frame_end = FIRST, LAST
thing = suzanne()
wave = thing.modifiers.new("Wave", "WAVE")
wave.height, wave.speed, wave.width = 0.2, 0.2, 0.8
for frame, x in (FIRST, 0), (LAST, 3):
    thing.location.x = x
    thing.keyframe_insert("location", frame=frame)
thing.data.edges[10].crease = 1
thing.vox.dim = 60
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath("anim.blend"))
thing.vox.folder = "//voxels"
scene.frame_set(7)
assert bpy.ops.object.vox_convert_frames() == {"FINISHED"}
assert scene.frame_current == 7

volume = bpy.context.object
assert volume.type == "VOLUME" and volume.data.filepath == f"//voxels/Suzanne.{FIRST:04}.vdb"
thing.hide_set(False)
for frame in range(FIRST, LAST + 1):
    scene.frame_set(frame)
    data = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = [moved(data.matrix_world, v.co) for v in data.data.vertices]
    write_obj(f"frame.{frame:04}.obj", points, faces_of(data.data))
    assert volume.data.grids.load(), volume.data.grids.error_message
    assert volume.data.grids.frame_filepath.endswith(f"Suzanne.{frame:04}.vdb")
with open("edges.txt", "w") as file:
    file.write("{} {}\n".format(*thing.data.edges[10].vertices))
target = "blender-3.4" if bpy.app.version < (3, 5) else "blender"
vox("convert", "frame.####.obj", "-o", "frame.####.vdb", "--target", target, "--dim", 60, "--crease-edges", "edges.txt")
made = sorted(glob.glob("voxels/*"))
assert len(made) == LAST - FIRST + 1 and not glob.glob("voxels/.*"), made
for frame in range(FIRST, LAST + 1):
    assert same(f"voxels/Suzanne.{frame:04}.vdb", f"frame.{frame:04}.vdb"), frame
assert not same(made[0], made[-1])

# A single frame again, with the same volume.
assert bpy.ops.object.vox_convert() == {"FINISHED"}
assert bpy.context.object == volume and not volume.data.is_sequence
assert volume.data.filepath == "//voxels/Suzanne.vdb"
print("as the command line")

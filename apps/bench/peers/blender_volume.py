"""Blender's way from a mesh to a volume: the modifiers Subdivision Surface and Mesh to Volume.

    blender --background --factory-startup --python blender_volume.py -- MESH.obj OUT.vdb LEVELS VOXEL_SIZE
"""

import sys

import bpy

mesh, output, levels, voxel_size = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.obj_import(filepath=mesh)
model = bpy.context.selected_objects[0]
model.modifiers.new("smooth", "SUBSURF").levels = int(levels)
volume = bpy.data.objects.new("volume", bpy.data.volumes.new("volume"))
bpy.context.scene.collection.objects.link(volume)
convert = volume.modifiers.new("convert", "MESH_TO_VOLUME")
convert.object = model
convert.resolution_mode = "VOXEL_SIZE"
convert.voxel_size = float(voxel_size)
grids = volume.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.grids
# Blender ends with 0 whatever becomes of its script.
print("written" if grids.save(filepath=output) else "not written")

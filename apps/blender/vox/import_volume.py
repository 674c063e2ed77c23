"""Files of voxels as volume objects with a material: new ones, and new files for old ones."""

import math
import os

import bpy
from mathutils import Matrix

from .framing import frame
from .material import give_material
from .metadata import metadata_of

SOLID_VIEW = 200  # density of the volume in Solid view: enough for a shell one voxel thick
LEAST_BOUNCES = 4  # of light within a volume; without any, filtered light is missing and it is dark


def new_volume(name, collection):
    volume = bpy.data.objects.new(name, bpy.data.volumes.new(name))
    volume.data.display.density = SOLID_VIEW
    collection.objects.link(volume)
    return volume


def set_file(volume, path, frames=None):
    """Gives a volume a file, or the first of a sequence with its numbers, and the material for it."""
    metadata = metadata_of(bpy.path.abspath(path))
    data = volume.data
    # Blender keeps what it has read of a path as long as any copy of the volume shows it.
    data.filepath = ""
    bpy.context.view_layer.update()
    data.is_sequence = False  # the first file counts for the material, whatever frame the scene shows
    data.filepath = path
    give_material(volume, metadata)
    if frames is not None:
        data.is_sequence = True
        data.frame_start, data.frame_duration, data.frame_offset = frames[0], len(frames), frames[0] - 1
    cycles = getattr(bpy.context.scene, "cycles", None)  # None if the user has switched Cycles off
    if cycles is not None:
        cycles.volume_bounces = max(LEAST_BOUNCES, cycles.volume_bounces)
    return metadata


def import_vdb(path):
    """A file as a new volume, selected, to be seen with Cycles. Errors are a VoxError of one line."""
    metadata_of(path)  # before there is a volume
    context = bpy.context
    volume = new_volume(os.path.splitext(os.path.basename(path))[0], context.collection)
    try:
        metadata = set_file(volume, path)
    except RuntimeError:
        bpy.data.volumes.remove(volume.data)  # and the object
        raise
    if metadata.get("creator", b"").startswith(b"Houdini"):  # there, y points up
        volume.matrix_world = Matrix.Rotation(math.pi / 2, 4, "X")
    select(volume)
    context.scene.render.engine = "CYCLES"
    context.view_layer.update()
    return volume


def select(thing):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    if thing.name in bpy.context.view_layer.objects:  # its collection may be excluded
        thing.select_set(True)
        bpy.context.view_layer.objects.active = thing


class ImportVoxels(bpy.types.Operator):
    """Import a .vdb file with a material of its grids, and point the camera at it"""

    bl_idname = "import_scene.vox"
    bl_label = "Import Voxels"
    bl_options = {"UNDO"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.vdb", options={"HIDDEN"})

    def execute(self, context):
        try:
            frame(import_vdb(self.filepath))
        except (RuntimeError, OSError) as wrong:
            self.report({"ERROR"}, str(wrong))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


def menu_entry(menu, context):
    menu.layout.operator(ImportVoxels.bl_idname, text="Voxels (.vdb)")

"""Operators of the panel: convert the mesh, or a range of its frames, and show the voxels in its place."""

import os

import bpy
from mathutils import Matrix

from .child import VoxError
from .conversion import NUMBER, Conversion
from .import_volume import new_volume, select, set_file
from .preferences import program
from .run import Run, RunsConversion


def mesh_object(context):
    """The mesh that is meant: the active object, or the one that the active volume was made from."""
    thing = context.object
    if thing is not None and thing.type == "VOLUME":
        thing = thing.vox.mesh
    is_there = thing is not None and thing.type == "MESH" and thing.name in context.view_layer.objects
    return thing if is_there else None


def volume_of(context, mesh):
    """The volume in the scene that was made from a mesh, or None."""
    return next((thing for thing in context.scene.objects if thing.type == "VOLUME" and thing.vox.mesh == mesh), None)


def _target():
    """Blender 3.4 draws grids half a voxel off, and vox makes up for it."""
    return ["--target", "blender-3.4" if bpy.app.version < (3, 5) else "blender"]


def _folder_of(settings):
    if settings.folder.startswith("//") and not bpy.data.filepath:
        return os.path.join(bpy.app.tempdir, "voxels")
    return bpy.path.abspath(settings.folder)


class _Converts(RunsConversion):
    """Base of the operators."""

    @classmethod
    def poll(cls, context):
        return Run.now is None and mesh_object(context) is not None

    def _made(self, context, ending, frames=None):
        mesh = mesh_object(context)
        if "density" not in mesh.vox.grids:
            raise VoxError("Blender shows no volume without the grid Density; choose it, too")
        path = os.path.join(_folder_of(mesh.vox), bpy.path.clean_name(mesh.name_full) + ending)
        return Conversion(mesh, program(context), path, _target(), frames)

    def end(self, context, conversion):
        mesh = context.view_layer.objects.get(conversion.name)
        if mesh is None:
            raise VoxError(f"{conversion.name} is gone; its voxels are in {conversion.path}")
        volume = volume_of(context, mesh)
        if volume is None:
            volume = new_volume(f"{mesh.name} Voxels", mesh.users_collection[0])
            volume.vox.mesh = mesh
        volume.matrix_world = conversion.place or Matrix.Identity(4)
        path = conversion.first_path()
        if mesh.vox.folder.startswith("//") and bpy.data.filepath:
            path = bpy.path.relpath(path)
        set_file(volume, path, conversion.frames)
        if mesh.vox.use_hide and context.mode == "OBJECT":
            mesh.hide_render = True
            mesh.hide_set(True)
            select(volume)


class ConvertMesh(_Converts, bpy.types.Operator):
    """Convert the mesh into voxels and show them in its place. Voxels made from it before are replaced"""

    bl_idname = "object.vox_convert"
    bl_label = "Convert"
    bl_options = {"UNDO"}

    def begin(self, context):
        return self._made(context, ".vdb")


class ConvertFrames(_Converts, bpy.types.Operator):
    """Convert the mesh in every frame of the scene, with one voxel size, into a sequence of files"""

    bl_idname = "object.vox_convert_frames"
    bl_label = "Convert Frames"
    bl_options = {"UNDO"}

    def begin(self, context):
        scene = context.scene
        if scene.frame_start < 0:
            raise VoxError("files have no negative numbers; let the frames of the scene start at 0 or later")
        return self._made(context, f".{NUMBER}.vdb", range(scene.frame_start, scene.frame_end + 1))

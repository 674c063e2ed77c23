"""File > Export: the voxels of the active mesh as a file for any program."""

import bpy
from bpy_extras.io_utils import ExportHelper

from .child import VoxError
from .conversion import Conversion
from .convert import mesh_object
from .panel import draw_settings
from .preferences import program
from .run import Run, RunsConversion

TARGETS = [
    ("NONE", "Any", "Names of grids as for Blender; z points up"),
    ("HOUDINI", "Houdini", "The names N and Cd; the model is turned so that y points up"),
]


class ExportVoxels(RunsConversion, ExportHelper, bpy.types.Operator):
    """Convert the active mesh, where it is in the world, into a file of voxels, with the settings of its panel Vox"""

    bl_idname = "export_scene.vox"
    bl_label = "Export Voxels"

    filename_ext = ".vdb"
    filter_glob: bpy.props.StringProperty(default="*.vdb;*.nvdb", options={"HIDDEN"})
    target: bpy.props.EnumProperty(name="For", description="Program that will read the file", items=TARGETS)

    @classmethod
    def poll(cls, context):
        return Run.now is None and mesh_object(context) is not None

    def invoke(self, context, event):
        self.is_in_window = True
        return ExportHelper.invoke(self, context, event)

    def execute(self, context):  # after the file is chosen
        in_window = getattr(self, "is_in_window", False) and not bpy.app.background
        return self.start(context) if in_window else self.run(context)

    def draw(self, context):
        self.layout.prop(self, "target")
        draw_settings(self.layout, mesh_object(context).vox)

    def check(self, context):
        return False  # both endings are right: .vdb and .nvdb

    def begin(self, context):
        path = bpy.path.abspath(self.filepath)
        if not path.lower().endswith((".vdb", ".nvdb")):
            raise VoxError(f"{path}: the name of the file must end in .vdb or .nvdb")
        target = ["--target", "houdini", "--up", "z"] if self.target == "HOUDINI" else []
        return Conversion(mesh_object(context), program(context), path, target, in_world=True)

    def end(self, context, conversion):
        pass  # the file is what was asked for


def menu_entry(menu, context):
    menu.layout.operator(ExportVoxels.bl_idname, text="Voxels (.vdb, .nvdb)")

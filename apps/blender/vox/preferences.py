"""The preferences of the add-on: where the program vox is."""

import bpy

from .child import VoxError, find_vox


class VoxPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Path of vox",
        description="The program vox; empty: the one on PATH",
        subtype="FILE_PATH",
    )

    def draw(self, context):
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=f"Found: {program(context)}", icon="CHECKMARK")
        except VoxError as wrong:
            self.layout.label(text=str(wrong), icon="ERROR")


def program(context):
    """Path of the program vox. Raises VoxError if there is none."""
    addon = context.preferences.addons.get(__package__)  # None if a script registers the package
    path = addon.preferences.program if addon and addon.preferences else ""
    return find_vox(bpy.path.abspath(path))

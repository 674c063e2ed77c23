"""The panel Vox in the sidebar of the 3D view."""

import bpy

from .convert import ConvertFrames, ConvertMesh, mesh_object, volume_of
from .run import CancelRun, Run


def draw_settings(layout, settings):
    """The settings of a mesh that both Convert and Export use."""
    box = layout.box().column()
    box.row().prop(settings, "resolution", expand=True)
    box.prop(settings, "dim" if settings.resolution == "DIM" else "voxel_size", text="")
    box.prop(settings, "use_modifiers")

    box = layout.box().column()
    box.prop(settings, "use_smooth")
    if settings.use_smooth:
        box.prop(settings, "interpolate", text="")
        box.prop(settings, "boundary", text="")
        box.label(text="Stay sharp:")
        row = box.row(align=True)
        row.prop(settings, "use_creases", toggle=True)
        row.prop(settings, "use_sharp", toggle=True)
        row = box.row(align=True)
        row.prop(settings, "use_angle", toggle=True)
        angle = row.row(align=True)
        angle.enabled = settings.use_angle
        angle.prop(settings, "angle", text="")

    box = layout.box().column()
    box.label(text="Grids:")
    box.grid_flow(columns=2, align=True, row_major=True, even_columns=True).prop(settings, "grids")
    if "color" in settings.grids:
        box.prop(settings, "color", text="")
        if settings.color == "IMAGE":
            box.template_ID(settings, "image", open="image.open")
    box.prop(settings, "use_soft")
    box.prop(settings, "use_solid")
    box.prop(settings, "more")


class VoxPanel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_vox"
    bl_label = "Vox"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Vox"

    def draw(self, context):
        layout = self.layout
        if Run.now is not None:
            layout.label(text=Run.now.name, icon="MESH_DATA")
            row = layout.row(align=True)
            row.prop(context.window_manager, "vox_progress", text=Run.now.stage.capitalize(), slider=True)
            row.operator(CancelRun.bl_idname, text="", icon="X")
            return
        mesh = mesh_object(context)
        if mesh is None:
            layout.label(text="Select a mesh", icon="INFO")
            return
        layout.label(text=mesh.name, icon="MESH_DATA")
        draw_settings(layout, mesh.vox)
        box = layout.box().column()
        box.prop(mesh.vox, "folder", text="")
        if mesh.vox.folder.startswith("//") and not bpy.data.filepath:
            box.label(text="Not saved: voxels end with Blender", icon="INFO")
        box.prop(mesh.vox, "use_hide")
        column = layout.column()
        column.scale_y = 1.4
        column.operator(
            ConvertMesh.bl_idname,
            text="Convert Again" if volume_of(context, mesh) else "Convert",
            icon="VOLUME_DATA",
        )
        scene = context.scene
        layout.operator(
            ConvertFrames.bl_idname,
            text=f"Convert Frames {scene.frame_start} to {scene.frame_end}",
            icon="RENDER_ANIMATION",
        )
        if context.engine.startswith("BLENDER_EEVEE"):
            layout.label(text="Cycles shows voxels best", icon="INFO")

"""Smooth voxel models of meshes, made by the program vox."""

import bpy

from . import convert, export_voxels, import_volume, panel, preferences, run, settings

# Read by Blender up to 4.1. Later versions read blender_manifest.toml.
bl_info = {
    "name": "Vox",
    "description": "Smooth voxel models (OpenVDB) of meshes, made by the program vox",
    "author": "The libvox authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > Vox; File > Import; File > Export",
    "category": "Object",
}

CLASSES = (
    settings.VoxSettings,
    preferences.VoxPreferences,
    run.CancelRun,
    convert.ConvertMesh,
    convert.ConvertFrames,
    import_volume.ImportVoxels,
    export_voxels.ExportVoxels,
    panel.VoxPanel,
)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Object.vox = bpy.props.PointerProperty(type=settings.VoxSettings)
    bpy.types.WindowManager.vox_progress = bpy.props.FloatProperty(
        name="Progress", subtype="PERCENTAGE", min=0, max=100, precision=0, options={"SKIP_SAVE"}
    )
    bpy.types.TOPBAR_MT_file_import.append(import_volume.menu_entry)
    bpy.types.TOPBAR_MT_file_export.append(export_voxels.menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(export_voxels.menu_entry)
    bpy.types.TOPBAR_MT_file_import.remove(import_volume.menu_entry)
    del bpy.types.WindowManager.vox_progress
    del bpy.types.Object.vox
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)

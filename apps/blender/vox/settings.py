"""The settings that each mesh has in the panel, and the options of vox that they are."""

import shlex

import bpy

from .child import VoxError

GRIDS = [
    ("density", "Density", "One value at each voxel; Blender shows no volume without it", 1),
    ("mask", "Mask", "The voxels of the surface", 2),
    ("surface", "Surface", "A level set: signed distances to the smooth surface", 4),
    ("normal", "Normal", "The normal of the surface; the material computes the light of the sun from it", 8),
    ("color", "Color", "The colour of each voxel", 16),
    ("part", "Part", "The number of the material of each voxel", 32),
]
COLORS = [
    ("MATERIAL", "Colors of Materials", "The base colours of the materials, and their images"),
    (
        "ATTRIBUTE",
        "Color Attribute",
        "The active colour attribute. Colours of face corners are kept if each face has one colour,"
        " else they are blended at the vertices",
    ),
    ("IMAGE", "One Image", "One image, placed by the active UV map"),
]


class VoxSettings(bpy.types.PropertyGroup):
    mesh: bpy.props.PointerProperty(type=bpy.types.Object, description="The mesh that this volume was made from")
    resolution: bpy.props.EnumProperty(
        name="Resolution",
        items=[
            ("DIM", "Voxels", "A number of voxels along the longest side"),
            ("SIZE", "Voxel Size", "The edge length of a voxel"),
        ],
    )
    dim: bpy.props.IntProperty(
        name="Voxels",
        description="Voxels along the longest side of the mesh",
        default=256,
        min=1,
        soft_max=4096,
    )
    voxel_size: bpy.props.FloatProperty(
        name="Voxel Size",
        description="Edge length of a voxel",
        subtype="DISTANCE",
        default=0.01,
        min=1e-5,
        precision=4,
    )
    use_modifiers: bpy.props.BoolProperty(
        name="Modifiers", description="Convert the mesh with its modifiers applied", default=True
    )
    use_smooth: bpy.props.BoolProperty(
        name="Smooth",
        description="Smooth the mesh by Doo-Sabin subdivision; off: convert its polygons as they are",
        default=True,
    )
    interpolate: bpy.props.EnumProperty(
        name="Pass Through",
        description="Vertices that the smooth surface passes through",
        items=[
            ("none", "Through No Vertices", "The smoothest surface; it is a bit smaller than the mesh"),
            ("interior", "Through Inner Vertices", "All vertices that are not on a boundary"),
            ("boundary", "Through Boundary Vertices", "All vertices on a boundary"),
            ("both", "Through All Vertices", "The surface keeps the size of the mesh"),
        ],
    )
    boundary: bpy.props.EnumProperty(
        name="Boundary",
        description="Where an open surface ends",
        items=[
            ("extend", "Smooth Boundary", "At a smooth curve along the boundary of the mesh"),
            ("corners", "Boundary with Corners", "The same, but with corners at vertices that only one face has"),
            ("free", "Free Boundary", "Short of the boundary of the mesh, because smoothing shrinks the surface"),
        ],
    )
    use_creases: bpy.props.BoolProperty(
        name="Creases",
        description="Edges with a crease of 0.5 or more stay sharp, and so do such vertices as corners."
        " vox knows sharp and smooth only, nothing between",
        default=True,
    )
    use_sharp: bpy.props.BoolProperty(
        name="Sharp Edges", description="Edges that are marked sharp stay sharp", default=True
    )
    use_angle: bpy.props.BoolProperty(
        name="Angle", description="Edges whose faces turn by more than this angle stay sharp"
    )
    angle: bpy.props.FloatProperty(
        name="Angle",
        description="Edges whose faces turn by more than this angle stay sharp",
        subtype="ANGLE",
        default=0.698132,
        min=0,
        max=3.141592,
    )
    grids: bpy.props.EnumProperty(
        name="Grids", description="Grids of the file", items=GRIDS, options={"ENUM_FLAG"}, default={"density"}
    )
    color: bpy.props.EnumProperty(name="Color from", description="What the grid Color is made of", items=COLORS)
    image: bpy.props.PointerProperty(
        name="Image", description="Image on the whole mesh, placed by the active UV map", type=bpy.types.Image
    )
    use_soft: bpy.props.BoolProperty(
        name="Soft Edges",
        description="The density fades within a voxel at the surface, so that no steps show",
        default=True,
    )
    use_solid: bpy.props.BoolProperty(
        name="Solid", description="Fill the inside; off: a surface, one voxel thick"
    )
    more: bpy.props.StringProperty(
        name="More", description="More options of vox convert, such as --weld 0.001 --close 4"
    )
    folder: bpy.props.StringProperty(
        name="Folder",
        description="Folder of the files of voxels. Beside a .blend file that is not saved yet,"
        " a folder that lasts as long as Blender runs",
        subtype="DIR_PATH",
        default="//voxels",
    )
    use_hide: bpy.props.BoolProperty(
        name="Hide Mesh", description="Hide the mesh, which covers its voxels, after the conversion", default=True
    )


def options(settings, scale):
    """Options of `vox convert`. Lengths of the mesh that vox reads, times `scale`, are those of the world."""
    if not settings.grids:
        raise VoxError("no grid is chosen; choose Density")
    made = ["--grids", ",".join(row[0] for row in GRIDS if row[0] in settings.grids)]
    if settings.resolution == "DIM":
        made += ["--dim", str(settings.dim)]
    else:
        size = float(f"{settings.voxel_size:.7g}")  # 0.05 as typed, not the float next to it
        made += ["--voxel-size", repr(size / scale)]
    if settings.use_smooth:
        made += ["--interpolate", settings.interpolate, "--boundary", settings.boundary]
        if settings.use_angle:
            made += ["--crease", f"{settings.angle * 57.29577951308232:.6g}"]
    else:
        made += ["--until", "levels=0"]
    made += ["--edge", "soft" if settings.use_soft else "hard"]
    made += ["--fill", "solid" if settings.use_solid else "surface"]
    if "part" in settings.grids:
        made += ["--part-by", "group"]
    try:
        return made + shlex.split(settings.more)
    except ValueError as wrong:
        raise VoxError(f"More options: {wrong}")

"""Voxel models of vox in Blender: import a .vdb with a ready material, and frame it.

    blender --python vox_import.py -- model.vdb                       look at it
    blender --background --python vox_import.py -- model.vdb out.png  a picture of it

Or open this file in Blender's Text Editor and run it: File > Import then has "Voxel model (.vdb)".
"""

import os
import struct
import sys
import threading
import time

import bpy
from mathutils import Color, Vector

# Optical depth of one voxel: a shell that thin is to look solid.
DEPTH_OF_VOXEL = 6.0
LIGHT = Vector((-0.5, -0.6, 0.62))  # towards the sun, in world space
TOWARDS_CAMERA = Vector((0.35, -0.85, 0.35))  # from the front, a bit above and to the right
HUE_STEP = 0.618034  # from the hue of a part to that of the next
PART_SATURATION = 0.75
PART_VALUE = 0.8
LENS = 100  # millimetres; a long lens fits the model closer than Blender's 50
# Of out.png. Blender's own 1920 x 1080 pixels of 4096 samples would take hours.
PICTURE_SIZE = 640, 480
PICTURE_SAMPLES = 32
PICTURE_SECONDS = 35  # of samples; a slower machine takes fewer


def grids_of(volume):
    """Grids of a volume by name, loaded from its file."""
    grids = volume.data.grids
    if not grids.load():
        raise RuntimeError(f"{volume.data.filepath}: {grids.error_message}")
    return {grid.name: grid for grid in grids}


def densities_of(grids):
    """Names of the grids that together are the density: `density`, or those of the parts of --split."""
    if "density" in grids:
        return ["density"]
    return [grid.name for grid in grids.values() if grid.data_type == "FLOAT" and grid.name != "surface"]


def color_of_part(number):
    """A colour of its own for each part: the hues of near numbers differ much."""
    color = Color()
    color.hsv = number * HUE_STEP % 1, PART_SATURATION, PART_VALUE
    return color


def metadata_of(path):
    """The metadata of a file: values as bytes, by name.

    A .vdb begins with 21 bytes of magic number, versions and flags and 36 of a unique name. Then it
    counts its metadata, each a name, a type and a value, all with their lengths before them.
    """
    with open(path, "rb") as file:
        if file.read(21 + 36)[:4] != b" BDV":
            raise RuntimeError(f"{path} is no OpenVDB file; vox convert makes one of a mesh")

        def sized():
            return file.read(struct.unpack("<I", file.read(4))[0])

        (count,) = struct.unpack("<I", file.read(4))
        metadata = {}
        for _ in range(count):
            name, _ = sized(), sized()
            metadata[name.decode()] = sized()
    return metadata


def add_material(volume, metadata):
    """A material of the grids that are there; `metadata` is that of the file.

    Blender mixes the values of neighbours. Around a soft density, the grid color goes on for a voxel: what is
    mixed are colours. Around a hard one, color is 0, and so is density: then color / (density / gain) is the
    colour of those voxels that are there. Without the grid color, each part has a colour of its own: each number
    of the grid part, or each grid of a split density. With the grid normal, the light is computed by the material;
    without, the volume scatters the light of the scene.
    """
    grids = grids_of(volume)
    densities = densities_of(grids)
    if not densities:
        raise RuntimeError(f"{volume.data.filepath} has no grid density; add it to --grids of vox convert")
    voxel = max(grids[densities[0]].matrix_object.to_scale())
    (gain,) = struct.unpack("<f", metadata.get("vox_gain", struct.pack("<f", 1)))
    is_soft = metadata.get("vox_edge") == b"soft"
    material = bpy.data.materials.new(volume.name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()

    def node(kind, place, **settings):
        made = nodes.new(kind)
        made.location = place
        for name, value in settings.items():
            setattr(made, name, value)
        return made

    def vector_math(operation, place, a, b):
        made = node("ShaderNodeVectorMath", place, operation=operation)
        for socket, value in zip(made.inputs, (a, b)):
            if isinstance(value, bpy.types.NodeSocket):
                links.new(value, socket)
            else:
                socket.default_value = value
        return made

    def math(operation, place, a, b=0.0):
        made = node("ShaderNodeMath", place, operation=operation)
        for socket, value in zip(made.inputs, (a, b)):
            if isinstance(value, bpy.types.NodeSocket):
                links.new(value, socket)
            else:
                socket.default_value = value
        return made

    def value_of(name, place):
        return node("ShaderNodeAttribute", place, attribute_name=name).outputs["Fac"]

    # A density that is split: the sum of its parts, and the sum of their colours, each times its density.
    values = [value_of(name, (-1400 - 400 * i, 0)) for i, name in enumerate(densities)]
    total, painted = values[0], None
    if len(values) > 1:
        for i, value in enumerate(values[1:], 1):
            total = math("ADD", (-1200 - 400 * i, 0), total, value).outputs[0]
        for i, value in enumerate(values):
            added = vector_math("MULTIPLY_ADD", (-1200 - 400 * i, -300), color_of_part(i + 1), value)
            if painted is not None:
                links.new(painted, added.inputs[2])
            painted = added.outputs[0]
    density = math("DIVIDE", (-900, 0), total, gain)
    depth = node("ShaderNodeMath", (-200, -200), operation="MULTIPLY")
    depth.inputs[1].default_value = DEPTH_OF_VOXEL / voxel
    links.new(density.outputs[0], depth.inputs[0])
    shader = node("ShaderNodeVolumePrincipled", (0, 0))
    shader.inputs["Density Attribute"].default_value = ""
    links.new(depth.outputs[0], shader.inputs["Density"])

    color = None
    if "color" in grids:
        attribute = node("ShaderNodeAttribute", (-900, 250), attribute_name="color")
        color = attribute.outputs["Vector"]
        if not is_soft:
            color = vector_math("DIVIDE", (-650, 250), color, density.outputs[0]).outputs[0]
        links.new(color, shader.inputs["Color"])
    elif painted is not None:
        color = vector_math("DIVIDE", (-650, 250), painted, total).outputs[0]
        links.new(color, shader.inputs["Color"])
    elif "part" in grids and is_soft:
        # At soft edges, part is blended with 0, and nothing tells how much of the blend are voxels.
        print("the grid part has no colours with soft edges; use --edge hard, or --split part", flush=True)
    elif "part" in grids:
        part = math("DIVIDE", (-900, 250), value_of("part", (-1150, 250)), density.outputs[0]).outputs[0]
        number = math("ROUND", (-750, 250), part).outputs[0]
        hue = math("FRACT", (-450, 250), math("MULTIPLY", (-600, 250), number, HUE_STEP).outputs[0])
        combined = node("ShaderNodeCombineColor", (-300, 250), mode="HSV")
        links.new(hue.outputs[0], combined.inputs[0])
        combined.inputs[1].default_value, combined.inputs[2].default_value = PART_SATURATION, PART_VALUE
        color = combined.outputs[0]
        links.new(color, shader.inputs["Color"])
    if "normal" in grids:
        attribute = node("ShaderNodeAttribute", (-900, 500), attribute_name="normal")
        unit = vector_math("NORMALIZE", (-650, 500), attribute.outputs["Vector"], (0, 0, 0))
        light = volume.matrix_world.inverted().to_3x3() @ LIGHT
        facing = vector_math("DOT_PRODUCT", (-450, 500), unit.outputs[0], light.normalized())
        strength = node("ShaderNodeMapRange", (-250, 500))
        strength.inputs["From Min"].default_value = -0.2
        strength.inputs["To Min"].default_value = 0.15
        links.new(facing.outputs["Value"], strength.inputs["Value"])
        shaded = vector_math("MULTIPLY", (-50, 300), color or (0.8, 0.8, 0.8), strength.outputs[0])
        # All light is emitted: with an optical depth, brightness times density is what shows.
        emitted = node("ShaderNodeMath", (-200, -400), operation="MULTIPLY")
        emitted.inputs[1].default_value = 1.0
        links.new(depth.outputs[0], emitted.inputs[0])
        links.new(shaded.outputs[0], shader.inputs["Emission Color"])
        links.new(emitted.outputs[0], shader.inputs["Emission Strength"])
        for link in list(shader.inputs["Color"].links):
            links.remove(link)
        shader.inputs["Color"].default_value = (0, 0, 0, 1)
    output = node("ShaderNodeOutputMaterial", (300, 0))
    links.new(shader.outputs[0], output.inputs["Volume"])
    volume.data.materials.append(material)
    return material


def import_vdb(path):
    """The file as a volume object with a material.

    Errors are a RuntimeError of one line.
    """
    if not os.path.isfile(path):
        raise RuntimeError(f"{path}: no such file; check the path")
    metadata = metadata_of(path)
    bpy.ops.object.volume_import(filepath=path, files=[])
    volume = bpy.context.object
    add_material(volume, metadata)
    # Filtered light bounces within a dense volume; none would make it dark.
    bpy.context.scene.cycles.volume_bounces = max(4, bpy.context.scene.cycles.volume_bounces)
    bpy.context.scene.render.engine = "CYCLES"
    bpy.context.view_layer.update()
    return volume


def frame(volume):
    """Points the camera at the middle of the volume, with a sun, both made if there are none."""
    scene = bpy.context.scene
    corners = [volume.matrix_world @ Vector(corner) for corner in volume.bound_box]
    middle = sum(corners, Vector()) / len(corners)
    if scene.camera is None:
        scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(scene.camera)
    camera = scene.camera
    camera.data.lens = LENS
    turn = (-TOWARDS_CAMERA).to_track_quat("-Z", "Y")
    # The slopes of the sides of the picture, in the space of the camera, which looks along -z.
    edge = camera.data.view_frame(scene=scene)[0]
    slopes = abs(edge.x / edge.z), abs(edge.y / edge.z)
    far = 0
    for corner in corners:
        seen = turn.inverted() @ (corner - middle)
        far = max(far, seen.z + abs(seen.x) / slopes[0], seen.z + abs(seen.y) / slopes[1])
    camera.rotation_euler = turn.to_euler()
    camera.location = middle + turn @ Vector((0, 0, far))
    distance = max((corner - camera.location).length for corner in corners)
    camera.data.clip_start = distance / 10000
    camera.data.clip_end = distance * 10
    if not any(o.type == "LIGHT" and o.data.type == "SUN" for o in scene.objects):
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy = 5
        sun.rotation_euler = (-LIGHT).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(sun)


def make_way():
    """Removes the cube of an untouched startup scene, which would hide the model."""
    cube = bpy.data.objects.get("Cube")
    if not bpy.data.filepath and cube is not None and len(cube.data.vertices) == 8:
        bpy.data.objects.remove(cube)


class ImportVoxelModel(bpy.types.Operator):
    """Import a .vdb of vox with a material, and frame it"""

    bl_idname = "import_scene.vox"
    bl_label = "Voxel model (.vdb)"
    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.vdb", options={"HIDDEN"})

    def execute(self, context):
        try:
            frame(import_vdb(self.filepath))
        except RuntimeError as wrong:
            self.report({"ERROR"}, str(wrong))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


def menu_entry(menu, context):
    menu.layout.operator(ImportVoxelModel.bl_idname)


def render_picture(path):
    """Writes a picture of the scene. Tells every few seconds how long it takes."""
    scene = bpy.context.scene
    scene.cycles.samples = PICTURE_SAMPLES
    scene.cycles.time_limit = PICTURE_SECONDS
    scene.cycles.use_denoising = False  # Debian's Blender has no denoiser
    scene.render.filepath = path
    start = time.monotonic()
    done = threading.Event()

    def tell():
        while not done.wait(5):
            print(f"rendering: {time.monotonic() - start:.0f} s of about {PICTURE_SECONDS}", flush=True)

    teller = threading.Thread(target=tell)
    teller.start()
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        done.set()
        teller.join()


def main(arguments):
    if not arguments:
        bpy.utils.register_class(ImportVoxelModel)
        bpy.types.TOPBAR_MT_file_import.append(menu_entry)
        return
    make_way()
    volume = import_vdb(arguments[0])
    scene = bpy.context.scene
    if len(arguments) > 1:
        scene.render.resolution_x, scene.render.resolution_y = PICTURE_SIZE
    frame(volume)
    if len(arguments) > 1:
        render_picture(arguments[1])


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    except RuntimeError as wrong:
        print("vox_import: error:", str(wrong).removeprefix("Error: ").strip(), file=sys.stderr)
        if bpy.app.background:
            sys.exit(1)

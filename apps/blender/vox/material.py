"""The material of a volume of vox, made of the grids of its file."""

import struct

import bpy
from mathutils import Color

from .child import VoxError
from .framing import LIGHT

# Optical depth of one voxel: a shell that thin is to look solid.
DEPTH_OF_VOXEL = 6.0
HUE_STEP = 0.618034  # from the hue of a part to that of the next
PART_SATURATION = 0.75
PART_VALUE = 0.8
KIND = "vox_kind"  # property of our materials: what their nodes were made for
# Nodes whose values follow the file, by name.
GAIN, DEPTH, SUN = "Vox Gain", "Vox Depth", "Vox Sun"


def grids_of(volume):
    """Grids of a volume by name, loaded from its file."""
    grids = volume.data.grids
    if not grids.load():
        raise VoxError(f"{volume.data.filepath}: {grids.error_message}")
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


def give_material(volume, metadata):
    """Gives a volume a material of the grids of its file; `metadata` is that of the file.

    If it has one of ours that fits, only the values that follow the file change: what the user has
    changed stays. A material of the user's own stays as it is.
    """
    grids = grids_of(volume)
    densities = densities_of(grids)
    if not densities:
        raise VoxError(f"{volume.data.filepath} has no grid density; choose it, or add it to --grids of vox convert")
    is_soft = metadata.get("vox_edge") == b"soft"
    kind = " ".join(["soft" if is_soft else "hard", *densities, *sorted({"color", "normal", "part"} & set(grids))])
    material = volume.active_material
    if material is None:
        material = bpy.data.materials.new(volume.name)
        volume.data.materials.append(material)
    elif KIND not in material:
        return
    if material.get(KIND) != kind:
        material.use_nodes = True
        _make_nodes(material.node_tree, grids, densities, is_soft)
        material[KIND] = kind
    _set_values(material.node_tree.nodes, volume, grids[densities[0]], metadata)


def _set_values(nodes, volume, density, metadata):
    (gain,) = struct.unpack("<f", metadata.get("vox_gain", struct.pack("<f", 1)))
    light = (volume.matrix_world.inverted_safe().to_3x3() @ LIGHT).normalized()
    depth = DEPTH_OF_VOXEL / max(density.matrix_object.to_scale())
    for name, value in (GAIN, gain), (DEPTH, depth), (SUN, light):
        if name in nodes:
            nodes[name].inputs[1].default_value = value


def _make_nodes(tree, grids, densities, is_soft):
    """Makes the nodes of a material, for the grids that are there.

    Blender mixes the values of neighbours. Around a soft density, the grid color goes on for a voxel: what is
    mixed are colours. Around a hard one, color is 0, and so is density: then color / (density / gain) is the
    colour of those voxels that are there. Without the grid color, each part has a colour of its own: each number
    of the grid part, or each grid of a split density. With the grid normal, the light is computed by the material;
    without, the volume scatters the light of the scene.
    """
    nodes, links = tree.nodes, tree.links
    nodes.clear()

    def node(kind, place, **settings):
        made = nodes.new(kind)
        made.location = place
        for name, value in settings.items():
            setattr(made, name, value)
        return made

    def vector_math(operation, place, a, b):
        return calculation("ShaderNodeVectorMath", operation, place, a, b)

    def math(operation, place, a, b=0.0):
        return calculation("ShaderNodeMath", operation, place, a, b)

    def calculation(kind, operation, place, a, b):
        made = node(kind, place, operation=operation)
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
    density = math("DIVIDE", (-900, 0), total)
    depth = math("MULTIPLY", (-200, -200), density.outputs[0])
    density.name, depth.name = GAIN, DEPTH
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
        facing = vector_math("DOT_PRODUCT", (-450, 500), unit.outputs[0], LIGHT)
        facing.name = SUN
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

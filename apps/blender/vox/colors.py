"""The colours of a mesh as OBJ files have them: of its vertices, or a material for each face."""

import collections

import numpy
from mathutils import Matrix

from . import images
from .arrays import read, srgb
from .child import VoxError

GREY = (0.8, 0.8, 0.8)
_MAPPED = "Location", "Rotation", "Scale"  # inputs of the node Mapping

# Colours of a mesh. `vertices`: a row for each, or None. `faces`: which material each face has.
# `materials`: lines of an MTL file. `uv`: texture coordinates of the corners, or None.
Colors = collections.namedtuple("Colors", "vertices faces materials uv", defaults=(None, None, (), None))


def of_mesh(mesh, settings, folder, warn):
    """Colours as the settings want them. Images are saved in `folder`; `warn` takes lines of text."""
    if settings.color == "ATTRIBUTE":
        return _of_attribute(mesh)
    if settings.color == "IMAGE":
        return _of_image(mesh, settings.image, folder)
    return _of_materials(mesh, folder, warn)


def _plain(color):
    return ["Kd %.17g %.17g %.17g" % tuple(color[:3])]


def _of_attribute(mesh):
    attribute = mesh.color_attributes.active_color
    if attribute is None:
        raise VoxError("the mesh has no colour attribute; add one, or take the colours of the materials")
    values = read(attribute.data, "color", 4)[:, :3]  # linear light
    if attribute.domain == "POINT":
        return Colors(vertices=srgb(values))
    starts = read(mesh.polygons, "loop_start", kind=numpy.int32)
    sizes = read(mesh.polygons, "loop_total", kind=numpy.int32)
    if (values == numpy.repeat(values[starts], sizes, 0)).all():  # loops are in the order of the faces
        rows, faces = numpy.unique(values[starts], axis=0, return_inverse=True)
        return Colors(faces=faces.ravel(), materials=[_plain(row) for row in rows.tolist()])
    sums = numpy.zeros((len(mesh.vertices), 4))
    corners = read(mesh.loops, "vertex_index", kind=numpy.int32)
    numpy.add.at(sums, corners, numpy.hstack((values, numpy.ones((len(values), 1)))))
    return Colors(vertices=srgb(sums[:, :3] / numpy.maximum(sums[:, 3:], 1)))


def _coordinates(mesh, name=""):
    """Texture coordinates of the corners: those of a name, or of the map that is active for renders."""
    layers = mesh.uv_layers
    layer = layers.get(name) or next((layer for layer in layers if layer.active_render), None)
    if layer is None:
        raise VoxError("the mesh has no UV map, which its image needs; unwrap it")
    return read(layer.data, "uv", 2)


def _of_image(mesh, image, folder):
    if image is None:
        raise VoxError("no image is chosen for the colours; choose one")
    return Colors(
        faces=numpy.zeros(len(mesh.polygons), int),
        materials=[["map_Kd " + images.save(image, folder)]],
        uv=_coordinates(mesh),
    )


def _of_materials(mesh, folder, warn):
    looks = [_look_of(material, warn) for material in mesh.materials] or [_Look(GREY)]
    faces = numpy.minimum(read(mesh.polygons, "material_index", kind=numpy.int32), len(looks) - 1)
    used = set(faces.tolist())
    uv, lines = None, []
    slots = numpy.repeat(faces, read(mesh.polygons, "loop_total", kind=numpy.int32))
    for slot, look in enumerate(looks):
        lines.append(_plain(look.color))
        if look.image is None or slot not in used:
            continue
        placed = _coordinates(mesh, look.uv_map)
        if look.matrix is not None:
            placed = placed @ look.matrix[:2, :2].T + look.matrix[:2, 3]
        uv = numpy.zeros_like(placed) if uv is None else uv
        uv[slots == slot] = placed[slots == slot]
        clamp = "" if look.repeats else "-clamp on "
        lines[-1].append("map_Kd " + clamp + images.save(look.image, folder))
    return Colors(faces=faces, materials=lines, uv=uv)


# What a material looks like: a colour in linear light, and an image with its place, or None.
_Look = collections.namedtuple("_Look", "color image uv_map matrix repeats", defaults=(None, "", None, True))


def _look_of(material, warn):
    if material is None:
        return _Look(GREY)
    socket = _base_color(material)
    if socket is None:
        return _Look(tuple(material.diffuse_color))
    if not socket.is_linked:
        return _Look(tuple(socket.default_value))
    node = socket.links[0].from_node
    if node.type == "RGB":
        return _Look(tuple(node.outputs[0].default_value))
    placed = _placement(node) if node.type == "TEX_IMAGE" and node.image else None
    if placed is None or node.image.source == "TILED":
        warn(
            f"material {material.name}: vox reads plain base colours and images placed by a UV map, not"
            " other nodes; the colour of the viewport is used"
        )
        return _Look(tuple(material.diffuse_color))
    return _Look(GREY, node.image, *placed, node.extension == "REPEAT")


def _base_color(material):
    """The socket of the base colour of the shader that the output shows; None without such nodes."""
    if not material.use_nodes or material.node_tree is None:
        return None
    output = material.node_tree.get_output_node("ALL")
    if output is None or not output.inputs["Surface"].is_linked:
        return None
    inputs = output.inputs["Surface"].links[0].from_node.inputs
    return inputs.get("Base Color") or inputs.get("Color")


def _placement(node):
    """Name of the UV map that places an image, and a matrix or None; None if other nodes do."""
    vector, matrix = node.inputs["Vector"], None
    if vector.is_linked and vector.links[0].from_node.type == "MAPPING":
        mapping = vector.links[0].from_node
        if mapping.vector_type != "POINT" or any(mapping.inputs[name].is_linked for name in _MAPPED):
            return None
        location, rotation, scale = (mapping.inputs[name].default_value for name in _MAPPED)
        matrix = numpy.array(Matrix.LocRotScale(location, rotation, scale))
        vector = mapping.inputs["Vector"]
    if not vector.is_linked:
        return "", matrix
    source = vector.links[0]
    if source.from_node.type == "UVMAP":
        return source.from_node.uv_map, matrix
    return ("", matrix) if source.from_socket.name == "UV" else None


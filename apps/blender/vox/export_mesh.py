"""A mesh as files for vox: a scene of one object (.toml), its faces (.obj), its materials (.mtl)."""

import os

import bpy
import numpy

from . import colors, sharp
from .arrays import lines, read
from .child import VoxError


def uniform_scale(place):
    """The scale of a matrix; None if it is not the same in all directions."""
    square = numpy.array(place.to_3x3())
    square = square.T @ square
    scale = square.trace() / 3
    return scale**0.5 if numpy.allclose(square, scale * numpy.eye(3), rtol=0, atol=1e-6 * scale) else None


def write(mesh, place, settings, folder, name, warn):
    """Writes the files; returns the path of the scene.

    Faces keep all their corners, and vertices their numbers. Each material is a group, too, which is
    what the grid part numbers.
    @param place  matrix from the mesh to the coordinates of the files, or None
    @param name   of the files, without an ending
    """
    if not mesh.polygons:
        raise VoxError("the mesh has no faces; vox converts the faces of a mesh")
    points = read(mesh.vertices, "co", 3).astype(float)
    if place is not None:
        matrix = numpy.array(place)
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
    wants_color = "color" in settings.grids
    looks = colors.of_mesh(mesh, settings, folder, warn) if wants_color else colors.Colors()
    with open(os.path.join(folder, f"{name}.mtl"), "w", encoding="utf-8") as file:
        for number, material in enumerate(looks.materials):
            file.write("\n".join([f"newmtl m{number}", *material, ""]))
    with open(os.path.join(folder, f"{name}.obj"), "w", encoding="utf-8") as file:
        file.write(f"mtllib {name}.mtl\n")
        if looks.vertices is None:
            file.write(lines("v" + 3 * " %.17g" + "\n", points))
        else:
            file.write(lines("v" + 6 * " %.17g" + "\n", numpy.hstack((points, looks.vertices))))
        if looks.uv is not None:
            file.write(lines("vt %.17g %.17g\n", looks.uv))
        is_mirrored = place is not None and place.determinant() < 0
        _write_faces(file, mesh, looks, _group_names(mesh, name), -1 if is_mirrored else 1)
    scene = os.path.join(folder, f"{name}.toml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(f'[[object]]\nname = "{name}"\nmesh = "{name}.obj"\n')
        if settings.use_smooth:
            edges = sharp.edges_of(mesh, settings.use_creases, settings.use_sharp)
            file.write(f"crease_edges = {edges.tolist()}\n")
            file.write(f"corner_vertices = {sharp.corners_of(mesh, settings.use_creases).tolist()}\n")
    return scene


def _group_names(mesh, name):
    """A name for each material of the mesh; `name` if it has none."""
    return [bpy.path.clean_name(material.name) if material else name for material in mesh.materials] or [name]


def _write_faces(file, mesh, looks, groups, direction):
    """The faces in their order, with a new group and material wherever these change.

    @param direction  of the corners around a face: -1 turns the face over
    """
    corners = read(mesh.loops, "vertex_index", kind=numpy.int32) + 1
    starts = read(mesh.polygons, "loop_start", kind=numpy.int32)
    sizes = read(mesh.polygons, "loop_total", kind=numpy.int32)
    slots = numpy.minimum(read(mesh.polygons, "material_index", kind=numpy.int32), len(groups) - 1)
    kinds = slots if looks.faces is None else looks.faces
    if looks.uv is None:
        texts = [str(corner) for corner in corners.tolist()]
    else:
        texts = [f"{corner}/{i}" for i, corner in enumerate(corners.tolist(), 1)]
    before = None
    for start, size, slot, kind in zip(starts.tolist(), sizes.tolist(), slots.tolist(), kinds.tolist()):
        if before != (slot, kind):
            file.write(f"g {groups[slot]}\n")
            if looks.faces is not None:
                file.write(f"usemtl m{kind}\n")
            before = slot, kind
        file.write(f"f {' '.join(texts[start:start + size][::direction])}\n")

"""What stays sharp of a mesh: edges and corners."""

import bpy
import numpy

from .arrays import read

SHARP = 0.5  # creases from here on are sharp; vox knows nothing between sharp and smooth


def _creased(mesh, rows, attribute, layers):
    """Which rows (edges or vertices) have a crease: an attribute since Blender 4.0, a layer before."""
    if bpy.app.version < (4, 0):
        found = next(iter(getattr(mesh, layers)), None)
    else:
        found = mesh.attributes.get(attribute)
    return read(found.data, "value") >= SHARP if found else numpy.zeros(len(rows), bool)


def edges_of(mesh, use_creases, use_sharp):
    """The sharp edges, as two numbers of vertices each. Loose edges do not count."""
    sharp = numpy.zeros(len(mesh.edges), bool)
    if use_creases:
        sharp |= _creased(mesh, mesh.edges, "crease_edge", "edge_creases")
    if use_sharp:
        sharp |= read(mesh.edges, "use_edge_sharp", kind=bool)
    of_faces = numpy.zeros(len(mesh.edges), bool)
    of_faces[read(mesh.loops, "edge_index", kind=numpy.int32)] = True
    return read(mesh.edges, "vertices", 2, numpy.int32)[sharp & of_faces]


def corners_of(mesh, use_creases):
    """The vertices that are sharp corners. Loose vertices do not count."""
    if not use_creases:
        return numpy.zeros(0, numpy.int32)
    of_faces = numpy.zeros(len(mesh.vertices), bool)
    of_faces[read(mesh.loops, "vertex_index", kind=numpy.int32)] = True
    return numpy.flatnonzero(_creased(mesh, mesh.vertices, "crease_vert", "vertex_creases") & of_faces)

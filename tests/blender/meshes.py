"""What the tests of the add-on share: meshes as files of their own, and the command line."""

import os
import subprocess

import bpy


def vox(*arguments):
    subprocess.run(["vox", *map(str, arguments)], check=True)


def same(a, b):
    """Whether two files hold the same voxels with the same values, at the same place."""
    return subprocess.run(["vox", "diff", a, b, "--no-metadata"]).returncode == 0


def empty_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)


def suzanne(**placed):
    bpy.ops.mesh.primitive_monkey_add(**placed)
    thing = bpy.context.object
    thing.vox.folder = os.getcwd()
    thing.vox.dim = 80
    return thing


def write_obj(path, points, faces, colors=None):
    """An OBJ file; a face is a list of vertices, or a line of text."""
    with open(path, "w") as file:
        for i, point in enumerate(points):
            file.write("v " + " ".join(repr(float(x)) for x in (*point, *(colors[i] if colors else ()))) + "\n")
        for face in faces:
            file.write((face if isinstance(face, str) else "f " + " ".join(str(v + 1) for v in face)) + "\n")


def moved(matrix, point):
    """A point after a matrix, in the precision of Python."""
    return [sum(m * x for m, x in zip(row[:3], point)) + row[3] for row in matrix]


def faces_of(mesh):
    return [list(face.vertices) for face in mesh.polygons]


def refused(operator, *words):
    """Whether an operator reports an error of one line with these words."""
    try:
        operator()
    except RuntimeError as wrong:
        text = str(wrong).strip()
        print("refused:", text)
        assert "Traceback" not in text and len(text.splitlines()) == 1, text
        return all(word in text for word in words)
    return False

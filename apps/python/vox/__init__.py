"""Smooth voxel models in OpenVDB from polygon meshes.

    import vox

    grids = vox.convert("model.obj", dim=256, grids=["density", "normal"])
    print(grids["density"].coords)      # (n, 3) voxels, index space
    grids.write("model.vdb")

Options have the names and values of the command line, with _ in place of -: ``voxel_size=0.01``
is ``--voxel-size 0.01``. A switch is True or False, a list of values may be a list, and None means
that an option is not given. Errors are exceptions below ``vox.Error`` with the line that the
program ``vox`` prints; warnings are ``vox.VoxWarning``.

Functions release the interpreter's lock while they work, and use all processors. Ctrl-C stops
``convert``, ``subdivide``, ``render`` and ``Grids.write``, as an exception of their ``progress``
function does.
"""
from __future__ import annotations

import collections.abc
import contextlib
import inspect
import json
import os
import tempfile
import textwrap
import typing
import warnings

import numpy as np

from . import _arrays, _vox
from ._vox import (Cancelled, CheckFailed, Error, InputError, IoError, LimitError, MeshError,
                   UsageError, __version__)

__all__ = ["Cancelled", "CheckFailed", "Error", "Grid", "Grids", "InputError", "IoError",
           "LimitError", "Mesh", "MeshError", "Scene", "Transform", "UsageError", "VoxWarning",
           "__version__", "check", "convert", "diff", "info", "read", "render", "subdivide"]


class VoxWarning(UserWarning):
    """What the program prints as a warning: a repair, for example."""


def _warn(lines):
    for line in lines:
        warnings.warn(line, VoxWarning, stacklevel=3)


class Mesh:
    """A polygon mesh. It is never changed.

    points: (V, 3) coordinates, float32 or float64, world units.
    faces: vertices of each face, counted from 0. Either an (F, k) array of integers; or a list of
        lists, of any lengths of 3 or more; or a tuple (offsets, corners): face f has the vertices
        ``corners[offsets[f]:offsets[f + 1]]``, so there are F + 1 offsets. (A tuple of two is
        always the last.) Faces may be concave and need not be planar.
    point_colors, face_colors: (V, 3) or (F, 3); floats are linear, 0 to 1, and uint8 is sRGB.
    uv: (C, 2) texture coordinates of corners, in the order of the faces; a corner without has NaN.
    smoothing_groups: (F,) integers, for ``crease="groups"``; 0: flat.
    objects, groups, materials: the sets of faces of ``part_by`` and ``split``. F texts or integers,
        "" or negative for none; or a tuple (names, numbers) with F numbers of names, -1 for none.
    name: for messages, and of the part if there is one for each object.

    Raises TypeError for values of a wrong type, InputError for a wrong shape, and MeshError for an
    index that is out of range or a coordinate that is not finite or beyond 1e15. The arrays are
    copied once, not more, if they are contiguous.
    """

    __slots__ = ("_handle",)

    def __init__(self, points, faces, *, point_colors=None, face_colors=None, uv=None,
                 smoothing_groups=None, objects=None, groups=None, materials=None, name="mesh"):
        if points is None:
            raise TypeError("points: must be numbers, not None")
        offsets, corners = _arrays.faces(faces)
        if smoothing_groups is not None:
            smoothing_groups = _arrays.indices("smoothing_groups", smoothing_groups)
        self._handle = _vox.MeshHandle(
            os.fsencode(name), _arrays.rows("points", points, 3), offsets, corners,
            _arrays.colors("point_colors", point_colors),
            _arrays.colors("face_colors", face_colors), _arrays.rows("uv", uv, 2),
            smoothing_groups, _arrays.labels("objects", objects),
            _arrays.labels("groups", groups), _arrays.labels("materials", materials))

    @classmethod
    def _of(cls, handle):
        mesh = cls.__new__(cls)
        mesh._handle = handle
        return mesh

    name = property(lambda self: self._handle.name, doc="Name of the object.")
    points = property(lambda self: self._handle.points,
                      doc="(V, 3) float64, world units. Not a copy; read only.")
    offsets = property(lambda self: self._handle.offsets,
                       doc="(F + 1,) uint32: where the corners of each face begin. Read only.")
    corners = property(lambda self: self._handle.corners,
                       doc="(C,) uint32: the vertex of each corner. Read only.")
    point_colors = property(lambda self: self._handle.point_colors,
                            doc="(V, 3) float32, linear, 0 to 1; or None. Read only.")
    face_colors = property(lambda self: self._handle.face_colors,
                           doc="(F, 3) float32, linear, 0 to 1; or None. Read only.")
    uv = property(lambda self: self._handle.uv,
                  doc="(C, 2) float32 of corners, NaN: none; or None. Read only.")
    smoothing_groups = property(lambda self: self._handle.smoothing_groups,
                                doc="(F,) uint32; or None. Read only.")
    objects = property(lambda self: self._handle.objects,
                       doc="(names, (F,) int64 numbers of names, -1: none); or None.")
    groups = property(lambda self: self._handle.groups, doc="As objects.")
    materials = property(lambda self: self._handle.materials, doc="As objects.")

    def write(self, path, *, overwrite=False):
        """Writes a file .obj, .ply or .off, all or nothing."""
        _vox.write_mesh(self._handle, _arrays.path(path), bool(overwrite))

    def __repr__(self):
        return (f"<vox.Mesh {self.name!r}: {len(self.points)} vertices, "
                f"{len(self.offsets) - 1} faces>")


class Scene:
    """Several meshes, and the options of a scene file (.toml) if it was read from one.

    meshes: Mesh objects; each becomes an object of the scene.
    """

    __slots__ = ("_handle",)

    def __init__(self, meshes):
        handles = []
        for mesh in meshes:
            if not isinstance(mesh, Mesh):
                raise TypeError(f"a scene consists of vox.Mesh, not {type(mesh).__name__}")
            handles.append(mesh._handle)
        self._handle = _vox.SceneHandle(handles)

    @classmethod
    def _of(cls, handle):
        scene = cls.__new__(cls)
        scene._handle = handle
        return scene

    meshes = property(lambda self: [Mesh._of(one) for one in self._handle.meshes],
                      doc="The objects, in world space.")
    files = property(lambda self: self._handle.files, doc="Paths of the files that were read.")

    def __repr__(self):
        return f"<vox.Scene: {', '.join(mesh.name for mesh in self.meshes)}>"


class Transform(typing.NamedTuple):
    """Where the voxels of a grid lie: ``world = voxel * voxel_size + origin``."""

    voxel_size: tuple[float, float, float]  #: along x, y and z, world units
    origin: tuple[float, float, float]  #: world position of the centre of voxel (0, 0, 0)

    def to_world(self, voxels):
        """World positions, (n, 3) float64, of voxels, (n, 3); fractions are between centres."""
        return np.asarray(voxels) * np.asarray(self.voxel_size) + np.asarray(self.origin)

    def to_index(self, positions):
        """The inverse of to_world."""
        return (np.asarray(positions) - np.asarray(self.origin)) / np.asarray(self.voxel_size)


def _frozen(array):
    array.flags.writeable = False
    return array


class Grid:
    """A grid of voxels, most of which are inactive and have no memory. It is never changed."""

    __slots__ = ("_coords", "_handle", "_values")

    def __init__(self):
        raise TypeError("grids come from vox.convert and vox.read")

    @classmethod
    def _of(cls, handle):
        grid = cls.__new__(cls)
        grid._handle, grid._coords, grid._values = handle, None, None
        return grid

    name = property(lambda self: self._handle.name, doc="Name of the grid.")
    dtype = property(lambda self: np.dtype(self._handle.dtype),
                     doc="Type of values; bool for a mask. Vectors have three of them.")
    grid_class = property(lambda self: self._handle.grid_class,
                          doc='"fog volume", "level set", "staggered vector field" or "unknown".')
    active_voxels = property(lambda self: self._handle.active_voxels,
                             doc="n, the number of active voxels.")
    bounds = property(lambda self: self._handle.bounds,
                      doc="The lowest and the highest voxel that is active, (x, y, z) each, index "
                          "space, both inclusive; None if no voxel is active.")
    transform = property(lambda self: Transform(*self._handle.transform),
                         doc="Voxel size and origin. InputError if the voxels are turned.")
    metadata = property(lambda self: self._handle.metadata, doc="What a file says of the grid.")

    @property
    def coords(self):
        """(n, 3) int32: the active voxels, index space. Read only; gathered once.

        The order depends on the grid only, and is that of values.
        """
        if self._coords is None:
            self._coords = _frozen(self._handle.coords())
        return self._coords

    @property
    def values(self):
        """(n,), or (n, 3) for vectors: the values of the active voxels. Read only; gathered once."""
        if self._values is None:
            self._values = _frozen(self._handle.values())
        return self._values

    def to_dense(self, low=None, high=None):
        """(nx, ny, nz), or (nx, ny, nz, 3) for vectors: the values of all voxels of a box.

        low, high: its corners (x, y, z), index space, both inclusive; None: those of bounds. Element
        [i, j, k] is voxel low + (i, j, k). Voxels that are not active have the background, and in a
        level set minus the background inside.
        """
        if low is None or high is None:
            bounds = self.bounds or ((0, 0, 0), (-1, -1, -1))
            low = bounds[0] if low is None else low
            high = bounds[1] if high is None else high
        corners = [_arrays.indices(name, corner) for name, corner in (("low", low), ("high", high))]
        for name, corner in zip(("low", "high"), corners):
            if corner.shape != (3,) or (np.abs(corner.astype(float)) > 2**30).any():
                raise InputError(f"{name}: must be three numbers between -2^30 and 2^30")
        return self._handle.to_dense(*([int(x) for x in corner] for corner in corners))

    def __repr__(self):
        return f"<vox.Grid {self.name!r}: {self.active_voxels} active voxels, {self.dtype}>"


class Grids(collections.abc.Mapping):
    """The grids of a conversion, or of a file: a mapping of names to Grid."""

    __slots__ = ("_grids", "_handle", "_report")

    def __init__(self):
        raise TypeError("grids come from vox.convert and vox.read")

    @classmethod
    def _of(cls, handle):
        grids = cls.__new__(cls)
        grids._handle = handle
        grids._grids = {one.name: Grid._of(one) for one in handle.grids}
        grids._report = None
        return grids

    def __getitem__(self, name):
        try:
            return self._grids[name]
        except KeyError:
            raise KeyError(f"there is no grid {name!r}; there are "
                           f"{', '.join(self._grids) or 'none'}") from None

    def __iter__(self):
        return iter(self._grids)

    def __len__(self):
        return len(self._grids)

    @property
    def report(self):
        """Times in seconds, counts, memory in bytes and warnings of the conversion, as --report
        writes them; empty for grids that were read."""
        if self._report is None:
            self._report = json.loads(self._handle.report or "{}")
            self._report.pop("output", None)
            self._report.get("seconds", {}).pop("write", None)
        return self._report

    def write(self, path, *, overwrite=False, compression=None, progress=None):
        """Writes a file .vdb (OpenVDB) or .nvdb (NanoVDB), all or nothing.

        overwrite: whether an existing file is replaced; else IoError.
        compression: "blosc", "zip" or "none"; None: as asked for in the conversion, else "blosc".
        progress: as in convert.
        """
        _vox.write_grids(self._handle, _arrays.path(path), bool(overwrite), compression, progress)

    def __repr__(self):
        return f"<vox.Grids: {', '.join(self._grids)}>"


def read(path):
    """Reads a file.

    Returns a Mesh for .obj, .ply, .off, .stl, .om, .gltf and .glb; a Scene for .toml; Grids for
    .vdb and .nvdb.
    """
    name = _arrays.path(path)
    if _vox.is_grid_file(name):
        return Grids._of(_vox.read_grids(name))
    handle = _vox.read_scene(name)
    if os.path.splitext(name)[1].lower() == b".toml":
        return Scene._of(handle)
    return Mesh._of(handle.meshes[0])


def _input(value):
    if isinstance(value, (Mesh, Scene)):
        return value._handle
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError("expected a vox.Mesh, a vox.Scene or the path of a file, not "
                        f"{type(value).__name__}")
    return _arrays.path(value)


_known = {command: [name for name, _, _ in _vox.options(command)]
          for command in ("convert", "subdivide", "render", "info", "diff", "check")}


def _options(command, options):
    """The options as the extension takes them: texts, and arrays of vertices."""
    lists = _arrays.lists(options, _known[command])
    return _arrays.keywords(options), lists


def convert(input, *, progress=None, **options):
    """Converts a mesh or scene into a smooth voxel model.

    input: a Mesh, a Scene, or the path of a file of either.
    progress: None, or a function of a fraction, 0 to 1, and the name of a stage. It is called in
        this thread, at most every 0.05 s or so. If it returns False the conversion stops with
        vox.Cancelled; if it raises an exception it stops with that.

    Returns Grids. Raises UsageError, InputError, MeshError, LimitError, CheckFailed.
    """
    made = Grids._of(_vox.convert(_input(input), *_options("convert", options), progress))
    _warn(made._handle.warnings)
    return made


def subdivide(input, *, progress=None, **options):
    """Smooths a mesh or scene: Doo-Sabin subdivision, without voxels.

    input, progress: as in convert. levels: the number of steps; it must be given.

    Returns a Mesh.
    """
    handle, lines = _vox.subdivide(_input(input), *_options("subdivide", options), progress)
    _warn(lines)
    return Mesh._of(handle)


def render(input, path=None, *, overwrite=False, progress=None, **options):
    """Draws grids, or the voxels of a mesh or scene.

    input: Grids, a Mesh, a Scene, or the path of a file of any of these.
    path: also write the picture to this file (.png).
    overwrite: whether an existing file is replaced; else IoError.
    progress: as in convert.

    Returns (height, width, 4) uint8: red, green, blue (sRGB) and coverage; the top row first.
    """
    name = None if path is None else _arrays.path(path)
    if name is not None and not name.lower().endswith(b".png"):
        raise UsageError(f"{os.fsdecode(name)}: the output of render must end in .png")
    shown = input._handle if isinstance(input, Grids) else _input(input)
    picture, lines = _vox.render(shown, name, bool(overwrite), *_options("render", options),
                                 progress)
    _warn(lines)
    return picture


@contextlib.contextmanager
def _file(grids):
    """The path of a file; grids in memory are written into one for as long as that."""
    if not isinstance(grids, Grids):
        yield _arrays.path(grids)
        return
    with tempfile.TemporaryDirectory(prefix="vox-") as folder:
        path = os.path.join(folder, "grids.vdb")
        grids.write(path, compression="none")
        yield os.fsencode(path)


def info(input, **options):
    """Describes meshes, scenes and grids, as ``vox info --json`` does.

    input: a Mesh, a Scene, Grids, or the path of a file of any of these.

    Returns a dict: "meshes" or "grids" is a list of dicts.
    """
    with _file(input) if isinstance(input, Grids) else contextlib.nullcontext(
            _input(input)) as name:
        found = json.loads(_vox.info(name, *_options("info", options)))
    if not isinstance(input, (str, bytes, os.PathLike)):
        found.pop("file", None)
    return found


def diff(a, b, *, overwrite=False, **options):
    """Compares grids, as ``vox diff --json`` does.

    a, b: Grids, or paths of .vdb or .nvdb files, or of folders of such files.
    overwrite: True replaces the files of `report` and `junit`.

    Returns a dict: "same" is True if nothing differs; "grids", for folders "files", is a list of
    dicts.
    """
    with _file(a) as name_a, _file(b) as name_b:
        found = json.loads(_vox.diff(name_a, name_b, overwrite, _arrays.keywords(options)))
    for key, value in (("a", a), ("b", b)):
        if isinstance(value, Grids):
            found[key] = None
    return found


def check(grids, mesh=None, *, overwrite=False, **options):
    """Looks for faults of grids, as ``vox check --json`` does.

    grids: Grids, or the path of a .vdb or .nvdb file.
    mesh: what the grids were made from, a Mesh, a Scene or a path. The voxels must separate the
        sides of its surface; None: they are checked alone.
    overwrite: True replaces the file of `report`.

    Returns a dict: "ok" is True if there are no faults; "faults" and "warnings" are lists of dicts.
    """
    with _file(grids) as name:
        found = json.loads(_vox.check(name, None if mesh is None else _input(mesh), overwrite,
                                      *_options("check", options)))
    if isinstance(grids, Grids):
        found["file"] = None
    return found


def _describe(function, command):
    """Adds the options of a command to the signature and the documentation of its function."""
    signature = inspect.signature(function)
    own = [one for one in signature.parameters.values()
           if one.kind is not inspect.Parameter.VAR_KEYWORD]
    names = {one.name for one in own}
    lines = [f"\n\nOptions are those of ``vox {command}``:\n"]
    for name, kind, text in _vox.options(command):
        if name in names:
            continue
        own.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None))
        head = f"{name}: " + (f"{kind}. " if kind else "True or False. ")
        lines.append(textwrap.fill(head + text, 92, subsequent_indent="    "))
    function.__signature__ = signature.replace(parameters=own)
    function.__doc__ = inspect.cleandoc(function.__doc__) + "\n".join(lines)


for _command in (convert, subdivide, render, info, diff, check):
    _describe(_command, _command.__name__)

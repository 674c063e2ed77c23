"""Brings the arguments of functions into the forms that the extension takes."""
from __future__ import annotations

import itertools
import numbers
import os

import numpy as np

from . import _vox

_FLOATS = ("float32", "float64")
_INDICES = ("int32", "uint32", "int64", "uint64")


def path(value):
    """The bytes of a path."""
    name = os.fsencode(value)
    if b"\0" in name:
        raise ValueError("embedded null byte")
    return name


def _array(name, value):
    try:
        return np.asarray(value)
    except ValueError as error:  # lists of different lengths
        raise ValueError(f"{name}: cannot become an array: {error}") from None


def _inform(array, dtypes, otherwise):
    """The array, without a copy if it is contiguous and of a type that the extension takes."""
    dtype = array.dtype.newbyteorder("=")
    return np.ascontiguousarray(array, dtype if dtype.name in dtypes else otherwise)


def _require_rows(name, array, columns):
    if array.ndim != 2 or array.shape[1] != columns:
        raise _vox.InputError(f"{name}: must have shape (n, {columns}), not {array.shape}")


def rows(name, value, columns):
    """Floats of shape (n, columns); None stays None."""
    if value is None:
        return None
    array = _array(name, value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: must be numbers, not {array.dtype}")
    _require_rows(name, array, columns)
    return _inform(array, _FLOATS, "float64")


def colors(name, value):
    """Floats, or bytes, of shape (n, 3); None stays None."""
    if value is None:
        return None
    array = _array(name, value)
    if array.dtype.kind != "f" and array.dtype != np.uint8:
        raise TypeError(f"{name}: must be floats from 0 to 1 (linear), or uint8 (sRGB), "
                        f"not {array.dtype}")
    _require_rows(name, array, 3)
    return _inform(array, (*_FLOATS, "uint8"), "float64")


def indices(name, value, ndim=1):
    """Whole numbers, contiguous."""
    array = _array(name, value)
    if array.size == 0:
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: must be whole numbers, not {array.dtype}")
    if array.ndim != ndim:
        raise _vox.InputError(f"{name}: must have {ndim} dimension{'s' * (ndim > 1)}, "
                              f"not shape {array.shape}")
    return _inform(array, _INDICES, "int64")


def faces(value):
    """Offsets and corners of an (n, k) array, of a list of lists, or of a pair of both."""
    if isinstance(value, tuple) and len(value) == 2:
        return indices("offsets", value[0]), indices("corners", value[1])
    if isinstance(value, np.ndarray) and value.dtype != object:
        corners = indices("faces", value, ndim=2)
        count, size = corners.shape
        if size < 3:
            raise _vox.InputError(f"faces: must have shape (n, k) with k of 3 or more, "
                                  f"not {corners.shape}")
        return np.arange(count + 1, dtype=np.int64) * size, corners.reshape(-1)
    try:
        each = value if isinstance(value, (list, tuple)) else list(value)
        offsets = np.cumsum([0, *map(len, each)], dtype=np.int64)
        corners = list(itertools.chain.from_iterable(each))
    except TypeError:
        raise TypeError("faces: must be an (n, k) array, a list of lists, "
                        "or a tuple (offsets, corners)") from None
    return offsets, indices("faces", corners)


def labels(name, value):
    """Names and the number of each face's name, or -1; None stays None."""
    if value is None:
        return None
    if isinstance(value, tuple) and len(value) == 2 and not np.isscalar(value[0]):
        names, wanted = list(value[0]), indices(name, value[1])
        if not all(isinstance(one, str) for one in names):
            raise TypeError(f"{name}: names must be texts")
        return [os.fsencode(one) for one in names], wanted.astype(np.int64)
    array = _array(name, value)
    if array.ndim != 1:
        raise _vox.InputError(f"{name}: must have 1 dimension, not shape {array.shape}")
    if array.dtype == object and all(isinstance(one, str) for one in array):
        array = array.astype(str)
    if array.dtype.kind not in "iuU":
        raise TypeError(f"{name}: must be whole numbers or texts, not {array.dtype}")
    known, which = np.unique(array, return_inverse=True)
    has_none = known == "" if array.dtype.kind == "U" else known < 0
    which = np.where(has_none[which], -1, which).astype(np.int64)
    return [os.fsencode(str(one)) for one in known], which


def lists(options, known):
    """Takes those numbers of vertices out of the options that are arrays, not files."""
    found = []
    for name in ("interpolate_vertices", "crease_edges", "corner_vertices"):
        value = options.get(name)
        is_file = value is None or isinstance(value, (str, bytes, os.PathLike))
        if is_file or name not in known:
            found.append(None)
            continue
        del options[name]
        is_edges = name == "crease_edges"
        array = indices(name, value, ndim=2 if is_edges else 1)
        if is_edges:
            _require_rows(name, array, 2)
        found.append(array.reshape(-1))
    return _vox.Lists(*found)


def _text(name, value):
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsencode(value)
    if isinstance(value, numbers.Integral) and not isinstance(value, (bool, np.bool_)):
        return str(int(value)).encode()
    if isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_)):
        return repr(float(value)).encode()
    raise TypeError(f"{name}: must be texts or numbers, not {type(value).__name__}")


def keywords(options):
    """Options as the command line takes them: switches as bool, all else as texts."""
    found = []
    for name, value in options.items():
        if value is None:
            continue
        if isinstance(value, np.ndarray) and value.ndim == 0:
            value = value[()]
        if isinstance(value, (bool, np.bool_)):
            value = bool(value)
        elif isinstance(value, (str, bytes, os.PathLike, numbers.Real)):
            value = _text(name, value)
        else:
            try:
                parts = list(value)
            except TypeError:
                _text(name, value)
            value = [_text(name, part) for part in parts]
        found.append((name.encode(errors="replace"), value))
    return found

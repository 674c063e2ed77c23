"""Data of a mesh as arrays of NumPy, which Blender ships."""

import numpy


def read(rows, name, width=1, kind=numpy.float32):
    """An attribute of all rows, such as `co` of vertices: one row each, or, of width 1, one value."""
    values = numpy.empty(len(rows) * width, kind)
    rows.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def lines(pattern, values):
    """A line of text for each row of `values`, as `pattern` says it."""
    return pattern * len(values) % tuple(values.ravel().tolist())


def srgb(linear):
    """Values as on a screen, 0 to 1, of linear light."""
    linear = numpy.clip(linear.astype(float), 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

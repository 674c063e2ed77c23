"""Images of Blender as files that vox reads: PNG or JPEG, with values as on a screen."""

import os
import shutil

import bpy
import numpy

from .arrays import srgb
from .child import VoxError

LINEAR = {"Linear", "Linear Rec.709", "Non-Color", "Raw"}  # names of colour spaces, of all versions
ENDINGS = {"PNG": ".png", "JPEG": ".jpg"}


def save(image, folder):
    """Name of the file made in the folder; an image that is there already is not made again."""
    if image.source == "TILED":
        raise VoxError(f"image {image.name}: is made of tiles (UDIM), which vox does not read; bake it into one image")
    stem = f"{bpy.path.clean_name(image.name)}-{list(bpy.data.images).index(image)}"
    source = _file_of(image)
    name = stem + (ENDINGS[image.file_format] if source else ".png")
    path = os.path.join(folder, name)
    if os.path.exists(path):
        return name
    if source:
        shutil.copyfile(source, path)
    else:
        _save_pixels(image, path)
    return name


def _file_of(image):
    """The file of an image, if vox reads in it what Blender shows; else None."""
    path = image.filepath_from_user()
    is_same = image.source == "FILE" and not image.is_dirty and not image.packed_file
    is_read = image.file_format in ENDINGS and image.colorspace_settings.name == "sRGB"
    return path if is_same and is_read and os.path.isfile(path) else None


def _save_pixels(image, path):
    width, height = image.size
    if not width or not height:
        raise VoxError(f"image {image.name}: has no pixels; check its file")
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(-1, image.channels)
    color = pixels[:, :3] if image.channels >= 3 else numpy.repeat(pixels[:, :1], 3, 1)
    alpha = pixels[:, 3:] if image.channels == 4 else numpy.ones((len(pixels), 1))
    if image.is_float or image.colorspace_settings.name in LINEAR:
        color = srgb(color)
    saved = bpy.data.images.new("vox", width, height, alpha=True)
    try:
        saved.pixels.foreach_set(numpy.hstack((color, alpha)).astype(numpy.float32).ravel())
        saved.file_format = "PNG"
        saved.filepath_raw = path
        saved.save()
    finally:
        bpy.data.images.remove(saved)

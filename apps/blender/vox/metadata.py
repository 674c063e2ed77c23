"""The metadata of .vdb files, which Blender does not show to scripts."""

import os
import struct

from .child import VoxError


def metadata_of(path):
    """The metadata of a file: values as bytes, by name.

    A .vdb begins with 21 bytes of magic number, versions and flags and 36 of a unique name. Then it
    counts its metadata, each a name, a type and a value, all with their lengths before them.
    """
    if not os.path.isfile(path):
        raise VoxError(f"{path}: no such file; check the path")
    with open(path, "rb") as file:
        if file.read(21 + 36)[:4] != b" BDV":
            raise VoxError(f"{path} is no OpenVDB file; vox convert makes one of a mesh or .nvdb file")

        def sized():
            return file.read(struct.unpack("<I", file.read(4))[0])

        metadata = {}
        try:
            (count,) = struct.unpack("<I", file.read(4))
            for _ in range(count):
                name, _ = sized(), sized()
                metadata[name.decode()] = sized()
        except (struct.error, UnicodeDecodeError):
            raise VoxError(f"{path} is cut off or damaged; convert again") from None
    return metadata

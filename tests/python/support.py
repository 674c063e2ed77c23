"""What the tests of the Python package share. Run by ctest with PYTHONPATH, VOX and VOX_SCENES."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not installed")
    sys.exit(77)

import vox

SCENES = pathlib.Path(os.environ["VOX_SCENES"])
PROGRAM = os.environ["VOX"]

# A cube, its faces wound outward.
CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def cube(**attributes):
    return vox.Mesh(CUBE, CUBE_FACES, **attributes)


def run(*arguments, **options):
    """The program vox; its result has texts."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          check=False, **options)


def python(code, **options):
    """A fresh interpreter."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                          check=False, **options)


class InFolder(unittest.TestCase):
    """Tests that write files into a folder of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def program(self, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

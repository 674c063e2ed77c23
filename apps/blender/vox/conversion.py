"""One conversion, step by step: the mesh is written, vox runs, the files move to their place."""

import os
import tempfile

import bpy

from . import export_mesh
from .child import Child, VoxError
from .evaluated import mesh_of
from .settings import options

NUMBER = "####"  # place for the number of a frame in a path


class Conversion:
    """A conversion of the mesh of an object, or of a range of frames of it.

    Objects are kept by name: what Python knows of them does not outlive an undo.
    """

    def __init__(self, thing, program, path, target=(), frames=None, in_world=False):
        """@param path    of the file to make, with NUMBER in it for frames
        @param target  further options of vox, those for the program that will read the file
        @param frames  a range, or None for the frame that the scene shows
        @param in_world  the file shall hold the mesh where it is in the world
        """
        self.name = thing.name
        self.path = path
        self.frames = frames
        self.place = None  # of the result in the world, once the mesh is written; None: where it is
        self.warnings = []
        self._in_world = in_world or frames is not None  # results of frames do not move with the object
        self._program = program
        self._target = target

    def first_path(self):
        return self.path.replace(NUMBER, f"{self.frames[0]:04}") if self.frames else self.path

    def steps(self):
        """Does the work. Yields how much is done, 0 to 1, and what is being done.

        To cancel it, close the generator: nothing is left behind, and files that were there stay.
        Raises VoxError or OSError.
        """
        folder = os.path.dirname(self.path)
        os.makedirs(folder, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="vox-") as meshes:
            yield from self._write_meshes(meshes)
            with tempfile.TemporaryDirectory(prefix=".vox-", dir=folder) as results:
                yield from self._run_vox(meshes, results)
                for result in sorted(os.listdir(results)):
                    os.replace(os.path.join(results, result), os.path.join(folder, result))

    def _write_meshes(self, folder):
        scene = bpy.context.scene
        if self.frames is None:
            yield 0, "mesh"
            self._write_mesh(folder, self._file_name())
            return
        shown = scene.frame_current
        try:
            for frame in self.frames:
                yield 0, f"mesh of frame {frame}"
                scene.frame_set(frame)
                self._write_mesh(folder, self._file_name().replace(NUMBER, f"{frame:04}"))
        finally:
            scene.frame_set(shown)

    def _file_name(self):
        """Of the files for vox, without an ending; vox names them in messages."""
        name = bpy.path.clean_name(self.name)
        return f"{name}.{NUMBER}" if self.frames else name

    def _write_mesh(self, folder, name):
        thing = bpy.data.objects.get(self.name)
        if thing is None:
            raise VoxError(f"{self.name} is gone")
        with mesh_of(thing, thing.vox.use_modifiers) as (mesh, place):
            scale = None if self._in_world else export_mesh.uniform_scale(place)
            self.place = place if scale else None
            self._options = options(thing.vox, scale or 1)
            export_mesh.write(mesh, None if scale else place, thing.vox, folder, name, self._warn)

    def _warn(self, text):
        if text not in self.warnings:
            self.warnings.append(text)

    def _run_vox(self, meshes, results):
        """Runs vox. Its messages tell of our own folders, which mean nothing to the user."""
        folder, file = os.path.split(self.path)

        def told(text):
            return text.replace(meshes + os.sep, "").replace(results + os.sep, folder + os.sep)

        scene = os.path.join(meshes, f"{self._file_name()}.toml")
        arguments = [scene, "--output", os.path.join(results, file), *self._options, *self._target]
        with Child(self._program, arguments, len(self.frames or [1])) as child:
            while child.is_running():
                yield child.fraction(), child.stage
            try:
                child.check()
            except VoxError as wrong:
                raise VoxError(told(str(wrong))) from None
            for warning in child.warnings:
                self._warn(told(warning))

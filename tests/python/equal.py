"""What Python converts is what the program converts."""
import json
import unittest
import warnings

import numpy as np
import support
import vox

GRIDS = ["density", "mask", "normal", "color", "surface", "part"]

# Keyword arguments and the same options of the program.
OPTIONS = [
    ({"dim": 40}, ["--dim", "40"]),
    ({"voxel_size": 0.11, "fill": "solid", "edge": "soft"},
     ["--voxel-size", "0.11", "--fill", "solid", "--edge", "soft"]),
    ({"dim": 30, "interpolate": "both", "crease": 60, "band": (2, 5), "gain": 2.5, "half": True},
     ["--dim", "30", "--interpolate", "both", "--crease", "60", "--band", "2,5", "--gain", "2.5",
      "--half"]),
    ({"dim": 30, "bounds": [-0.5, -0.5, -0.5, 1, 1, 1], "until": ["angle=5", "diameter=4"],
      "target": "houdini", "up": "z", "strict": False, "threads": 1},
     ["--dim", "30", "--bounds", "-0.5,-0.5,-0.5,1,1,1", "--until", "angle=5,diameter=4",
      "--target", "houdini", "--up", "z", "--strict=false", "--threads", "1"]),
    ({"dim": np.int64(25), "weld": np.float32(0), "drop_components": "below=2", "verify": True,
      "localize": "before", "submesh_faces": 20},
     ["--dim", "25", "--weld", "0", "--drop-components", "below=2", "--verify", "--localize",
      "before", "--submesh-faces", "20"]),
]


class Equal(support.InFolder):
    def require_same(self, made, written, **options):
        """The grids as a file, in memory, and as NanoVDB are those of the program."""
        mine = self.folder / "python.vdb"
        made.write(mine, overwrite=True)
        args = ["--no-metadata"] if options.get("no_metadata") else []
        done = support.run("diff", mine, written, *args)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue(vox.diff(made, written, **options)["same"])

    def test_five_lines_equal_the_command_line_for_every_grid(self):
        code = """
import vox
grids = vox.convert({!r}, dim=60, grids={!r})
for name, grid in grids.items():
    assert grid.coords.shape == (grid.active_voxels, 3) and len(grid.values) == grid.active_voxels
grids.write("python.vdb")
"""
        model = support.SCENES / "toy_jack.obj"
        done = support.python(code.format(str(model), GRIDS), cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.program("convert", model, "-o", self.folder / "vox.vdb", "--dim", 60, "--grids",
                     ",".join(GRIDS))
        self.program("diff", self.folder / "python.vdb", self.folder / "vox.vdb")
        self.assertEqual((self.folder / "python.vdb").read_bytes(),
                         (self.folder / "vox.vdb").read_bytes())

    def test_options_mean_what_they_mean_to_the_program(self):
        model = support.SCENES / "torus.obj"
        for number, (keywords, arguments) in enumerate(OPTIONS):
            with self.subTest(keywords), warnings.catch_warnings():
                warnings.simplefilter("ignore", vox.VoxWarning)
                written = self.folder / f"{number}.vdb"
                self.program("convert", model, "-o", written, "--grids",
                             "density,normal,surface,part", *arguments)
                made = vox.convert(model, grids=["density", "normal", "surface", "part"],
                                   **keywords)
                self.require_same(made, written)

    def test_a_mesh_in_memory_equals_its_file(self):
        model = support.SCENES / "torus.obj"
        written = self.folder / "vox.vdb"
        self.program("convert", model, "-o", written, "--dim", 50, "--grids",
                     "density,mask,normal,surface")
        wanted = {"dim": 50, "grids": ["density", "mask", "normal", "surface"]}
        read = vox.read(model)
        self.require_same(vox.convert(read, **wanted), written)  # knows its file
        self.assertEqual(vox.convert(read, **wanted)["density"].metadata["vox_input"], "torus.obj")
        for mesh in (
                vox.Mesh(read.points, (read.offsets, read.corners)),
                vox.Mesh(read.points.tolist(),
                         [read.corners[a:b].tolist()
                          for a, b in zip(read.offsets, read.offsets[1:])]),
                vox.Mesh(np.asfortranarray(read.points),
                         (read.offsets.astype(np.int64), read.corners.astype(">i4"))),
        ):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                self.require_same(vox.convert(mesh, **wanted), written, no_metadata=True)

    def test_a_scene_equals_its_file(self):
        scene = support.SCENES / "marble_jack.toml"
        written = self.folder / "vox.vdb"
        self.program("convert", scene, "-o", written, "--dim", 40, "--grids", "density,color")
        wanted = {"dim": 40, "grids": ["density", "color"]}
        self.require_same(vox.convert(scene, **wanted), written)
        self.require_same(vox.convert(vox.read(scene), **wanted), written)
        self.require_same(vox.convert(vox.Scene(vox.read(scene).meshes), **wanted), written,
                          no_metadata=True)

    def test_lists_of_vertices_are_arrays_or_files(self):
        (self.folder / "edges.txt").write_text("0 1\n1 3\n")
        (self.folder / "corners.txt").write_text("7\n")
        mesh = support.cube()
        mesh.write(self.folder / "cube.ply")
        written = self.folder / "vox.vdb"
        self.program("convert", self.folder / "cube.ply", "-o", written, "--dim", 30,
                     "--crease-edges", self.folder / "edges.txt", "--corner-vertices",
                     self.folder / "corners.txt", "--interpolate-vertices",
                     self.folder / "corners.txt")
        for edges, corners in (([[0, 1], [1, 3]], np.array([7], np.uint8)),
                               (self.folder / "edges.txt", self.folder / "corners.txt")):
            made = vox.convert(mesh, dim=30, crease_edges=edges, corner_vertices=corners,
                               interpolate_vertices=corners)
            self.require_same(made, written, no_metadata=True)

    def test_attributes_reach_the_grids(self):
        red = np.array([[255, 0, 0]] * 6, np.uint8)
        made = vox.convert(support.cube(face_colors=red, groups=["a", "a", "b", "", "b", "b"]),
                           dim=20, grids=["density", "color", "part"], part_by="group")
        np.testing.assert_allclose(made["color"].values - [1, 0, 0], 0, atol=1e-6)
        self.assertEqual(set(made["part"].values), {1, 2, 3})
        half = vox.convert(support.cube(point_colors=np.full((8, 3), 0.5, np.float32)), dim=10,
                           grids=["density", "color"])
        np.testing.assert_allclose(half["color"].values, 0.5, atol=1e-6)

    def test_nanovdb_files_hold_the_same_grids(self):
        made = vox.convert(support.SCENES / "torus.obj", dim=40, grids=["density", "normal"])
        made.write(self.folder / "a.nvdb")
        made.write(self.folder / "a.vdb", compression="zip")
        self.assertTrue(vox.diff(self.folder / "a.nvdb", made, no_metadata=True)["same"])
        self.assertTrue(vox.diff(self.folder / "a.vdb", made)["same"])
        read = vox.read(self.folder / "a.nvdb")
        self.assertEqual(list(read), ["density", "normal"])
        read.write(self.folder / "b.vdb")
        self.assertTrue(vox.diff(self.folder / "b.vdb", made, no_metadata=True)["same"])

    def test_the_report_is_that_of_the_program(self):
        model = support.SCENES / "torus.obj"
        self.program("convert", model, "-o", self.folder / "a.vdb", "--dim", 30, "--report",
                     self.folder / "report.json")
        wanted = json.loads((self.folder / "report.json").read_text())
        made = vox.convert(model, dim=30).report
        for key in ("vox_version", "input", "input_hash", "options", "threads", "voxel_size",
                    "grids", "active_voxels", "objects", "warnings"):
            self.assertEqual(made[key], wanted[key], key)


if __name__ == "__main__":
    unittest.main()

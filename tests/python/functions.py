"""Grids, and the functions beside convert."""
import contextlib
import inspect
import json
import struct
import unittest
import warnings

import numpy as np
import support
import vox

TORUS = support.SCENES / "torus.obj"


class GridArrays(support.InFolder):
    def test_arrays_agree_with_each_other(self):
        made = vox.convert(TORUS, dim=40, fill="solid",
                           grids=["density", "mask", "normal", "surface", "part"])
        self.assertEqual(list(made), ["density", "mask", "normal", "surface", "part"])
        kinds = {"density": "float32", "mask": "bool", "normal": "float32", "surface": "float32",
                 "part": "int32"}
        for name, grid in made.items():
            with self.subTest(name):
                self.assertEqual(grid.name, name)
                self.assertEqual(grid.dtype, kinds[name])
                self.assertEqual(grid.values.dtype, kinds[name])
                self.assertEqual(grid.coords.dtype, np.int32)
                shape = (grid.active_voxels,) + ((3,) if name == "normal" else ())
                self.assertEqual(grid.values.shape, shape)
                low, high = map(np.array, grid.bounds)
                np.testing.assert_array_equal(grid.coords.min(0), low)
                np.testing.assert_array_equal(grid.coords.max(0), high)
                self.assertEqual(len(np.unique(grid.coords, axis=0)), grid.active_voxels)
                dense = grid.to_dense()
                self.assertEqual(dense.dtype, grid.values.dtype)
                self.assertEqual(dense.shape[:3], tuple(high - low + 1))
                np.testing.assert_array_equal(dense[tuple((grid.coords - low).T)], grid.values)
                self.assertIs(grid.coords, grid.coords)
                self.assertTrue(grid.coords.base is None and grid.values.base is None)
        solid = made["density"].to_dense()
        self.assertEqual((solid > 0).sum(), made["density"].active_voxels)
        self.assertTrue((made["surface"].to_dense() < 0).any())
        np.testing.assert_allclose(np.linalg.norm(made["normal"].values, axis=1), 1, atol=1e-5)

    def test_a_box_of_a_grid_is_a_part_of_it(self):
        grid = vox.convert(TORUS, dim=30)["density"]
        low, high = grid.bounds
        whole = grid.to_dense()
        wide = grid.to_dense(np.array(low) - 2, np.array(high) + 1)
        np.testing.assert_array_equal(wide[2:-1, 2:-1, 2:-1], whole)
        self.assertEqual(wide[0].any(), False)
        part = grid.to_dense((0, 1, 0), (4, 1, 3))
        self.assertEqual(part.shape, (5, 1, 4))
        np.testing.assert_array_equal(
            part, wide[2 - low[0]:7 - low[0], 3 - low[1]:4 - low[1], 2 - low[2]:6 - low[2]])

    def test_the_transform_leads_to_the_world(self):
        grid = vox.convert(support.cube(), voxel_size=0.125, until="levels=0")["density"]
        self.assertEqual(grid.transform, ((0.125,) * 3, (0.0,) * 3))
        places = grid.transform.to_world(grid.coords)
        self.assertLessEqual(np.abs(places - np.clip(places, 0, 1)).max(), 0.0625)
        np.testing.assert_allclose(grid.transform.to_index(places), grid.coords)

    def test_grids_without_voxels(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            grid = vox.convert(support.cube(), dim=10, bounds=[50, 50, 50, 60, 60, 60])["density"]
        self.assertIsNone(grid.bounds)
        self.assertEqual(grid.coords.shape, (0, 3))
        self.assertEqual(grid.values.shape, (0,))
        self.assertEqual(grid.to_dense().shape, (0, 0, 0))

    def test_grids_that_are_read_equal_those_that_were_written(self):
        made = vox.convert(TORUS, dim=30, grids=["density", "normal"])
        made.write(self.folder / "a.vdb")
        read = vox.read(self.folder / "a.vdb")
        made.write(self.folder / "a.vdb", overwrite=True)
        for name, grid in made.items():
            np.testing.assert_array_equal(grid.coords, read[name].coords)
            np.testing.assert_array_equal(grid.values, read[name].values)
            self.assertEqual(grid.transform, read[name].transform)
        self.assertEqual(read.report, {})
        self.assertEqual(read["density"].grid_class, "fog volume")
        self.assertEqual(read["density"].metadata["vox_guarantee"], "6-separating")
        with self.assertRaisesRegex(KeyError, "there is no grid 'color'; there are density, normal"):
            read["color"]
        with self.assertRaisesRegex(vox.IoError, "a.vdb"):
            made.write(self.folder / "a.vdb")
        with self.assertRaisesRegex(vox.UsageError, "must end in .vdb or .nvdb"):
            made.write(self.folder / "a.obj")
        with self.assertRaisesRegex(vox.UsageError, "compression must be one of"):
            made.write(self.folder / "b.vdb", compression="lzma")
        with self.assertRaisesRegex(vox.UsageError, "32 bits"):
            vox.convert(TORUS, dim=10, half=True).write(self.folder / "h.nvdb")

    def test_works_beside_pyopenvdb(self):
        try:
            import pyopenvdb
        except ImportError:
            self.skipTest("python3-openvdb is not installed")
        made = vox.convert(TORUS, dim=30)
        made.write(self.folder / "a.vdb")
        theirs = pyopenvdb.read(str(self.folder / "a.vdb"), "density")
        mine = {tuple(voxel): value
                for voxel, value in zip(made["density"].coords.tolist(), made["density"].values)}
        self.assertEqual({item.min: item.value for item in theirs.citerOnValues()}, mine)
        theirs["note"] = "by pyopenvdb"
        pyopenvdb.write(str(self.folder / "b.vdb"), grids=[theirs])
        read = vox.read(self.folder / "b.vdb")
        self.assertEqual(read["density"].metadata["note"], "by pyopenvdb")
        self.assertTrue(vox.diff(read, made, no_metadata=True)["same"])
        for kind, name in ((pyopenvdb.BoolGrid, "bool"), (pyopenvdb.Vec3SGrid, "float32")):
            grid = kind()
            grid.name = "other"
            grid.fill((0, 0, 0), (3, 9, 3), True if name == "bool" else (1, 2, 3))
            pyopenvdb.write(str(self.folder / "c.vdb"), grids=[grid])
            other = vox.read(self.folder / "c.vdb")["other"]
            self.assertEqual(other.dtype, name)
            self.assertEqual(len(other.coords), 160)


class Functions(support.InFolder):
    def test_subdivide_makes_the_mesh_of_the_program(self):
        self.program("subdivide", TORUS, "-o", self.folder / "a.ply", "--levels", 2)
        mesh = vox.subdivide(TORUS, levels=2)
        mesh.write(self.folder / "b.ply")
        self.assertEqual((self.folder / "a.ply").read_bytes(), (self.folder / "b.ply").read_bytes())
        again = vox.subdivide(vox.subdivide(vox.read(TORUS), levels=1), levels=1)
        self.assertEqual(len(again.offsets), len(mesh.offsets))
        with self.assertRaisesRegex(vox.UsageError, "--levels is required"):
            vox.subdivide(TORUS)
        with self.assertRaises(vox.IoError):
            mesh.write(self.folder / "a.ply")

    def test_meshes_give_back_what_they_were_made_of(self):
        names = (["skin", "bone"], np.array([0, 1, -1, 1, 0, 0]))
        mesh = support.cube(name="box", point_colors=np.full((8, 3), 0.25), uv=np.zeros((24, 2)),
                            smoothing_groups=[1, 1, 2, 2, 0, 0], materials=names,
                            groups=[3, 3, 3, -1, 4, 4])
        self.assertEqual(mesh.name, "box")
        np.testing.assert_array_equal(mesh.points, support.CUBE)
        np.testing.assert_array_equal(mesh.offsets, np.arange(7) * 4)
        np.testing.assert_array_equal(mesh.corners, np.ravel(support.CUBE_FACES))
        np.testing.assert_array_equal(mesh.point_colors, np.full((8, 3), 0.25))
        np.testing.assert_array_equal(mesh.uv, np.zeros((24, 2)))
        np.testing.assert_array_equal(mesh.smoothing_groups, [1, 1, 2, 2, 0, 0])
        self.assertIsNone(mesh.face_colors)
        self.assertEqual(mesh.materials[0], ["skin", "bone"])
        np.testing.assert_array_equal(mesh.materials[1], names[1])
        self.assertEqual([mesh.groups[0][k] if k >= 0 else None for k in mesh.groups[1]],
                         ["3", "3", "3", None, "4", "4"])
        copy = support.cube(groups=mesh.groups)
        self.assertEqual(copy.groups[0], mesh.groups[0])

    def test_a_scene_joins_meshes(self):
        far = vox.Mesh(support.CUBE + 5, support.CUBE_FACES, name="far")
        scene = vox.Scene([support.cube(name="near"), far])
        self.assertEqual([mesh.name for mesh in scene.meshes], ["near", "far"])
        made = vox.convert(scene, dim=30, split="object")
        self.assertEqual(list(made), ["near", "far"])
        alone = vox.convert(scene.meshes[1], voxel_size=0.2)
        self.assertTrue(vox.diff(alone, vox.convert(far, voxel_size=0.2))["same"])
        with self.assertRaises(vox.InputError):
            vox.Scene([])
        with self.assertRaises(TypeError):
            vox.Scene([TORUS])

    def test_info_diff_and_check_return_what_the_program_prints(self):
        made = vox.convert(TORUS, dim=30, grids=["density", "mask"])
        made.write(self.folder / "a.vdb")
        vox.convert(TORUS, dim=32).write(self.folder / "b.vdb")
        a, b = self.folder / "a.vdb", self.folder / "b.vdb"
        self.assertEqual([vox.info(TORUS)], json.loads(support.run("info", TORUS, "--json").stdout))
        self.assertEqual([vox.info(a)], json.loads(support.run("info", a, "--json").stdout))
        self.assertEqual(vox.diff(a, b), json.loads(support.run("diff", a, b, "--json").stdout))
        self.assertEqual(vox.check(a, TORUS),
                         json.loads(support.run("check", a, "--mesh", TORUS, "--json").stdout))
        # In memory.
        self.assertEqual(vox.info(vox.read(TORUS))["meshes"], vox.info(TORUS)["meshes"])
        self.assertEqual([grid["active_voxels"] for grid in vox.info(made)["grids"]],
                         [grid.active_voxels for grid in made.values()])
        self.assertEqual(vox.check(made, vox.read(TORUS)) | {"file": str(a)}, vox.check(a, TORUS))
        self.assertTrue(vox.check(made, ignore=["leak"])["ok"])
        self.assertTrue(vox.diff(made, a)["same"])
        self.assertFalse(vox.diff(made, b, grids=["density"])["same"])
        self.assertTrue(vox.diff(made, made, tolerance=0.5, relative=0.1)["same"])

    def test_diff_and_check_write_pages_for_people(self):
        made = vox.convert(TORUS, dim=20)
        other = vox.convert(TORUS, dim=20, until="levels=1")
        page, cases = self.folder / "diff.html", self.folder / "diff.xml"
        vox.diff(made, other, report=page, junit=cases)
        self.assertIn(">Different</h1>", page.read_text())
        self.assertIn("<testsuite", cases.read_text())
        with self.assertRaises(vox.IoError):
            vox.diff(made, other, report=page)
        vox.diff(made, made, report=page, overwrite=True)
        self.assertIn(">The same</h1>", page.read_text())
        vox.check(made, report=self.folder / "check.html")
        self.assertIn(">No faults</h1>", (self.folder / "check.html").read_text())
        self.assertTrue(vox.diff(made, other, tolerance_voxels=2, no_metadata=True)["same"])

    def test_render_draws_the_picture_of_the_program(self):
        made = vox.convert(TORUS, dim=40, grids=["density", "normal"])
        made.write(self.folder / "a.vdb")
        self.program("render", self.folder / "a.vdb", "-o", self.folder / "a.png", "--size",
                     "64x48", "--view", "front,iso")
        wanted = (self.folder / "a.png").read_bytes()
        for number, shown in enumerate((made, self.folder / "a.vdb")):
            path = self.folder / f"{number}.png"
            picture = vox.render(shown, path, size="64x48", view=["front", "iso"])
            self.assertEqual(path.read_bytes(), wanted)
            self.assertEqual((picture.dtype, picture.ndim, picture.shape[2]), (np.uint8, 3, 4))
            self.assertEqual(struct.unpack(">II", wanted[16:24]), picture.shape[1::-1])
        drawn = vox.render(TORUS, dim=40, size="40x30", background="transparent")
        self.assertEqual(drawn.shape, (30, 40, 4))
        self.assertEqual(set(np.unique(drawn[..., 3])) >= {0, 255}, True)
        np.testing.assert_array_equal(
            drawn, vox.render(vox.read(TORUS), dim=40, size="40x30", background="transparent"))
        with self.assertRaises(vox.IoError):
            vox.render(made, self.folder / "a.png")
        with self.assertRaises(vox.UsageError):
            vox.render(made, self.folder / "a.jpg")
        with self.assertRaisesRegex(vox.UsageError, "is for meshes and scenes only"):
            vox.render(made, dim=30)


class Options(support.InFolder):
    def test_errors_have_the_line_of_the_program(self):
        (self.folder / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
        (self.folder / "dim.toml").write_text("[convert]\ndimm = 3\n")
        cases = [
            (vox.UsageError, TORUS, {"dmi": 5}), (vox.UsageError, TORUS, {"dim": 0}),
            (vox.UsageError, TORUS, {"dim": "many"}), (vox.UsageError, TORUS, {"dim": 2.5}),
            (vox.UsageError, TORUS, {"voxel_size": -1}), (vox.UsageError, TORUS, {"gain": "x"}),
            (vox.UsageError, TORUS, {"dim": 5, "voxel_size": 1}),
            (vox.UsageError, TORUS, {"grids": ["density", "colour"]}),
            (vox.UsageError, TORUS, {"band": (0, 1)}), (vox.UsageError, TORUS, {"bounds": [1, 2]}),
            (vox.UsageError, TORUS, {"interpolate": "all"}), (vox.UsageError, TORUS, {"clip": True}),
            (vox.UsageError, TORUS, {"clip": "maybe"}), (vox.UsageError, TORUS, {"weld": -1}),
            (vox.UsageError, TORUS, {"texture": "marbel"}), (vox.UsageError, TORUS, {"part": "3"}),
            (vox.InputError, self.folder / "missing.obj", {}),
            (vox.InputError, self.folder / "bad.obj", {}),
            (vox.InputError, self.folder / "dim.toml", {}), (vox.InputError, self.folder, {}),
            (vox.InputError, TORUS, {"crease_edges": self.folder / "none.txt"}),
            (vox.LimitError, TORUS, {"dim": 20000, "max_memory": "64M"}),
            (vox.LimitError, TORUS, {"voxel_size": 1e-30}),
        ]
        for kind, source, options in cases:
            with self.subTest(options):
                with self.assertRaises(vox.Error) as caught:
                    vox.convert(source, **options)
                self.assertIs(type(caught.exception), kind)
                words = []
                for name, value in options.items():
                    text = ",".join(map(str, value)) if isinstance(value, (list, tuple)) else value
                    option = "--" + name.replace("_", "-")
                    words.append(option if value is True else f"{option}={text}")
                done = support.run("convert", source, "-o", self.folder / "o.vdb", *words)
                self.assertEqual(done.stderr, f"vox: error: {caught.exception}\n")

    def test_an_unknown_name_suggests_the_nearest(self):
        for function, name, nearest in ((vox.convert, "voxelsize", "--voxel-size"),
                                        (vox.convert, "interpolat", "--interpolate"),
                                        (vox.render, "sample", "--samples"),
                                        (vox.info, "boundry", "--boundary")):
            with self.assertRaisesRegex(vox.UsageError, f"did you mean {nearest}"):
                function(TORUS, **{name: 1})

    def test_options_of_the_program_alone_are_refused(self):
        for name in ("output", "force", "quiet", "verbose", "report", "dry_run"):
            with self.assertRaisesRegex(vox.UsageError, "is for the program only"):
                vox.convert(TORUS, **{name: True})
        for name in ("help", "version", "man", "o", "", "--dim", "dim=5 --fill"):
            with self.assertRaisesRegex(vox.UsageError, "unknown option|needs a value"):
                vox.convert(TORUS, **{name: "x"})
        with self.assertRaisesRegex(vox.UsageError, "json is for the program only"):
            vox.diff(TORUS, TORUS, json=True)
        with self.assertRaisesRegex(vox.UsageError, "--dim needs a value, not true or false"):
            vox.convert(TORUS, dim=True)
        with self.assertRaisesRegex(vox.UsageError, "--grids: must not be empty"):
            vox.convert(TORUS, grids=[])
        with self.assertRaisesRegex(vox.UsageError, "--scale is for files"):
            vox.convert(support.cube(), scale=2)
        with self.assertRaisesRegex(vox.UsageError, "is a file of grids"):
            vox.convert("a.vdb")

    def test_values_of_a_wrong_type_are_refused(self):
        for value in (object(), {"a": object()}.values(), [[1, 2], [3, 4]], 1j):
            with self.assertRaises(TypeError):
                vox.convert(TORUS, dim=value)
        for value in (3, None, ["a.obj"], object()):
            with self.assertRaises(TypeError):
                vox.convert(value)
            with self.assertRaises(TypeError):
                vox.read(value)
        with self.assertRaises(ValueError):
            vox.read("a\0.obj")
        for kind in (vox.Grid, vox.Grids):
            with self.assertRaises(TypeError):
                kind()

    def test_none_means_not_given(self):
        self.assertTrue(vox.diff(vox.convert(TORUS, dim=20, crease=None, clip=None),
                                 vox.convert(TORUS, dim=20))["same"])

    def test_names_of_files_may_be_any(self):
        for name in ("-odd name.obj", "ümläut=1.obj", b"\xff\xfe.obj", "a,b.obj", "[a].obj"):
            path = self.folder / (name if isinstance(name, str) else name.decode(
                "utf-8", "surrogateescape"))
            path.write_bytes(TORUS.read_bytes())
            made = vox.convert(path, dim=20)
            self.assertEqual(list(made), ["density"])
            self.assertTrue(vox.read(path).name)
            path.with_suffix(".vdb")
            made.write(path.with_suffix(".vdb"))
            self.assertTrue(vox.diff(path.with_suffix(".vdb"), made)["same"])
        with contextlib.chdir(self.folder):
            vox.convert("-odd name.obj", dim=20)
        with self.assertRaisesRegex(vox.InputError, r"\\xff\.obj: .*no such file"):
            vox.read(b"\xff.obj")

    def test_warnings_are_warnings(self):
        (self.folder / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\n"
                                              "f 1 2 3\nf 1 2 3\nf 1 3 4\n")
        with self.assertWarnsRegex(vox.VoxWarning, "duplicate") as caught:
            vox.convert(self.folder / "open.obj", dim=20)
        self.assertEqual(caught.filename, __file__)

    def test_help_lists_the_options(self):
        for function in (vox.convert, vox.subdivide, vox.render, vox.info, vox.diff, vox.check):
            parameters = inspect.signature(function).parameters
            self.assertFalse({"output", "force", "json"} & set(parameters))
            for name in parameters:
                self.assertIn(f"{name}", function.__doc__)
        self.assertNotIn("report", inspect.signature(vox.convert).parameters)
        self.assertIn("dim", inspect.signature(vox.convert).parameters)
        self.assertRegex(vox.convert.__doc__, "(?m)^dim: .*Voxels along the longest side")


if __name__ == "__main__":
    unittest.main()

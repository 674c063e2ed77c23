"""No array crashes: it becomes a mesh, or an exception says what is wrong with it."""
import random
import unittest
import warnings

import numpy as np
import support
import vox
from support import CUBE, CUBE_FACES


class WrongArrays(unittest.TestCase):
    def refused(self, kind, text, points=CUBE, faces=CUBE_FACES, **attributes):
        with self.assertRaisesRegex(kind, text) as caught:
            vox.Mesh(points, faces, **attributes)
        self.assertNotIn("\n", str(caught.exception))

    def test_points_of_a_wrong_shape_or_type(self):
        self.refused(vox.InputError, r"points: must have shape \(n, 3\), not \(24,\)", CUBE.ravel())
        self.refused(vox.InputError, r"points: .*not \(8, 2\)", CUBE[:, :2])
        self.refused(vox.InputError, "points: ", [])
        self.refused(TypeError, "points: must be numbers, not complex128", CUBE.astype(complex))
        self.refused(TypeError, "points: must be numbers, not bool", CUBE > 0)
        self.refused(TypeError, "points: must be numbers, not <U", [["a", "b", "c"]])
        self.refused(TypeError, "points: must be numbers, not None", None)
        self.refused(TypeError, "points: must be numbers, not object", object())
        self.refused(ValueError, "points: cannot become an array", [[0, 0, 0], [1, 1]])

    def test_points_that_are_no_places(self):
        for value, text in ((np.nan, "vertex 3 has a coordinate that is not finite"),
                            (-np.inf, "vertex 3 has a coordinate that is not finite"),
                            (1e300, "vertex 3 has a coordinate beyond 1e15")):
            points = CUBE.copy()
            points[3, 1] = value
            self.refused(vox.MeshError, text, points)
        points = CUBE.astype(np.float32)
        points[0] = np.float32(3e38)
        self.refused(vox.MeshError, "vertex 0 has a coordinate beyond 1e15", points)

    def test_faces_of_a_wrong_shape_or_type(self):
        array = np.array(CUBE_FACES)
        self.refused(TypeError, "faces: must be whole numbers, not float64", faces=array * 1.0)
        self.refused(TypeError, "faces: must be whole numbers, not bool", faces=array > 1)
        self.refused(TypeError, "faces: must be whole numbers, not object", faces=[[0, 1, 2**70]])
        self.refused(TypeError, "faces: must be whole numbers, not float64", faces=[[0, 1, 2.5]])
        self.refused(TypeError, "faces: must be whole numbers, not <U", faces="abc")
        self.refused(TypeError, "faces: must be an .n, k. array, a list of lists", faces=7)
        self.refused(TypeError, "faces: must be an .n, k. array", faces=[0, 1, 2])
        self.refused(vox.InputError, "faces: must have 2 dimensions", faces=array.ravel())
        self.refused(vox.InputError, "faces: must have shape .n, k. with k of 3 or more",
                     faces=array[:, :2])
        self.refused(vox.MeshError, "the mesh has no faces", faces=[])
        self.refused(vox.MeshError, "the mesh has no faces", faces=np.zeros((0, 3), int))
        self.refused(vox.MeshError, "face 1 has fewer than 3 corners", faces=[[0, 1, 2], [3, 4]])

    def test_indices_out_of_range(self):
        for wrong in (-1, 8, 2**31, 2**32, 2**32 - 1, 2**63 - 1, -2**63):
            faces = [list(face) for face in CUBE_FACES]
            faces[2][1] = wrong
            for form in (faces, np.array(faces)):
                self.refused(vox.MeshError, f"face 2 names vertex {wrong} of 8", faces=form)
        self.refused(vox.MeshError, f"face 0 names vertex {2**64 - 1} of 8",
                     faces=np.array([[2**64 - 1, 0, 1]], np.uint64))
        self.refused(vox.MeshError, "face 0 names vertex 200 of 8",
                     faces=np.array([[200, 0, 1]], np.uint8))

    def test_offsets_that_make_no_faces(self):
        corners = np.arange(6)
        for offsets, text in (([0, 3], "offsets must start at 0 and end at"),
                              ([3, 6], "offsets must start at 0 and end at"),
                              ([0, 5, 4, 6], "face 1 has fewer than 3 corners"),
                              ([0, -3, 6], "offset 1 is -3 of 6 corners"),
                              ([0, 2**40, 6], f"offset 1 is {2**40} of 6 corners"),
                              ([], "the mesh has no faces"), ([0], "the mesh has no faces")):
            self.refused(vox.MeshError, text, faces=(offsets, corners))
        self.refused(TypeError, "offsets: must be whole numbers", faces=([0.0, 3.0], corners))

    def test_attributes_that_do_not_fit(self):
        self.refused(vox.InputError, "point_colors: must have one row per vertex: 8, not 7",
                     point_colors=np.zeros((7, 3)))
        self.refused(vox.InputError, r"face_colors: must have shape \(n, 3\), not \(6, 4\)",
                     face_colors=np.zeros((6, 4)))
        self.refused(vox.InputError, "point_colors: row 2: floats must lie between 0 and 1",
                     point_colors=np.array([[0.5] * 3] * 2 + [[0, 1.5, 0]] + [[0.5] * 3] * 5))
        self.refused(vox.InputError, "point_colors: row 0: floats",
                     point_colors=np.full((8, 3), np.nan))
        self.refused(TypeError, "point_colors: must be floats .* not int64",
                     point_colors=np.zeros((8, 3), int))
        self.refused(vox.InputError, "uv: must have one row per corner: 24, not 8",
                     uv=np.zeros((8, 2)))
        self.refused(vox.InputError, "uv: row 0 is infinite", uv=np.full((24, 2), np.inf))
        self.refused(vox.InputError, "smoothing_groups: number 1 is -1",
                     smoothing_groups=[0, -1, 0, 0, 0, 0])
        self.refused(vox.InputError, "groups: must have one row per face: 6, not 2",
                     groups=["a", "b"])
        self.refused(vox.InputError, "groups: face 5 has number 1 of 1 names",
                     groups=(["a"], [0, 0, 0, 0, 0, 1]))
        self.refused(TypeError, "materials: must be whole numbers or texts",
                     materials=np.zeros(6))

    def test_lists_of_vertices_that_do_not_fit(self):
        mesh = support.cube()
        for value, kind, text in (([[0, 1, 2]], vox.InputError, r"crease_edges: must have shape"),
                                  ([[-1, 0]], vox.InputError, "crease_edges: number 0 is -1"),
                                  ([[0.5, 1]], TypeError, "crease_edges: must be whole numbers"),
                                  ([[0, 99]], vox.Error, "99"),
                                  ([[0, 2**40]], vox.InputError, "crease_edges: number 1 is")):
            with self.assertRaisesRegex(kind, text):
                vox.convert(mesh, dim=8, crease_edges=value)

    def test_to_dense_refuses_boxes_that_are_none(self):
        grid = vox.convert(support.cube(), dim=8)["density"]
        self.assertEqual(grid.to_dense((0, 0, 0), (-1, 5, 5)).shape, (0, 6, 6))
        for low in ((0, 0), "abc", (0.5, 0, 0), (2**40, 0, 0), (-2**31, 0, 0)):
            with self.assertRaises((vox.InputError, TypeError)):
                grid.to_dense(low)
        with self.assertRaises(vox.LimitError):
            grid.to_dense((-2**30, -2**30, -2**30), (2**30, 2**30, 2**30))


class RandomArrays(unittest.TestCase):
    """Random arguments: a mesh or an exception of the kinds that are documented."""

    def test_random_arrays_are_refused_or_converted(self):
        seed = 20240607
        chance = random.Random(seed)
        numbers = np.random.default_rng(seed)
        counts = {"converted": 0, "refused": 0}
        for number in range(1500):
            points = self.random_points(chance, numbers)
            faces = self.random_faces(chance, numbers)
            attributes = self.random_attributes(chance, numbers)
            with self.subTest(number=number), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    mesh = vox.Mesh(points, faces, **attributes)
                    grids = vox.convert(mesh, dim=chance.choice((1, 5, 12)),
                                        grids=chance.choice((["density"], ["surface", "mask"],
                                                             ["color"], ["normal", "part"])))
                    for grid in grids.values():
                        self.assertEqual(grid.coords.shape, (grid.active_voxels, 3))
                        self.assertEqual(len(grid.values), grid.active_voxels)
                    counts["converted"] += 1
                except (vox.Error, TypeError, ValueError) as error:
                    self.assertNotIn("\n", str(error))
                    self.assertNotIn("internal", str(error))
                    counts["refused"] += 1
        self.assertGreater(counts["converted"], 300, counts)
        self.assertGreater(counts["refused"], 300, counts)

    @staticmethod
    def random_points(chance, numbers):
        shape = (8, 3)
        if chance.random() < 0.05:
            shape = chance.choice([(8, 2), (0, 3), (8,), (2, 4, 3), (1, 3)])
        points = numbers.normal(size=shape)
        if chance.random() < 0.1 and points.size:
            points.flat[chance.randrange(points.size)] = chance.choice(
                (np.nan, np.inf, 1e300, 1e15, -1e16, 5e-324))
        kind = float
        if chance.random() < 0.3:
            kind = chance.choice([np.float32, np.float16, np.int8, np.uint64, complex, bool, object,
                                  ">f8", "longdouble"])
        with np.errstate(all="ignore"):
            points = points.astype(kind)
        if chance.random() < 0.2:
            points = points[::-1]
        return points.tolist() if chance.random() < 0.2 else points

    @staticmethod
    def random_faces(chance, numbers):
        count = chance.choice((1, 3, 6, 12) if chance.random() < 0.95 else (0,))
        size = chance.choice((3, 3, 4, 5) if chance.random() < 0.95 else (2, 1, 0))
        low, high = (0, 8) if chance.random() < 0.9 else chance.choice(((-1, 8), (0, 9), (0, 2**31)))
        faces = numbers.integers(low, high, size=(count, size))
        kind = np.int64
        if chance.random() < 0.3:
            kind = chance.choice([np.int32, np.uint64, np.int8, float, bool, ">i8"])
        with np.errstate(all="ignore"):
            faces = faces.astype(kind)
        form = chance.randrange(4)
        if form == 0:
            return faces
        if form == 1:
            return [face[:chance.choice((size, size, size, 3))].tolist() for face in faces]
        if form == 2:
            offsets = np.arange(count + 1) * size
            if chance.random() < 0.2:
                offsets[chance.randrange(count + 1)] = chance.choice((-1, 0, 7, 2**40))
            return offsets, faces.ravel()
        return np.asfortranarray(faces)

    @staticmethod
    def random_attributes(chance, numbers):
        attributes = {}
        if chance.random() < 0.3:
            attributes["point_colors"] = numbers.random(chance.choice([(8, 3)] * 4 + [(8, 4)]))
        if chance.random() < 0.05:
            attributes["uv"] = numbers.normal(size=(chance.choice((3, 18, 24)), 2))
        if chance.random() < 0.1:
            attributes["groups"] = numbers.integers(-1, 3, size=chance.choice((1, 3, 6, 12)))
        return attributes


if __name__ == "__main__":
    unittest.main()

"""The type hints: mypy accepts what is right, and they name the options of the program."""
import ast
import inspect
import pathlib
import subprocess
import sys
import tempfile
import unittest

import support  # noqa: F401  (skips without NumPy)
import vox

USE = '''
import numpy as np
import vox

points = np.zeros((8, 3), np.float32)
mesh = vox.Mesh(points, [[0, 1, 2], [0, 2, 3, 4]], groups=["a", "b"], uv=None)
vox.Mesh(points.tolist(), (np.array([0, 3]), np.array([0, 1, 2])), materials=(["m"], [0]))

def tell(part: float, stage: str) -> None:
    print(part, stage)

grids = vox.convert(mesh, dim=256, grids=["density"], crease=40, band=(2, 5), until="levels=1",
                    crease_edges=np.array([[0, 1]]), strict=True, progress=tell)
grid: vox.Grid = grids["density"]
total: int = grid.coords.shape[0] + grid.active_voxels
size: float = grid.transform.voxel_size[0]
world = grid.transform.to_world(grid.coords) + grid.to_dense((0, 0, 0), [1, 1, 1]).sum()
grids.write("a.vdb", overwrite=True, compression="zip")
for name, one in grids.items():
    print(name.upper(), one.values.mean(), grids.report["active_voxels"])
fine: vox.Mesh = vox.subdivide(vox.Scene([mesh]), levels=2)
picture = vox.render(grids, "a.png", size="640x480")
picture[0, 0, :3] = 255
same: bool = vox.diff(grids, "a.vdb")["same"]
print(vox.check(grids, mesh)["ok"], vox.info("a.vdb"), vox.read("a.obj"))
try:
    vox.convert("a.obj")
except vox.MeshError as error:
    print(error)
except (vox.InputError, ValueError, vox.Cancelled):
    pass
'''

WRONG = [
    "vox.convert(mesh, dmi=5)", "vox.convert(mesh, 256)", "vox.convert(mesh, dim='many')",
    "vox.convert(5)", "vox.subdivide(mesh)", "vox.convert(mesh, strict='yes')",
    "vox.convert(mesh, dim=5).values.mean()", "vox.diff(mesh, 'a.vdb')", "vox.Grid().color",
    "vox.render(mesh, output='a.png')",
]


def mypy(folder, text):
    source = pathlib.Path(folder) / "use.py"
    source.write_text(text)
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", f"{folder}/cache", source],
        capture_output=True, text=True, check=False, cwd=folder,
        env={"MYPYPATH": str(pathlib.Path(vox.__file__).parents[1]), "PATH": "/usr/bin:/bin"})


class Types(unittest.TestCase):
    def test_mypy_accepts_what_is_right_and_refuses_what_is_wrong(self):
        if subprocess.run([sys.executable, "-m", "mypy", "--version"], capture_output=True,
                          check=False).returncode != 0:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as folder:
            done = mypy(folder, USE)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            head = "import vox\nimport numpy as np\n"
            head += "mesh = vox.Mesh(np.zeros((8, 3)), [[0, 1, 2]])\n"
            done = mypy(folder, head + "".join(line + "\n" for line in WRONG))
            for number, line in enumerate(WRONG, start=head.count("\n") + 1):
                self.assertIn(f"use.py:{number}: error", done.stdout, line)

    def test_hints_name_the_options_of_the_program(self):
        hints = ast.parse(pathlib.Path(vox.__file__).with_suffix(".pyi").read_text())
        hinted = {node.name: node.args for node in hints.body if isinstance(node, ast.FunctionDef)}
        for name in ("convert", "subdivide", "render", "info", "diff", "check"):
            names = [one.arg for one in hinted[name].args + hinted[name].kwonlyargs]
            self.assertEqual(sorted(names),
                             sorted(inspect.signature(getattr(vox, name)).parameters), name)

    def test_hints_name_what_the_package_has(self):
        hints = ast.parse(pathlib.Path(vox.__file__).with_suffix(".pyi").read_text())
        names = {node.name for node in hints.body
                 if isinstance(node, (ast.FunctionDef, ast.ClassDef))} | {"__version__"}
        self.assertEqual(names, set(vox.__all__))
        for node in hints.body:
            if not isinstance(node, ast.ClassDef):
                continue
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    self.assertTrue(hasattr(getattr(vox, node.name), member.name), member.name)


if __name__ == "__main__":
    unittest.main()

"""Threads, progress, cancelling, Ctrl-C, memory."""
import concurrent.futures
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

import numpy as np
import support
import vox

TORUS = support.SCENES / "torus.obj"

# A conversion that takes long enough to be stopped, but could end: minutes.
LONG = {"dim": 6000, "until": "levels=9", "max_memory": "100G", "grids": ["mask"]}


def resident():
    """Bytes of memory that this process has now."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Runs(support.InFolder):
    def test_threads_at_once_make_what_one_makes(self):
        sizes = [20, 35, 50, 65] * 3
        wanted = {size: vox.convert(TORUS, dim=size, grids=["density", "normal"])
                  for size in set(sizes)}
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            made = list(pool.map(
                lambda size: vox.convert(TORUS, dim=size, grids=["density", "normal"],
                                         threads=size % 3 + 1), sizes))
        for size, grids in zip(sizes, made):
            for name, grid in grids.items():
                np.testing.assert_array_equal(grid.coords, wanted[size][name].coords)
                np.testing.assert_array_equal(grid.values, wanted[size][name].values)

    def test_one_grid_serves_many_threads(self):
        grid = vox.convert(TORUS, dim=60)["density"]
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            arrays = list(pool.map(lambda _: (grid.coords, grid.values, grid.to_dense()), range(16)))
        for coords, values, dense in arrays:
            np.testing.assert_array_equal(coords, arrays[0][0])
            np.testing.assert_array_equal(values, arrays[0][1])
            np.testing.assert_array_equal(dense, arrays[0][2])

    def test_the_lock_of_the_interpreter_is_free_meanwhile(self):
        turns = []
        stop = threading.Event()

        def count():
            while not stop.is_set():
                turns.append(1)
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        before = len(turns)
        vox.convert(TORUS, dim=500, threads=1)
        during = len(turns) - before
        stop.set()
        counter.join()
        self.assertGreater(during, 3)

    def test_progress_rises_to_one_in_the_calling_thread(self):
        calls = []
        vox.convert(TORUS, dim=200,
                    progress=lambda part, stage: calls.append((part, stage, threading.get_ident())))
        parts = [part for part, _, _ in calls]
        self.assertEqual(parts, sorted(parts))
        self.assertEqual(parts[-1], 1)
        self.assertEqual({thread for _, _, thread in calls}, {threading.get_ident()})
        self.assertTrue(all(isinstance(stage, str) and stage for _, stage, _ in calls))

    def test_an_exception_of_progress_stops_the_run(self):
        class Stop(Exception):
            pass

        def stop(part, stage):
            raise Stop(stage)

        for work in (lambda: vox.convert(TORUS, progress=stop, **LONG),
                     lambda: vox.subdivide(TORUS, levels=2, progress=stop),
                     lambda: vox.render(TORUS, dim=50, progress=stop)):
            with self.assertRaises(Stop):
                work()
        made = vox.convert(TORUS, dim=50)
        with self.assertRaises(Stop):
            made.write(self.folder / "a.vdb", progress=stop)
        # A file may be complete before the first call; there are no partial ones.
        self.assertLessEqual({path.name for path in self.folder.iterdir()}, {"a.vdb"})

    def test_false_of_progress_cancels(self):
        with self.assertRaisesRegex(vox.Cancelled, "^interrupted$"):
            vox.convert(TORUS, progress=lambda part, stage: False, **LONG)
        with self.assertRaises(TypeError):
            vox.convert(TORUS, progress=3)

    def test_control_c_stops_a_conversion(self):
        code = f"""
import sys, vox
print("ready", flush=True)
try:
    vox.convert({str(TORUS)!r}, **{LONG!r})
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(len(vox.convert({str(TORUS)!r}, dim=20)["density"].coords) > 0)
"""
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True) as child:
            self.assertEqual(child.stdout.readline(), "ready\n")
            time.sleep(0.7)
            child.send_signal(signal.SIGINT)
            out, err = child.communicate(timeout=120)
        self.assertEqual(out, "interrupted\nTrue\n", err)
        self.assertEqual(child.returncode, 0, err)

    @unittest.skipIf("VOX_SANITIZED" in os.environ, "sanitizers keep memory that was freed")
    def test_a_thousand_conversions_keep_no_memory(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            before = None
            for number in range(1000):
                mesh = support.cube(name=f"cube {number}", groups=["a", "b"] * 3)
                grids = vox.convert(mesh, dim=30, grids=["density", "normal", "part"])
                for grid in grids.values():
                    self.assertEqual(len(grid.coords), len(grid.values))
                grids["density"].to_dense()
                if number == 200:
                    before = resident()
        growth = resident() - before
        self.assertLess(growth, 20e6, f"{growth} bytes more after 800 conversions")

    def test_views_keep_their_mesh_alive(self):
        points = vox.read(TORUS).points
        copy = points.copy()
        made = [vox.convert(TORUS, dim=20) for _ in range(3)]
        np.testing.assert_array_equal(points, copy)
        self.assertFalse(points.flags.writeable)
        values = made.pop()["density"].values
        self.assertTrue((values == values[0]).all())


if __name__ == "__main__":
    unittest.main()

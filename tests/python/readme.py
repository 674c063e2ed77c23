"""The examples of apps/python/README.md run, one after the other. Usage: readme.py README"""
import contextlib
import io
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import support

README = pathlib.Path(sys.argv.pop())


class Readme(unittest.TestCase):
    def test_the_examples_run(self):
        blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(), re.M | re.S)
        self.assertGreater(len(blocks), 5)
        names = {}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out:
            shutil.copy(support.SCENES / "toy_jack.obj", pathlib.Path(folder, "model.obj"))
            os.chdir(folder)
            try:
                for block in blocks:
                    exec(compile(block, README, "exec"), names)
                    pathlib.Path("model.vdb").unlink(missing_ok=True)
            finally:
                os.chdir(before)
        for said in re.findall(r"^ +print\(error\) +# (.*)$", README.read_text(), re.M):
            self.assertIn(said, out.getvalue())


if __name__ == "__main__":
    unittest.main()

"""vox as a child process: its progress, its one line of error, and the means to stop it."""

import os
import re
import shutil
import subprocess
import threading

PROGRESS = re.compile(r"vox: (\d+)% (\w+)$")  # of --progress
WARNING = "vox: warning: "
ERROR = "vox: error: "
FINISHED = re.compile(r"vox: .*: \d+ active voxels")  # the last line of each file


class VoxError(RuntimeError):
    """What went wrong, in one line that tells what to do."""


def find_vox(path):
    """The program: `path` of the preferences, or, if it is empty, the one on PATH."""
    found = shutil.which(path or "vox")
    if found is None:
        where = f"{path} is no program" if path else "vox is not on PATH"
        raise VoxError(f"{where}; install vox, or set its path in Preferences > Add-ons > Vox")
    return os.path.abspath(found)


class Child:
    """A run of `vox convert`. As a context it ends with its block, however that ends."""

    def __init__(self, program, arguments, files=1):
        """@param files  that the run writes, one after another"""
        self.stage = "start"
        self.warnings = []
        self._files = files
        self._finished = 0
        self._percent = 0
        self._error = ""
        try:
            self._process = subprocess.Popen(
                [program, "convert", *arguments, "--progress"],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
            )
        except OSError as wrong:
            raise VoxError(f"{program}: {wrong.strerror}; set the path of vox in Preferences > Add-ons > Vox")
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.is_running():
            self._process.terminate()  # vox removes what it has begun to write
        self._process.wait()
        self._reader.join()

    def is_running(self):
        return self._process.poll() is None

    def fraction(self):
        """What is done of all files, 0 to 1."""
        return min((self._finished + self._percent / 100) / self._files, 1)

    def check(self):
        """Raises VoxError if vox, which has ended, has failed."""
        self._reader.join()
        code = self._process.returncode
        if code != 0:
            raise VoxError(self._error or f"vox ended with code {code}")

    def _read(self):
        for line in self._process.stderr:
            line = line.rstrip("\n")
            if progress := PROGRESS.match(line):
                self._percent, self.stage = int(progress[1]), progress[2]
            elif line.startswith(WARNING):
                self.warnings.append(line.removeprefix(WARNING))
            elif FINISHED.match(line):
                self._finished, self._percent = self._finished + 1, 0
            elif line:
                self._error = line.removeprefix(ERROR)

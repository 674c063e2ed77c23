"""Builds the package vox with CMake into a wheel: a backend of pip (PEP 517).

pip install ./apps/python                                        builds in build/python
pip install --config-settings=build=build/release ./apps/python  uses a build that is there, with
                                                                 VOX_BUILD_PYTHON=ON
"""
import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
INSTALLED = "lib/python3/dist-packages"  # as apps/python/CMakeLists.txt installs it


def _version():
    return re.search(r"project\(vox VERSION (\S+)",
                     (REPOSITORY / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _cmake(*arguments):
    subprocess.run(["cmake", *map(str, arguments)], cwd=REPOSITORY, check=True)


def _build(settings):
    """The folder of a build that has the package."""
    if "build" in settings:
        folder = REPOSITORY / settings["build"]
    else:
        folder = REPOSITORY / "build/python"
        _cmake("--preset", "release", "-B", folder, "-DVOX_BUILD_PYTHON=ON", "-DVOX_BUILD_TESTS=OFF",
               "-DVOX_BUILD_BENCHMARKS=OFF", f"-DPython_EXECUTABLE={sys.executable}")
    _cmake("--build", folder, "--target", "vox_python")
    return folder


def _files(settings):
    """The files of the package, by their names in the wheel."""
    with tempfile.TemporaryDirectory() as prefix:
        _cmake("--install", _build(settings), "--component", "python", "--strip", "--prefix", prefix)
        root = pathlib.Path(prefix, INSTALLED)
        files = {str(path.relative_to(root)): path.read_bytes() for path in root.glob("vox/*")}
    extension = f"vox/_vox{sysconfig.get_config_var('EXT_SUFFIX')}"
    if extension not in files:
        raise RuntimeError(f"the build is for another Python: it has no {extension}")
    return files


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Makes the wheel and returns its name."""
    version, tag = _version(), _tag()
    files = _files(config_settings or {})
    info = f"vox-{version}.dist-info"
    readme = (REPOSITORY / "apps/python/README.md").read_text(encoding="utf-8")
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: vox\nVersion: {version}\n"
        "Summary: Smooth voxel models in OpenVDB from polygon meshes\nLicense: MIT\n"
        f"Requires-Python: >=3.9\nRequires-Dist: numpy\nDescription-Content-Type: text/markdown\n\n"
        f"{readme}").encode()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: build_wheel\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag}\n").encode()
    record = "".join(
        f"{name},sha256="
        f"{base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},"
        f"{len(content)}\n" for name, content in files.items())
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    name = f"vox-{version}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            wheel.writestr(path, content)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """There is none: the package is built from a clone of the repository."""
    raise NotImplementedError("build the package from a clone of the repository")

#!/usr/bin/env bash
# Installs the Python package into a fresh environment, without a network, and uses it there. It uses
# the build that is there; without --config-settings pip would build libvox first.
# Usage: pip.sh PYTHON BUILD SOURCE
set -euo pipefail
python=$1 build=$2 source=$3
"$python" -c 'import numpy, pip, venv' 2>/dev/null ||
  { echo "skipped: NumPy, pip or venv is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$python" -m venv --system-site-packages env
PIP_NO_INDEX=1 env/bin/pip install --quiet --config-settings=build="$build" "$source/apps/python"
env/bin/python - "$source/scenes/torus.obj" <<'PY'
import sys
import vox
grids = vox.convert(sys.argv[1], dim=30)
grids.write("torus.vdb")
print(vox.__file__, grids)
assert vox.__file__.startswith(sys.prefix)
PY
"$build/apps/vox/vox" info torus.vdb | grep 'grid density'
env/bin/pip uninstall --quiet --yes vox
! env/bin/python -c 'import vox' 2>/dev/null

#!/usr/bin/env bash
# Makes the Debian packages, unpacks them and runs what is in there. Usage: package.sh CPACK BUILD
# SCENES
set -euo pipefail
cpack=$1 build=$2 scenes=$3
command -v dpkg-shlibdeps >/dev/null || { echo "skipped: dpkg-dev is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$cpack" --config "$build/CPackConfig.cmake" -B "$folder" >/dev/null
dpkg-deb --field vox_*.deb Depends | grep libopenvdb
dpkg-deb --contents libvox-dev_*.deb | grep usr/include/libvox/pipeline/convert.h
dpkg-deb --extract vox_*.deb root
root/usr/bin/vox convert "$scenes/torus.toml" -o torus.vdb --dim 30 --verify
[ -x root/usr/share/vox/cluster/slurm.sh ]
python3 -m zipfile -l root/usr/share/vox/blender/vox_addon.zip | grep vox_addon/blender_manifest.toml
[ -r root/usr/share/vox/ci/action.yml ]
gzip -dc root/usr/share/man/man1/vox.1.gz | grep '^.SS vox convert'

# The Python package, if it was built: for the Python that is there.
if [ -f "$(echo python3-vox_*.deb)" ]; then
  dpkg-deb --field python3-vox_*.deb Depends | grep 'python3-numpy.*\|libopenvdb'
  dpkg-deb --extract python3-vox_*.deb root
  if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    PYTHONPATH=root/usr/lib/python3/dist-packages /usr/bin/python3 -c "
import vox
grids = vox.convert('$scenes/torus.toml', dim=30)
assert vox.__file__.startswith('$folder/root') and vox.diff(grids, 'torus.vdb')['same']"
  fi
fi

# Completion: commands, options, values.
completed() {
  # shellcheck disable=SC1091
  (source root/usr/share/bash-completion/completions/vox
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _vox
    echo "${COMPREPLY[*]}")
}
[ "$(completed vox conv)" = convert ]
[ "$(completed vox convert a.obj --bounda)" = --boundary ]
[ "$(completed vox convert a.obj --boundary e)" = extend ]
[ "$(completed vox convert a.obj --until l)" = levels= ]
[ -z "$(completed vox convert a.o)" ]

#!/usr/bin/env bash
# Installs the add-on as users do, in folders of its own, and runs a script in a headless Blender
# that has it enabled; window.py in a window. Usage: run.sh VOX ADDON.zip SCRIPT.py
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: blender is not installed"; exit 77; }
vox=$(realpath "$1") zip=$(realpath "$2") script=$(realpath "$3")
how=(blender --background)
if [ "$(basename "$script")" = window.py ]; then
  command -v xvfb-run >/dev/null || { echo "skipped: xvfb-run is not installed"; exit 77; }
  export LIBGL_ALWAYS_SOFTWARE=1
  how=(xvfb-run -a -s "-screen 0 1280x800x24" blender)
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/config" "$folder/scripts" "$folder/bin" "$folder/work"
ln -s "$vox" "$folder/bin/vox"
export BLENDER_USER_CONFIG=$folder/config BLENDER_USER_SCRIPTS=$folder/scripts PATH=$folder/bin:$PATH

cat >"$folder/install.py" <<'PY'
import sys

import bpy

bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
bpy.ops.preferences.addon_enable(module="vox_addon")
bpy.ops.preferences.addon_disable(module="vox_addon")  # and once more
bpy.ops.preferences.addon_enable(module="vox_addon")
assert hasattr(bpy.types, "VIEW3D_PT_vox")
bpy.ops.wm.save_userpref()
PY
blender --background --factory-startup --python-exit-code 1 --python "$folder/install.py" -- "$zip"
cd "$folder/work"
PYTHONPATH=$(dirname "$script") PYTHONDONTWRITEBYTECODE=1 \
  "${how[@]}" --python-use-system-env --python-exit-code 1 --python "$script"

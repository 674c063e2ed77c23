#!/usr/bin/env bash
# Installs what is missing, builds vox, converts the toy jack and says what to do next.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/install-packages.sh cmake/packages.txt
cmake --preset release -DVOX_BUILD_TESTS=OFF -DVOX_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build --preset release --target vox_app

vox=build/release/apps/vox/vox
"$vox" convert scenes/toy_jack.toml -o toy_jack.vdb --force
"$vox" info toy_jack.vdb

cat <<EOF

Done. $PWD/toy_jack.vdb is a smooth voxel model.
  Blender   Add > Volume > Import OpenVDB..., choose toy_jack.vdb, look at it in Rendered view
  Houdini   a File SOP that reads toy_jack.vdb
  your own  $vox convert YOUR_MESH.obj -o out.vdb --dim 256
  more      $vox --help
EOF

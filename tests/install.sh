#!/usr/bin/env bash
# Installs the build into an empty folder and lets a program of its own find and use it there.
# Usage: install.sh CMAKE BUILD SOURCE
set -euo pipefail
cmake=$1 build=$2 source=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$cmake" --install "$build" --prefix "$folder/prefix" >/dev/null
cp -r "$source/apps/example" "$folder/example"
"$cmake" -S "$folder/example" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$folder/prefix" >/dev/null
"$cmake" --build "$folder/build"
cd "$folder"
"$folder/build/example" tetrahedron.vdb
"$folder/prefix/bin/vox" info tetrahedron.vdb | grep 'grid density'

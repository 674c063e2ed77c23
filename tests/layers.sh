#!/usr/bin/env bash
# Fails on an include that runs against the ranks of libvox/README.md:
# core < mesh, options < grid < stages (which never include each other) < pipeline, inspect, render < report < apps < apps/python < tests.
set -euo pipefail
cd "$1"

rank() {
  case $1 in
    libvox/core) echo 0 ;;
    libvox/mesh | libvox/options) echo 1 ;;
    libvox/grid) echo 2 ;;
    libvox/io | libvox/prepare | libvox/localize | libvox/subdivide | libvox/voxelize | libvox/foot | libvox/volume) echo 3 ;;
    libvox/pipeline | libvox/inspect | libvox/render) echo 4 ;;
    libvox/report) echo 5 ;;
    apps/python) echo 7 ;;
    apps/*) echo 6 ;;
    tests | tests/*) echo 8 ;;
    *) echo "unknown folder $1: give it a rank in tests/layers.sh" >&2; exit 1 ;;
  esac
}

wrong=0
checked=0
while IFS=: read -r file include; do
  from=$(dirname "$file")
  to=$(dirname "$include")
  [ "$from" = "$to" ] && continue
  from_rank=$(rank "$from")
  to_rank=$(rank "$to")
  checked=$((checked + 1))
  if [ "$to_rank" -ge "$from_rank" ]; then
    echo "$file includes $include: $from (rank $from_rank) may not use $to (rank $to_rank)"
    wrong=1
  fi
done < <(grep -roE --include='*.h' --include='*.cpp' '^#include "(libvox|apps|tests)/[^"]+"' libvox apps tests |
  sed -E 's/#include "([^"]+)"/\1/')

if grep -rlE --include='*.h' --include='*.cpp' '#include <OpenMesh' libvox apps | grep -v '^libvox/io/'; then
  echo "OpenMesh may be included in libvox/io only"
  wrong=1
fi
# Programs use public headers only: those that libvox/CMakeLists.txt installs. So do these themselves.
while IFS=: read -r file include; do
  grep -q "^ *${include#libvox/}\$" libvox/CMakeLists.txt && continue
  echo "$file includes $include, which is not installed"
  wrong=1
done < <({
  grep -roE --include='*.h' --include='*.cpp' '^#include ["<]libvox/[^">]+' apps
  grep -oE '^ +[a-z]+/[a-z_0-9]+\.h$' libvox/CMakeLists.txt | sed 's|^ *|libvox/|' |
    xargs grep -oE '^#include "libvox/[^"]+'
} | sed -E 's/#include ["<]//')

echo "$checked includes checked"
[ "$checked" -gt 0 ] && [ "$wrong" -eq 0 ]

#!/usr/bin/env bash
# Every source file is as clang-format 14 leaves it. Usage: format.sh SOURCE
set -euo pipefail
cd "$1"
command -v clang-format-14 >/dev/null || { echo "skipped: clang-format-14 is not installed"; exit 77; }
find libvox apps tests -name '*.h' -o -name '*.cpp' | xargs clang-format-14 --dry-run -Werror

#!/usr/bin/env bash
# Prints, file by file, how many lines of libvox the tests run and which they leave out.
# Usage: coverage.sh SOURCE BUILD [LEAST]  after the tests of the coverage preset have run;
# exit code 1 when fewer than LEAST percent (90) are covered.
set -euo pipefail
source=$(realpath "$1")
build=$(realpath "$2")
command -v gcovr >/dev/null || { echo "skipped: gcovr is not installed"; exit 77; }
cd "$source"
gcovr --root . --filter 'libvox/' --exclude-throw-branches --exclude-unreachable-branches -j 2 \
  --fail-under-line "${3:-90}" "$build"

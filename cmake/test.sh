#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Usage: test.sh [PRESET]  (release)
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}

cmake/install-packages.sh cmake/packages.txt cmake/packages-python.txt cmake/packages-test.txt
cmake --preset "$preset" -DVOX_BUILD_TESTS=ON -DVOX_BUILD_BENCHMARKS=ON -DVOX_BUILD_PYTHON=ON >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset"

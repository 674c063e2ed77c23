#!/usr/bin/env bash
# The programs with which vox is compared make the same voxels: exactly the same as each other, and
# as many as vox up to the depth that it chooses. Measures the scaling, too.
# Usage: bench_peers.sh VOX BENCH_FOLDER
set -euo pipefail
vox=$(realpath "$1")
bench=$(realpath "$2")
command -v python3 >/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

voxels() {
  grep -oE '[0-9]+ active voxels' | cut -d ' ' -f 1
}

for mesh in torus quads triangles; do
  "$bench/vox_bench_inputs_write" $mesh $mesh.obj
  ours=$("$vox" convert $mesh.obj -o vox.vdb --force --dim 64 --grids mask 2>&1 | voxels)
  naive=$("$bench/peers/vox_peer_naive" $mesh.obj -o naive.vdb --dim 64 | voxels)
  echo "$mesh: vox $ours, naive $naive"
  [ $((10 * ours)) -ge $((9 * naive)) ] && [ $((10 * ours)) -le $((11 * naive)) ]
  if [ -x "$bench/peers/vox_peer_cgal" ]; then
    [ "$("$bench/peers/vox_peer_cgal" $mesh.obj -o cgal.vdb --dim 64 | voxels)" -eq "$naive" ]
    "$vox" info --json naive.vdb cgal.vdb >info.json
  else
    "$vox" info --json naive.vdb vox.vdb >info.json
  fi
  python3 - <<'PYTHON'
import json

grids = [entry["grids"][0] for entry in json.load(open("info.json"))]
for grid in grids:
    assert grid["name"] == "mask", grid
assert grids[0]["voxel_size"] == grids[1]["voxel_size"]
PYTHON
done

# A contest names absent programs and has numbers for the others.
mkdir plots
"$bench/vox_bench_pair" -q --compare torus --dims 48,32 --runs 1 --vox "$vox" --json contest.json \
  --plots plots >contest.md
grep -q '^### torus at 48$' contest.md
python3 - <<'PYTHON'
import json
import xml.etree.ElementTree

contest = json.load(open("contest.json"))["contests"][0]
assert contest["dims"] == [32, 48]
for contender in contest["contenders"]:
    first = contender["at_dims"][0]
    print(contender["name"], first["status"], first["active_voxels"])
    if contender["name"].startswith("vox"):
        assert all(side["status"] == "ok" and side["active_voxels"] > 0 for side in contender["at_dims"])
    else:
        assert first["status"] in ("ok", "absent"), first
xml.etree.ElementTree.parse("plots/torus_time.svg")
PYTHON

"$bench/vox_bench_pair" -q --scaling torus --dims 32,64,128 --runs 1 --vox "$vox" --json scaling.json
python3 - <<'PYTHON'
import json

scaling = json.load(open("scaling.json"))["scaling"]
assert [point["dim"] for point in scaling["points"]] == [32, 64, 128]
for point in scaling["points"]:
    assert point["one_thread"]["status"] == point["threads"]["status"] == "ok"
    assert point["efficiency"] > 0
assert scaling["floor"]["status"] == "ok"
assert scaling["exponents"]["wall"] is not None
PYTHON

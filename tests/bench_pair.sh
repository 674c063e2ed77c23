#!/usr/bin/env bash
# vox_bench_pair measures whole processes, and names errors.
# Usage: bench_pair.sh VOX_BENCH_PAIR
set -euo pipefail
pair=$(realpath "$1")
command -v python3 >/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$pair" -q --runs 3 --json numbers.json 'sleep 0.02' 'sleep 0.06' >table
grep -q '^  B/A ' table
"$pair" -q --runs 1 --json voxels.json 'echo 10 active voxels' "sh -c 'echo 20 active voxels'" >table
"$pair" -q --runs 1 --json heavy.json true "python3 -c 'bytearray(100 << 20); sum(range(3000000))'" >table
"$pair" -q --runs 2 --json absent.json true ./nothing >table
grep -q 'nothing.* absent$' table
"$pair" -q --runs 2 --json failed.json "sh -c 'echo no luck >&2; exit 3'" true >table
grep -q 'failed (exit code 3: no luck)$' table
"$pair" -q --runs 2 --timeout 0.1 --json slow.json true "sh -c 'sleep 50; true'" >table
"$pair" -q --runs 1 --max-memory 256M --json large.json true "python3 -c 'bytearray(1 << 30)'" >table

python3 - <<'PYTHON'
import json

def load(name):
    report = json.load(open(name + ".json"))
    assert report["machine"]["processors"] >= 1
    (comparison,) = report["comparisons"]
    return comparison["a"], comparison["b"], comparison["ratio"]

a, b, ratio = load("numbers")
assert a["status"] == b["status"] == "ok"
assert a["runs"] == b["runs"] == 3
assert a["command"] == ["sleep", "0.02"]
assert 0.02 <= a["wall_seconds"]["min"] <= a["wall_seconds"]["median"] <= a["wall_seconds"]["max"]
assert b["wall_seconds"]["min"] >= 0.06
assert b["cpu_seconds"]["min"] < 0.06
assert ratio["wall"]["min"] <= ratio["wall"]["median"] <= ratio["wall"]["max"]
assert ratio["peak"]["median"] > 0
assert ratio["cpu_per_voxel"] is None

a, b, ratio = load("voxels")
assert (a["active_voxels"], b["active_voxels"]) == (10, 20)
assert abs(ratio["cpu_per_voxel"]["median"] / ratio["cpu"]["median"] - 0.5) < 1e-12

_, b, _ = load("heavy")
assert b["peak_bytes"]["median"] >= 100 << 20
assert b["cpu_seconds"]["median"] > 0.01

a, b, ratio = load("absent")
assert (a["status"], b["status"]) == ("ok", "absent")
assert a["runs"] == 2 and b["runs"] == 0
assert b["wall_seconds"] is None and ratio["wall"] is None

a, b, _ = load("failed")
assert (a["status"], a["exit_code"], b["status"]) == ("failed", 3, "ok")

_, b, _ = load("slow")
assert b["status"] == "timed out"

_, b, _ = load("large")
assert b["status"] == "out of memory", b
PYTHON

# Mistakes, exit code 2.
for mistake in '' 'true' 'true true --suite issue' '--suite none' '--scaling cube --dims 0' 'true true --dims 64'; do
  code=0
  "$pair" $mistake >stdout 2>stderr || code=$?
  [ "$code" -eq 2 ] || { echo "vox_bench_pair $mistake: exit code $code"; exit 1; }
  [ -s stderr ]
done

# Interrupted while a program runs: the program is killed and the temporary folder removed.
mkdir temporary
TMPDIR=$folder/temporary "$pair" -q "sh -c 'echo \$\$ >child; exec sleep 50'" true &
running=$!
until [ -s child ]; do sleep 0.01; done
kill -TERM $running
code=0
wait $running || code=$?
[ "$code" -eq 130 ]
[ -z "$(ls temporary)" ]
if kill -0 "$(cat child)" 2>stderr; then
  echo "the program goes on after the interruption"
  exit 1
fi

#!/usr/bin/env bash
# Measures a conversion in parts against the same conversion in one run, and checks that the merged
# file has the same bytes.
# Usage: parts.sh VOX PARTS INPUT [options of vox convert]
set -euo pipefail
export LC_ALL=C
[ $# -ge 3 ] || { sed -n 4p "$0" >&2; exit 2; }
vox=$(realpath "$1")
parts=$2
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
TIMEFORMAT='%U %S'

# measure NAME ARGUMENTS...: seconds of CPU and peak MiB of vox, into the file NAME.
measure() {
  local name=$1
  shift
  { time "$vox" "$@" -v 2>"$folder/said" >&2; } 2>"$folder/time"
  local peak
  peak=$(sed -n 's/.*memory: peak \([0-9.]*\) \([KMG]\)iB.*/\1 \2/p' "$folder/said" |
    awk '{ print $1 * ($2 == "G" ? 1024 : $2 == "K" ? 1 / 1024 : 1) }')
  awk -v peak="$peak" '{ print $1 + $2, peak }' "$folder/time" >"$folder/$name"
}

measure whole convert "$@" -o "$folder/whole.vdb"
for part in $(seq "$parts"); do
  measure "part.$part" convert "$@" --part "$part/$parts" -o "$folder/p$part.vdb"
done
"$vox" merge "$folder"/p*.vdb -o "$folder/merged.vdb" -q
cmp "$folder/whole.vdb" "$folder/merged.vdb"
cat "$folder/whole" "$folder"/part.* | awk '
  NR == 1 { cpu = $1; peak = $2; next }
  { sum += $1; if ($1 > slowest) slowest = $1; if ($2 > largest) largest = $2 }
  END {
    parts = NR - 1
    printf "whole: %.2f s of CPU, %.0f MiB\n", cpu, peak
    printf "%d parts: %.2f s of CPU (%.2fx), slowest %.2fx the mean, at most %.0f MiB (%.2fx)\n",
           parts, sum, sum / cpu, slowest * parts / sum, largest, largest / peak
  }'

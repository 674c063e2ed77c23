#!/usr/bin/env bash
# Runs every libFuzzer program of a build in turn and prints what each has done.
# Usage: run.sh BUILD SECONDS [NAME...]; inputs that fail stay in BUILD/findings.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(realpath "$1")
seconds=$2
shift 2
names=("$@")
[ ${#names[@]} -gt 0 ] || mapfile -t names < <(ls "$here/corpus")
mkdir -p "$build/findings"
failures=0

for name in "${names[@]}"; do
  mkdir -p "$build/corpus/$name"
  "$build/tests/fuzz/fuzz_$name" "$build/corpus/$name" "$here/corpus/$name" \
    -dict="$here/words.dict" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -max_len=4096 -print_final_stats=1 -artifact_prefix="$build/findings/$name-" \
    >"$build/$name.log" 2>&1 || failures=$((failures + 1))
  echo "$name: $(sed -n 's/^stat::number_of_executed_units: //p' "$build/$name.log") inputs," \
    "$(grep -c 'SUMMARY' "$build/$name.log") failures"
done
[ "$failures" -eq 0 ]

#!/usr/bin/env bash
# Prints the seconds that each step of the last build took, largest first, and their sum.
# Usage: build-times.sh [BUILD]  (build/release)
#
# Ninja keeps the times in BUILD/.ninja_log. Steps run at the same time and slow each other down: the
# sum is more than the build took, and about the CPU time if there were no more steps than processors.
set -euo pipefail
cd "$(dirname "$0")/.."
log=${1:-build/release}/.ninja_log

# Columns: start and end in milliseconds, time stamp, file, hash of the command. The last line about
# a file counts. A step that makes several files has a line for each, with the same times and hash.
awk -F '\t' '
  !/^#/ { file[$4] = $1 "\t" $2 "\t" $5 }
  END {
    for (name in file) if (!(file[name] in step) || name < step[file[name]]) step[file[name]] = name
    for (times in step) {
      split(times, t)
      printf "%8.1f  %s\n", (t[2] - t[1]) / 1000, step[times]
      sum += (t[2] - t[1]) / 1000
    }
    printf "%8.1f  sum\n", sum
  }' "$log" | sort -rn

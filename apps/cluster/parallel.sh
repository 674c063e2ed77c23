#!/usr/bin/env bash
# One conversion in parts with GNU parallel, on this machine or on several, then the merge. After a
# failure, the same command runs only the parts that are not there yet.
# Usage: parallel.sh [--jobs N] [--hosts FILE] PARTS INPUT OUT.vdb [OPTION of vox convert]...
#   --jobs N      parts at a time on each machine (default: 1, with all processors)
#   --hosts FILE  machines, as for --sshloginfile of GNU parallel (default: this one)
set -euo pipefail
here=$(dirname "$(realpath "$0")")
usage() {
  echo "usage: parallel.sh [--jobs N] [--hosts FILE] PARTS INPUT OUT.vdb [OPTION of vox convert]..." >&2
  exit 2
}
fail() {
  echo "parallel.sh: error: $1" >&2
  exit "$2"
}

jobs=1 hosts=()
while [[ ${1-} == --* ]]; do
  [ $# -ge 2 ] || usage
  case $1 in
    --jobs) jobs=$2 ;;
    --hosts) hosts=(--sshloginfile "$2") ;;
    *) usage ;;
  esac
  shift 2
done
[ $# -ge 3 ] || usage
parallel --version 2>/dev/null | grep -q '^GNU parallel' || fail "GNU parallel is not installed" 1

commands=$("$here/commands.sh" "$@")
folder=${3%.vdb}.parts
list=$folder/commands
# The log knows parts by their numbers only.
if [ -e "$list" ]; then
  [ "$commands" = "$(cat "$list")" ] || fail "$folder is from another command; delete it first" 1
  [ ! "$2" -nt "$list" ] || fail "$2 is newer than $folder; delete the folder first" 1
fi
echo "$commands" >"$list"

head -n -1 "$list" |
  parallel --jobs "$jobs" "${hosts[@]}" --joblog "$folder/joblog" --resume-failed ||
  fail "parts failed (exit codes: $folder/joblog); the same command runs them again" 1
tail -n 1 "$list" | bash
rm -r "$folder"

#!/usr/bin/env bash
# One conversion in parts on a Slurm cluster: an array job, then the merge. If parts need more memory
# or time than they have, all is submitted again with twice as many parts.
# Usage: slurm.sh [--mem SIZE] [--cpus N] [--doublings N] PARTS INPUT OUT.vdb [OPTION of vox convert]...
#   --mem SIZE     memory of each task, such as 800M or 8G (default: the cluster's)
#   --cpus N       processors of each task (default: 1)
#   --doublings N  how often the number of parts may be doubled (default: 3)
# sbatch takes all else from its environment, such as SBATCH_PARTITION and SBATCH_TIMELIMIT.
set -euo pipefail
self=$(realpath "$0")
usage() {
  echo "usage: slurm.sh [--mem SIZE] [--cpus N] [--doublings N] PARTS INPUT OUT.vdb" \
    "[OPTION of vox convert]..." >&2
  exit 2
}
fail() {
  echo "slurm.sh: error: $1" >&2
  exit "$2"
}

step=submit
case ${1-} in part | merge | again) step=$1 && shift ;; esac  # jobs of ours
mem='' cpus=1 doublings=3
while [[ ${1-} == --* ]]; do
  [ $# -ge 2 ] || usage
  case $1 in
    --mem) mem=$2 ;;
    --cpus) cpus=$2 ;;
    --doublings) doublings=$2 ;;
    *) usage ;;
  esac
  shift 2
done
command -v sbatch >/dev/null || fail "sbatch (Slurm) is not installed" 1
[ $# -ge 3 ] && [[ $mem =~ ^([1-9][0-9]*[MG])?$ && $cpus$doublings =~ ^[1-9][0-9]*$ ]] || usage
parts=$1 out=$3
inputs=("${@:2}")
folder=${out%.vdb}.parts
list=$folder/commands_of_$parts
limits=(--cpus "$cpus" ${mem:+--mem "$mem"})

# Submits a step of this script with OPTIONs of sbatch; prints the number of the job.
job() {
  local name=$1
  shift
  sbatch --parsable --job-name "vox-$(basename "$out" .vdb)" ${mem:+--mem "$mem"} "$@" \
    --wrap "$(printf '%q ' "$self" "$name" "${limits[@]}" --doublings "$doublings" "$parts" \
      "${inputs[@]}")" | cut -d ';' -f 1
}

submit() {
  # What Slurm grants is also what vox may use.
  "$(dirname "$self")/commands.sh" "$parts" "${inputs[@]}" --threads "$cpus" \
    ${mem:+--max-memory "$mem"} >"$folder.new"
  mv "$folder.new" "$list"
  rm -f "$folder/failed"
  local array merge again
  array=$(job part --array "1-$parts" --cpus-per-task "$cpus" --requeue \
    --output "$folder/part.%a_of_$parts.log")
  merge=$(job merge --dependency "afterok:$array" --kill-on-invalid-dep yes \
    --output "$folder/merge_of_$parts.log")
  again=$(job again --dependency "afternotok:$array" --kill-on-invalid-dep yes --mem 100M \
    --output "$folder/again_of_$parts.log")
  echo "$parts parts: job $array; merge: job $merge; if parts fail: job $again; logs: $folder"
  echo "cancel all: scancel --name vox-$(basename "$out" .vdb)"
}

part() {
  local code=0
  sed -n "${SLURM_ARRAY_TASK_ID}p" "$list" | bash || code=$?
  case $code in
    0) ;;
    4 | 130 | 137 | 143) ;;       # a limit, or TERM or KILL because of one: more parts may help
    *) touch "$folder/failed" ;;  # they do not
  esac
  exit "$code"
}

merge() {
  tail -n 1 "$list" | bash
  rm "$folder"/part.*_of_"$parts".vdb
}

again() {
  [ ! -e "$folder/failed" ] || fail "a part failed, and not for memory: see $folder/part.*.log" 1
  [ "$doublings" -gt 0 ] || fail "parts failed with $parts parts, and there are no doublings left" 4
  rm -f "$folder"/part.*_of_"$parts".vdb
  doublings=$((doublings - 1)) parts=$((2 * parts))
  list=$folder/commands_of_$parts
  submit
}

"$step"

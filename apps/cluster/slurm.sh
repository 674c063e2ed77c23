#!/usr/bin/env bash
# One conversion in parts on a Slurm cluster: an array job, then the merge. A part that needs more
# memory or time than it has is cut into halves, which are submitted in its place.
# Usage: slurm.sh [--mem SIZE] [--cpus N] [--halvings N] PARTS INPUT OUT.vdb [OPTION of vox convert]...
#   --mem SIZE    memory of each task, such as 800M or 8G (default: the cluster's)
#   --cpus N      processors of each task (default: 1)
#   --halvings N  how often parts may be halved (default: 3)
# sbatch takes all else from its environment, such as SBATCH_PARTITION and SBATCH_TIMELIMIT.
set -euo pipefail
self=$(realpath "$0")
usage() {
  echo "usage: slurm.sh [--mem SIZE] [--cpus N] [--halvings N] PARTS INPUT OUT.vdb" \
    "[OPTION of vox convert]..." >&2
  exit 2
}
fail() {
  echo "slurm.sh: error: $1" >&2
  exit "$2"
}

step=first
case ${1-} in part | merge | again) step=$1 && shift ;; esac  # jobs of ours
mem='' cpus=1 halvings=3 numbers=''
while [[ ${1-} == --* ]]; do
  [ $# -ge 2 ] || usage
  case $1 in
    --mem) mem=$2 ;;
    --cpus) cpus=$2 ;;
    --halvings) halvings=$2 ;;
    --numbers) numbers=$2 ;;  # ours
    *) usage ;;
  esac
  shift 2
done
command -v sbatch >/dev/null || fail "sbatch (Slurm) is not installed" 1
[ $# -ge 3 ] && [[ $mem =~ ^([1-9][0-9]*[MG])?$ && $cpus$halvings =~ ^[1-9][0-9]*$ ]] &&
  [[ $1 =~ ^[1-9][0-9]*$ && $3 == ?*.vdb ]] || usage
parts=$1 input=$2 out=$3
options=("${@:4}")
vox=${VOX:-vox}
folder=${out%.vdb}.parts
name=vox-$(basename "$out" .vdb)

# Submits a step of this script with OPTIONs of sbatch; prints the number of the job.
job() {
  sbatch --parsable --job-name "$name" ${mem:+--mem "$mem"} "${@:2}" \
    --wrap "$(printf '%q ' "$self" "$1" --cpus "$cpus" ${mem:+--mem "$mem"} --halvings "$halvings" \
      --numbers "$numbers" "$parts" "$input" "$out" "${options[@]}")" | cut -d ';' -f 1
}

submit() {
  local array merge again
  array=$(job part --array "$numbers" --cpus-per-task "$cpus" \
    --output "$folder/part.%a_of_$parts.log")
  merge=$(job merge --dependency "afterok:$array" --kill-on-invalid-dep yes \
    --output "$folder/merge.log")
  again=$(job again --dependency "afternotok:$array" --kill-on-invalid-dep yes --mem 100M \
    --output "$folder/again_of_$parts.log")
  echo "$(wc -w <<<"${numbers//,/ }") of $parts parts: job $array; merge: job $merge;" \
    "if parts fail: job $again"
}

first() {
  [ -e "$input" ] || fail "$input does not exist" 3
  [ ! -e "$out" ] || fail "$out exists; delete it first" 5
  mkdir -p "$folder"
  rm -f "$folder"/part.*.vdb "$folder/failed"
  numbers=$(seq -s , "$parts")
  submit
  echo "logs: $folder; to cancel all: scancel --name $name"
}

part() {
  local number=$SLURM_ARRAY_TASK_ID code=0
  "$vox" convert "$input" "${options[@]}" --threads "$cpus" ${mem:+--max-memory "$mem"} \
    --part "$number/$parts" -o "$folder/part.${number}_of_$parts.vdb" --force || code=$?
  case $code in
    0) ;;
    4 | 130 | 137 | 143) ;;       # a limit, or TERM or KILL because of one: smaller parts may help
    *) touch "$folder/failed" ;;  # they do not
  esac
  exit "$code"
}

merge() {
  "$vox" merge "$folder"/part.*.vdb -o "$out"
  rm "$folder"/part.*.vdb
}

# Part 3 of 8 is parts 5 and 6 of 16.
again() {
  [ ! -e "$folder/failed" ] || fail "a part failed, and not for memory: see $folder/part.*.log" 1
  [ "$halvings" -gt 0 ] || fail "parts of $parts failed, and there are no halvings left" 4
  local number halves=()
  for number in ${numbers//,/ }; do
    [ -e "$folder/part.${number}_of_$parts.vdb" ] || halves+=($((2 * number - 1)) $((2 * number)))
  done
  numbers=$(IFS=, && echo "${halves[*]}")
  if [ -z "$numbers" ]; then  # a task ended badly, but after its file was complete
    job merge --output "$folder/merge.log"
  else
    halvings=$((halvings - 1)) parts=$((2 * parts))
    submit
  fi
}

"$step"

#!/usr/bin/env bash
# Prints the commands of one conversion in parts, a line each for a shell: all parts, then the merge.
# Makes the folder OUT.parts for the files of the parts. VOX names the program (default: vox).
# Usage: commands.sh PARTS INPUT OUT.vdb [OPTION of vox convert]...
set -euo pipefail
if [ $# -lt 3 ] || [[ ! $1 =~ ^[1-9][0-9]{0,5}$ ]] || [[ $3 != ?*.vdb ]]; then
  echo "usage: commands.sh PARTS INPUT OUT.vdb [OPTION of vox convert]..." >&2
  exit 2
fi
parts=$1 input=$2 out=$3
shift 3

[ -e "$input" ] || { echo "commands.sh: error: $input does not exist" >&2; exit 3; }
[ ! -e "$out" ] || { echo "commands.sh: error: $out exists; delete it first" >&2; exit 5; }
folder=${out%.vdb}.parts
mkdir -p "$folder"

# Words as a POSIX shell reads them; quotes only where they are needed.
quoted() {
  local word line=()
  for word in "$@"; do
    [[ $word =~ ^[A-Za-z0-9_./:=,+@%^-]+$ ]] || word="'${word//\'/\'\\\'\'}'"
    line+=("$word")
  done
  echo "${line[*]}"
}

# Relative names mean the same on every machine that has this folder.
there="cd $(quoted "$PWD") && $(quoted "${VOX:-vox}")"
convert="$there convert $(quoted "$input" "$@")"
files=$(quoted "$folder")/part
for ((i = 1; i <= parts; ++i)); do
  echo "$convert --part $i/$parts -o $files.${i}_of_$parts.vdb --force"
done
echo "$there merge $files.*_of_$parts.vdb -o $(quoted "$out")"

#!/usr/bin/env bash
# The commands of apps/cluster/commands.sh, run by sh, make the file of the conversion as a whole, also
# where names have blanks and quotes. Mistakes are one line. Usage: commands.sh VOX SOURCE
set -euo pipefail
VOX=$(realpath "$1")
export VOX
source=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
commands=$source/apps/cluster/commands.sh
cp "$source/scenes/toy_jack.obj" jack.obj

"$VOX" convert jack.obj -o whole.vdb --dim 300 --grids density,mask
"$commands" 3 jack.obj jack.vdb --dim 300 --grids density,mask >list
[ "$(wc -l <list)" -eq 4 ]
(cd / && sh -e "$folder/list")
cmp jack.vdb whole.vdb

# A list may be run again, and each line alone.
rm jack.vdb
for line in 3 1 2 4; do sed -n ${line}p list | sh -e; done
cmp jack.vdb whole.vdb

mkdir "it's here"
cp jack.obj "it's here/a jack.obj"
cd "it's here"
"$commands" 2 'a jack.obj' '$a "jack".vdb' --dim 300 --grids density,mask >list
sh -e list
"$VOX" diff '$a "jack".vdb' ../whole.vdb --no-metadata
cd ..

# refused CODE PATTERN ARGS...: one line on stderr, nothing made.
refused() {
  local code=0
  "$commands" "${@:3}" >stdout 2>stderr || code=$?
  [ "$code" -eq "$1" ] && [ "$(wc -l <stderr)" -eq 1 ] && grep -q -- "$2" stderr &&
    [ ! -s stdout ] && [ ! -e out.parts ] ||
    { echo "FAILED: commands.sh ${*:3}: exit code $code: $(cat stderr)"; exit 1; }
}
refused 2 usage 0 jack.obj out.vdb
refused 2 usage jack.obj out.vdb
refused 2 usage 2 jack.obj out.obj
refused 3 'no.obj does not exist' 2 no.obj out.vdb
refused 5 'whole.vdb exists' 2 jack.obj whole.vdb

#!/usr/bin/env bash
# apps/cluster/parallel.sh: of 8 parts two are killed at random moments. The next run makes these two
# alone, and the merged file is that of the conversion as a whole. Usage: parallel.sh VOX SOURCE
set -euo pipefail
parallel --version 2>/dev/null | grep -q '^GNU parallel' ||
  { echo "skipped: parallel (GNU) is not installed"; exit 77; }
vox=$(realpath "$1")
source=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cluster() { VOX=$folder/vox "$source/apps/cluster/parallel.sh" "$@"; }
fail() {
  echo "FAILED: $*"
  exit 1
}

# A vox that notes its parts, and whose victims are killed the first time, when that may be.
cat >vox <<'VOX'
#!/usr/bin/env bash
part=$(grep -oE -- '--part [0-9]+' <<<"$*" | cut -d ' ' -f 2)
echo "$part" >>"$FOLDER/runs"
if rm "$FOLDER/victim.$part" 2>/dev/null; then
  "$REAL" "$@" &
  sleep 0.$((RANDOM % 3))$((RANDOM % 10))
  kill -KILL $!
  exit 137
fi
exec "$REAL" "$@"
VOX
chmod +x vox
export FOLDER=$folder REAL=$vox HOME=$folder  # GNU parallel writes into ~/.parallel

cp "$source/scenes/toy_jack.obj" jack.obj
options=(--dim 500 --grids density,surface)
"$vox" convert jack.obj -o whole.vdb "${options[@]}"

mapfile -t victims < <(seq 8 | shuf -n 2 | sort -n)
for part in "${victims[@]}"; do touch "victim.$part"; done
echo "victims: ${victims[*]}"
cluster --jobs 2 8 jack.obj jack.vdb "${options[@]}" 2>stderr && fail "killed parts, and no error"
grep -q '^parallel.sh: error: parts failed' stderr || fail "$(cat stderr)"
[ ! -e jack.vdb ] || fail "a merge of missing parts"

# Parts of another command, or of an older mesh, are not taken.
cluster 8 jack.obj jack.vdb --dim 500 2>stderr && fail "another command"
grep -q 'is from another command' stderr || fail "$(cat stderr)"
touch -d '1 minute' jack.obj
cluster 8 jack.obj jack.vdb "${options[@]}" 2>stderr && fail "a newer mesh"
grep -q 'is newer' stderr || fail "$(cat stderr)"
touch -d '1 hour ago' jack.obj

: >runs
cluster --jobs 2 8 jack.obj jack.vdb "${options[@]}"
[ "$(grep . runs | sort -n | xargs)" = "${victims[*]}" ] || fail "ran again: $(xargs <runs)"
cmp jack.vdb whole.vdb
[ ! -e jack.parts ] || fail "left $(ls jack.parts)"

# Two hosts; ssh is a stand-in that runs here what the other host would run. As sshd does, it sets
# SHELL: without it GNU parallel runs nothing there, and calls that a success.
cat >ssh <<'SSH'
#!/usr/bin/env bash
while [[ $1 == -* ]]; do shift; done
echo "$1" >>"$FOLDER/hosts_used"
shift
[ "$1" != -- ] || shift
cd / && SHELL=/bin/sh exec sh -c "$*"
SSH
chmod +x ssh
printf '1/left\n1/right\n' >hosts
rm jack.vdb
PARALLEL_SSH=$folder/ssh cluster --hosts hosts 4 jack.obj jack.vdb "${options[@]}"
cmp jack.vdb whole.vdb
[ "$(sort -u hosts_used | xargs)" = 'left right' ] || fail "hosts: $(xargs <hosts_used)"

#!/usr/bin/env bash
# Faults while `vox convert` runs, each with no target and with an old one. Afterwards the target is
# absent or the old file, or complete to the byte, as the exit code says, and nothing else is left.
# Only after SIGKILL may something stay: a hidden file .vox-NUMBER.part, which nothing reads again.
# Usage: faults.sh VOX SCENES
set -uo pipefail
vox=$(realpath "$1")
scenes=$(realpath "$2")
folder=$(mktemp -d)
trap 'umount "$folder/full" 2>/dev/null; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
RANDOM=1994  # the same moments every time
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:allocator_may_return_null=1"

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

skipped() {
  echo "skipped: $*"
}

# The conversion, long enough for faults to hit it.
mkdir out
cp "$scenes/toy_jack.obj" mesh.obj
options=(--dim 128 --grids density,mask,surface)
"$vox" convert "$scenes/cube.toml" -o old.vdb --dim 16 --quiet || exit 1
before=$(date +%s%N)
"$vox" convert mesh.obj -o complete.vdb "${options[@]}" --quiet && "$vox" info complete.vdb >info.txt || exit 1
run_ms=$(($(($(date +%s%N) - before)) / 1000000 + 1))

# state FILE: absent, old, complete or broken.
state() {
  if [ ! -e "$1" ]; then echo absent
  elif cmp -s "$1" old.vdb; then echo old
  elif cmp -s "$1" complete.vdb; then echo complete
  else echo broken; fi
}

# attempt WHAT 'CODES' COMMAND...: runs COMMAND, which is to write $target, with no target and with
# an old one. The exit code must be one of CODES, the file what the code promises.
target=out/model.vdb
partial_allowed=false
attempt() {
  local what=$1 codes=$2 old expected code
  shift 2
  for old in absent old; do
    [ $old = old ] && { cp old.vdb "$target" || fail "$what: cannot be set up"; }
    "$@" >stdout 2>stderr </dev/null
    code=$?
    [[ " $codes " == *" $code "* ]] || fail "$what: exit code $code, not $codes: $(head -3 stderr)"
    expected=$old
    [ $code -eq 0 ] && expected=complete
    # The signal may come after the file has got its name.
    case $code in
      130 | 137) [ "$(state "$target")" = complete ] && expected=complete ;;
    esac
    [ "$(state "$target")" = "$expected" ] ||
      fail "$what, exit code $code: the target is $(state "$target"), not $expected"
    count "$what" "$code" "$expected"
    rm -f "$target"
    $partial_allowed && rm -f "$(dirname "$target")"/.vox-*.part
    [ -z "$(ls -A "$(dirname "$target")")" ] || fail "$what: left $(ls -A "$(dirname "$target")")"
  done
}

declare -A table
count() {
  local key="$1: exit code $2, target $3"
  table[$key]=$((${table[$key]:-0} + 1))
}

convert() { "$vox" convert mesh.obj -o "$target" "${options[@]}" --force "$@"; }

attempt "no fault" 0 convert

# --- disks and folders

# A disk with room for the old file only.
mkdir full
old_kb=$(($(stat -c %s old.vdb) / 1024 + 1))
if mount -t tmpfs -o size=$((old_kb + 16))k vox full 2>/dev/null; then
  target=full/model.vdb
  attempt "full disk" 5 convert
  umount full
  target=out/model.vdb
else
  skipped "full disk: no tmpfs can be mounted"
fi
file_limit() { (ulimit -f 64; convert); }  # a write that fails on the way, for any user
attempt "largest file size" 5 file_limit
to_full() { "$vox" convert mesh.obj -o - "${options[@]}" >/dev/full; }
attempt "full standard output" 5 to_full
ln -s /dev/full device.vdb
device() { "$vox" convert mesh.obj -o device.vdb "${options[@]}" --force; }
attempt "device as output" 5 device
missing_folder() { "$vox" convert mesh.obj -o missing/model.vdb "${options[@]}" --force; }
attempt "missing folder" 5 missing_folder
[ -e missing ] && fail "the missing folder was made"

# Permissions bind root, too, once it has no capabilities.
bound=()
[ "$(id -u)" -eq 0 ] && bound=(setpriv --inh-caps=-all --bounding-set=-all)
mkdir closed && chmod 555 closed
if "${bound[@]}" true 2>/dev/null && ! "${bound[@]}" touch closed/file 2>/dev/null; then
  bound_convert() { "${bound[@]}" "$vox" convert "$1" -o "$target" "${options[@]}" --force; }
  closed() { chmod 555 out; bound_convert mesh.obj; local code=$?; chmod 755 out; return $code; }
  attempt "read-only folder" 5 closed
  cp mesh.obj secret.obj && chmod 000 secret.obj
  attempt "unreadable input" 3 bound_convert secret.obj
else
  skipped "read-only folder, unreadable input: permissions do not bind this user"
fi
ln -s loop.obj loop.obj
mkdir folder.obj
for input in missing.obj folder.obj loop.obj; do
  other_input() { "$vox" convert "$input" -o "$target" "${options[@]}" --force; }
  attempt "no file as input" 3 other_input
done

# --- output equal to input: the input stays

cp mesh.obj same.obj
ln same.obj hard.vdb
ln -s same.obj soft.vdb
for output in same.obj hard.vdb soft.vdb ./out/../soft.vdb; do
  onto_input() { "$vox" convert same.obj -o $output "${options[@]}" --force; }
  attempt "output equal to input" 2 onto_input
  cmp -s mesh.obj same.obj || fail "$output: the input has changed"
done

# --- signals at random moments

moment() { awk -v ms=$((run_ms * (RANDOM % 120) / 100)) 'BEGIN { print ms / 1000 }'; }
signalled() {
  timeout --preserve-status -s "$1" "$2" "$vox" convert mesh.obj -o "$target" "${options[@]}" --force
}
for signal in INT TERM HUP KILL; do
  codes="0 130"  # or, before main, 128 and the number of the signal
  case $signal in
    TERM) codes+=" 143" ;;
    HUP) codes+=" 129" ;;
    KILL)
      codes="0 137"
      partial_allowed=true
      ;;
  esac
  for _ in 1 2 3 4 5; do
    attempt "SIG$signal" "$codes" signalled $signal "$(moment)"
  done
  partial_allowed=false
done
attempt "no fault after all" 0 convert

# --- memory

limited() { (ulimit -v $((mb * 1024)); "$@"); }
mb=2000
if limited "$vox" --version >stdout 2>&1; then
  for mb in 60 90 110 120 130 140 150 160 170 180 200 220 240 260 300 400; do
    # Below some 100 MB the libraries of vox do not even start.
    limited "$vox" --version >stdout 2>&1 || continue
    attempt "limit of address space" "0 4" limited convert --threads 2
  done
else
  skipped "limit of address space: this build reserves more"
fi
tight() { convert --max-memory 1M; }
attempt "--max-memory 1M" 4 tight

for key in "${!table[@]}"; do echo "$key: ${table[$key]} times"; done | sort
[ "$failures" -eq 0 ]

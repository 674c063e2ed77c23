#!/usr/bin/env bash
# apps/cluster/slurm.sh on a real Slurm: one node, this machine, with folders, ports and a key of its own.
# The merged file of 8 parts is that of the conversion as a whole. A task that exceeds its memory
# fails alone, and its part alone is cut into halves. Usage: slurm.sh VOX SOURCE
set -euo pipefail
PATH=$PATH:/usr/sbin
for program in slurmctld slurmd sbatch munged; do
  command -v $program >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skipped: slurmd needs root"; exit 77; }
vox=$(realpath "$1")
source=$(realpath "$2")
folder=$(mktemp -d)
cd "$folder"
unset "${!SLURM_@}" "${!SBATCH_@}"
export SLURM_CONF=$folder/slurm.conf  # before anything else: no job of another Slurm is ours
daemons=()
stop() {
  scancel --user "$(id -un)" 2>/dev/null || true
  local jobs end=$((SECONDS + 20))
  while jobs=$(squeue -h 2>/dev/null) && [ -n "$jobs" ] && [ $SECONDS -lt $end ]; do sleep 0.5; done
  for ((i = ${#daemons[@]} - 1; i >= 0; --i)); do
    kill "${daemons[i]}" 2>/dev/null && wait "${daemons[i]}" || true
  done
  rm -rf "$folder"
}
trap stop EXIT
trap 'exit 1' INT TERM HUP
fail() {
  echo "FAILED: $*"
  tail -n 5 ./*.parts/*.log log/* || true
  exit 1
}

free_port() {
  local port
  while port=$((20000 + RANDOM % 10000)) && (: >"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo "$port"
}

# until_true SECONDS COMMAND...: waits for it.
until_true() {
  local end=$((SECONDS + $1))
  until "${@:2}" >/dev/null 2>&1; do
    [ "$SECONDS" -lt "$end" ] || fail "still not after $1 seconds: ${*:2}"
    sleep 0.5
  done
}

host=$(hostname -s)
mkdir log state spool
(umask 077 && head -c 1024 /dev/urandom >munge.key)
cat >slurm.conf <<CONF
ClusterName=cluster
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld
SlurmdLogFile=$folder/log/slurmd
MailProg=$(command -v true)
SwitchType=switch/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
# Memory is measured each second, which needs no cgroups.
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
ReturnToService=2
MessageTimeout=60
SchedulerParameters=batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1500 State=UNKNOWN
PartitionName=cluster Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
munged --foreground --force --key-file munge.key --socket "$folder/munge.socket" \
  --pid-file "$folder/munged.pid" --log-file "$folder/log/munged" --seed-file "$folder/munge.seed" \
  2>log/munged.stderr &
daemons+=($!)
until_true 60 munge --socket munge.socket --no-input
slurmctld -D 2>log/slurmctld.stderr &
daemons+=($!)
slurmd -D 2>log/slurmd.stderr &
daemons+=($!)
until_true 60 eval '[ "$(sinfo -h -o %t)" = idle ]'

idle() {
  local jobs
  jobs=$(squeue -h) && [ -z "$jobs" ]
}
cluster() { "$source/apps/cluster/slurm.sh" --mem 500M "$@"; }
array_in() { sed -nE 's/^[0-9]+ of [0-9]+ parts: job ([0-9]+);.*/\1/p' "$1"; }
states() { squeue -h -a -t all -r -o '%K %T' -j "$1" | sort -n; }
cp "$source/scenes/toy_jack.obj" jack.obj
options=(--dim 400 --grids density,surface)
"$vox" convert jack.obj -o whole.vdb "${options[@]}"

# An array of 8, and the merge that depends on it.
VOX=$vox cluster 8 jack.obj jack.vdb "${options[@]}" | tee submitted
until_true 300 idle
cmp jack.vdb whole.vdb || fail "8 parts"
[ -z "$(ls jack.parts/*.vdb 2>/dev/null)" ] || fail "left $(ls jack.parts)"
array=$(array_in submitted)
[ "$(states "$array" | grep -c ' COMPLETED$')" -eq 8 ] || fail "$(states "$array")"
rm -r jack.vdb jack.parts

# Part 3 of 8 takes twice its memory, and so does its first half. Their halves do not.
cat >hungry <<VOX
#!/usr/bin/env bash
case "\$*" in *'--part 3/8 '* | *'--part 5/16 '* | *'--part 1/2 '*) python3 -c 'import time; x = b"x" * 1000000000; time.sleep(300)' ;; esac
exec '$vox' "\$@"
VOX
chmod +x hungry
VOX=$folder/hungry cluster 8 jack.obj jack.vdb "${options[@]}" | tee submitted
until_true 300 idle
array=$(array_in submitted)
[ "$(states "$array" | grep -v ' COMPLETED$' | cut -d ' ' -f 1)" = 3 ] || fail "$(states "$array")"
grep -q 'exceeded memory limit' jack.parts/part.3_of_8.log || fail "part 3 failed otherwise"
cat jack.parts/again_of_{8,16}.log
[ "$(states "$(array_in jack.parts/again_of_8.log)" | xargs)" = '5 FAILED 6 COMPLETED' ] || fail 16
[ "$(states "$(array_in jack.parts/again_of_16.log)" | xargs)" = '9 COMPLETED 10 COMPLETED' ] ||
  fail 32
cmp jack.vdb whole.vdb || fail "halves"
rm -r jack.vdb jack.parts

# Nothing is submitted again if smaller parts do not help, or if there have been enough.
VOX=$vox cluster 2 jack.obj jack.vdb --grids nonsense
VOX=$folder/hungry cluster --halvings 0 2 jack.obj few.vdb "${options[@]}"
until_true 300 idle
grep -q 'error: a part failed, and not for memory' jack.parts/again_of_2.log || fail "bad option"
grep -q 'no halvings left' few.parts/again_of_2.log || fail "halvings"
[ ! -e jack.vdb ] && [ ! -e few.vdb ] || fail "a merge of missing parts"

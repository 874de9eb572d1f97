#!/usr/bin/env bash
# Starts Slurm with this machine as its only node, runs COMMAND with it in the present folder, and ends it again.
#   one_node_slurm.sh COMMAND...
# Exit status 77 where Slurm cannot start.
set -u
here=$PWD
folder=$(mktemp -d /tmp/slurm.XXXXXX) || exit 77 # names of sockets are short
cd "$folder" || exit 77
for program in munged slurmctld slurmd sbatch srun sinfo; do
  command -v "$program" >/dev/null || PATH=$PATH:/usr/sbin
  command -v "$program" >/dev/null || { echo "no $program" >&2; exit 77; }
done
mkdir -p state spool
chmod 700 .
user=$(id -un)
host=$(hostname -s)
dd if=/dev/urandom of=munge.key bs=128 count=1 status=none && chmod 400 munge.key
cat > slurm.conf <<CONF
ClusterName=annulus
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmctldPort=$((20000 + $$ % 20000))
SlurmdPort=$((20001 + $$ % 20000))
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmdSpoolDir=$folder/spool
StateSaveLocation=$folder/state
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 1024)) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
stop() {
  cd "$folder" || return
  for name in slurmd slurmctld munged; do
    [ -f "$name.pid" ] || continue
    pid=$(cat "$name.pid")
    kill "$pid" 2>/dev/null
    for _ in $(seq 100); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
  done
  rm -rf "$folder"
}
trap stop EXIT
munged --force --key-file "$folder/munge.key" --socket "$folder/munge.socket" --pid-file "$folder/munged.pid" \
  --log-file "$folder/munged.log" --seed-file "$folder/munged.seed" 2>/dev/null || exit 77
slurmctld 2>/dev/null || exit 77
slurmd 2>/dev/null || exit 77
for _ in $(seq 50); do
  sinfo --noheader --format=%t 2>/dev/null | grep -q idle && break
  sleep 0.2
done
sinfo --noheader --format=%t 2>/dev/null | grep -q idle || { tail -5 slurmctld.log slurmd.log >&2; exit 77; }
timeout 30 srun --ntasks=1 true 2>/dev/null || { echo "no job runs" >&2; exit 77; }
cd "$here" && "$@"

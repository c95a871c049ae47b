#!/bin/sh
# A real Slurm on this machine (one controller, two node daemons under different names), a render in parts on it,
# one task killed and put back into the queue, and the merged file compared with that of one render.
#
# Needs Debian's slurm-wlm and munge, and root. TERRARIUM names the program, SCENE the scene, SHARDS how many parts.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${TERRARIUM:-$root/target/release/terrarium}
scene=$(realpath "${SCENE:-$root/scenes/terrarium.ron}")
shards=${SHARDS:-8}
more=${MORE:---passes 64 --set image.width=320 --set image.height=180}
for needed in slurmctld slurmd sbatch munged; do
    command -v $needed >/dev/null || { echo "slurm.sh: not tried: $needed is not installed (apt install slurm-wlm munge)"; exit 0; }
done
[ "$(id -u)" -eq 0 ] || { echo "slurm.sh: not tried: the daemons need root"; exit 0; }

work=$(mktemp -d)
chmod 755 "$work"
host=$(hostname -s)
mkdir -p "$work/state" "$work/munge" "$work/one" "$work/two"
daemons=
stop() {
    for pid in $daemons; do kill "$pid" 2>/dev/null || true; done
    sleep 1
    for pid in $daemons; do kill -9 "$pid" 2>/dev/null || true; done
    rm -rf "$work"
}
trap stop EXIT

# A key of its own; the socket where both daemons look.
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 2>/dev/null
chown -R munge:munge "$work/munge" && chmod 700 "$work/munge" && chmod 400 "$work/munge/key"
socket=/run/munge/terrarium.socket
mkdir -p /run/munge && chown munge:munge /run/munge && chmod 755 /run/munge
su -s /bin/sh munge -c "munged -F --key-file=$work/munge/key --socket=$socket --pid-file=$work/munge/pid \
    --log-file=$work/munge/log --seed-file=$work/munge/seed" &
daemons="$daemons $!"

cores=$(nproc)
cat >"$work/slurm.conf" <<CONF
ClusterName=terrarium
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$socket
CredType=cred/munge
SlurmctldPort=17817
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=requeue_delay=1,batch_sched_delay=1
JobRequeue=1
MinJobAge=600
KillWait=5
NodeName=one NodeHostname=$host NodeAddr=127.0.0.1 Port=17818 CPUs=$cores State=UNKNOWN
NodeName=two NodeHostname=$host NodeAddr=127.0.0.1 Port=17819 CPUs=$cores State=UNKNOWN
PartitionName=all Nodes=one,two Default=YES MaxTime=60 State=UP OverSubscribe=NO
CONF
export SLURM_CONF="$work/slurm.conf"
sleep 1
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 & daemons="$daemons $!"
slurmd -D -N one -f "$SLURM_CONF" >"$work/one.out" 2>&1 & daemons="$daemons $!"
slurmd -D -N two -f "$SLURM_CONF" >"$work/two.out" 2>&1 & daemons="$daemons $!"
for _ in $(seq 30); do
    [ "$(sinfo -h -o %A 2>/dev/null)" = "0/2" ] && break
    sleep 1
done
sinfo -N -o "%N %T" || { cat "$work"/*.out "$work"/*.log; exit 1; }

cd "$root"
# Memory is no resource in this Slurm.
# shellcheck disable=SC2086
"$program" farm "$scene" --engine slurm --shards "$shards" -o "$work/out.exr" --parts "$work/parts" \
    --folder "$work/job" --program "$program" --cpus 1 $more
sed -i '/--mem=/d; s/--resume/--resume --checkpoint 300ms/' "$work"/job/*.sh
begin=$(date +%s)
jobs=$(sh "$work"/job/*.submit.sh)
array=${jobs% *}
merge=${jobs#* }

# A task that has written a checkpoint is killed; its script puts it back into the queue.
task=
for _ in $(seq 300); do
    for victim in $(pgrep -f "$program render $scene" || true); do
        task=$(tr '\0' '\n' <"/proc/$victim/environ" 2>/dev/null | sed -n 's/^SLURM_ARRAY_TASK_ID=//p') || true
        [ -n "$task" ] && ls "$work"/parts/*/*shard-000"$task"-*.checkpoint >/dev/null 2>&1 && break 2
    done
    task=
    sleep 0.1
done
[ -n "$task" ] || { echo "slurm.sh: no task was seen at work"; exit 1; }
kill -9 "$victim"
echo "killed task $task of job $array"
for _ in $(seq 300); do
    # Slurm lets a task that was put back wait for two minutes.
    scontrol update JobId="${array}_$task" StartTime=now 2>/dev/null || true
    state=$(squeue -h -j "$array,$merge" -o "%i %T" 2>/dev/null || true)
    [ -z "$state" ] && break
    sleep 1
done
if [ ! -f "$work/out.exr" ]; then
    scontrol show job "$merge" || true
    tail -n 20 "$root"/terrarium-*.log
    exit 1
fi
echo "merged after $(($(date +%s) - begin)) s; restarts of task $task: $(scontrol show job "${array}_$task" | sed -n 's/.*Restarts=\([0-9]*\).*/\1/p' | head -1)"
rm -f "$root"/terrarium-*-*.log
# shellcheck disable=SC2086
"$program" render "$scene" -o "$work/whole.exr" --progress none -q $more
cmp "$work/out.exr" "$work/whole.exr" && echo "slurm.sh: the same bits as one render"

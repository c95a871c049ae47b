//! Slurm: an array of tasks, and a merge that waits for all of them.

use super::{Job, Sheet, shell, shell_line, text};

/// Seconds between the signal and the end that Slurm sets.
const NOTICE: u32 = 60;

/// Times that a part may be begun again after it was killed.
const AGAIN: u32 = 6;

pub fn sheets(job: &Job) -> Vec<Sheet> {
    let log = |what: &str| shell(&text(&job.folder.join(format!("{}-{what}.log", job.name))));
    let minutes = |seconds: u64| seconds.div_ceil(60) + 1;
    let mebibytes = |bytes: u64| bytes.div_ceil(1 << 20);
    let render = job.render_words(&["--shard", "auto", "--threads", "${SLURM_CPUS_PER_TASK:-1}"]);
    // The one word that the shell is to read.
    let render = shell_line(&render).replace("'${SLURM_CPUS_PER_TASK:-1}'", "\"${SLURM_CPUS_PER_TASK:-1}\"");
    let array = format!(
        "#!/bin/sh
# {name}: {shards} parts. Submit with sh {name}.submit.sh
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --cpus-per-task={cpus}
#SBATCH --mem={mem}M
#SBATCH --time={time}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@{NOTICE}
#SBATCH --output={log}
mkdir -p {parts}
# A signal stops the render, which leaves a checkpoint (code 6): the task goes back to the queue and goes on from it,
# and so does one that was killed, some times.
{render} &
child=$!
trap 'kill -USR1 \"$child\" 2>/dev/null' USR1 TERM
code=0
wait \"$child\" || code=$?
# The wait ends with the signal; the render a moment later.
while kill -0 \"$child\" 2>/dev/null; do code=0; wait \"$child\" || code=$?; done
if [ \"$code\" -eq 6 ] || {{ [ \"$code\" -gt 128 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {AGAIN} ]; }}; then
    scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\" && exit 0
fi
exit \"$code\"
",
        name = job.name,
        shards = job.shards,
        last = job.shards - 1,
        cpus = job.cpus,
        mem = mebibytes(job.bytes),
        time = minutes(job.seconds),
        log = log("%a"),
        parts = shell(&text(&job.parts)),
    );
    let merge = format!(
        "#!/bin/sh
#SBATCH --job-name={name}-merge
#SBATCH --cpus-per-task={cpus}
#SBATCH --mem={mem}M
#SBATCH --time=30
#SBATCH --output={log}
exec {merge}
",
        name = job.name,
        cpus = job.cpus,
        mem = mebibytes(job.merge_bytes),
        log = log("merge"),
        merge = shell_line(&job.merge_words()),
    );
    let submit = format!(
        "#!/bin/sh
# Submits the parts, and the merge that waits for all of them.
set -eu
cd \"$(dirname \"$0\")\"
array=$(sbatch --parsable {name}.array.sh)
merge=$(sbatch --parsable --dependency=afterok:\"$array\" --kill-on-invalid-dep=yes {name}.merge.sh)
echo \"$array $merge\"
",
        name = job.name
    );
    [("array.sh", array), ("merge.sh", merge), ("submit.sh", submit)]
        .map(|(ending, text)| Sheet { name: format!("{}.{ending}", job.name), text })
        .into()
}

//! Kubernetes: a Job with indexed completions, and a Job for the merge to be created after it.

use super::{Job, Sheet, text, yaml, yaml_list};

/// Seconds between SIGTERM and SIGKILL: a render writes its checkpoint within 5.
const NOTICE: u32 = 60;

/// Times that a part may be begun again.
const AGAIN: u32 = 6;

pub fn sheets(job: &Job) -> Vec<Sheet> {
    let render = job.render_words(&["--shard", "auto"]);
    // Stopped with a checkpoint (6): begun again, and no failure. Wrong calls and scenes (2) never come right.
    let policy = format!(
        "  completionMode: Indexed
  completions: {shards}
  parallelism: {shards}
  backoffLimitPerIndex: {AGAIN}
  podFailurePolicy:
    rules:
      - {{action: FailJob, onExitCodes: {{containerName: terrarium, operator: In, values: [2]}}}}
      - {{action: Ignore, onExitCodes: {{containerName: terrarium, operator: In, values: [6]}}}}
      - {{action: Ignore, onPodConditions: [{{type: DisruptionTarget, status: \"True\"}}]}}
",
        shards = job.shards
    );
    let parts = manifest(job, "render", &policy, &render, job.bytes, Some(job.seconds));
    let merge = manifest(job, "merge", "  backoffLimit: 2\n", &job.merge_words(), job.merge_bytes, None);
    let submit = format!(
        "#!/bin/sh
# Creates the Job of the parts, waits for it, and creates that of the merge.
set -eu
cd \"$(dirname \"$0\")\"
kubectl apply -f {name}-render.yaml
kubectl wait --for=condition=complete --timeout=-1s job/{name}-render
kubectl apply -f {name}-merge.yaml
",
        name = job.name
    );
    vec![
        Sheet { name: format!("{}-render.yaml", job.name), text: parts },
        Sheet { name: format!("{}-merge.yaml", job.name), text: merge },
        Sheet { name: format!("{}.submit.sh", job.name), text: submit },
    ]
}

fn manifest(
    job: &Job,
    what: &str,
    policy: &str,
    words: &[String],
    bytes: u64,
    seconds: Option<u64>,
) -> String {
    let limit = seconds.map_or(String::new(), |s| format!("      activeDeadlineSeconds: {s}\n"));
    format!(
        "# All machines see the folder of the scene and the parts through the claim `terrarium`, at the same place.
apiVersion: batch/v1
kind: Job
metadata:
  name: {name}-{what}
spec:
{policy}  template:
    spec:
      restartPolicy: Never
      terminationGracePeriodSeconds: {NOTICE}
{limit}      containers:
        - name: terrarium
          image: {image}
          workingDir: {folder}
          command: [{program}]
          args: {args}
          resources:
            requests: {{cpu: \"{cpus}\", memory: {mem}Mi}}
            limits: {{memory: {mem}Mi}}
          volumeMounts:
            - {{name: project, mountPath: {folder}}}
      volumes:
        - name: project
          persistentVolumeClaim: {{claimName: terrarium}}
",
        name = job.name,
        image = yaml(&job.image),
        folder = yaml(&text(&job.folder)),
        program = yaml(&words[0]),
        args = yaml_list(&words[1..]),
        cpus = job.cpus,
        mem = bytes.div_ceil(1 << 20),
    )
}

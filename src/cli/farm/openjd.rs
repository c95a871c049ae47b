//! Open Job Description (AWS Deadline Cloud): one template, parts in chunks, then the merge.

use super::{Job, Sheet, yaml, yaml_list};

/// Seconds that a render is given to write its checkpoint.
const NOTICE: u32 = 60;

pub fn sheets(job: &Job) -> Vec<Sheet> {
    let render = job.render_words(&["--shards", "{{Task.Param.Shard}}", "--progress", "openjd"]);
    let merge = job.merge_words();
    let mebibytes = |bytes: u64| bytes.div_ceil(1 << 20);
    let requirements = |bytes: u64| {
        format!(
            "{{amounts: [{{name: amount.worker.vcpu, min: {}}}, {{name: amount.worker.memory, min: {}}}]}}",
            job.cpus,
            mebibytes(bytes)
        )
    };
    let text = format!(
        "# {shards} parts, each a task. Check with `openjd check`, run here with
# `openjd run --step Merge --run-dependencies`.
specificationVersion: jobtemplate-2023-09
extensions: [TASK_CHUNKING]
name: {name}
steps:
  - name: Render
    hostRequirements: {render_needs}
    parameterSpace:
      taskParameterDefinitions:
        - name: Shard
          type: CHUNK[INT]
          range: \"0-{last}\"
          chunks: {{defaultTaskCount: 1, rangeConstraint: CONTIGUOUS}}
    script:
      actions:
        onRun:
          command: {program}
          args: {render}
          timeout: {seconds}
          cancelation: {{mode: NOTIFY_THEN_TERMINATE, notifyPeriodInSeconds: {NOTICE}}}
  - name: Merge
    hostRequirements: {merge_needs}
    dependencies: [{{dependsOn: Render}}]
    script:
      actions:
        onRun:
          command: {program}
          args: {merge}
",
        shards = job.shards,
        name = yaml(&job.name),
        last = job.shards - 1,
        render_needs = requirements(job.bytes),
        merge_needs = requirements(job.merge_bytes),
        program = yaml(&job.program),
        render = yaml_list(&render[1..]),
        merge = yaml_list(&merge[1..]),
        seconds = job.seconds,
    );
    vec![Sheet { name: format!("{}.openjd.yaml", job.name), text }]
}

//! Which part of an array of tasks this process is, by the variables that engines set.

/// An engine's variables.
struct Engine {
    name: &'static str,
    /// This task's number.
    index: &'static str,
    /// The variable with the first number, and the number where there is none.
    first: (Option<&'static str>, u32),
    /// The variable with how many there are, or with the last number.
    count: Option<Count>,
    /// The variable with how many tasks there are, where numbers may be left out.
    tasks: Option<&'static str>,
}

enum Count {
    Of(&'static str),
    Last(&'static str),
}

const ENGINES: [Engine; 8] = [
    Engine {
        name: "Slurm",
        index: "SLURM_ARRAY_TASK_ID",
        first: (Some("SLURM_ARRAY_TASK_MIN"), 0),
        count: Some(Count::Last("SLURM_ARRAY_TASK_MAX")),
        tasks: Some("SLURM_ARRAY_TASK_COUNT"),
    },
    Engine { name: "Kubernetes", index: "JOB_COMPLETION_INDEX", first: (None, 0), count: None, tasks: None },
    Engine {
        name: "AWS Batch",
        index: "AWS_BATCH_JOB_ARRAY_INDEX",
        first: (None, 0),
        count: Some(Count::Of("AWS_BATCH_JOB_ARRAY_SIZE")),
        tasks: None,
    },
    Engine { name: "PBS", index: "PBS_ARRAY_INDEX", first: (None, 0), count: None, tasks: None },
    Engine {
        name: "Grid Engine",
        index: "SGE_TASK_ID",
        first: (Some("SGE_TASK_FIRST"), 1),
        count: Some(Count::Last("SGE_TASK_LAST")),
        tasks: None,
    },
    Engine {
        name: "LSF",
        index: "LSB_JOBINDEX",
        first: (None, 1),
        count: Some(Count::Last("LSB_JOBINDEX_END")),
        tasks: None,
    },
    Engine { name: "OpenCue", index: "CUE_IFRAME", first: (None, 0), count: None, tasks: None },
    Engine { name: "HyperQueue", index: "HQ_TASK_ID", first: (None, 0), count: None, tasks: None },
];

/// A task's place among its fellows, from 0 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Task {
    pub index: u32,
    pub of: u32,
}

/// The task that this process is. With `of`, numbers are taken to begin where the engine's usually do, so that
/// an array of some of the tasks, as for those that failed, means the same parts.
pub fn find(of: Option<u32>, variable: impl Fn(&str) -> Option<String>) -> Result<Task, String> {
    let mut found: Option<(&Engine, Task)> = None;
    for engine in ENGINES.iter().filter(|engine| engine.runs(&variable)) {
        let task = engine.task(of, &variable).map_err(|reason| format!("--shard auto: {reason}"))?;
        match found {
            Some((first, other)) if other != task => {
                let part = |Task { index, of }: Task| format!("part {index} of {of}");
                return Err(format!(
                    "--shard auto: by {} this is {}, by {} {}: say which with --shard I/N",
                    first.name,
                    part(other),
                    engine.name,
                    part(task)
                ));
            }
            _ => found = Some((engine, task)),
        }
    }
    if let Some((_, task)) = found {
        return Ok(task);
    }
    let said = ENGINES.iter().find_map(|engine| Some((engine.index, variable(engine.index)?)));
    Err(match said {
        Some((name, text)) => format!("--shard auto: {name} is `{}`, which is no task's number", text.trim()),
        None => {
            let names = ENGINES.map(|engine| engine.index).join(", ");
            format!("--shard auto: no engine says which part this is: none of {names} is set")
        }
    })
}

fn number(variable: &impl Fn(&str) -> Option<String>, name: &str) -> Option<u32> {
    variable(name).and_then(|text| text.trim().parse().ok())
}

impl Engine {
    /// Whether it says that this is a task of an array. A number below those that it gives to tasks, as LSF's 0,
    /// is that of a job which is none.
    fn runs(&self, variable: &impl Fn(&str) -> Option<String>) -> bool {
        number(variable, self.index).is_some_and(|index| index >= self.first.1)
    }

    fn task(&self, of: Option<u32>, variable: &impl Fn(&str) -> Option<String>) -> Result<Task, String> {
        let (name, usual) = (self.name, self.first.1);
        let index = number(variable, self.index).ok_or_else(|| format!("{} is no number", self.index))?;
        let (first, of) = match of {
            Some(of) => (usual, of),
            None => self
                .array(variable)?
                .ok_or_else(|| format!("{name} does not say how many parts there are: add --of N"))?,
        };
        match index.checked_sub(first).filter(|index| *index < of) {
            Some(index) => Ok(Task { index, of }),
            None => Err(format!(
                "{name}'s task {index} is none of {of} parts: number the tasks from {first} to {}",
                u64::from(first) + u64::from(of) - 1
            )),
        }
    }

    /// The first number of the array and how many there are, if the engine says so. Of an array with gaps, as of
    /// those that failed, it cannot be told which part a task is.
    fn array(&self, variable: &impl Fn(&str) -> Option<String>) -> Result<Option<(u32, u32)>, String> {
        let number = |name: &str| number(variable, name);
        let (first, of) = match &self.count {
            None => return Ok(None),
            Some(Count::Of(count)) => match number(count) {
                Some(of) => return Ok(Some((self.first.1, of))),
                None => return Ok(None),
            },
            Some(Count::Last(last)) => {
                let first = self.first.0.and_then(number).unwrap_or(self.first.1);
                match number(last).and_then(|last| last.checked_sub(first)?.checked_add(1)) {
                    Some(of) => (first, of),
                    None => return Ok(None),
                }
            }
        };
        let tasks = self.tasks.and_then(number).unwrap_or(of);
        if tasks != of || (of == 1 && first != self.first.1) {
            return Err(format!(
                "{}'s array has {tasks} of the numbers from {first} to {}: say of how many parts with --of N",
                self.name,
                u64::from(first) + u64::from(of) - 1
            ));
        }
        Ok(Some((first, of)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(of: Option<u32>, variables: &[(&str, &str)]) -> Result<Task, String> {
        find(of, |name| {
            variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn each_engine_says_which_part_this_is() {
        let task = |index, of| Ok(Task { index, of });
        let slurm =
            [("SLURM_ARRAY_TASK_ID", "9"), ("SLURM_ARRAY_TASK_MIN", "5"), ("SLURM_ARRAY_TASK_MAX", "12")];
        assert_eq!(found(None, &slurm), task(4, 8));
        // some of the tasks, submitted again
        assert_eq!(found(Some(16), &slurm), task(9, 16));
        assert_eq!(found(Some(3), &[("JOB_COMPLETION_INDEX", "2")]), task(2, 3));
        let aws = [("AWS_BATCH_JOB_ARRAY_INDEX", "0"), ("AWS_BATCH_JOB_ARRAY_SIZE", "4")];
        assert_eq!(found(None, &aws), task(0, 4));
        assert_eq!(found(Some(4), &[("PBS_ARRAY_INDEX", "3")]), task(3, 4));
        let sge = [("SGE_TASK_ID", "1"), ("SGE_TASK_FIRST", "1"), ("SGE_TASK_LAST", "8")];
        assert_eq!(found(None, &sge), task(0, 8));
        assert_eq!(found(Some(8), &sge), task(0, 8));
        assert_eq!(found(None, &[("LSB_JOBINDEX", "3"), ("LSB_JOBINDEX_END", "3")]), task(2, 3));
        assert_eq!(found(Some(5), &[("CUE_IFRAME", "4")]), task(4, 5));
        assert_eq!(found(Some(5), &[("HQ_TASK_ID", "4")]), task(4, 5));
    }

    #[test]
    fn what_no_engine_says_is_refused() {
        assert!(found(Some(2), &[]).is_err_and(|e| e.contains("SLURM_ARRAY_TASK_ID")));
        assert!(found(None, &[("JOB_COMPLETION_INDEX", "2")]).is_err_and(|e| e.contains("--of")));
        assert!(found(Some(2), &[("JOB_COMPLETION_INDEX", "2")]).is_err_and(|e| e.contains("from 0 to 1")));
        let said = found(Some(2), &[("SGE_TASK_ID", "undefined")]);
        assert!(said.is_err_and(|e| e.contains("SGE_TASK_ID is `undefined`")));
        let two = [("SLURM_ARRAY_TASK_ID", "1"), ("HQ_TASK_ID", "2")];
        assert_eq!(
            found(Some(4), &[("SLURM_ARRAY_TASK_ID", "1"), ("SGE_TASK_ID", "2")]),
            Ok(Task { index: 1, of: 4 })
        );
        assert!(found(Some(4), &[("HQ_TASK_ID", "2"), ("LSB_JOBINDEX", "0")]).is_ok());
        let stepped = [
            ("SLURM_ARRAY_TASK_ID", "5"),
            ("SLURM_ARRAY_TASK_COUNT", "3"),
            ("SLURM_ARRAY_TASK_MIN", "1"),
            ("SLURM_ARRAY_TASK_MAX", "5"),
        ];
        assert!(found(None, &stepped).is_err_and(|e| e.contains("3 of the numbers from 1 to 5")));
        assert!(found(Some(8), &stepped).is_ok());
        let alone =
            [("SLURM_ARRAY_TASK_ID", "5"), ("SLURM_ARRAY_TASK_MIN", "5"), ("SLURM_ARRAY_TASK_MAX", "5")];
        assert!(found(None, &alone).is_err_and(|e| e.contains("--of N")));
        assert!(
            found(Some(4), &two)
                .is_err_and(|e| e.contains("by Slurm this is part 1 of 4, by HyperQueue part 2 of 4"))
        );
        assert!(found(Some(2), &[("LSB_JOBINDEX", "0")]).is_err());
    }
}

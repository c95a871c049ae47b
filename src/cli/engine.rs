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
    },
    Engine { name: "Kubernetes", index: "JOB_COMPLETION_INDEX", first: (None, 0), count: None },
    Engine {
        name: "AWS Batch",
        index: "AWS_BATCH_JOB_ARRAY_INDEX",
        first: (None, 0),
        count: Some(Count::Of("AWS_BATCH_JOB_ARRAY_SIZE")),
    },
    Engine { name: "PBS", index: "PBS_ARRAY_INDEX", first: (None, 0), count: None },
    Engine {
        name: "Grid Engine",
        index: "SGE_TASK_ID",
        first: (Some("SGE_TASK_FIRST"), 1),
        count: Some(Count::Last("SGE_TASK_LAST")),
    },
    Engine {
        name: "LSF",
        index: "LSB_JOBINDEX",
        first: (None, 1),
        count: Some(Count::Last("LSB_JOBINDEX_END")),
    },
    Engine { name: "OpenCue", index: "CUE_IFRAME", first: (None, 0), count: None },
    Engine { name: "HyperQueue", index: "HQ_TASK_ID", first: (None, 0), count: None },
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
    let number = |name: &str| variable(name).and_then(|text| text.trim().parse::<u32>().ok());
    let mut engines = ENGINES.iter().filter_map(|e| Some((e, number(e.index)?)));
    let Some((engine, index)) = engines.next() else {
        let said = ENGINES.iter().find_map(|e| Some((e.index, variable(e.index)?)));
        return Err(match said {
            Some((name, text)) => format!("--shard auto: {name} is `{}`, which is no number", text.trim()),
            None => {
                let names = ENGINES.map(|engine| engine.index).join(", ");
                format!("--shard auto: no engine says which part this is: none of {names} is set")
            }
        });
    };
    if let Some((other, second)) = engines.find(|(_, second)| *second != index) {
        return Err(format!(
            "--shard auto: {} is {index} and {} is {second}: say which part this is with --shard I/N",
            engine.index, other.index
        ));
    }
    let (name, usual) = (engine.name, engine.first.1);
    let of_engine = |count: &Count| match count {
        Count::Of(count) => Some((usual, number(count)?)),
        Count::Last(last) => {
            let first = engine.first.0.and_then(number).unwrap_or(usual);
            Some((first, number(last)?.checked_sub(first)?.checked_add(1)?))
        }
    };
    let found = match of {
        Some(of) => Some((usual, of)),
        None => engine.count.as_ref().and_then(of_engine),
    };
    let Some((first, of)) = found else {
        return Err(format!("--shard auto: {name} does not say how many parts there are: add --of N"));
    };
    match index.checked_sub(first).filter(|index| *index < of) {
        Some(index) => Ok(Task { index, of }),
        None => Err(format!(
            "--shard auto: {name}'s task {index} is none of {of} parts: number the tasks from {first} to {}",
            u64::from(first) + u64::from(of) - 1
        )),
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
        assert!(found(Some(4), &two).is_err_and(|e| e.contains("HQ_TASK_ID is 2")));
        assert!(found(Some(2), &[("LSB_JOBINDEX", "0")]).is_err());
    }
}

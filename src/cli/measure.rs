//! `plan --measure`: the scene rendered with each effect left out in turn.

use super::exit::Failure;
use super::progress::duration;
use serde::Serialize;
use terrarium::description::Loaded;
use terrarium::measure::{self, LeftOut};
use terrarium::render::{Options, Planned, Progress};

/// What each effect costs, and brings.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct Table(measure::Prices);

pub fn table(
    loaded: &Loaded,
    options: &Options,
    planned: &Planned,
    progress: &dyn Progress,
) -> Result<Table, Failure> {
    Ok(Table(measure::prices(loaded, options, planned.passes, &planned.survey.decisions, progress)?))
}

impl Table {
    /// A row an effect.
    pub fn text(&self) -> String {
        let mut text = format!("measured: {} with all of it\n", duration(self.0.seconds));
        for LeftOut { effect, seconds, relative_rms, mean_change, same } in &self.0.left_out {
            let change = match same {
                true => "the same image".to_owned(),
                false => {
                    format!(
                        "the image changes by {:.2} %, its mean by {:+.2} %",
                        100.0 * relative_rms,
                        100.0 * mean_change
                    )
                }
            };
            let more = 100.0 * (seconds / self.0.seconds - 1.0);
            text +=
                &format!("  without {:15} {} ({more:+.1} %), {change}\n", effect.name(), duration(*seconds));
        }
        text
    }
}

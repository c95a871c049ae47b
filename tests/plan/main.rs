//! Which effects a scene calls for, what is said of them, and that what is off does not run.

mod adds_up;
mod command_line;
mod decisions;
mod forced;
mod free;
pub(crate) mod lab;
mod overrides;
mod survey;

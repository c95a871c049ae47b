//! The command line: arguments, progress, messages and exit codes, over the library's public face.
//!
//! Everything that the program prints is printed here. Standard output carries only what was asked
//! for; progress and messages go to standard error.

mod args;
mod batch_args;
mod blocks;
mod breakage;
mod check;
mod convert;
mod diff;
mod diff_args;
mod diff_text;
mod engine;
mod exit;
mod farm;
mod farm_args;
mod finished;
mod frame_args;
mod frames;
mod machine;
mod measure;
mod merge;
mod plan;
mod progress;
mod ranges;
mod render;
mod replay;
mod replay_args;
mod report;
mod signals;
mod study;
mod study_args;
mod summary;
mod target;
mod viewer;
mod watch;
mod watch_args;

use args::{Args, Command};
use clap::{CommandFactory, FromArgMatches};
use exit::Failure;
use report::Terminal;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

/// Runs the program; the exit codes are those of `exit`.
pub fn run() -> ExitCode {
    let args = match Args::command().try_get_matches().and_then(|found| Args::from_arg_matches(&found)) {
        Ok(args) => args,
        Err(error) => {
            // help and version are errors to clap, of code 0; a closed pipe is no reason to fail
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(exit::USAGE));
        }
    };
    let terminal = Terminal::new(args.color);
    let place = report::keep_panics();
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| dispatch(&args, &terminal)));
    let failure = match outcome {
        Ok(Ok(())) => return ExitCode::SUCCESS,
        Ok(Err(failure)) => failure,
        Err(_) => {
            let what = place.lock().map(|text| text.clone()).unwrap_or_default();
            Failure::new(exit::FAILED, format!("the program broke off, which is a defect of its own: {what}"))
        }
    };
    if let Command::Render(args) = &args.command {
        machine::failed(args.progress, &failure, frames::Place::default(), &terminal);
    }
    if !failure.message.is_empty() {
        terminal.error(&failure.message);
    }
    ExitCode::from(failure.code)
}

fn dispatch(args: &Args, terminal: &Terminal) -> Result<(), Failure> {
    match &args.command {
        Command::Render(args) => render::run(args, terminal),
        Command::Watch(args) => watch::run(args, terminal),
        Command::Plan(args) => plan::run(args, terminal),
        Command::Study(args) => study::run(args, terminal),
        Command::Check(args) => check::run(args, terminal),
        Command::Merge(args) => merge::run(args, terminal),
        Command::Farm(args) => farm::run(args, terminal),
        Command::Convert(args) => convert::run(args, terminal),
        Command::Diff(args) => diff::run(args, terminal),
        Command::Schema => {
            let schema = terrarium::description::json_schema();
            report::print(&format!("{schema:#}\n"))
        }
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Args::command(), "terrarium", &mut script);
            report::print(&String::from_utf8_lossy(&script))
        }
    }
}

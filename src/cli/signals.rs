//! Signals that ask the program to stop: the first lets it write what is there, a later one ends it at once.

use super::exit::STOPPED;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;
use terrarium::render::Halt;

/// A signal that follows the first within this time is the same request: GNU `timeout` signals its child and
/// then the child's whole group, shells and engines do alike.
const SAME_REQUEST: Duration = Duration::from_secs(1);

static HALT: OnceLock<Halt> = OnceLock::new();

/// Whether there may be something to write down.
static TRACING: AtomicBool = AtomicBool::new(false);

/// From now on SIGINT and SIGTERM, and SIGUSR1 where engines send it before a time limit, set the flag of
/// [`halt`]. Before anything has been traced they end the program, after `early`.
pub fn stop_on_signals(early: impl FnOnce() + Send + 'static) {
    HALT.get_or_init(|| {
        let (halt, armed) = (Halt::default(), Arc::new(AtomicBool::new(false)));
        for signal in signals() {
            let _ =
                signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&armed));
            let _ = signal_hook::flag::register(signal, Arc::clone(&halt.0));
        }
        let asked = Arc::clone(&halt.0);
        // Without this thread signals are heeded only while tiles are traced.
        let _ = thread::Builder::new().name("signals".to_owned()).spawn(move || wait(&asked, &armed, early));
        halt
    });
}

/// Told by signals.
pub fn halt() -> Option<Halt> {
    HALT.get().cloned()
}

/// From now on a signal lets the program write what is there, or not any longer.
pub fn tracing(now: bool) {
    TRACING.store(now, Ordering::SeqCst);
}

/// Ends the program where there is nothing to write, or lets the next signal do so, some time after the first.
fn wait(asked: &AtomicBool, armed: &AtomicBool, early: impl FnOnce()) {
    while !asked.load(Ordering::SeqCst) {
        thread::sleep(SAME_REQUEST / 8);
    }
    if !TRACING.load(Ordering::SeqCst) {
        early();
        std::process::exit(STOPPED.into());
    }
    thread::sleep(SAME_REQUEST);
    armed.store(true, Ordering::SeqCst);
}

#[cfg(unix)]
fn signals() -> Vec<i32> {
    use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
    vec![SIGINT, SIGTERM, SIGUSR1]
}

#[cfg(not(unix))]
fn signals() -> Vec<i32> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    vec![SIGINT, SIGTERM]
}

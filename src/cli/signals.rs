//! Signals that ask the program to stop: the first lets it write what is there, a later one ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;
use terrarium::render::Halt;

/// A signal that follows the first within this time is the same request: GNU `timeout` signals its child and
/// then the child's whole group, shells and engines do alike.
const SAME_REQUEST: Duration = Duration::from_secs(1);

/// From now on SIGINT and SIGTERM, and SIGUSR1 where engines send it before a time limit, set the flag.
pub fn stop_on_signals() -> Halt {
    static HALT: OnceLock<Halt> = OnceLock::new();
    HALT.get_or_init(|| {
        let (halt, armed) = (Halt::default(), Arc::new(AtomicBool::new(false)));
        for signal in signals() {
            let _ =
                signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&armed));
            let _ = signal_hook::flag::register(signal, Arc::clone(&halt.0));
        }
        let asked = Arc::clone(&halt.0);
        // Without this thread no signal ends it at once.
        let _ = thread::Builder::new().name("signals".to_owned()).spawn(move || arm(&asked, &armed));
        halt
    })
    .clone()
}

/// Lets the next signal end the program, some time after the first.
fn arm(asked: &AtomicBool, armed: &AtomicBool) {
    while !asked.load(Ordering::SeqCst) {
        thread::sleep(SAME_REQUEST / 8);
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

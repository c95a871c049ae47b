//! Signals that ask the program to stop: the first lets it write what is there, the second ends it at once.

use std::sync::{Arc, OnceLock};
use terrarium::render::Halt;

/// From now on SIGINT and SIGTERM, and SIGUSR1 where engines send it before a time limit, set the flag.
pub fn stop_on_signals() -> Halt {
    static HALT: OnceLock<Halt> = OnceLock::new();
    HALT.get_or_init(|| {
        let halt = Halt::default();
        for signal in signals() {
            // In this order: the second signal finds the flag set.
            let _ =
                signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&halt.0));
            let _ = signal_hook::flag::register(signal, Arc::clone(&halt.0));
        }
        halt
    })
    .clone()
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

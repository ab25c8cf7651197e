//! Ctrl-C and termination: unfinished files are removed, then the signal does what it always does.

use signal_hook::{consts::TERM_SIGNALS, iterator::Signals, low_level::emulate_default_handler};
use std::{
    path::{Path, PathBuf},
    sync::{Mutex, Once, PoisonError},
};

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
static LISTEN: Once = Once::new();

/// Removes this file when a signal ends the process. Once renamed, it is no longer there to be removed.
pub(crate) fn remove_on_signal(path: &Path) {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
    LISTEN.call_once(|| {
        // Without a listener a signal leaves the hidden file behind, which harms nobody.
        if let Ok(mut signals) = Signals::new(TERM_SIGNALS) {
            std::thread::spawn(move || {
                for signal in signals.forever() {
                    for path in UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).iter() {
                        let _ = std::fs::remove_file(path);
                    }
                    let _ = emulate_default_handler(signal);
                }
            });
        }
    });
}

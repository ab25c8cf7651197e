//! Ctrl-C and termination: unfinished files are removed, then the signal does what it always does.

use signal_hook::{consts::TERM_SIGNALS, iterator::Signals, low_level::emulate_default_handler};
use std::{
    io,
    path::PathBuf,
    sync::{Mutex, Once, PoisonError},
};
use tempfile::NamedTempFile;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
static LISTEN: Once = Once::new();

/// Creates a file that is removed when a signal ends the process. Once renamed, it is no longer there to be
/// removed. A signal that arrives during the creation waits for it.
pub(crate) fn removed_on_signal(
    create: impl FnOnce() -> io::Result<NamedTempFile>,
) -> io::Result<NamedTempFile> {
    LISTEN.call_once(listen);
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let file = create()?;
    unfinished.push(file.path().to_owned());
    Ok(file)
}

fn listen() {
    // Without a listener a signal leaves the hidden file behind, which harms nobody.
    let Ok(mut signals) = Signals::new(TERM_SIGNALS) else { return };
    std::thread::spawn(move || {
        for signal in signals.forever() {
            let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            for path in unfinished.iter() {
                let _ = std::fs::remove_file(path);
            }
            // With the lock still held, so that no file is begun any more.
            let _ = emulate_default_handler(signal);
        }
    });
}

//! Ctrl-C, termination and a lost terminal.
//!
//! Unfinished files that are not worth keeping are removed, then the signal has its usual effect. A tool may ask to get the signal
//! first and end in order; a second signal ends it at once. The handler itself notes that a signal arrived, because the thread that acts on it may
//! run later than the failure of a program or pipe that the same signal ended.

use crate::part::{Keep, PartFile};
use signal_hook::{
    consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ, TERM_SIGNALS},
    flag,
    iterator::Signals,
    low_level::emulate_default_handler,
};
use std::{
    io,
    path::{Path, PathBuf},
    sync::{
        Arc, LazyLock, Mutex, Once, PoisonError,
        atomic::{AtomicBool, Ordering::SeqCst},
    },
    time::{Duration, Instant},
};

static UNFINISHED: Mutex<Vec<(PathBuf, Keep)>> = Mutex::new(Vec::new());
static LISTEN: Once = Once::new();
/// Whether the tool ends in order by itself.
static ORDERLY: AtomicBool = AtomicBool::new(false);
/// Whether a signal that asks a tool to end has arrived.
static ARRIVED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// Whether the tool has begun to end in order.
static ASKED: AtomicBool = AtomicBool::new(false);
/// How long a failure waits for a signal that has arrived to end the tool.
const PATIENCE: Duration = Duration::from_secs(1);

/// From now on, a write that reaches the limit on file sizes (`ulimit -f`) is an error; by default a signal kills the tool.
pub(crate) fn size_limit_is_an_error() {
    // Without it the tool is killed, as before.
    let _ = flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
}

/// From now on, the first SIGINT, SIGTERM or SIGHUP only makes [`stop_requested`] true.
pub fn stop_in_order() {
    ORDERLY.store(true, SeqCst);
    LISTEN.call_once(listen);
}

/// Whether a signal asked the tool to stop; only after [`stop_in_order`].
pub fn stop_requested() -> bool {
    ORDERLY.load(SeqCst) && ARRIVED.load(SeqCst)
}

/// Waits until a signal that has arrived ends the tool: the failure that the tool sees is most often a program or a pipe that the same signal ended.
pub(crate) fn let_it_end() {
    let since = Instant::now();
    while !ORDERLY.load(SeqCst) && ARRIVED.load(SeqCst) && since.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Creates a file that is removed when a signal ends the process. Once renamed, it is no longer there to be
/// removed. A signal that arrives during the creation waits for it.
pub(crate) fn removed_on_signal(create: impl FnOnce() -> io::Result<PartFile>) -> io::Result<PartFile> {
    LISTEN.call_once(listen);
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let part = create()?;
    unfinished.extend(part.path().map(|path| (path.to_owned(), part.keeper())));
    Ok(part)
}

/// Creates a folder at `path`, which is removed when a signal ends the process, unless it was renamed before.
///
/// # Errors
/// Those of `create`.
pub fn folder_removed_on_signal<T, E>(
    create: impl FnOnce() -> Result<T, E>,
    path: impl FnOnce(&T) -> &Path,
) -> Result<T, E> {
    LISTEN.call_once(listen);
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let made = create()?;
    unfinished.push((path(&made).to_owned(), Keep::default()));
    Ok(made)
}

/// Whether a lost terminal does not end the tool, as under `nohup`; true where the system does not say.
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask >> (SIGHUP - 1) & 1 == 1)
}

fn remove(unfinished: &[(PathBuf, Keep)]) {
    for (path, _) in unfinished.iter().filter(|(_, keep)| !keep.kept()) {
        let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    }
}

/// Removes unfinished files before the process ends, unless one is being created at this instant.
pub(crate) fn remove_unfinished() {
    if let Ok(unfinished) = UNFINISHED.try_lock() {
        remove(&unfinished);
    }
}

fn listen() {
    // Without a listener a signal leaves the hidden file behind, which is harmless.
    let hangup = Some(SIGHUP).filter(|_| !hangup_is_ignored());
    let all = TERM_SIGNALS.iter().copied().chain(hangup);
    let Ok(mut signals) = Signals::new(all.clone()) else { return };
    for signal in all {
        // Without it the listener alone notes the signal.
        let _ = flag::register(signal, ARRIVED.clone());
    }
    let listener = move || {
        for signal in signals.forever() {
            ARRIVED.store(true, SeqCst);
            let polite = [SIGINT, SIGTERM, SIGHUP].contains(&signal);
            if polite && ORDERLY.load(SeqCst) && !ASKED.swap(true, SeqCst) {
                continue;
            }
            let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            remove(&unfinished);
            // The lock is still held, so that no other file is created.
            let _ = emulate_default_handler(signal);
        }
    };
    // Without memory for a thread, the hidden file is left behind, as if signals were not watched.
    let _ = std::thread::Builder::new().spawn(listener);
}

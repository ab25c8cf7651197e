//! Readers of other crates, whose panics become errors.
//!
//! laz and pcd-rs panic on some damaged packed points, by an index or a shift that the file gives; las and e57 read numbers in the same way. What would take
//! memory, time or the whole stack instead is refused before they run. Each reader gets a thread of its own: a panic ends that thread alone and becomes an
//! error of the file. The standard library prints a panic by the hook of the whole process, before anything can catch it; a hook knows the name of the thread,
//! so the one that is set here prints nothing for these threads and passes all others on.

use super::error::ReadError;
use crate::points::Cloud;
use std::io;
use std::sync::Once;
use std::thread::{Builder, Scope, ScopedJoinHandle, current};

/// The name of every thread of such a reader.
const NAME: &str = "reader";
/// Its stack, as large as that of a main thread [B].
const STACK: usize = 8 << 20;

/// Starts a thread whose panics are not printed.
///
/// # Errors
/// No thread can be started.
pub(super) fn spawn<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    stack: usize,
    work: impl FnOnce() -> T + Send + 'scope,
) -> io::Result<ScopedJoinHandle<'scope, T>> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if current().name() != Some(NAME) {
                print(panic);
            }
        }));
    });
    Builder::new().name(NAME.into()).stack_size(stack).spawn_scoped(scope, work)
}

/// Runs a reader of another crate; a panic in it, also in a thread that it started by [`spawn`] and joined, becomes an error.
pub(super) fn guarded(
    format: &'static str,
    read: impl FnOnce() -> Result<Cloud, ReadError> + Send,
) -> Result<Cloud, ReadError> {
    let ended = std::thread::scope(|scope| Ok(spawn(scope, STACK, read)?.join()));
    ended.map_err(ReadError::Io)?.unwrap_or_else(|_| {
        let what = "the file is broken in a way its reader could not name: export it again".to_owned();
        Err(ReadError::Broken { format, what, point: None })
    })
}

//! Whether the process has a stdout.
//!
//! A shell can start a tool without one (`>&-`). The runtime of Rust then opens /dev/null as descriptor 1 before `main`: what is written there
//! is lost without an error. So the descriptor is looked at earlier, among the initialisers of the program.

use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

static CLOSED: AtomicBool = AtomicBool::new(false);

/// Whether the process was started without a stdout; false where the system does not tell.
pub(crate) fn is_closed() -> bool {
    CLOSED.load(SeqCst)
}

#[cfg(target_os = "linux")]
extern "C" fn look() {
    CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), SeqCst);
}

#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "an initialiser of the program is named by its section")]
// SAFETY: the section holds pointers to functions of this type. This one only asks the system for a flag and stores it: it needs nothing
// of the runtime, which is not there yet, and cannot panic.
#[unsafe(link_section = ".init_array")]
#[used]
static LOOK: extern "C" fn() = look;

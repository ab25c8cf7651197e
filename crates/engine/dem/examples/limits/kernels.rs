//! What a step takes of a particle, a contact and a bond. Operations are as `crates/engine/dem/src/passes/operations.rs` counts them.

/// Bytes and operations of one kernel.
pub struct Kernel {
    /// Its name.
    pub name: &'static str,
    /// Bytes of a particle: its row read and written (64 + 64), acceleration read and written (32 + 32), home (32), first entry (4);
    /// with rotation spin read and written (32 + 32), angular acceleration read and written (32 + 32).
    pub particle: f64,
    /// Bytes of a listed contact: its two particles (8), two entries of the gather (8), its load written (32, with rotation 64, with torques 96) and
    /// read again while it is in the cache (0), its history read and written.
    pub listed: f64,
    /// Adds and multiplies of a contact that touches and sticks. Comparison, choice and minimum are not counted.
    pub operations: f64,
    /// Divisions.
    pub divisions: f64,
    /// Square roots.
    pub roots: f64,
    /// Adds and multiplies in the gather of a contact's two ends, four at a time.
    pub gather: f64,
}

const fn kernel(
    name: &'static str,
    [particle, listed, gather]: [f64; 3],
    [operations, divisions, roots]: [f64; 3],
) -> Kernel {
    Kernel { name, particle, listed, operations, divisions, roots, gather }
}

/// Contacts by Hooke's law, each with one effect more.
pub const KERNELS: [Kernel; 5] = [
    kernel("frictionless", [228.0, 48.0, 16.0], [48.0, 1.0, 2.0]),
    kernel("friction", [356.0, 128.0, 32.0], [186.0, 2.0, 3.0]),
    kernel("rolling", [356.0, 208.0, 48.0], [291.0, 3.0, 4.0]),
    kernel("twisting", [356.0, 224.0, 48.0], [320.0, 4.0, 5.0]),
    kernel("cohesion", [356.0, 224.0, 48.0], [335.0, 5.0, 5.0]),
];

/// A bond with moments, dashpots and the stresses of both ends; `dem-run --report` has its bytes.
pub const BOND: Kernel = kernel("bond", [0.0; 3], [510.0, 2.0, 4.0]);

//! Topics of a run, of walls and of an inlet.

/// Frames: a row for each particle.
pub const PARTICLES: &str = "/particles";
/// A row for each rigid clump, at its centre of mass.
pub const BODIES: &str = "/bodies";
/// A row for each bond that was made, half-way between its particles.
pub const BONDS: &str = "/bonds";
/// A row for each bond that broke since the message before, where and when it did.
pub const CRACKS: &str = "/cracks";
/// A row for each contact.
pub const CONTACTS: &str = "/contacts";
/// Contacts that have a history, with the last frame: what a run that starts from its particles takes along.
pub const HISTORY: &str = "/history";
/// Wall spheres: once, and again with each frame when they move.
pub const WALLS: &str = "/walls";
/// Planes, meshes and motions of walls; JSON, see [`crate::WallRecord`].
pub const SURFACES: &str = "/surfaces";
/// The energy ledger; JSON.
pub const ENERGY: &str = "/energy";
/// What grains do to walls; JSON.
pub const WALL_FORCES: &str = "/wall_forces";
/// A row for each wall sphere and triangle that was touched since the frame before.
pub const WALL_WEAR: &str = "/wall_wear";
/// The periodic domain where it changes; JSON, see [`crate::DomainRecord`].
pub const DOMAIN: &str = "/domain";
/// How far the grains are from rest, as JSON.
pub const SETTLING: &str = "/settling";
/// Notes, and why a run was stopped; JSON, see [`crate::LogMessage`].
pub const LOG: &str = "/log";
/// Pieces of checkpoints; bincode.
pub const CHECKPOINT: &str = "/checkpoint";
/// A row for each crossing of a storage plane, in the order of times.
pub const CROSSINGS: &str = "/crossings";
/// "Nothing more before t"; JSON, see [`crate::Watermark`].
pub const WATERMARK: &str = "/crossings/watermark";
/// Contacts of particles that cross.
pub const CROSSING_CONTACTS: &str = "/crossings/touches";
/// Bonds of particles that cross.
pub const CROSSING_BONDS: &str = "/crossings/bonds";
/// Samples of the paths of particles that are about to cross.
pub const PATHS: &str = "/crossings/paths";

//! The files of a deck, and of the folder in which it runs.

/// The input script.
pub const INPUT: &str = "run.in";
/// All atoms at t = 0.
pub const DATA: &str = "particles.data";
/// Style and coefficients of bonds.
pub const BONDS: &str = "bonds.in";
/// Rigid bodies at t = 0.
pub const BODIES: &str = "bodies.info";
/// What the name of a state is given for the rigid bodies that belong to it.
pub const OF_BODIES: &str = ".rigid";
/// The batch script.
pub const BATCH: &str = "batch.sh";
/// The dump of frames, unless a variable says otherwise.
pub const FRAMES: &str = "frames.dump";
/// The dump of samples near outlets, likewise.
pub const ZONE: &str = "zone.dump";
/// The dump of pairs that touch, likewise.
pub const PAIRS: &str = "pairs.dump";
/// The dump of grains that touch planes, likewise.
pub const TOUCHES: &str = "touches.dump";
/// The dump of bonds that are whole, likewise.
pub const OF_BONDS: &str = "bonds.dump";
/// All dumps.
pub const DUMPS: [&str; 5] = [FRAMES, ZONE, PAIRS, TOUCHES, OF_BONDS];
/// What LAMMPS keeps its state in, in turn.
pub const STATES: [&str; 2] = ["state_1", "state_2"];
/// How a state that is whole ends, before a byte of zero.
pub const WHOLE: &str = "LammpS RestartT";
/// It says that the last step was reached.
pub const FINISHED: &str = "finished";
/// It is held while a process works in the folder.
pub const LOCK: &str = "lock";
/// Columns of frames and samples.
pub const COLUMNS: &str = "id x y z vx vy vz omegax omegay omegaz";
/// More columns of frames of a scene with bonds: how each grain has turned.
pub const TURNS: &str = " c_turned[1] c_turned[2] c_turned[3] c_turned[4]";

//! A run in progress: what it holds, what it writes, and what came of it.

use crate::checkpoint::Checkpoint;
use crate::earlier::Earlier;
use crate::fallen::Fallen;
use crate::frames::WallHead;
use crate::integration::IntegrationError;
use crate::schedule::Schedule;
use crate::servos::ServoHeld;
use crate::settling::Settling;
use crate::supply::Supply;
use dem::device::Device;
use dem::setup::Crossing;
use dem::{Halt, Simulation};
use record::StopCause;
use scene::Below;
use scene::keys::Output;
use serde::Serialize;
use stages::outlet::path::PathRow;
use std::io::Write;
use stream::mcap::{Provenance, StreamOptions, Writer};

/// What was done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Why the run was stopped, as its log has it.
    pub stopped: Option<String>,
    /// What stopped the run, and the sentence about it without its time.
    #[serde(skip)]
    pub stop: Option<(StopCause, String)>,
    /// The guard that has stopped it.
    #[serde(skip)]
    pub halt: Option<Halt>,
    /// Why the run ended before its last step: the grains have come to rest.
    pub settled: Option<String>,
    /// Time reached [s].
    pub time: f64,
    /// Time step [s].
    pub dt: f64,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub chosen_by: Option<String>,
    /// Steps done in this run.
    pub steps: u64,
    /// Frames written.
    pub frames: u64,
    /// Particles at the end.
    pub particles: usize,
    /// Particles that entered.
    pub entered: u64,
    /// Particles that crossed a storage plane.
    pub crossings: u64,
    /// Particles that went back through planes.
    pub returned: dem::Returned,
    /// Warnings about records that ended before the run.
    pub inflow: Vec<String>,
    /// Energy that the finite time step created, where the ledger is kept.
    pub integration: Option<IntegrationError>,
    /// How well servos held what they follow.
    pub servos: Vec<ServoHeld>,
    /// Contacts listed at the end.
    pub listed_contacts: usize,
    /// How often neighbour lists were rebuilt.
    pub listings: u64,
    /// Bonds at the start, and those that broke until the end.
    pub bonds: [usize; 2],
    /// Particles that sleep at the end.
    pub asleep: usize,
    /// Particles that have fallen past all walls.
    pub fallen: Option<Fallen>,
    /// Effects in force: name, pair, key.
    pub effects: Vec<String>,
    /// What made the steps, where this processor did not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
}

/// How a run is written.
pub struct Settings<W> {
    /// What made the run.
    pub provenance: Provenance,
    /// How its file is written.
    pub how: StreamOptions<W>,
    /// The state that it goes on from; `None`: t = 0.
    pub resume: Option<Checkpoint>,
    /// What the run that goes on has written, to be written again; `None`: the file begins with the checkpoint.
    pub earlier: Option<Earlier>,
    /// Whether the energy of each frame is computed for progress reports.
    pub watched: bool,
    /// Called between steps: whether the run is to end here, with a checkpoint.
    pub stop: fn() -> bool,
    /// What makes the steps; `None`: this processor.
    pub device: Option<Box<dyn Device>>,
}

/// What of a scene and its setup decides what is written.
pub(crate) struct Written {
    /// Text of the scene.
    pub scene: String,
    /// Role and SHA-256 of its inputs.
    pub inputs: Vec<(String, String)>,
    pub walls: Vec<WallHead>,
    /// Whether wall spheres move, so that they are written with every frame.
    pub walls_move: bool,
    pub outlets: bool,
    /// Masses of clumps at scale 1 [kg]; empty where the scene has no clump.
    pub masses: Vec<f64>,
    /// As the scene asks for it.
    pub output: Output,
    /// Whether forces on walls are written: as the scene asks for it, and where a wall has a servo.
    pub wall_forces: bool,
    /// Whether the sums of their spheres and triangles are.
    pub wear: bool,
    /// The periodic domain at the start, where a run cannot be read by its scene alone.
    pub domain: Option<[Option<(f64, f64)>; 3]>,
    /// How far walls reach, where particles can fall past them.
    pub below: Option<Below>,
    /// Steps between samples of paths, where any are recorded.
    pub sampling: Option<u64>,
    /// Whether the energy of each frame is computed for progress reports.
    pub watched: bool,
    /// Whether the energy ledger is kept.
    pub ledger: bool,
    /// At what the run ends before its last step.
    pub settling: Settling,
}

/// A state to go back to: what the sources had given, and the engine.
pub(crate) struct Before {
    pub given: Vec<u64>,
    pub state: dem::Checkpoint<'static>,
}

/// Energies of the frame that has just been written [J].
#[derive(Clone, Copy)]
pub(crate) struct FrameEnergy {
    pub kinetic: f64,
    /// Of the ledger, where it is kept.
    pub balance: Option<f64>,
}

/// A run in progress.
pub(crate) struct Run<W: Write> {
    pub sim: Simulation,
    pub supply: Supply,
    pub writer: Writer<W>,
    pub schedule: Schedule,
    pub written: Written,
    /// Step that the run began with.
    pub first: u64,
    /// Whether what is due in that step was written before the run was resumed.
    pub begins_written: bool,
    /// Whether what broke at that instant is in the file.
    pub cracks_told: bool,
    pub crossings: Vec<Crossing>,
    /// Step of the last sample of paths, or of the checkpoint that was resumed.
    pub sampled: Option<u64>,
    pub paths: Vec<PathRow>,
    pub outcome: Outcome,
    pub frame_energy: Option<FrameEnergy>,
    /// Most energy of motion and springs in a frame so far [J].
    pub peak: f64,
    /// The state when something was last written: a run whose numbers are lost is resumed from there.
    pub before: Option<Before>,
    /// When something was last written [s].
    pub saved_at: f64,
    pub checkpoints: u64,
}

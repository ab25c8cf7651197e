//! Reading: what the messages of a run say, frame by frame, and which frames a measure sees.

mod clumped;
mod frame;
pub mod path;
pub mod run;
mod scene_value;
pub mod selection;
pub mod settled;
pub(crate) mod table;
pub(crate) mod time_slice;
mod wall_record;

pub use frame::{Contact, Contacts, Crossing, Frame, Partner};
pub use run::{Ledger, Run, RunMessage, WallSpheres};
pub use selection::{Selected, Which};
pub use wall_record::{ForceOnWall, WallForces, WallMeans};

//! Measures of runs: heap angle, flow, profiles, segregation, energy, contacts, bonds, porosity, wall force, residence,
//! impacts, bed height, mean stress and strain.
//!
//! Each measure stands alone: it takes a [`Frame`] (columns at one time) or a table of contacts and gives a typed
//! result. An [`Observer`] does the same for a run that comes event by event (see [`Run::take`]), also while it is
//! still being written, in memory for a frame or two, and gives rows of numbers under named columns with units, a
//! [`Summary`] by name, and what to draw. Nothing here reads files, prints or draws.

pub mod ball;
pub mod bed;
pub mod bonds;
mod cells;
mod chord;
mod clumped;
pub mod coordination;
mod cubic;
pub mod cylinder;
pub mod domain;
pub mod energy;
mod error;
pub mod flow;
pub mod forces;
mod frame;
pub mod impact;
pub mod observer;
pub mod overview;
pub mod path;
pub mod periodic;
pub mod plane_force;
pub mod porosity;
pub mod profile;
pub mod radial;
pub mod region;
pub mod repose;
pub mod residence;
pub mod run;
pub mod segregation;
pub mod selection;
pub mod settling;
mod sheet;
pub mod statistics;
pub mod strain;
pub mod stress;
mod table;
pub mod track;
pub mod wall_force;
mod wall_record;
pub mod wear;

pub use bonds::{Bond, Bonds};
pub use error::MeasureError;
pub use frame::{Contact, Contacts, Crossing, Frame, Partner};
pub use observer::{Observer, OfFrame, PerFrame};
pub use run::{Ledger, Run, RunMessage, WallSpheres};
pub use selection::{Selected, Which};
pub use sheet::{Chart, Curve, Head, Look, Panel, Row, Summary};
pub use wall_record::{ForceOnWall, WallForces};

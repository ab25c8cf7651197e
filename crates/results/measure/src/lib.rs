//! Measures of runs: heap angle, flow, profiles, segregation, energy, contacts, bonds, porosity, wall force, residence,
//! impacts, bed height, mean stress and strain.
//!
//! Each measure stands alone: it takes a [`Frame`] (columns at one time) or a table of contacts and gives a typed
//! result. An [`Observer`] does the same for a run that comes event by event (see [`Run::take`]), also while it is
//! still being written, in memory for a frame or two, and gives rows of numbers under named columns with units, a
//! [`Summary`] by name, and what to draw. Nothing here reads files, prints or draws.

pub mod bonds;
mod bulk;
pub mod definition;
mod error;
mod geometry;
mod mechanics;
pub mod observer;
pub mod overview;
mod reading;
pub mod registry;
mod shape;
mod sheet;
pub mod statistics;
mod transport;
mod walls;

pub use bonds::{Bond, Bonds};
pub use bulk::{porosity, profile, segregation};
pub use error::MeasureError;
pub use geometry::{ball, cylinder, extent, periodic, region};
pub use mechanics::{coordination, domain, energy, fabric, forces, plane_force, settling, strain, stress};
pub use observer::{Observer, OfFrame, PerFrame};
pub use reading::{
    Contact, Contacts, Crossing, ForceOnWall, Frame, Ledger, Partner, Run, RunMessage, Selected, WallForces,
    WallMeans,
};
pub use reading::{WallSpheres, Which, path, run, selection, settled};
pub use shape::{bed, radial, repose};
pub use sheet::{Chart, Curve, Geometry, Head, Look, Panel, Row, Summary};
pub use transport::{flow, residence, track};
pub use walls::{impact, wall_force, wear};

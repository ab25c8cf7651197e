//! Where a scene is cut, and which stage is kept.

use dem::setup::{ZoneMotion, ZoneTest};
use geom::Plane;
use std::path::PathBuf;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Before the plane.
    Upstream,
    /// Behind it.
    Downstream,
}

impl Stage {
    /// The list of zones that the cut adds to.
    pub(super) fn zone(self) -> &'static str {
        match self {
            Stage::Upstream => "outlet",
            Stage::Downstream => "inlet",
        }
    }
}

/// Where a scene is cut.
#[derive(Debug, Clone)]
pub struct Cut {
    /// Its normal is the direction of flow.
    pub plane: Plane,
    /// Which stage is kept.
    pub keep: Stage,
    /// Length of the zone [m]; absent: "auto".
    pub length: Option<f64>,
    pub motion: ZoneMotion,
    /// Which point of a particle crosses its planes.
    pub test: ZoneTest,
    /// Folder that files of the new scene are relative to.
    pub folder: PathBuf,
}

//! All measures, once: what programs, options and documents tell of them is read from here.
//!
//! A measure is its file, which implements [`Measure`], and its line in [`ALL`]. From these come the options of `dem-measure`, with their
//! help and with the refusal of options that a measure does not take, and the names that `cost-curve` knows. The table of measures in the
//! documents is compared with them.

use crate::Observer;
use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure};

/// The line of a measure in [`ALL`].
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// [`Measure::NAME`].
    pub name: &'static str,
    /// [`Measure::HELP`].
    pub help: &'static str,
    /// [`Measure::ARGUMENT`].
    pub argument: ArgumentKind,
    /// [`Measure::FRAMES`].
    pub frames: Frames,
    /// [`Measure::OPTIONS`].
    pub options: &'static [&'static str],
    /// [`Measure::FIGURES`].
    pub figures: &'static [Figure],
    /// [`Measure::observer`].
    pub observer: fn(&Asked) -> Result<Box<dyn Observer>, AskError>,
}

const fn entry<M: Measure>() -> Entry {
    Entry {
        name: M::NAME,
        help: M::HELP,
        argument: M::ARGUMENT,
        frames: M::FRAMES,
        options: M::OPTIONS,
        figures: M::FIGURES,
        observer: M::observer,
    }
}

/// All measures, in the order of the help.
pub const ALL: &[Entry] = &[
    entry::<crate::repose::Repose>(),
    entry::<crate::flow::Flow>(),
    entry::<crate::profile::Profile>(),
    entry::<crate::radial::Radial>(),
    entry::<crate::segregation::Segregation>(),
    entry::<crate::energy::Energy>(),
    entry::<crate::settling::Settling>(),
    entry::<crate::domain::Domain>(),
    entry::<crate::coordination::ContactNumbers>(),
    entry::<crate::fabric::Fabric>(),
    entry::<crate::extent::Extent>(),
    entry::<crate::bonds::BondNumbers>(),
    entry::<crate::bonds::CrackList>(),
    entry::<crate::bonds::FragmentList>(),
    entry::<crate::bonds::Grading>(),
    entry::<crate::forces::Forces>(),
    entry::<crate::porosity::Porosity>(),
    entry::<crate::wall_force::WallForce>(),
    entry::<crate::stress::Stress>(),
    entry::<crate::strain::Strain>(),
    entry::<crate::plane_force::PlaneForce>(),
    entry::<crate::wear::Wear>(),
    entry::<crate::residence::Residence>(),
    entry::<crate::track::Track>(),
    entry::<crate::impact::Impacts>(),
    entry::<crate::bed::BedHeight>(),
    entry::<crate::bed::BedSlope>(),
];

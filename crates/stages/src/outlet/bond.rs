//! Bonds of what passes a storage plane, as a table: with whom, and all that makes the beam.
//!
//! Topic `/crossings/bonds`, written before the rows of `/crossings` that it belongs to. A row for each bond that was whole when a particle passed: `id`,
//! `partner`, the direction from `partner` to `id` when they were bonded (`axisx`…), `length` and `radius` of the beam [m], the springs `stretching` [N/m], `bending` and `torsion` [N·m/rad], `lag`
//! (dashpots over springs [s]), `tensile_strength` and `shear_strength` [Pa] (infinite: it never breaks); x y z is where the particle was. How particles have
//! turned since they were bonded is in their own rows. The record `bonds` says what all of them ask of a time step.
//!
//! In an inlet stream a row says that two are bonded who come in.

use crate::columns::Columns;
use crate::crossings::{Builder, number};
use crate::error::SceneError;
use dem::setup::{Crossing, EntryBonds, Link};
use geom::Vec3;
use std::collections::BTreeMap;
use stream::{Table, Values};

/// Topic of the bonds.
pub const LINKS: &str = "/crossings/bonds";
/// Name of the metadata record.
pub const BONDS: &str = "bonds";

/// One bond of a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linking {
    /// Passage time [s].
    pub time: f64,
    /// Where the particle was [m].
    pub place: Vec3,
    /// The bond.
    pub link: Link,
}

/// The bonds of a run's crossings.
pub(crate) fn of_crossings(crossings: &[Crossing]) -> Vec<Linking> {
    let of = |c: &Crossing| {
        let (time, place) = (c.time, c.particle.position);
        c.links.clone().into_iter().map(move |link| Linking { time, place, link })
    };
    crossings.iter().flat_map(of).collect()
}

/// The table of the topic.
pub fn to_table(rows: &[Linking]) -> Table {
    let number = |of: fn(&Link) -> f64| rows.iter().map(move |r| of(&r.link));
    let whose = |of: fn(&Link) -> u32| Values::U32(rows.iter().map(|r| of(&r.link)).collect());
    Builder::new(rows.len())
        .vectors(["x", "y", "z"], rows, |r| r.place)
        .f64("time", rows.iter().map(|r| r.time))
        .with("id", whose(|l| l.id))
        .with("partner", whose(|l| l.partner))
        .vectors(["axisx", "axisy", "axisz"], rows, |r| r.link.axis)
        .f64("length", number(|l| l.size[0]))
        .f64("radius", number(|l| l.size[1]))
        .f64("stretching", number(|l| l.springs[0]))
        .f64("bending", number(|l| l.springs[1]))
        .f64("torsion", number(|l| l.springs[2]))
        .f64("lag", number(|l| l.lag))
        .f64("tensile_strength", number(|l| l.strength[0]))
        .f64("shear_strength", number(|l| l.strength[1]))
        .0
}

/// The bonds of a table.
///
/// # Errors
/// Columns that are missing or wrong.
pub fn from_table(stream: &str, table: &Table) -> Result<Vec<Linking>, SceneError> {
    let columns = Columns { name: stream, table };
    let cure = "run stage-replay again";
    let need = |column: &str| {
        let found = columns.indices(column, f64::from(u32::MAX - 1))?;
        found.ok_or_else(|| SceneError::file(stream, format!("the column '{column}' is missing"), cure))
    };
    let (ids, partners) = (need("id")?, need("partner")?);
    let (times, places) = (columns.numbers("time")?, columns.vectors(["x", "y", "z"])?);
    let axes = columns.vectors(["axisx", "axisy", "axisz"])?;
    let (length, radius, lag) =
        (columns.numbers("length")?, columns.numbers("radius")?, columns.numbers("lag")?);
    let springs = columns.vectors(["stretching", "bending", "torsion"])?;
    let strength = |column: &str| {
        // Infinite ones never break.
        let found = columns.optional(column).filter(|all| all.iter().all(|s| *s > 0.0));
        let why = || format!("the column '{column}' is missing, or has a strength that is not above 0");
        found.ok_or_else(|| SceneError::file(stream, why(), cure))
    };
    let (tension, shears) = (strength("tensile_strength")?, strength("shear_strength")?);
    let row = |k: usize| {
        let link = Link {
            id: ids[k],
            partner: partners[k],
            axis: axes[k],
            size: [length[k], radius[k]],
            springs: springs[k].into(),
            lag: lag[k],
            strength: [tension[k], shears[k]],
        };
        let sound = (link.axis.norm() - 1.0).abs() < 1e-9
            && link.size.iter().chain(&link.springs).all(|x| *x > 0.0)
            && link.lag >= 0.0
            && link.id != link.partner;
        if sound {
            return Ok(Linking { time: times[k], place: places[k], link });
        }
        let why = format!(
            "row {k} of {LINKS}: a bond of {} and {} with an axis of length {}, length and radius {:?} m, springs {:?}, lag {} s",
            link.id,
            link.partner,
            link.axis.norm(),
            link.size,
            link.springs,
            link.lag
        );
        Err(SceneError::file(stream, why, cure))
    };
    (0..ids.len()).map(row).collect()
}

/// The record of what may come.
pub(crate) fn to_map(bonds: &EntryBonds) -> BTreeMap<String, String> {
    let one = |key: &str, x: f64| (key.to_owned(), x.to_string());
    BTreeMap::from([one("step", bonds.step), one("longest", bonds.longest)])
}

/// From the record.
///
/// # Errors
/// A key that is missing or no positive number.
pub(crate) fn from_map(stream: &str, map: &BTreeMap<String, String>) -> Result<EntryBonds, SceneError> {
    let positive = |key: &str| number(stream, BONDS, map, key);
    Ok(EntryBonds { step: positive("step")?, longest: positive("longest")? })
}

//! What a run says of itself before its first message: what an inlet stream needs of it.

use super::{REPLAY, Replay};
use crate::clump_info::{self, ClumpInfo};
use crate::crossings::{SIZES, Sizes};
use crate::error::SceneError;
use crate::gate::Gate;
use crate::inlet::INLET;
use crate::links::BONDS;
use crate::material_info::MATERIALS;
use crate::run::{CLUMPS, OUTLETS};
use dem::setup::{Zone, ZoneMotion};
use geom::Shown;
use std::collections::BTreeMap;
use std::io::Write;
use stream::mcap::{McapError, Writer};

pub struct Head {
    pub materials: BTreeMap<String, String>,
    /// The record of the sizes, as it is passed on.
    pub sizes_record: BTreeMap<String, String>,
    /// Radius of the widest that may come [m], of clumps that of the sphere which holds them.
    pub widest: f64,
    /// Shapes of clumps: the record, or an empty one.
    pub clumps_record: BTreeMap<String, String>,
    /// How many spheres each has.
    pub members: Vec<u32>,
    /// What bonds may come: the record, or an empty one.
    pub bonds_record: BTreeMap<String, String>,
    /// Where grains come in.
    pub gate: Gate,
}

impl Head {
    /// Writes what a stream says of itself.
    pub fn write<W: Write>(&self, what: &Replay, writer: &mut Writer<W>) -> Result<(), McapError> {
        writer.metadata(MATERIALS, self.materials.clone())?;
        writer.metadata(SIZES, self.sizes_record.clone())?;
        if !self.clumps_record.is_empty() {
            writer.metadata(CLUMPS, self.clumps_record.clone())?;
        }
        if !self.bonds_record.is_empty() {
            writer.metadata(BONDS, self.bonds_record.clone())?;
        }
        writer.metadata(REPLAY, what.to_map())?;
        // The last record: from it on, messages may come as late as a run upstream makes them.
        writer.metadata(INLET, self.gate.to_map())
    }
}

/// From the metadata of a run.
pub fn head(
    name: &str,
    mut records: BTreeMap<String, BTreeMap<String, String>>,
    what: &Replay,
) -> Result<Head, SceneError> {
    let no_run = |record: &str| {
        let why = format!("has no record '{record}' before its first message");
        SceneError::file(name, why, "give a run that dem-run wrote")
    };
    if records.contains_key(INLET) {
        let why = "is an inlet already, that stage-replay made";
        return Err(SceneError::file(name, why, "give it to dem-run, or give the run that it was made of"));
    }
    if !records.contains_key(crate::input::SCENE) {
        return Err(no_run(crate::input::SCENE));
    }
    let Some(outlets) = records.remove(OUTLETS) else {
        let why = "is a run without [[outlet]], so that nothing was recorded";
        return Err(SceneError::file(name, why, "make its scene with stage-split --keep upstream"));
    };
    let Some(json) = outlets.get(&what.outlet.to_string()) else {
        let why = format!("has {} outlets, none with index {}", outlets.len(), what.outlet);
        return Err(SceneError::file(name, why, "--outlet 0 is the first"));
    };
    let wrong = |e| SceneError::file(name, format!("record '{OUTLETS}': {e}"), "run dem-run again");
    let recorded: Gate = serde_json::from_str(json).map_err(wrong)?;
    let sizes_record = records.remove(SIZES).ok_or_else(|| no_run(SIZES))?;
    let sizes = Sizes::from_map(name, &sizes_record)?;
    let clumps_record = records.remove(CLUMPS).unwrap_or_default();
    let clumps = clump_info::from_map(name, &clumps_record)?;
    let widest = clumps.iter().map(ClumpInfo::reach).fold(sizes.largest, f64::max);
    let members = clumps.iter().map(|c| c.spheres.len() as u32).collect();
    let zone = Zone {
        plane: what
            .at
            .unwrap_or_else(|| what.frame.map_or(recorded.zone.plane, |f| f.plane(&recorded.zone.plane))),
        length: what.length.unwrap_or(recorded.zone.length),
        motion: what.motion.unwrap_or(recorded.zone.motion),
        test: recorded.zone.test,
    };
    if zone.motion == ZoneMotion::Recorded {
        if recorded.zone.motion != ZoneMotion::Recorded {
            let why = "has no paths, which --move recorded follows";
            return Err(SceneError::file(
                name,
                why,
                "run the stage upstream with motion = \"recorded\" in its [[outlet]]",
            ));
        }
        if let Some(option) = what.off_path() {
            let why = format!("{option} does not go with recorded paths");
            return Err(SceneError::file(name, why, "leave it out, or use --move constant or ballistic"));
        }
    }
    if zone.motion == ZoneMotion::Ballistic && recorded.gravity.is_none() {
        let why = "does not tell its gravity, which --move ballistic needs";
        return Err(SceneError::file(name, why, "run the stage upstream again with this version"));
    }
    if zone.length.is_nan() || zone.length <= 2.0 * widest {
        let why = format!(
            "--length {} m is not above the largest diameter, {} m",
            Shown(zone.length),
            Shown(2.0 * widest)
        );
        return Err(SceneError::file(name, why, format!("use at least {} m", Shown(2.4 * widest))));
    }
    let materials = records.remove(MATERIALS).ok_or_else(|| no_run(MATERIALS))?;
    let bonds_record = records.remove(BONDS).unwrap_or_default();
    let gate = Gate { zone, ..recorded };
    Ok(Head { materials, sizes_record, widest, clumps_record, members, bonds_record, gate })
}

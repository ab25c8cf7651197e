//! The metadata records of a run that an inlet stream passes on.

use super::{Passage, Replay};
use dem::setup::{Zone, ZoneMotion};
use geom::{Shown, Vec3};
use record::metadata::{BONDS, CLUMPS, INLET, MATERIALS, OUTLETS, REPLAY, SCENE, SIZES, TIME};
use record::{ClumpRecord, Map, RunTimes, Sizes};
use scene::input::ZoneRecord;
use scene::{Result, SceneError};
use std::collections::BTreeMap;
use std::io::Write;
use stream::mcap::{McapError, Writer};

pub struct Head {
    pub materials: Map,
    /// The record of the sizes.
    pub sizes: Map,
    /// Radius of the widest particle that may come [m]; of clumps that of the sphere which holds them.
    pub widest: f64,
    /// The record of clumps, or an empty one.
    pub clumps: Map,
    /// Number of spheres of each shape.
    pub members: Vec<u32>,
    /// The record of bonds, or an empty one.
    pub bonds: Map,
    /// The zone of the inlet.
    pub zone: ZoneRecord,
    /// Time step of the run [s], where passages are counted in steps.
    pub step: f64,
}

impl Head {
    /// Writes the records.
    pub fn write<W: Write>(&self, what: &Replay, writer: &mut Writer<W>) -> Result<(), McapError> {
        writer.metadata(MATERIALS, self.materials.clone())?;
        writer.metadata(SIZES, self.sizes.clone())?;
        if !self.clumps.is_empty() {
            writer.metadata(CLUMPS, self.clumps.clone())?;
        }
        if !self.bonds.is_empty() {
            writer.metadata(BONDS, self.bonds.clone())?;
        }
        writer.metadata(REPLAY, what.to_map())?;
        // The last record: messages after it may come as late as a run upstream makes them.
        writer.metadata(INLET, self.zone.to_map())
    }

    /// Acceleration of particles in the zone [m/s²].
    pub fn acceleration(&self) -> Vec3 {
        self.zone.zone.acceleration(&self.zone.gravity.unwrap_or_default())
    }

    /// From the metadata of a run.
    ///
    /// # Errors
    /// A stream that is not a run with this outlet, options that do not go with it.
    pub fn new(name: &str, mut records: BTreeMap<String, Map>, what: &Replay) -> Result<Head> {
        let no_run = |record: &str| {
            let why = format!("has no record '{record}' before its first message");
            SceneError::file(name, why, "give a run that dem-run wrote")
        };
        if records.contains_key(INLET) {
            let why = "is an inlet already, that stage-replay made";
            let cure = "give it to dem-run, or give the run that it was made from";
            return Err(SceneError::file(name, why, cure));
        }
        if !records.contains_key(SCENE) {
            return Err(no_run(SCENE));
        }
        let recorded = outlet(name, records.remove(OUTLETS), what.outlet)?;
        let sizes = records.remove(SIZES).ok_or_else(|| no_run(SIZES))?;
        let clumps = records.remove(CLUMPS).unwrap_or_default();
        let shapes = ClumpRecord::from_map(name, &clumps)?;
        let largest = Sizes::from_map(name, &sizes)?.largest;
        let widest = shapes.iter().map(ClumpRecord::reach).fold(largest, f64::max);
        let members = shapes.iter().map(|c| c.spheres.len() as u32).collect();
        let zone = zone(name, &recorded, what, widest)?;
        let materials = records.remove(MATERIALS).ok_or_else(|| no_run(MATERIALS))?;
        let bonds = records.remove(BONDS).unwrap_or_default();
        let zone = ZoneRecord { zone, ..recorded };
        let step = match what.passage {
            Passage::Time => 0.0,
            Passage::Steps => step(name, records.remove(TIME))?,
        };
        Ok(Head { materials, sizes, widest, clumps, members, bonds, zone, step })
    }
}

/// The time step of a run [s].
fn step(name: &str, times: Option<Map>) -> Result<f64> {
    let dt = times.and_then(|map| RunTimes::read(&map).dt).filter(|dt| *dt > 0.0 && dt.is_finite());
    dt.ok_or_else(|| {
        let cure = "leave --passage steps out, or run the upstream stage again";
        SceneError::file(name, "has no record of its time step, which --passage steps counts", cure)
    })
}

/// The outlet of a run with this index.
fn outlet(name: &str, outlets: Option<Map>, index: u16) -> Result<ZoneRecord> {
    let Some(outlets) = outlets else {
        let why = "is a run without [[outlet]]: it has no recorded crossings";
        return Err(SceneError::file(name, why, "make its scene with stage-split --keep upstream"));
    };
    let Some(json) = outlets.get(&index.to_string()) else {
        let why = format!("has {}, none with index {index}", geom::counted(outlets.len(), "outlet"));
        return Err(SceneError::file(name, why, "--outlet 0 is the first"));
    };
    let wrong = |e| SceneError::file(name, format!("record '{OUTLETS}': {e}"), "run dem-run again");
    serde_json::from_str(json).map_err(wrong)
}

/// The zone of the inlet: that of the outlet, with the changes that are asked for.
fn zone(name: &str, recorded: &ZoneRecord, what: &Replay, widest: f64) -> Result<Zone> {
    let plane = what.frame.map_or(recorded.zone.plane, |f| f.plane(&recorded.zone.plane));
    let zone = Zone {
        plane: what.at.unwrap_or(plane),
        length: what.length.unwrap_or(recorded.zone.length),
        motion: what.motion.unwrap_or(recorded.zone.motion),
        test: recorded.zone.test,
        when_blocked: None,
    };
    let refuse = |why: String, cure: String| Err(SceneError::file(name, why, cure));
    if zone.motion == ZoneMotion::Recorded {
        if recorded.zone.motion != ZoneMotion::Recorded {
            let cure = "run the upstream stage with motion = \"recorded\" in its [[outlet]]";
            return refuse("has no paths, which --move recorded follows".into(), cure.into());
        }
        if let Some(option) = what.off_path() {
            let cure = "leave it out, or use --move constant or ballistic";
            return refuse(format!("{option} does not work with recorded paths"), cure.into());
        }
    }
    if zone.motion == ZoneMotion::Ballistic && recorded.gravity.is_none() {
        let why = "has no record of its gravity, which --move ballistic needs";
        return refuse(why.into(), "run the upstream stage again with this version".into());
    }
    if zone.length.is_nan() || zone.length <= 2.0 * widest {
        let (length, largest) = (Shown(zone.length), Shown(2.0 * widest));
        let why = format!("--length {length} m is not above the largest diameter, {largest} m");
        return refuse(why, format!("use at least {} m", Shown(2.4 * widest)));
    }
    Ok(zone)
}

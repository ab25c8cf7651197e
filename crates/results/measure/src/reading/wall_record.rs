//! The force on each wall at one time, and means over the steps since the time before, as a run records them (topic `/wall_forces`).

use crate::MeasureError;
use geom::Vec3;
use record::topic::WALL_FORCES;
use serde_json::Value;

/// The force of the grains on one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceOnWall {
    pub name: String,
    /// The force [N].
    pub force: Vec3,
    /// Number of contacts that carry a force.
    pub contacts: u64,
    /// How far it has moved since the start [m]; `None` where the run does not tell.
    pub shift: Option<Vec3>,
    /// What grains did to it since the message before; `None` where the run does not tell.
    pub means: Option<WallMeans>,
}

/// What grains did to a wall in an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallMeans {
    /// Mean force [N].
    pub force: Vec3,
    /// Largest force at an instant [N].
    pub largest: f64,
    /// Mean of the sum of normal forces [N].
    pub normal: f64,
    /// Mean torque [N·m].
    pub torque: Vec3,
    /// Mean power [W].
    pub power: f64,
    /// Grains that came to touch it.
    pub impacts: f64,
    /// Energy of their approach [J].
    pub impact_energy: f64,
    /// Sliding work [J]; NaN without the ledger.
    pub sliding_work: f64,
}

impl WallMeans {
    /// Of a wall in a message that has them.
    fn read(wall: &Value) -> Option<WallMeans> {
        let number = |key: &str| wall[key].as_f64().filter(|x| x.is_finite());
        let energy = |k: usize| wall["impact_energy"][k].as_f64().filter(|x| x.is_finite());
        Some(WallMeans {
            force: vector(&wall["mean_force"])?,
            largest: number("largest_force")?,
            normal: number("mean_normal")?,
            torque: vector(&wall["mean_torque"])?,
            power: number("mean_power")?,
            impacts: number("impacts")?,
            impact_energy: energy(0)? + energy(1)?,
            sliding_work: number("sliding_work").unwrap_or(f64::NAN),
        })
    }
}

/// The forces on all walls at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct WallForces {
    /// Time [s].
    pub time: f64,
    /// Time since the message before [s]; `None` where the run has no means.
    pub interval: Option<f64>,
    /// By index.
    pub walls: Vec<ForceOnWall>,
}

impl WallForces {
    /// From a message; `time` [s] is used where it names none.
    ///
    /// # Errors
    /// A message that is no JSON, or lacks walls, a name or a finite force.
    pub fn new(time: f64, data: &[u8]) -> Result<WallForces, MeasureError> {
        let wrong = |why: String| MeasureError::Message { topic: WALL_FORCES.to_owned(), time, why };
        let message: Value = serde_json::from_slice(data).map_err(|e| wrong(e.to_string()))?;
        let rows = message["walls"].as_array().ok_or_else(|| wrong("its 'walls' are missing".to_owned()))?;
        let row = |(k, w): (usize, &Value)| {
            let force = vector(&w["force"]);
            let force = force.ok_or_else(|| wrong(format!("wall {k} has no force of three numbers")))?;
            let name = w["name"].as_str().map_or_else(|| k.to_string(), str::to_owned);
            let contacts = w["contacts"].as_u64().unwrap_or(0);
            Ok(ForceOnWall { name, force, contacts, shift: vector(&w["shift"]), means: WallMeans::read(w) })
        };
        let walls = rows.iter().enumerate().map(row).collect::<Result<_, _>>()?;
        let interval = message["interval"].as_f64().filter(|length| length.is_finite() && *length >= 0.0);
        Ok(WallForces { time: message["time"].as_f64().unwrap_or(time), interval, walls })
    }
}

/// Three finite numbers.
fn vector(json: &Value) -> Option<Vec3> {
    let component = |k: usize| json[k].as_f64().filter(|x| x.is_finite());
    Some(Vec3::new(component(0)?, component(1)?, component(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_without_walls_or_with_a_broken_force_is_refused() {
        let read = |text: &str| WallForces::new(0.5, text.as_bytes());
        let good =
            read(r#"{"time": 0.25, "walls": [{"name": "lid", "force": [0, 1, -2.5], "contacts": 3}]}"#);
        let lid = ForceOnWall {
            name: "lid".to_owned(),
            force: Vec3::new(0.0, 1.0, -2.5),
            contacts: 3,
            shift: None,
            means: None,
        };
        assert_eq!(good, Ok(WallForces { time: 0.25, interval: None, walls: vec![lid] }));
        for text in [
            "",
            "[]",
            r#"{"walls": 3}"#,
            r#"{"walls": [{"force": [0, 1]}]}"#,
            r#"{"walls": [{"force": [0, 1, null]}]}"#,
        ] {
            assert!(matches!(read(text), Err(MeasureError::Message { .. })), "{text}");
        }
    }
}

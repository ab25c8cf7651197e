//! The tests, one file each.
//!
//! A test says which scenes it needs and how their tables become a curve; [`crate::lab`] runs them.

mod boxes;
mod crush;
mod direct_shear;
mod drum;
mod heap;
mod list;
mod oedometer;
mod plates;
mod repose;
mod sectors;
mod text;
mod triaxial;
mod triaxial_periodic;
mod uniaxial;

pub use list::{ALL, find};

use crate::composing::compose::number;
use crate::curves::room::Room;
use crate::error::{LabError, Result};
use crate::request::{Request, Specimen};
use crate::running::chain::Chain;
use crate::sample::Sample;
use crate::series::{Curve, Series, residual, smoothed};
use geom::Vec3;
use std::collections::BTreeMap;
use text::{around, cylinder, damping, output, plane, pressing, rectangle, servo, translate, triangle, wall};

/// What the stresses of a test are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stresses {
    /// One specimen for each.
    Each,
    /// One specimen follows all of them, in their order.
    Path,
    /// One, under which the specimen is prepared.
    Preparation,
    /// The test has none.
    None,
}

/// One specimen: its stress, or the stresses that it follows, and its seed.
#[derive(Debug, Clone)]
pub struct Loading {
    /// Stress, or first stress [Pa]; 0 without any.
    pub stress: f64,
    /// All stresses that it follows [Pa].
    pub path: Vec<f64>,
    /// Seed of its grains.
    pub seed: u64,
}

/// A scene's part that a test adds to its sample.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// End of the run [s].
    pub until: f64,
    /// Whether the run ends when the grains rest.
    pub to_rest: bool,
    /// Sections.
    pub text: String,
    /// Files that the scene names: name and text.
    pub files: Vec<(String, String)>,
    /// Whether grains that are there keep their bonds.
    pub bonds: bool,
    /// Another source of the grains than the sample's, or the prepared ones.
    pub grains: Option<String>,
    /// How the grains are poured in, where they are not there at the start.
    pub pour: Option<Pour>,
}

/// Grains that are poured in during a test.
#[derive(Debug, Clone)]
pub struct Pour {
    /// Where from, as a shape.
    pub shape: String,
    /// Downward speed [m/s].
    pub speed: f64,
    /// Mass rate [kg/s].
    pub rate: f64,
}

/// What is known when the preparation has ended.
#[derive(Debug, Clone, Default)]
pub struct Prepared {
    /// How far each wall has moved [m].
    pub shifts: BTreeMap<String, Vec3>,
}

/// What the scenes of one specimen depend on.
pub struct Context<'a> {
    pub sample: &'a Sample,
    /// What is asked for.
    pub request: &'a Request,
    /// Stress and seed.
    pub loading: &'a Loading,
    /// Its space.
    pub specimen: &'a Specimen,
}

/// Tables of a test by name, and how a value of a wall is found in them.
pub struct Tables(pub(crate) BTreeMap<&'static str, Series>);

/// A number that a curve comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    pub name: &'static str,
    /// Its unit; "" for none.
    pub unit: &'static str,
    /// The number; NaN where the curve has none.
    pub value: f64,
}

/// A test.
pub trait Recipe: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// What stresses are for, and those that are used where none is given [Pa].
    fn stresses(&self) -> (Stresses, &'static [f64]);

    /// Lengths of the specimen over each other, and the share of the box that it fills.
    fn proportions(&self) -> ([f64; 3], f64);

    /// The space that is filled, as a shape: the box of the specimen.
    fn space(&self, of: &Context) -> String {
        let specimen = of.specimen;
        let [a, b, c] = [specimen.low.x, specimen.low.y, specimen.low.z].map(number);
        let [x, y, z] = [specimen.high.x, specimen.high.y, specimen.high.z].map(number);
        format!("box:{a},{b},{c},{x},{y},{z}")
    }

    /// Whether the preparation presses the loose grains together from all sides, not from above.
    fn is_pressed_all_round(&self) -> bool {
        false
    }

    /// Sliding friction during the preparation where the user gives none [–]; `None`: that of the sample.
    fn friction(&self) -> Option<f64> {
        None
    }

    /// Least restitution of a preparation with the test's local damping [–]: a lower one shortens the step, and that damping stops the grains.
    fn restitution(&self) -> f64 {
        0.0
    }

    /// Mean unbalanced over mean contact force of a prepared specimen where the user gives none [–].
    fn rest(&self) -> f64 {
        1e-4
    }

    /// Whether a seed changes a specimen.
    fn is_random(&self, sample: &Sample) -> bool {
        sample.is_random()
    }

    /// Refuses samples and options that do not fit.
    ///
    /// # Errors
    /// A sample that the test cannot take, an option that it does not use.
    fn check(&self, sample: &Sample, request: &Request) -> Result<()>;

    /// The preparation; `None` where the grains are taken as they are.
    ///
    /// # Errors
    /// A specimen that cannot be prepared.
    fn preparation(&self, of: &Context) -> Result<Option<Part>>;

    /// Walls of the preparation of which the test needs to know where they are.
    fn placed(&self) -> &'static [&'static str] {
        &[]
    }

    /// The test.
    ///
    /// # Errors
    /// A specimen that cannot be tested.
    fn test(&self, of: &Context, prepared: &Prepared) -> Result<Part>;

    /// Tables that the curve needs: name, and options of dem-measure.
    fn tables(&self, of: &Context, prepared: &Prepared) -> Vec<(&'static str, Vec<String>)>;

    /// The curve.
    ///
    /// # Errors
    /// Tables without the columns.
    fn curve(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Curve>;

    /// Size of the specimen in each row of the curve; `None`: no walls bound it.
    ///
    /// # Errors
    /// Tables without the columns.
    fn room(&self, _: &Context, _: &Prepared, _: &Tables) -> Result<Option<Room>> {
        Ok(None)
    }

    /// The SHAPE that holds all contacts of a bounded specimen, and its volume [m³]; without volume: that of the specimen. `None`: no walls bound it.
    fn measured(&self, _: &Context) -> Option<(String, Option<f64>)> {
        None
    }

    /// How far the specimen is sheared in each row [–]: axial strain, or displacement over the band that shears. `None`: the test does not tell.
    fn sheared(&self, _: &Context, _: &Curve) -> Option<Vec<f64>> {
        None
    }

    /// Column of the curve whose largest value is the peak of the test.
    fn peak(&self) -> Option<&'static str> {
        None
    }

    /// Grains of a specimen, where neither number nor size is given.
    fn grains(&self) -> u64 {
        GRAINS
    }

    /// What the curve comes to.
    fn values(&self, of: &Context, curve: &Curve) -> Vec<Value>;

    /// What the user should know of the curve.
    fn warnings(&self, _: &Context, _: &Curve) -> Vec<String> {
        Vec::new()
    }

    /// Axes of the plot: column along x, columns along y.
    fn axes(&self) -> (&'static str, &'static [&'static str]);

    /// The angles of the envelope over several stresses: normal and shear stress of a Mohr circle's top, or of a plane, by their values.
    fn envelope(&self) -> Option<Envelope> {
        None
    }
}

/// How an envelope is found from values over several stresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Envelope {
    /// τ = c + σ tan φ, of `normal stress at …` and `… shear stress`.
    Plane,
    /// q/2 = c cos φ + (σ1 + σ3)/2 sin φ, of the tops of Mohr's circles.
    Circles,
}

/// Grains of a specimen whose size is not given.
const GRAINS: u64 = 2000;

/// Rows of a curve, where the user does not say.
pub const ROWS: u64 = 200;

/// Refuses samples whose grains cannot fall into a heap or a drum.
fn falls(test: &str, sample: &Sample, request: &Request) -> Result<()> {
    let speed = "grains fall at their own speed (--speed is that of the wall or the stream)";
    unused(request.inertial.is_some(), "--inertial", test, speed)?;
    let wrong = |what, cure: &str| Err(sample.refusal(what, cure));
    if sample.is_packed() {
        return wrong("has [[particles]]", &format!("{test} pours its own grains: give a [[fill]]"));
    }
    if !sample.grains.falls_down {
        return wrong("has no gravity along −z", "give gravity = [0, 0, -9.81]");
    }
    if sample.has("local_damping") {
        return wrong("has [local_damping]", "take it out: it would hold grains that roll down");
    }
    Ok(())
}

/// Refuses another size than a diameter, which the amount of grains follows from.
fn one_length(test: &str, request: &Request) -> Result<()> {
    match request.size.as_ref().map_or(1, Vec::len) {
        1 => Ok(()),
        n => Err(LabError::Usage(format!("--size has {n} lengths: {test} takes one, the diameter"))),
    }
}

/// Forces on one wall, and how far it has moved.
fn force_on(wall: &str) -> Vec<String> {
    ["--wall-force", "all", "--instants", "--wall", wall].map(str::to_owned).to_vec()
}

/// Cracks, where there are bonds.
fn cracks(sample: &Sample) -> Vec<(&'static str, Vec<String>)> {
    if sample.has("bond") { vec![("cracks", vec!["--cracks".to_owned()])] } else { Vec::new() }
}

impl Tables {
    /// A column of a table.
    pub(crate) fn column(&self, table: &str, column: &str) -> Result<Vec<f64>> {
        match self.0.get(table) {
            Some(series) => series.column(column),
            None => Err(LabError::Usage(format!("there is no table {table}"))),
        }
    }

    /// The same for the sum of several tables.
    fn sum(&self, tables: &[&str], column: &str) -> Result<Vec<f64>> {
        let all = tables.iter().map(|table| self.column(table, column)).collect::<Result<Vec<_>>>()?;
        Ok((0..all[0].len()).map(|row| all.iter().map(|values| values[row]).sum()).collect())
    }

    /// Adds the number of cracks, where there are bonds.
    fn finish(&self, curve: Curve, times: &[f64]) -> Result<Curve> {
        if !self.0.contains_key("cracks") {
            return Ok(curve);
        }
        let broken = self.column("cracks", "time")?;
        let until = |t: &f64| broken.iter().filter(|crack| *crack <= t).count() as f64;
        Ok(curve.with("cracks", "", times.iter().map(until).collect()))
    }
}

/// Refuses an option that a test does not use.
fn unused(given: bool, option: &str, test: &str, why: &str) -> Result<()> {
    if given {
        Err(LabError::Usage(format!("{option} has no effect on {test}: {why}: leave it out")))
    } else {
        Ok(())
    }
}

impl Chain<'_> {
    /// All tables of a test.
    pub(crate) fn tables(&self, tables: &[(&'static str, Vec<String>)]) -> Result<Tables> {
        let measured = tables.iter().map(|(name, options)| {
            let options: Vec<&str> = options.iter().map(String::as_str).collect();
            Ok((*name, self.measure("test", &format!("{name}.csv"), &options)?))
        });
        Ok(Tables(measured.collect::<Result<_>>()?))
    }
}

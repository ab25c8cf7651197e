//! The tests, one file each.
//!
//! A test says which scenes it needs and how their tables become a curve; [`crate::lab`] runs them.

mod boxes;
mod crush;
mod direct_shear;
mod oedometer;
mod repose;
mod triaxial;
mod triaxial_periodic;
mod uniaxial;

use crate::chain::Chain;
use crate::compose::number;
use crate::error::{LabError, Result};
use crate::request::{Request, Specimen};
use crate::sample::Sample;
use crate::series::{Curve, Series, smooth};
use geom::Vec3;
use std::collections::BTreeMap;

/// All tests.
pub const ALL: [&dyn Recipe; 7] = [
    &direct_shear::DirectShear,
    &uniaxial::Uniaxial,
    &triaxial::Triaxial,
    &triaxial_periodic::TriaxialPeriodic,
    &oedometer::Oedometer,
    &repose::Repose,
    &crush::Crush,
];

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
}

/// What is known when the preparation has ended.
#[derive(Debug, Clone, Default)]
pub struct Prepared {
    /// How far each wall has moved [m].
    pub shifts: BTreeMap<String, Vec3>,
}

/// What the scenes of one specimen depend on.
pub struct Context<'a> {
    /// The sample.
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
    /// Its name.
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

    /// Whether the preparation presses the loose grains together from all sides, not from above.
    fn is_pressed_all_round(&self) -> bool {
        false
    }

    /// Sliding friction during the preparation where the user gives none [–]; `None`: that of the sample.
    fn friction(&self) -> Option<f64> {
        None
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

    /// What the curve comes to.
    fn values(&self, of: &Context, curve: &Curve) -> Vec<Value>;

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

/// The test of a name.
pub fn find(name: &str) -> Option<&'static dyn Recipe> {
    ALL.into_iter().find(|recipe| recipe.name() == name)
}

/// Rows of a curve, where the user does not say.
pub const ROWS: u64 = 200;
/// Share of the end of a curve that is its residual [–].
const RESIDUAL: f64 = 0.2;

/// A wall as text.
fn wall(name: &str, shape: &str, material: &str, more: &str) -> String {
    format!("[[wall]]\nname = \"{name}\"\n{shape}\nmaterial = \"{material}\"\n{more}\n")
}

/// The shape of a wall that is a plane: point and normal.
fn plane(point: Vec3, normal: [i8; 3]) -> String {
    let [x, y, z] = [point.x, point.y, point.z].map(number);
    let [a, b, c] = normal;
    format!("plane = \"{x},{y},{z},{a},{b},{c}\"")
}

/// What every run writes.
fn output(until: f64, rows: u64) -> String {
    let every = number(until / rows as f64);
    format!("[output]\nevery = {every}\nwall_forces = true\nprecision = \"f64\"\n\n")
}

/// The servo of a wall that presses along a direction.
fn servo(direction: [i8; 3], stress: &str, area: &str, limit: f64) -> String {
    let [x, y, z] = direction;
    format!("servo = {{ direction = [{x}, {y}, {z}], {stress}, {area}, speed_limit = {} }}\n", number(limit))
}

/// The servo of a lid that presses down with a stress [Pa] on an area [m²].
fn pressing(stress: f64, area: f64, limit: f64) -> String {
    let [stress, area] = [stress, area].map(number);
    servo([0, 0, -1], &format!("stress = {stress}"), &format!("area = {area}"), limit)
}

/// A motion at a constant velocity that begins smoothly.
fn translate(velocity: Vec3, ramp: f64) -> String {
    let [x, y, z] = [velocity.x, velocity.y, velocity.z].map(number);
    format!("motion = {{ translate = [{x}, {y}, {z}], ramp = {} }}\n", number(ramp))
}

/// Triangles of four corners, a line each.
fn rectangle(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> String {
    let line = |corners: [[f64; 3]; 3]| {
        let words: Vec<String> = corners.iter().flatten().map(|x| number(*x)).collect();
        words.join(" ") + "\n"
    };
    line([a, b, c]) + &line([a, c, d])
}

/// Local damping for the preparation: it stops the specimen as a whole, too, which hardly has unbalanced forces. Clumps and samples with damping of
/// their own get none.
fn damping(sample: &Sample) -> &'static str {
    if sample.has("local_damping") { "" } else { "[local_damping]\nfactor = 0.7\n\n" }
}

/// Forces on one wall, and how far it has moved.
fn force_on(wall: &str) -> Vec<String> {
    ["--wall-force", "all", "--wall", wall].map(str::to_owned).to_vec()
}

/// Tables of every test of grains: coordination, and cracks where there are bonds.
fn common(sample: &Sample) -> Vec<(&'static str, Vec<String>)> {
    let mut list = vec![("contacts", vec!["--contacts".to_owned()])];
    if sample.has("bond") {
        list.push(("cracks", vec!["--cracks".to_owned()]));
    }
    list
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

    /// Adds what every curve has.
    fn finish(&self, curve: Curve, times: &[f64]) -> Result<Curve> {
        let curve = curve.with("coordination", "", self.column("contacts", "coordination")?);
        if !self.0.contains_key("cracks") {
            return Ok(curve);
        }
        let broken = self.column("cracks", "time")?;
        let until = |t: &f64| broken.iter().filter(|crack| *crack <= t).count() as f64;
        Ok(curve.with("cracks", "", times.iter().map(until).collect()))
    }
}

/// A smooth curve: means over a fortieth of its rows.
fn smoothed(values: &[f64]) -> Vec<f64> {
    if values.is_empty() { Vec::new() } else { smooth(values, (values.len() / 40).max(1)) }
}

/// Mean over the last fifth of the rows; NaN of none.
fn residual(values: &[f64]) -> f64 {
    let from = values.len() - (RESIDUAL * values.len() as f64).ceil() as usize;
    let last = &values[from..];
    last.iter().sum::<f64>() / last.len() as f64
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

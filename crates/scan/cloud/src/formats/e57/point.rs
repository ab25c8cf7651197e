//! The fields of an E57 point that are no columns of their own: position, colour and intensity with their states, and indices.
//!
//! ```text
//! cartesianInvalidState   0 valid, 1 a direction only, 2 nothing; sphericalInvalidState alike
//! x = r cos ε cos α,  y = r cos ε sin α,  z = r sin ε      range r, azimuth α, elevation ε
//! pose                    x ← R(q) x + t
//! ```
//!
//! ASTM E2807-11 (2019), table 16.

use super::color::ColorScale;
use e57::{PointCloud, Quaternion, RawValues, RecordName, Translation};
use geom::Vec3;

/// Where the fields stand in a row, and the pose of the scan.
pub(crate) struct Fields<'a> {
    scan: &'a PointCloud,
    cartesian: Option<[usize; 3]>,
    cartesian_state: Option<usize>,
    spherical: Option<[usize; 3]>,
    spherical_state: Option<usize>,
    color: Option<[usize; 3]>,
    color_state: Option<usize>,
    color_scale: ColorScale,
    intensity: Option<usize>,
    intensity_state: Option<usize>,
    row: Option<usize>,
    column: Option<usize>,
    pose: Pose,
}

/// Whether a field says that its value counts.
const VALID: i64 = 0;

impl<'a> Fields<'a> {
    pub(crate) fn of(scan: &'a PointCloud, color_scale: ColorScale) -> Fields<'a> {
        use RecordName as Name;
        let place = |name: Name| scan.prototype.iter().position(|record| record.name == name);
        let three = |names: [Name; 3]| match names.map(place) {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            _ => None,
        };
        Fields {
            scan,
            cartesian: three([Name::CartesianX, Name::CartesianY, Name::CartesianZ]),
            cartesian_state: place(Name::CartesianInvalidState),
            spherical: three([Name::SphericalRange, Name::SphericalAzimuth, Name::SphericalElevation]),
            spherical_state: place(Name::SphericalInvalidState),
            color: three([Name::ColorRed, Name::ColorGreen, Name::ColorBlue]),
            color_state: place(Name::IsColorInvalid),
            color_scale,
            intensity: place(Name::Intensity),
            intensity_state: place(Name::IsIntensityInvalid),
            row: place(Name::RowIndex),
            column: place(Name::ColumnIndex),
            pose: Pose::of(scan),
        }
    }

    fn number(&self, row: &RawValues, at: usize) -> e57::Result<f64> {
        row[at].to_f64(&self.scan.prototype[at].data_type)
    }

    fn three(&self, row: &RawValues, at: [usize; 3]) -> e57::Result<[f64; 3]> {
        Ok([self.number(row, at[0])?, self.number(row, at[1])?, self.number(row, at[2])?])
    }

    fn whole(&self, row: &RawValues, at: usize) -> e57::Result<i64> {
        row[at].to_i64(&self.scan.prototype[at].data_type)
    }

    /// Whether the state at `state` says that a value counts; without a state it does.
    fn is_valid(&self, row: &RawValues, state: Option<usize>) -> e57::Result<bool> {
        Ok(state.map(|at| self.whole(row, at)).transpose()?.is_none_or(|state| state == VALID))
    }

    /// The position [m] in the frame of the file; NaN without an echo.
    pub(crate) fn position(&self, row: &RawValues) -> e57::Result<Vec3> {
        if let Some(at) = self.cartesian
            && self.is_valid(row, self.cartesian_state)?
        {
            return Ok(self.pose.apply(self.three(row, at)?));
        }
        if let Some(at) = self.spherical
            && self.is_valid(row, self.spherical_state)?
        {
            let [range, azimuth, elevation] = self.three(row, at)?;
            let flat = range * elevation.cos();
            let local = [flat * azimuth.cos(), flat * azimuth.sin(), range * elevation.sin()];
            return Ok(self.pose.apply(local));
        }
        Ok(Vec3::repeat(f64::NAN))
    }

    /// Red, green and blue as the file has them, or in the limits of all scans; NaN where they do not count.
    pub(crate) fn color(&self, row: &RawValues) -> e57::Result<[f32; 3]> {
        match self.color {
            Some(at) if self.is_valid(row, self.color_state)? => {
                Ok(self.color_scale.apply(self.three(row, at)?))
            }
            _ => Ok([f32::NAN; 3]),
        }
    }

    /// The intensity as the file has it; NaN where it does not count.
    pub(crate) fn intensity(&self, row: &RawValues) -> e57::Result<f64> {
        match self.intensity {
            Some(at) if self.is_valid(row, self.intensity_state)? => self.number(row, at),
            _ => Ok(f64::NAN),
        }
    }

    /// Row and column of the scanner's grid; −1 without one.
    pub(crate) fn indices(&self, row: &RawValues) -> e57::Result<[i32; 2]> {
        let index = |at: Option<usize>| at.map_or(Ok(-1), |at| self.whole(row, at).map(|index| index as i32));
        Ok([index(self.row)?, index(self.column)?])
    }
}

/// A rotation by its matrix, and a shift [m].
pub(crate) struct Pose {
    rotation: [[f64; 3]; 3],
    shift: Vec3,
}

impl Pose {
    /// Of a scan; without one nothing moves.
    pub(crate) fn of(scan: &PointCloud) -> Pose {
        let pose = scan.transform.clone().unwrap_or_default();
        let Quaternion { w, x, y, z } = pose.rotation;
        let Translation { x: a, y: b, z: c } = pose.translation;
        Pose {
            rotation: [
                [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
                [2.0 * (x * y + w * z), w * w + y * y - x * x - z * z, 2.0 * (y * z - w * x)],
                [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w + z * z - x * x - y * y],
            ],
            shift: Vec3::new(a, b, c),
        }
    }

    /// A direction in the frame of the file.
    pub(crate) fn turn(&self, [x, y, z]: [f64; 3]) -> Vec3 {
        Vec3::from(self.rotation.map(|row| row[0] * x + row[1] * y + row[2] * z))
    }

    fn apply(&self, local: [f64; 3]) -> Vec3 {
        self.turn(local) + self.shift
    }
}

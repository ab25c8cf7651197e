//! The cube of a lattice that holds a position.

use crate::MeasureError;
use geom::Vec3;

/// Numbers of cubes are whole in double precision up to here.
const MOST: f64 = 9e15;

/// The cube of side `side` [m] that holds `p` [m], counted from the origin.
///
/// # Errors
/// Cubes too small to be counted up to there.
pub(crate) fn cell_of(p: &Vec3, side: f64) -> Result<[i64; 3], MeasureError> {
    let at = p / side;
    if at.amax() <= MOST {
        return Ok([0, 1, 2].map(|axis| at[axis].floor() as i64));
    }
    let cure = "is too small to count cells with: give a longer side";
    Err(MeasureError::Setting { what: "cell", value: side, unit: "m", cure })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_cannot_be_counted_are_refused() {
        assert_eq!(cell_of(&Vec3::new(0.25, -0.1, 0.0), 0.1), Ok([2, -1, 0]));
        assert!(cell_of(&Vec3::new(0.25, 0.0, 0.0), 1e-300).is_err());
        assert!(cell_of(&Vec3::zeros(), 1e-300).is_ok());
    }
}

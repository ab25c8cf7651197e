//! Whether a direction towards the flow tells the side of a surface.

use crate::settings::WallError;
use geom::Vec3;

/// Part of the surface [–] that lies most squarely to the direction, and decides.
const DECIDES: f64 = 0.01;
/// Least cosine between its normals and the direction [–].
const ACROSS: f64 = 0.1;
/// Part of that cosine [–] from which on a point lies as squarely.
const AS_SQUARELY: f64 = 0.8;
/// How many may face away for each that faces the direction [–]: of a closed surface as many do, and the side that it begins with is chance.
const BOTH_WAYS: f64 = 0.5;

/// Refuses a direction that the surface, whose `normals` have been turned to its side, faces as well as it faces away, or lies along.
pub(crate) fn check(points: &[Vec3], normals: &[Vec3], direction: &Vec3) -> Result<(), WallError> {
    let cosines: Vec<f64> = normals.iter().map(|n| n.dot(direction) / direction.norm()).collect();
    let mut squarely: Vec<f64> = cosines.iter().map(|c| c.abs()).collect();
    let deciding = ((1.0 - DECIDES) * (squarely.len() - 1) as f64) as usize;
    let most = *squarely.select_nth_unstable_by(deciding, f64::total_cmp).1;
    if most < ACROSS {
        return Err(WallError::FacesAside { angle: most.asin().to_degrees() });
    }
    let facing = cosines.iter().filter(|c| **c > AS_SQUARELY * most).count();
    let away = || points.iter().zip(&cosines).filter(|(_, c)| **c < -AS_SQUARELY * most);
    let against = away().count();
    match away().min_by(|a, b| a.1.total_cmp(b.1)) {
        Some((at, _)) if against as f64 > BOTH_WAYS * facing as f64 => {
            let share = 100.0 * against as f64 / (against + facing) as f64;
            Err(WallError::FacesBothWays { share, at: (*at).into() })
        }
        _ => Ok(()),
    }
}

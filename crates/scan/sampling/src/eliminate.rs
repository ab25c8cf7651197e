//! A sample by elimination: of about ten times as many points as are wanted, the most crowded go (`crowding`).

use crate::cells::Cells;
use crate::crowding::uncrowded;
use crate::poisson::poisson;
use crate::{Amount, Sample, SampleError, SampleSettings, amount};
use geom::Vec3;

pub(crate) fn eliminate(
    points: &[Vec3],
    forced: Option<&[bool]>,
    settings: &SampleSettings,
) -> Result<Sample, SampleError> {
    let start = amount::sample_of(points, forced, settings)?;
    let count = match settings.amount {
        Amount::Count(count) => count,
        _ => start.kept.len(),
    };
    let few = thinned(points, forced, start.spacing, settings.seed);
    // For example duplicates: thinning may leave too few.
    let all = if few.len() >= count { few } else { (0..points.len() as u32).collect() };
    let kept = uncrowded(points, forced, &all, count, &start);
    Ok(Sample { kept, ..start })
}

/// A crowd of about ten times as many points as are wanted, or fewer: more change nothing but the time,
/// which goes with the square of the crowd in each other's reach.
fn thinned(points: &[Vec3], forced: Option<&[bool]>, spacing: f64, seed: u64) -> Vec<u32> {
    let fine = spacing / 3.0;
    poisson(&Cells::new(points, fine), fine, seed, forced)
}

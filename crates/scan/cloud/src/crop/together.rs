//! The rules of a crop that look at points together. Each place is judged once, however many points lie in it.

use super::marks::Reason;
use super::report::Cropped;
use super::rule::{grazing, ground, outliers, scatter};
use super::rules::{CropError, Rules};
use super::sieve::Sieve;
use crate::neighbours::connected;
use crate::points::Cloud;
use crate::points::places::{self, Places, judged};
use geom::{Shown, Vec3};

/// The rules that look at points together, in their order.
pub(crate) fn measure(
    cloud: &Cloud,
    rules: &Rules,
    sieve: &mut Sieve,
    report: &mut Cropped,
) -> Result<(), CropError> {
    match rules.distinct {
        Some(apart) => {
            report.repeated = sieve.keep(Reason::Repeated, &places::distinct(&sieve.points(), apart));
        }
        None if rules.measure() => {
            report.crowd = Places::of(&sieve.points()).and_then(|places| places.doubtful());
        }
        None => {}
    }
    if let Some(rule) = &rules.outliers {
        let rows = judged(&sieve.points(), |points| Ok::<_, CropError>(outliers::inliers(points, rule)))?;
        report.outliers = sieve.keep(Reason::Outlier, &rows);
    }
    if let Some(degrees) = rules.grazing {
        let eyes: Vec<Vec3> = rules.seen_from.iter().copied().chain(cloud.viewpoints()).collect();
        let some = sieve.points();
        if some.len() < grazing::FEWEST {
            report.idle.push(format!("--grazing needs {} points, and has {}", grazing::FEWEST, some.len()));
        }
        let rows = judged(&some, |points| Ok::<_, CropError>(grazing::faced(points, &eyes, degrees)))?;
        report.grazing = sieve.keep(Reason::Grazing, &rows);
        report.viewpoints = eyes.into_iter().map(Into::into).collect();
    }
    if let Some(rule) = &rules.ground {
        let above = ground::above(&sieve.points(), rule)?;
        if above.raster.is_none() {
            report.idle.push("--ground needs more points, not all at one place".to_owned());
        }
        report.ground = sieve.keep(Reason::Ground, &above.rows);
        report.ground_raster = above.raster;
    }
    if let Some(rule) = &rules.scattered {
        let mut sparse = false;
        let rows = judged(&sieve.points(), |points| {
            let compact = scatter::compact(points, rule)?;
            sparse = compact.sparse;
            Ok::<_, CropError>(compact.rows)
        })?;
        if sparse {
            let radius = Shown(rule.radius);
            report.idle.push(format!(
                "--scattered: most points have hardly another within {radius} m: give a RADIUS of several spacings of the scan"
            ));
        }
        report.scattered = sieve.keep(Reason::Scattered, &rows);
    }
    if let Some(radius) = rules.largest {
        let rows = judged(&sieve.points(), |points| Ok::<_, CropError>(connected::largest(points, radius)))?;
        report.smaller_parts = sieve.keep(Reason::SmallerPart, &rows);
    }
    Ok(())
}

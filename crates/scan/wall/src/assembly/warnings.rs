//! What a wall that was built leaves to be wished: leaks, sheets too close, sizes that do not fit the particles.

use super::report::{WallReport, representative};
use crate::radii::dents::{DEEP, DeepDents};
use crate::radii::equation::ROUNDED;
use crate::settings::{Radius, Representative, WallError, WallSettings};
use crate::surface::bulge::Bulges;
use crate::surface::leak;
use crate::surface::sheets::{self, Sheets};
use geom::star::Stars;
use geom::{Shown, Vec3};

/// Wall sphere diameter over smallest particle diameter below which spheres cost more than they give [–].
const PRACTICAL: f64 = 0.8;

/// Median wall sphere radius over smallest particle diameter above which a unit is likely wrong [–].
const FAR_LARGER: f64 = 20.0;

/// A wall that was built, and what it was built from.
pub(crate) struct Built<'a> {
    pub(crate) points: &'a [Vec3],
    pub(crate) stars: &'a Stars,
    pub(crate) centres: &'a [Vec3],
    pub(crate) radii: &'a [f64],
}

/// Adds warnings and gaps to the report; refuses spheres larger than the cloud.
pub(crate) fn judge(
    report: &mut WallReport,
    built: &Built,
    settings: &WallSettings,
) -> Result<(), WallError> {
    let spacing = report.spacing;
    if let Some(sheets) = sheets::closer_than(built.points, spacing) {
        report.warnings.push(two_sheets(&sheets, spacing));
        report.sheets = Some(sheets);
    }
    if let Some(bulges) = &report.bulges {
        report.warnings.push(sticking_out(bulges));
    }
    if let Some(deep) = &report.deep_dents {
        report.warnings.push(too_deep(deep, spacing));
    }
    if let Radius::Given(radius) = settings.radius {
        check_given(report, radius);
    }
    if let Some(largest) = settings.largest_particle {
        check_largest(report, largest);
    }
    if let Some(particle) = settings.smallest_particle {
        check_sizes(report, particle, built)?;
        check_particle(report, particle, built);
    } else if settings.gaps {
        // No particle: a gap too wide to be distinguished from the outline does not count.
        (report.widest_gap, _) = built.widest_gap(report.gaps_up_to);
    }
    Ok(())
}

impl Built<'_> {
    /// The widest gap, and how many pass a particle of this diameter [m].
    fn widest_gap(&self, particle: f64) -> (Option<leak::Gap>, usize) {
        leak::widest(self.centres, self.radii, &self.stars.triangles, &self.stars.outline, particle)
    }
}

/// Warns of a given radius [m] that is larger than the whole cloud.
fn check_given(report: &mut WallReport, radius: f64) {
    let width = report.width;
    if radius > width {
        report.warnings.push(format!(
            "the given radius of {} m is larger than the cloud, which is {} m wide: is it in millimetres?",
            Shown(radius),
            Shown(width)
        ));
    }
}

/// Refuses spheres larger than the cloud; warns of those far larger than the smallest particle [m].
fn check_sizes(report: &mut WallReport, particle: f64, built: &Built) -> Result<(), WallError> {
    let (width, radius) = (report.width, report.radius_range[2]);
    if radius > width {
        return Err(WallError::LargerThanCloud { radius, width });
    }
    let median = representative(built.radii, Representative::Median);
    if median > FAR_LARGER * particle {
        report.warnings.push(format!(
            "wall spheres of radius {} m (median) are far larger than the smallest particle ({} m), \
             and the cloud is {} m wide: is it in millimetres? If not, use a smaller spacing or more roughness",
            Shown(median),
            Shown(particle),
            Shown(width)
        ));
    }
    Ok(())
}

fn too_deep(deep: &DeepDents, spacing: f64) -> String {
    let [x, y, z] = deep.at.map(|c| format!("{c:.4}"));
    format!(
        "over {} % of the wall the dents are more than {DEEP} times as deep as asked: the deepest is {} m instead of {} m, at ({x}, {y}, {z}) m, \
         where neighbours are {} m apart, and {} m on average: fill sparse places before sampling (cloud-fill --for-spacing M), or use a \
         larger spacing",
        Shown((1e3 * deep.share).ceil() / 10.0),
        Shown(deep.deepest),
        Shown(deep.asked),
        Shown(deep.distance),
        Shown(spacing)
    )
}

fn sticking_out(bulges: &Bulges) -> String {
    let [x, y, z] = bulges.at.map(|c| format!("{c:.4}"));
    format!(
        "over {:.0} % of the surface spheres of other points stick out, by up to {} m at ({x}, {y}, {z}) m: there it bends outwards more tightly than \
         spheres of radius {} m, or is thinner than they are; make them smaller, by a smaller spacing or more roughness",
        100.0 * bulges.share,
        Shown(bulges.depth),
        Shown(bulges.radius)
    )
}

fn two_sheets(sheets: &Sheets, spacing: f64) -> String {
    let [x, y, z] = sheets.at.map(|c| format!("{c:.4}"));
    format!(
        "two sheets of the surface lie {} m apart, closer than the spacing of {} m, over {:.0} % of it, as at ({x}, {y}, {z}) m: \
         their spheres fill each other's dents; use a spacing below {} m, or crop the sheet that no particle touches",
        Shown(sheets.apart),
        Shown(spacing),
        (100.0 * sheets.share).max(1.0),
        Shown(sheets.apart)
    )
}

/// Warns of spheres larger than the largest particle [m]: a wall coarser than what flows over it.
fn check_largest(report: &mut WallReport, particle: f64) {
    let largest = 2.0 * report.radius_range[2];
    if largest > particle * ROUNDED {
        report.warnings.push(format!(
            "wall spheres up to {} m in diameter are larger than the largest particle ({} m): use a smaller spacing or more \
             roughness",
            Shown(largest),
            Shown(particle)
        ));
    }
}

/// Warns of gaps that the smallest particle [m] passes, and of spheres far smaller than it.
fn check_particle(report: &mut WallReport, particle: f64, built: &Built) {
    (report.widest_gap, report.leaks) = built.widest_gap(particle);
    if let Some(gap) = report.widest_gap.filter(|g| g.diameter >= particle) {
        let [x, y, z] = gap.at.map(|c| format!("{c:.4}"));
        let passes = Shown(particle);
        report.warnings.push(format!(
            "the wall leaks: a particle of {passes} m passes {}, the widest ({} m) at ({x}, {y}, {z}) m; \
             sample with a smaller spacing, fill the hole, or use larger radii (less roughness)",
            geom::counted(report.leaks, "gap"),
            Shown(gap.diameter)
        ));
    }
    let least = 2.0 * report.radius_range[0];
    if least < PRACTICAL * particle {
        report.warnings.push(format!(
            "wall spheres down to {} m in diameter are smaller than 80 % of the smallest particle ({} m): \
             so small spheres are many and shorten the time step; use a larger spacing or less roughness",
            Shown(least),
            Shown(particle)
        ));
    }
}

//! Share of grains that fall through a leaking wall, by their size.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use geom::Vec3;
use grainpipe_tests::sphere_walls::passing::{passes, share};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use rayon::prelude::*;
use sampling::Method;

/// Sizes over the widest gap.
const SIZES: [f64; 7] = [0.3, 0.5, 0.7, 0.8, 0.9, 0.98, 1.02];

pub fn study(page: &mut Page) -> Result<(), String> {
    let p = GRAIN;
    let layouts = [
        Layout::Square,
        Layout::Sampled(Method::Grid, 1),
        Layout::Sampled(Method::Poisson, 1),
        Layout::Sampled(Method::Relax, 1),
    ];
    let (mut rows, mut panel) = (
        Vec::new(),
        Panel {
            title: "ζ = 0.4 P".into(),
            axes: ("grain over widest gap".into(), "share that falls through in 0.6 s".into()),
            from_zero: true,
            ..Panel::default()
        },
    );
    let mut right = 0;
    for layout in layouts {
        let (wall, report) = spheres(&layout.points(p, 0.4), 0.4 * p, GRAIN);
        let gap = report.widest_gap.ok_or("a wall this rough has gaps")?;
        let shares: Vec<f64> =
            SIZES.par_iter().map(|s| share(&wall, 0.5 * s * gap.diameter, 0.3, 0.6)).collect();
        let over = |size: f64| {
            let from = Vec3::new(gap.at[0], gap.at[1], gap.at[2] + wall[0].1);
            passes(&wall, &[(from, 0.5 * size * gap.diameter)], (0.4, 0.002))[0]
        };
        right += u32::from(over(0.99)) + u32::from(!over(1.01));
        let mut row =
            vec![layout.name().to_owned(), format!("{:.3}", gap.diameter / GRAIN), report.leaks.to_string()];
        row.extend(shares.iter().map(|s| format!("{s:.2}")));
        rows.push(row);
        panel.lines.push((layout.name().to_owned(), SIZES.iter().copied().zip(shares).collect()));
    }
    page.head("Leaks: reported gaps, and grains that fall through");
    page.say(&format!(
        "Test of the reported gap: two grains, of 0.99 and 1.01 times the widest gap that wallgen reports, \
         are released over that gap. {right} of {} fell through or stayed as expected.\n\nTest at random \
         positions: the table shows the share of grains that fall through walls with ζ = 0.4 P and P = d. \
         Columns are the grain size over the widest gap. On a lattice all gaps are equal, so all grains or \
         none pass. On blue noise gaps as wide as the widest are rare, and most pockets hold a grain of \
         that size.",
        2 * layouts.len()
    ));
    let sizes: Vec<String> = SIZES.iter().map(|s| format!("{s}")).collect();
    let mut columns = vec!["points", "widest gap / d", "gaps wider than d"];
    columns.extend(sizes.iter().map(String::as_str));
    page.table("leaks", &columns, &rows)?;
    page.picture("leaks", "Share that falls through by size", 1, &[panel])
}

//! Which of the open cells of a patch are holes, and which are the outside.
//!
//! ```text
//! outside   what a disc of 2 cells' radius reaches from beyond the patch over open cells alone, and the cells next to it
//! hole      a connected part of what is left that does not leave the patch, and that borders on the outside along at most a
//!           fifth of its rim
//! ```
//!
//! On rough ground the shadows of stones are connected by narrow straits, also to the outside. They count as holes if
//! only a strait leads outside. A bay of the rim is open along more of its border and is not filled.

use super::raster::Raster;

/// Radius of the disc, in cells; the window of the search has closed straits by its own width before.
const STRAIT: f64 = 2.0;
/// Most of the border of a hole that the outside takes [–].
const MOUTH: f64 = 0.2;

/// The holes among the `open` cells, each a list of cells in order.
pub(crate) fn holes(raster: &Raster, mut open: Vec<bool>) -> Vec<Vec<usize>> {
    // A disc that reaches a cell from within does so from the border as well.
    let narrow = raster.grown(&raster.border(&open, false), STRAIT);
    let mut wide: Vec<bool> = open.iter().zip(&narrow).map(|(open, narrow)| *open && !narrow).collect();
    let before = wide.clone();
    raster.drop_outside(&mut wide);
    let reached: Vec<bool> = before.iter().zip(&wide).map(|(before, wide)| before & !wide).collect();
    let near = raster.grown(&raster.border(&reached, true), STRAIT + 0.5);
    let near = near.iter().zip(&reached).map(|(near, reached)| near | reached);
    let outside: Vec<bool> = open.iter().zip(near).map(|(open, near)| open & near).collect();
    open.iter_mut().zip(&outside).for_each(|(open, outside)| *open &= !outside);
    raster.drop_outside(&mut open);
    let mut parts = raster.parts(open.clone());
    parts.retain(|part| {
        let beside = || part.iter().flat_map(|&cell| raster.beside(cell, false)).filter(|&cell| !open[cell]);
        beside().filter(|&cell| outside[cell]).count() as f64 <= MOUTH * beside().count() as f64
    });
    parts.iter_mut().for_each(|part| part.sort_unstable());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Open cells of a picture, eight times as large.
    fn picture(rows: [&str; 7]) -> (Raster, Vec<bool>) {
        let raster = Raster::new(28.0, 1.0);
        let at = |cell: usize| {
            let (x, y) = (cell % raster.side / 8, cell / raster.side / 8);
            rows.get(y).and_then(|row| row.as_bytes().get(x)).is_none_or(|&c| c == b'.')
        };
        (raster, (0..raster.len()).map(at).collect())
    }

    #[test]
    fn an_enclosed_part_is_a_hole_and_a_bay_is_not() {
        let (raster, open) =
            picture([".......", ".#####.", ".#.###.", ".####..", ".###...", ".####..", "......."]);
        let found = holes(&raster, open);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].len() == 64 && found[0].iter().all(|c| (16..24).contains(&(c % raster.side))));
    }

    #[test]
    fn a_strait_does_not_make_a_hole_the_outside() {
        let (raster, mut open) =
            picture([".......", ".#####.", ".#...#.", ".#...#.", ".#...#.", ".#####.", "......."]);
        (0..20).for_each(|y| (27..30).for_each(|x| open[y * raster.side + x] = true));
        let found = holes(&raster, open.clone());
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((540..640).contains(&found[0].len()), "{}", found[0].len());
        // A gate as wide as half of it.
        (0..20).for_each(|y| (22..34).for_each(|x| open[y * raster.side + x] = true));
        assert!(holes(&raster, open).is_empty());
    }
}

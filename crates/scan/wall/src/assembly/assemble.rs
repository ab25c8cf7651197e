//! Builds a wall: neighbours, radii, placement, leak check.

use super::report::{Wall, WallReport, range, representative};
use super::warnings::{self, Built};
use crate::radii::dents;
use crate::radii::equation::{self, ROUNDED};
use crate::radii::pairs::{FURTHEST, Pairs, REACH, pairs};
use crate::radii::solve::{self, Changed, ChangedPair};
use crate::regions::Regions;
use crate::settings::{Placement, Radius, WallError, WallSettings};
use crate::surface::{bulge, curvature, facing, normals};
use geom::Vec3;
use geom::star::{Stars, stars};
use sampling::cells::Cells;

/// Largest circle through three points that is distinguished from the outline of the wall, in nearest distances.
const SQUARE: f64 = 3.0;
/// One sphere for each point [m], all finite.
///
/// # Errors
/// Points or settings that make no wall; see [`WallError`].
pub fn build(
    points: &[Vec3],
    regions: &Regions,
    settings: &WallSettings,
) -> Result<(Wall, WallReport), WallError> {
    check(points, settings)?;
    // From here to the end points are named by their slot in the order of the cells: neighbours lie side by side in memory.
    let (cells, found, typical) = neighbours(points)?;
    let wants_stars =
        settings.placement == Placement::Surface || settings.smallest_particle.is_some() || settings.gaps;
    let stars = if wants_stars { stars(&cells, SQUARE * typical) } else { Stars::default() };
    let region_of = regions.of(&cells.points, cells.order());
    let spacing = representative(&found.lengths, settings.representative);
    let zeta = roughness(regions, &region_of, cells.order(), settings)?;
    let (radii, zeta_all) = radii(&cells, &found, spacing, zeta.as_deref(), settings)?;
    let is_asked = zeta.is_some();
    let asked = zeta.unwrap_or_else(|| vec![zeta_all; radii.len()]);
    let changes = solve::changes(&found.pairs, &found.lengths, &asked, &radii);
    let centres = place(&cells.points, &stars, &found.pairs, &radii, settings)?;
    let stands_in_front = settings.placement == Placement::Centre && !settings.of_drawing;
    let mut report = WallReport {
        spheres: radii.len(),
        spacing,
        spacing_range: range(&found.lengths),
        roughness: zeta_all,
        radius_range: [range(&radii)[0], radii.iter().sum::<f64>() / radii.len() as f64, range(&radii)[1]],
        width: width(points),
        curvature_radius: if stands_in_front { curvature::radius(&cells, spacing) } else { None },
        in_front: stands_in_front.then(|| range(&radii)),
        changes,
        changed: if settings.list_changes { list(&cells, &found, &asked, &radii) } else { Vec::new() },
        deep_dents: if is_asked && !settings.of_drawing {
            dents::find(&cells.points, &found, &asked, &radii)
        } else {
            None
        },
        widest_gap: None,
        leaks: 0,
        gaps_up_to: SQUARE * typical,
        sheets: None,
        bulges: if settings.placement == Placement::Surface && !settings.of_drawing {
            bulge::find(&cells.points, &centres, &radii, spacing)
        } else {
            None
        },
        warnings: Vec::new(),
    };
    warnings::judge(
        &mut report,
        &Built { points: &cells.points, stars: &stars, centres: &centres, radii: &radii },
        settings,
    )?;
    let (centres, radii) = (by_index(&cells, &centres), by_index(&cells, &radii));
    Ok((Wall { centres, radii, regions: by_index(&cells, &region_of) }, report))
}

/// The sorted points, their pairs of neighbours, and the typical nearest distance [m].
fn neighbours(points: &[Vec3]) -> Result<(Cells, Pairs, f64), WallError> {
    let typical = sampling::nearest::typical(points).ok_or(WallError::OnePlace(points.len()))?;
    let cells = Cells::new(points, REACH * typical);
    let found = pairs(&cells, typical);
    check_apart(points, &cells, &found)?;
    if found.pairs.is_empty() {
        return Err(WallError::NoPairs { reach: FURTHEST * typical });
    }
    Ok((cells, found, typical))
}

/// Representative distance of neighbours [m] of points [m].
///
/// # Errors
/// Points that make no wall.
pub fn spacing(points: &[Vec3], settings: &WallSettings) -> Result<f64, WallError> {
    check(points, settings)?;
    Ok(representative(&neighbours(points)?.1.lengths, settings.representative))
}

/// The pairs whose ζ was changed, by the numbers that their points came in with.
fn list(cells: &Cells, found: &Pairs, asked: &[f64], radii: &[f64]) -> Vec<Changed> {
    let of = |ChangedPair { pair: k, asked, made }| {
        let (i, j) = found.pairs[k];
        let [a, b] = [i, j].map(|slot| cells.order()[slot as usize]);
        let at = (cells.points[i as usize] + cells.points[j as usize]) * 0.5;
        Changed { points: [a.min(b), a.max(b)], at: at.into(), distance: found.lengths[k], asked, made }
    };
    let mut all: Vec<Changed> = solve::changed(&found.pairs, &found.lengths, asked, radii).map(of).collect();
    all.sort_unstable_by_key(|c| c.points);
    all
}

/// Values by slot in the order of the points.
fn by_index<T: Copy + Default>(cells: &Cells, by_slot: &[T]) -> Vec<T> {
    let mut by_index = vec![T::default(); by_slot.len()];
    for (&i, value) in cells.order().iter().zip(by_slot) {
        by_index[i as usize] = *value;
    }
    by_index
}

fn check(points: &[Vec3], settings: &WallSettings) -> Result<(), WallError> {
    if points.len() < 2 {
        return Err(WallError::TooFew(points.len()));
    }
    if let Some(index) = points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        let p = points[index];
        return Err(WallError::NotFinite { index, x: p.x, y: p.y, z: p.z });
    }
    let positive = |x: f64| x > 0.0 && x.is_finite();
    match (settings.radius, settings.smallest_particle, settings.facing) {
        (Radius::Given(r), _, _) if !positive(r) => Err(WallError::BadRadius(r)),
        (_, Some(d), _) if !positive(d) => Err(WallError::BadParticle(d)),
        (_, _, Some(f)) if !positive(f.norm()) => Err(WallError::BadFacing { x: f.x, y: f.y, z: f.z }),
        (_, _, None)
            if settings.placement == Placement::Surface
                && settings.flow_at.is_none()
                && settings.seen_from.is_empty() =>
        {
            Err(WallError::NoFacing)
        }
        _ => Ok(()),
    }
}

/// Refuses two points at one place.
fn check_apart(points: &[Vec3], cells: &Cells, found: &Pairs) -> Result<(), WallError> {
    let at_once = found.nearest.iter().zip(cells.order()).filter(|(d, _)| **d == 0.0);
    let Some(first) = at_once.map(|(_, &i)| i).min() else { return Ok(()) };
    let p = points[first as usize];
    let second = points.iter().rposition(|q| *q == p).unwrap_or(first as usize) as u32;
    Err(WallError::Duplicate { first, second, x: p.x, y: p.y, z: p.z })
}

/// Roughness asked for at each point [m]; `None` when the radius is given instead.
fn roughness(
    regions: &Regions,
    region_of: &[u16],
    order: &[u32],
    settings: &WallSettings,
) -> Result<Option<Vec<f64>>, WallError> {
    if matches!(settings.radius, Radius::Given(_)) && !regions.is_rough() {
        return Ok(None);
    }
    let of = |(&i, &r): (&u32, &u16)| regions.roughness(i as usize, r).ok_or(WallError::NoRoughness);
    order.iter().zip(region_of).map(of).collect::<Result<Vec<f64>, _>>().map(Some)
}

/// Radii [m], and the representative roughness [m].
fn radii(
    cells: &Cells,
    found: &Pairs,
    spacing: f64,
    zeta: Option<&[f64]>,
    settings: &WallSettings,
) -> Result<(Vec<f64>, f64), WallError> {
    if let Radius::Given(radius) = settings.radius {
        let zeta = equation::dent(radius, radius, spacing);
        return Ok((vec![radius; cells.len()], zeta));
    }
    let zeta = zeta.ok_or(WallError::NoRoughness)?;
    let common = representative(zeta, settings.representative);
    let even = |zeta: f64| {
        let place = "the representative one".to_owned();
        // ζ = P/2 is valid, and P is a sum of rounded numbers.
        let rounded = if zeta <= 0.5 * spacing * ROUNDED { zeta.min(0.5 * spacing) } else { zeta };
        equation::radius(spacing, rounded)
            .ok_or_else(|| too_rough(zeta, spacing, "representative spacing", place))
    };
    if settings.radius == Radius::Uniform {
        return Ok((vec![even(common)?; cells.len()], common));
    }
    // The worst pair is named, so that one cure serves all.
    let want = |&(i, j): &(u32, u32)| 0.5 * (zeta[i as usize] + zeta[j as usize]);
    let rough = found.pairs.iter().zip(&found.lengths).filter(|(pair, p)| want(pair) > 0.5 * **p * ROUNDED);
    let worst = rough.max_by(|a, b| (want(a.0) / a.1).total_cmp(&(want(b.0) / b.1)));
    if let Some((pair, &p)) = worst {
        let ([i, j], at) =
            ([pair.0, pair.1].map(|p| cells.order()[p as usize]), cells.points[pair.0 as usize]);
        let place = format!("points {i} and {j} at ({:.4}, {:.4}, {:.4}) m", at.x, at.y, at.z);
        return Err(too_rough(want(pair), p, "spacing", place));
    }
    let start = zeta.iter().map(|&z| even(z)).collect::<Result<Vec<f64>, _>>()?;
    Ok((solve::solve(&found.pairs, &found.lengths, zeta, &start), common))
}

fn too_rough(roughness: f64, spacing: f64, which: &'static str, place: String) -> WallError {
    match roughness > 0.5 * spacing {
        true => WallError::TooRough {
            roughness,
            spacing,
            which,
            place,
            most: 0.5 * spacing,
            need: 2.0 * roughness,
        },
        false => WallError::NotPositive { roughness },
    }
}

fn place(
    points: &[Vec3],
    stars: &Stars,
    pairs: &[(u32, u32)],
    radii: &[f64],
    settings: &WallSettings,
) -> Result<Vec<Vec3>, WallError> {
    if settings.placement == Placement::Centre {
        return Ok(points.to_vec());
    }
    let towards = settings.facing.map(normals::Flow::Towards);
    let seen = (!settings.seen_from.is_empty()).then(|| normals::Flow::SeenFrom(&settings.seen_from));
    let flow = settings.flow_at.map(normals::Flow::At).or(towards).or(seen).ok_or(WallError::NoFacing)?;
    let normals = normals::oriented(points, &stars.normals, pairs, flow);
    if let normals::Flow::Towards(facing) = flow {
        facing::check(points, &normals, &facing)?;
    }
    Ok(points.iter().zip(&normals).zip(radii).map(|((p, n), r)| p - n * *r).collect())
}

/// Longest side of the box around points [m].
fn width(points: &[Vec3]) -> f64 {
    let (low, high) = geom::grid::bounds(points);
    (high - low).max()
}

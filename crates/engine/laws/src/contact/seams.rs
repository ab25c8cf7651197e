//! A particle on the seams of a mesh: which of the nearest points of its triangles are contacts, and which history they keep.
//!
//! A contact is where the distance to the mesh has a local minimum: a point inside a face, or a point on an edge or at a corner
//! that lies on no triangle which comes nearer elsewhere. So a particle on a seam touches once, in a corner between two
//! faces twice. After Kremmer & Favier (2001), Int. J. Numer. Methods Eng. 51. Points whose normals differ by less than 45° are one contact: the shortest
//! translation out of all of them ([`super::translation`]).
//!
//! Memory belongs to a contact, not to a triangle: where a triangle no longer counts that did in the step before, and
//! a neighbour without history counts, the neighbour takes over (the nearest one, within a quarter of r: contact points
//! move less in a step). The spring is turned into the new tangent plane by the effect itself.
//!
//! Nothing here takes memory: a GPU has none to give.

use super::translation::{Face, groups, shortest};
use crate::float::Float;
use primitives::{Feature, Vec3, closest_feature};

/// Two points closer than this share of the distance are one contact [–].
const SAME_POINT: f64 = 1e-6;
/// Memory goes no farther than this share of the radius [–].
const STRIDE: f64 = 0.25;
/// Points farther than this share of the radius are no contacts where nothing adheres [–].
const NEAR: f64 = 1.02;
/// How much farther walls beside each other look than the limit [–], so that what is at it is found by all of them.
pub const FARTHER: f64 = 1.0 + 1e-9;

/// The nearest point of one triangle, to a particle.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Nearest {
    triangle: [Vec3; 3],
    centre: Vec3,
    /// From the centre of the particle to the point; where it is part of a contact of several, to the point of that [m].
    pub way: Vec3,
    square: f64,
    face: Face,
    inside: bool,
    /// Whether it is a contact.
    pub counts: bool,
}

/// One of the nearest points, in a separate order.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct Member {
    /// Which of them.
    pub at: u32,
    /// The first of its group.
    pub group: u32,
}

impl Nearest {
    /// Of a triangle, to a particle at `centre` [m].
    #[inline(always)]
    pub fn of(triangle: [Vec3; 3], centre: Vec3) -> Nearest {
        let (point, feature) = closest_feature(triangle, centre);
        let way = point - centre;
        let inside = feature == Feature::Face;
        let face = Face { normal: Vec3::zeros(), overlap: 0.0 };
        Nearest { triangle, centre, way, square: way.norm_squared(), face, inside, counts: false }
    }

    /// Whether the same point of a particle lies on this triangle.
    #[inline(always)]
    fn holds(&self, way: &Vec3) -> bool {
        let position = self.centre + way;
        let tolerance = SAME_POINT * way.norm_squared().root();
        (closest_feature(self.triangle, position).0 - position).norm_squared() <= tolerance * tolerance
    }

    /// Whether it is no farther than this from the centre [m].
    #[inline(always)]
    pub fn is_within(&self, limit: f64) -> bool {
        self.square <= limit * limit
    }

    /// Square of the distance within which another point is the same [m²].
    #[inline(always)]
    fn blur(&self) -> f64 {
        (SAME_POINT * SAME_POINT) * self.square
    }
}

/// Distance from the centre of a particle beyond which a point is no contact [m].
#[inline(always)]
pub fn limit(radius: f64, reach: f64) -> f64 {
    (NEAR * radius).max(radius + reach)
}

/// How much farther than they touch triangles are listed [m], so that lists hold all within the limit.
#[inline(always)]
pub fn room(radius: f64, reach: f64) -> f64 {
    limit(radius, reach) - radius
}

/// Says which of the nearest points of a particle of `radius` [m] are contacts, where these act up to a gap of `reach` [m]. `order` has as many rows, of any
/// content.
#[inline(always)]
pub fn count(near: &mut [Nearest], order: &mut [Member], radius: f64, reach: f64) {
    let (limit, mut within) = (limit(radius, reach), 0);
    for (k, point) in near.iter().enumerate() {
        if point.is_within(limit) {
            order[within] = Member { at: k as u32, group: 0 };
            within += 1;
        }
    }
    if within == 1 {
        near[order[0].at as usize].counts = true;
        return;
    }
    let order = &mut order[..within];
    sort(order, |a, b| {
        let (p, q) = (&near[a.at as usize], &near[b.at as usize]);
        p.square.total_cmp(&q.square).then(a.at.cmp(&b.at)).is_lt()
    });
    for n in 0..within {
        let k = order[n].at as usize;
        let mine = near[k];
        let same = |m: &Nearest| m.counts && (m.way - mine.way).norm_squared() <= m.blur();
        let nearer = |m: &Nearest| !mine.inside && m.square < mine.square && m.holds(&mine.way);
        let before = order[..n].iter().map(|m| &near[m.at as usize]);
        let counts = !before.into_iter().any(|m| same(m) || nearer(m));
        near[k].counts = counts;
    }
    let mut bear = 0;
    for n in 0..within {
        if near[order[n].at as usize].counts {
            order[bear] = order[n];
            bear += 1;
        }
    }
    join(near, &mut order[..bear], radius);
}

/// Joins contacts whose normals differ little, of some in the order of their distance; those that do not bear most no longer count.
#[inline(always)]
fn join(near: &mut [Nearest], order: &mut [Member], radius: f64) {
    if order.len() < 2 {
        return;
    }
    for member in &*order {
        let point = &mut near[member.at as usize];
        let distance = point.square.root();
        point.face = Face { normal: point.way / -distance, overlap: radius - distance };
    }
    groups(order, |m| near[m.at as usize].face.normal);
    // Those of a group follow each other, in the order that they had.
    sort(order, |a, b| a.group < b.group);
    let mut from = 0;
    while from < order.len() {
        let group = order[from].group;
        let to = from + order[from..].iter().take_while(|m| m.group == group).count();
        let members = &order[from..to];
        let deepest = near[members[0].at as usize].way;
        // One that is as long as the radius would put the point behind the centre: the deepest alone is left there.
        let out = shortest(members.len(), |k| near[members[k].at as usize].face)
            .map(|(u, most)| (u, u.norm_squared().root(), most))
            .filter(|(_, q, _)| *q < radius);
        let (way, most) = out.map_or((deepest, 0), |(u, q, most)| (u * ((q - radius) / q), most));
        for (n, member) in members.iter().enumerate() {
            let point = &mut near[member.at as usize];
            (point.way, point.counts) = (way, n == most);
        }
        from = to;
    }
}

/// Sorts a few rows by insertion; equal ones stay in their order.
#[inline(always)]
fn sort(rows: &mut [Member], less: impl Fn(&Member, &Member) -> bool) {
    for k in 1..rows.len() {
        let mut at = k;
        while at > 0 && less(&rows[at], &rows[at - 1]) {
            rows.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// What contacts remember, by their number.
pub trait Memory {
    /// Whether one remembers anything.
    fn holds(&self, k: usize) -> bool;
    /// Moves what one remembers to another, which remembers nothing.
    fn give(&mut self, from: usize, to: usize);
}

/// Moves what points remember that no longer count to neighbours that remember nothing.
#[inline(always)]
pub fn hand_over(near: &[Nearest], radius: f64, memory: &mut impl Memory) {
    for k in 0..near.len() {
        if near[k].counts || !memory.holds(k) {
            continue;
        }
        let away = |m: usize| (near[m].way - near[k].way).norm_squared();
        let free = (0..near.len()).filter(|&m| near[m].counts && !memory.holds(m));
        let nearest = free.min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)));
        let farthest = STRIDE * radius;
        if let Some(m) = nearest.filter(|&m| away(m) <= farthest * farthest) {
            memory.give(k, m);
        }
    }
}

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

use crate::walls::translation::{Face, groups, shortest};
use geom::Vec3;
use geom::triangle::{Feature, closest_feature};
use laws::contact::{LEDGER, STIFFNESS};
use laws::simd::{BLOCK, Layout};

/// Two points closer than this share of the distance are one contact [–].
const SAME_POINT: f64 = 1e-6;
/// Memory goes no farther than this share of the radius [–].
const STRIDE: f64 = 0.25;
/// Points farther than this share of the radius are no contacts where nothing adheres [–].
const NEAR: f64 = 1.02;

/// The nearest point of one triangle, to a particle.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    triangle: [Vec3; 3],
    centre: Vec3,
    /// From the centre of the particle to the point; where it is part of a contact of several, to the point of that [m].
    pub way: Vec3,
    square: f64,
    face: bool,
    /// Whether it is a contact.
    pub counts: bool,
}

impl Nearest {
    /// Of a triangle, to a particle at `centre` [m].
    pub fn of(triangle: [Vec3; 3], centre: Vec3) -> Nearest {
        let (point, feature) = closest_feature(triangle, centre);
        let way = point - centre;
        let face = feature == Feature::Face;
        Nearest { triangle, centre, way, square: way.norm_squared(), face, counts: false }
    }

    /// Whether the same point of a particle lies on this triangle.
    fn holds(&self, way: &Vec3) -> bool {
        let position = self.centre + way;
        let tolerance = SAME_POINT * way.norm();
        (closest_feature(self.triangle, position).0 - position).norm_squared() <= tolerance * tolerance
    }

    /// Whether it is no farther than this from the centre [m].
    pub fn is_within(&self, limit: f64) -> bool {
        self.square <= limit * limit
    }

    /// Square of the distance within which another point is the same [m²].
    fn blur(&self) -> f64 {
        (SAME_POINT * SAME_POINT) * self.square
    }
}

/// Distance from the centre of a particle beyond which a point is no contact [m].
pub fn limit(radius: f64, reach: f64) -> f64 {
    (NEAR * radius).max(radius + reach)
}

/// Says which of the nearest points of a particle of `radius` [m] are contacts, where these act up to a gap of `reach` [m].
pub fn count(near: &mut [Nearest], radius: f64, reach: f64) {
    let limit = limit(radius, reach);
    let mut order: Vec<usize> = (0..near.len()).filter(|&k| near[k].is_within(limit)).collect();
    if let [only] = order[..] {
        near[only].counts = true;
        return;
    }
    order.sort_by(|&a, &b| {
        let (p, q) = (&near[a], &near[b]);
        p.square.total_cmp(&q.square).then(a.cmp(&b))
    });
    for (n, &k) in order.iter().enumerate() {
        let mine = near[k];
        let same = |m: &Nearest| m.counts && (m.way - mine.way).norm_squared() <= m.blur();
        let nearer = |m: &Nearest| !mine.face && m.square < mine.square && m.holds(&mine.way);
        near[k].counts = !order[..n].iter().any(|&m| same(&near[m]) || nearer(&near[m]));
    }
    order.retain(|&k| near[k].counts);
    join(near, &order, radius);
}

/// Joins contacts whose normals differ little, of some in the order of their distance; those that do not bear most no longer count.
fn join(near: &mut [Nearest], order: &[usize], radius: f64) {
    if order.len() < 2 {
        return;
    }
    let face = |k: &usize| {
        let distance = near[*k].square.sqrt();
        Face { normal: near[*k].way / -distance, overlap: radius - distance }
    };
    let faces: Vec<Face> = order.iter().map(face).collect();
    let group = groups(&faces);
    for first in 0..order.len() {
        let members: Vec<usize> = (first..order.len()).filter(|&k| group[k] == first).collect();
        let bear: Vec<Face> = members.iter().map(|&k| faces[k]).collect();
        // One that is as long as the radius would put the point behind the centre: the deepest alone is left there.
        let out = shortest(&bear).map(|(u, most)| (u, u.norm(), most)).filter(|(_, q, _)| *q < radius);
        let Some(&deepest) = members.first() else { continue };
        let (way, most) =
            out.map_or((near[order[deepest]].way, 0), |(u, q, most)| (u * ((q - radius) / q), most));
        for (n, &k) in members.iter().enumerate() {
            let point = &mut near[order[k]];
            (point.way, point.counts) = (way, n == most);
        }
    }
}

/// Contact history of some slots of one segment.
pub struct HistorySlots<'a> {
    /// Of the whole segment, by block and column.
    pub history: &'a mut [f64],
    /// Whether each block of it may hold any.
    pub active: &'a mut [bool],
    /// How it is kept.
    pub layout: Layout,
    /// First of the slots.
    pub first: usize,
    /// Numbers of each contact.
    pub columns: usize,
    /// Rows of the energy ledger of the whole segment; empty without it.
    pub ledger: &'a mut [f64],
}

impl HistorySlots<'_> {
    /// The same from slot `by` on.
    pub fn from(&mut self, by: usize) -> HistorySlots<'_> {
        let HistorySlots { history, active, layout, first, columns, ledger } = self;
        HistorySlots { history, active, layout: *layout, first: *first + by, columns: *columns, ledger }
    }

    fn at(&self, k: usize, column: usize) -> usize {
        self.layout.history_at(0, self.first + k, column, self.columns)
    }

    fn stiffness(&self, k: usize) -> usize {
        (self.first + k) * LEDGER + STIFFNESS
    }

    fn remembers(&self, k: usize) -> bool {
        (0..self.columns).any(|c| self.layout.get(self.history, self.at(k, c)) != 0.0)
    }

    fn is_booked(&self, k: usize) -> bool {
        self.ledger[self.stiffness(k)] != 0.0
    }

    fn move_history(&mut self, from: usize, to: usize) {
        for c in 0..self.columns {
            let (a, b) = (self.at(from, c), self.at(to, c));
            let x = self.layout.get(self.history, a);
            self.layout.put(self.history, b, x);
            self.layout.put(self.history, a, 0.0);
        }
        // Or a block in which nothing touches is passed over, by as many contacts as are computed at once.
        self.active[(self.first + to) / BLOCK] = true;
    }

    fn move_stiffness(&mut self, from: usize, to: usize) {
        let (a, b) = (self.stiffness(from), self.stiffness(to));
        self.ledger[b] = std::mem::take(&mut self.ledger[a]);
    }

    /// Moves the history of points that no longer count to neighbours without history, and the stiffness at which the ledger booked
    /// them to neighbours without one. Each by itself: what moves is the same with the ledger and without.
    pub fn take_over(&mut self, near: &[Nearest], radius: f64) {
        if self.columns > 0 {
            self.hand_over(near, radius, HistorySlots::remembers, HistorySlots::move_history);
        }
        if !self.ledger.is_empty() {
            self.hand_over(near, radius, HistorySlots::is_booked, HistorySlots::move_stiffness);
        }
    }

    fn hand_over(
        &mut self,
        near: &[Nearest],
        radius: f64,
        holds: impl Fn(&Self, usize) -> bool,
        give: impl Fn(&mut Self, usize, usize),
    ) {
        for k in (0..near.len()).filter(|&k| !near[k].counts) {
            if !holds(self, k) {
                continue;
            }
            let away = |m: usize| (near[m].way - near[k].way).norm_squared();
            let free = (0..near.len()).filter(|&m| near[m].counts && !holds(self, m));
            let nearest = free.min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)));
            if let Some(m) = nearest.filter(|&m| away(m) <= (STRIDE * radius).powi(2)) {
                give(self, k, m);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block that was skipped is computed again once one of its contacts takes a history.
    #[test]
    fn a_block_that_takes_history_is_active() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let layout = Layout::default();
        let (mut history, mut active) = (vec![0.0; 2 * BLOCK], [true, false]);
        let at = |k: usize| layout.history_at(0, k, 0, 1);
        layout.put(&mut history, at(7), 3.0);
        // The grain's triangles are the last of one block and the first of the next.
        let mut near = [Nearest::of(triangle, Vec3::new(0.2, 0.2, 1.0)); 2];
        near[1].counts = true;
        let mut ledger = vec![0.0; 2 * BLOCK * LEDGER];
        ledger[7 * LEDGER + STIFFNESS] = 5.0;
        let (history_of, active_of, ledger_of) = (&mut history[..], &mut active[..], &mut ledger[..]);
        let mut slots = HistorySlots {
            history: history_of,
            active: active_of,
            layout,
            first: 0,
            columns: 1,
            ledger: ledger_of,
        };
        slots.from(7).take_over(&near, 1.0);
        assert_eq!((layout.get(&history, at(7)), layout.get(&history, at(8))), (0.0, 3.0));
        assert_eq!(active, [true, true]);
        assert_eq!((ledger[7 * LEDGER + STIFFNESS], ledger[8 * LEDGER + STIFFNESS]), (0.0, 5.0));
    }
}

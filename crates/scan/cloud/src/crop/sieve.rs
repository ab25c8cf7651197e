//! Which points stay so far, and why the others go.

use super::marks::{LAST, MARK, Reason, marks};
use super::shapes::ShapeTest;
use crate::points::Cloud;
use geom::{Shape, Vec3};
use rayon::prelude::*;
use stream::Values;

/// Why each point goes.
pub(crate) struct Sieve<'a> {
    points: &'a [Vec3],
    /// 0 of a point that stays, else the number of a [`Reason`], with [`BEFORE`] of a point that was marked before; or [`NOT_FINITE`].
    reasons: Vec<u8>,
}

/// Added to the number of a reason: an earlier crop has marked the point.
pub(crate) const BEFORE: u8 = 64;
/// The reason of points without finite coordinates; never written.
pub(crate) const NOT_FINITE: u8 = 32;

impl<'a> Sieve<'a> {
    /// Shapes, and marks that a cloud has.
    pub fn new(cloud: &'a Cloud, judge: &ShapeTest) -> Sieve<'a> {
        let marks = marks(cloud).unwrap_or_default();
        let of = |(i, p): (usize, &Vec3)| match marks.get(i) {
            _ if !p.iter().all(|c| c.is_finite()) => NOT_FINITE,
            _ if !judge.stays(p) => Reason::Shape as u8,
            None | Some(0) => 0,
            Some(mark) => BEFORE | mark,
        };
        Sieve { points: &cloud.points, reasons: cloud.points.par_iter().enumerate().map(of).collect() }
    }

    /// How many points have such a reason.
    pub fn count(&self, has: impl Fn(u8) -> bool) -> usize {
        self.reasons.iter().filter(|r| has(**r)).count()
    }

    /// The points that stay so far, with their rows [m].
    pub fn staying(&self) -> impl Iterator<Item = (usize, &'a Vec3)> {
        let all = self.points.iter().enumerate().zip(&self.reasons);
        all.filter(|(_, reason)| **reason == 0).map(|(point, _)| point)
    }

    /// The points that stay so far [m].
    pub fn points(&self) -> Vec<Vec3> {
        self.staying().map(|(_, p)| *p).collect()
    }

    /// Of the points so far, those at the given ascending places stay; says how many go.
    pub fn keep(&mut self, reason: Reason, places: &[u32]) -> usize {
        self.judge(reason, places, true)
    }

    /// Of the points so far, those at the given ascending places go.
    pub fn remove(&mut self, reason: Reason, places: &[u32]) {
        self.judge(reason, places, false);
    }

    fn judge(&mut self, reason: Reason, places: &[u32], listed_stay: bool) -> usize {
        let mut places = places.iter().copied().peekable();
        let mut gone = 0;
        for (place, own) in (0u32..).zip(self.reasons.iter_mut().filter(|own| **own == 0)) {
            let listed = places.next_if_eq(&place).is_some();
            if listed != listed_stay {
                *own = reason as u8;
                gone += 1;
            }
        }
        gone
    }

    /// Points in the shapes come back if a rule or a mark has removed them; how many.
    pub fn restore(&mut self, shapes: &[Shape]) -> usize {
        let by_rule = Reason::Outlier as u8..=LAST as u8;
        let mut count = 0;
        for (reason, p) in self.reasons.iter_mut().zip(self.points) {
            let can = *reason & BEFORE != 0 || by_rule.contains(reason);
            if can && shapes.iter().any(|s| s.contains(p)) {
                *reason = 0;
                count += 1;
            }
        }
        count
    }

    /// What stays; or all that is finite, with marks.
    pub fn cloud(&self, cloud: &Cloud, mark: bool) -> Cloud {
        let goes = |reason: u8| if mark { reason == NOT_FINITE } else { reason != 0 };
        let rows: Vec<u32> =
            (0u32..).zip(&self.reasons).filter(|(_, r)| !goes(**r)).map(|(i, _)| i).collect();
        let mut out = if rows.len() == cloud.points.len() { cloud.clone() } else { cloud.select(&rows) };
        if marks(cloud).is_some() {
            out.attributes.remove(MARK);
        }
        if mark {
            let marks = rows.iter().map(|&r| self.reasons[r as usize] & !BEFORE).collect();
            let added = out.attributes.push(MARK, Values::U8(marks));
            debug_assert!(added.is_ok(), "as many marks as rows, and no other column of this name");
        }
        out
    }
}

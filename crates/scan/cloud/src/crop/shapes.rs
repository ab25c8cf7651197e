//! The shapes of a crop, and which of them change nothing.

use super::rules::{Action, Rules};
use geom::{Shape, Vec3};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Shapes that a point is in, or not.
pub(crate) struct ShapeTest<'a> {
    keep: Vec<Tried<'a>>,
    remove: Vec<Tried<'a>>,
}

/// A shape, and whether it has held a point that none before it held.
struct Tried<'a> {
    shape: &'a Shape,
    counts: AtomicBool,
}

impl<'a> Tried<'a> {
    fn new(shape: &'a Shape) -> Tried<'a> {
        Tried { shape, counts: AtomicBool::new(false) }
    }

    #[inline]
    fn holds(&self, p: &Vec3) -> bool {
        let holds = self.shape.contains(p);
        if holds && !self.counts.load(Relaxed) {
            self.counts.store(true, Relaxed);
        }
        holds
    }
}

impl ShapeTest<'_> {
    pub fn new(rules: &Rules) -> ShapeTest<'_> {
        let of = |action: Action| rules.regions.iter().filter(move |r| r.action == action).map(|r| &r.shape);
        ShapeTest {
            keep: rules.keep.iter().chain(of(Action::Keep)).map(Tried::new).collect(),
            remove: rules.remove.iter().chain(of(Action::Remove)).map(Tried::new).collect(),
        }
    }

    /// Shapes without a name that change nothing, once all points were seen.
    pub fn idle(&self, rules: &Rules) -> Vec<String> {
        let of = |option: &str, given: usize, tried: &[Tried]| {
            let idle = tried.iter().take(given).enumerate().filter(|(_, tried)| !tried.counts.load(Relaxed));
            idle.map(|(k, _)| {
                let which = if given > 1 { format!(" (number {})", k + 1) } else { String::new() };
                if k == 0 && (option == "--keep" || self.keep.is_empty()) {
                    format!("{option}{which} holds no point: compare its coordinates and their unit with those of the cloud")
                } else {
                    format!("{option}{which} changes nothing: it holds no point that other shapes leave to it")
                }
            })
            .collect::<Vec<String>>()
        };
        [of("--keep", rules.keep.len(), &self.keep), of("--remove", rules.remove.len(), &self.remove)]
            .concat()
    }

    /// Whether a point [m] stays, as far as shapes say.
    #[inline]
    pub fn stays(&self, p: &Vec3) -> bool {
        (self.keep.is_empty() || self.keep.iter().any(|s| s.holds(p)))
            && !self.remove.iter().any(|s| s.holds(p))
    }
}

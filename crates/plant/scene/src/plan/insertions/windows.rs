//! When an insertion is open: once, or again and again.

use crate::keys::Insert;

/// The times between which an insertion is open, and which of them is next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::plan) struct Windows {
    /// The first [s].
    from: f64,
    until: f64,
    /// From one to the next [s]; ∞: there is one only.
    period: f64,
    /// How many there are in all; ∞: without end.
    times: f64,
    /// Those that are over.
    past: f64,
}

/// How long an insertion is open until a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::plan) struct Open {
    /// In all [s].
    pub time: f64,
    /// ∫ of the time that it has been open, over the time until then [s²].
    pub moment: f64,
}

impl Windows {
    /// Those of an entry.
    pub(in crate::plan) fn new(entry: &Insert) -> Windows {
        let period = entry.repeat.unwrap_or(f64::INFINITY);
        let times = match entry.repeat {
            None => 1.0,
            Some(_) => entry.times.map_or(f64::INFINITY, |n| n as f64),
        };
        Windows { from: entry.from, until: entry.ends().unwrap_or(f64::INFINITY), period, times, past: 0.0 }
    }

    /// The same, each over after a time [s] at the latest.
    pub(in crate::plan) fn within(self, longest: f64) -> Windows {
        Windows { until: self.until.min(self.from + longest), ..self }
    }

    /// When the last of them is over [s]; ∞ without an end.
    pub(in crate::plan) fn last(&self) -> f64 {
        self.until + self.shift(self.times - 1.0)
    }

    fn shift(&self, k: f64) -> f64 {
        if k == 0.0 { 0.0 } else { k * self.period }
    }

    /// Start of the window that is open or next [s].
    pub(in crate::plan) fn from(&self) -> f64 {
        self.from + self.shift(self.past)
    }

    /// Its end [s].
    pub(in crate::plan) fn until(&self) -> f64 {
        self.until + self.shift(self.past)
    }

    /// Goes on by so many; false after the last.
    pub(in crate::plan) fn advance(&mut self, by: f64) -> bool {
        let more = self.past + by < self.times;
        if more {
            self.past += by;
        }
        more
    }

    /// Whether both are open at one time, when each stays open longer by a time [s]. Two that repeat in different periods count as such unless one is over
    /// before the other begins.
    pub(in crate::plan) fn meet(&self, other: &Windows, longer: f64, other_longer: f64) -> bool {
        let end = |w: &Windows, longer: f64| w.last() + longer;
        if self.from >= end(other, other_longer) || other.from >= end(self, longer) {
            return false;
        }
        let (a, b) = (self.until - self.from + longer, other.until - other.from + other_longer);
        // How much later than the start of one the other starts, within one period.
        let later = |one: &Windows, two: &Windows| (two.from - one.from).rem_euclid(one.period);
        match (self.period.is_finite(), other.period.is_finite()) {
            (false, false) => true,
            (true, true) => self.period != other.period || later(self, other) < a || later(other, self) < b,
            (true, false) => later(self, other) < a || later(self, other) + b > self.period,
            (false, true) => later(other, self) < b || later(other, self) + a > other.period,
        }
    }

    /// How long it is open until `end` [s], each time for at most `longest` [s].
    pub(in crate::plan) fn open(&self, end: f64, longest: f64) -> Open {
        let each = (self.until - self.from).min(longest);
        if !(end > self.from) {
            return Open { time: 0.0, moment: 0.0 };
        }
        let begun = (((end - self.from) / self.period).floor() + 1.0).min(self.times);
        // The last that has begun may still be open; those before it are over.
        let last = (end - self.from - self.shift(begun - 1.0)).min(each);
        let after = end - self.from - self.shift(begun - 1.0) - last;
        let full = begun - 1.0;
        let since = full * (end - self.from - 0.5 * each) - self.shift(0.5 * full * (full - 1.0));
        let all = if full > 0.0 {
            Open { time: full * each, moment: each * since }
        } else {
            Open { time: 0.0, moment: 0.0 }
        };
        Open { time: all.time + last, moment: all.moment + last * (0.5 * last + after) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn windows(from: f64, until: f64, period: f64, times: f64) -> Windows {
        Windows { from, until, period, times, past: 0.0 }
    }

    /// Every window one by one.
    fn each(w: &Windows, end: f64) -> Vec<(f64, f64)> {
        let mut w = *w;
        let mut all = Vec::new();
        loop {
            if w.from() >= end {
                return all;
            }
            all.push((w.from(), w.until()));
            if !w.advance(1.0) {
                return all;
            }
        }
    }

    fn cases() -> Vec<Windows> {
        let mut all = Vec::new();
        for from in [0.0, 0.4, 1.1, 2.9] {
            for length in [0.2, 0.5, 1.0] {
                for (period, times) in [(f64::INFINITY, 1.0), (1.0, 3.0), (1.0, f64::INFINITY), (1.6, 2.0)] {
                    all.push(windows(from, from + length, period, times));
                }
            }
        }
        all
    }

    #[test]
    fn what_is_open_is_the_sum_of_the_windows() {
        for w in cases() {
            for end in [0.3, 1.05, 2.0, 7.3] {
                for longest in [0.15, 0.8, f64::INFINITY] {
                    let (mut time, mut moment) = (0.0, 0.0);
                    for (from, until) in each(&w, end) {
                        let open = (until - from).min(longest).min(end - from);
                        time += open;
                        moment += open * (end - from - 0.5 * open);
                    }
                    let found = w.open(end, longest);
                    assert!((found.time - time).abs() < 1e-12, "{w:?} {end}: {found:?} {time}");
                    assert!((found.moment - moment).abs() < 1e-12, "{w:?} {end}: {found:?} {moment}");
                }
            }
        }
    }

    #[test]
    fn two_meet_where_any_of_their_windows_do() {
        let mut met = [0, 0];
        for a in cases() {
            for b in cases() {
                let (longer, other) = (0.03, 0.01);
                let overlap = |x: &(f64, f64), y: &(f64, f64)| x.0 < y.1 + other && y.0 < x.1 + longer;
                let truth = each(&a, 40.0).iter().any(|x| each(&b, 40.0).iter().any(|y| overlap(x, y)));
                let found = a.meet(&b, longer, other);
                // Never overlooked; said too often only where the periods differ, or one of the two ends.
                assert!(found || !truth, "{a:?} {b:?}");
                let exact = a.period == b.period && a.times == b.times
                    || !a.period.is_finite() && b.times.is_infinite();
                assert!(!exact || found == truth, "{a:?} {b:?}");
                met[usize::from(truth)] += 1;
            }
        }
        assert!(met[0] > 100 && met[1] > 100);
    }
}

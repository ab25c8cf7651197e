//! `[[insert]]`: particles that come through a cross-section at a rate.
//!
//! The shape is a zone: particles are generated where its velocity enters it, keep that velocity through it and
//! are free behind it. Seen from the moving particles, successive positions are random and no two
//! touch, because two particles that come Δt apart are v Δt apart along the velocity v. Where several entries leave no room for one, it is given where it
//! has room first, and the engine decides by its `when_blocked`.

use crate::error::{Result, SceneError};
use crate::plan::insertions::ahead::Ahead;
use crate::plan::insertions::feed::{Expected, Feed};
use dem::setup::{Entry, WhenBlocked};
use geom::{Shown, Vec3};
use rand_pcg::Pcg64Mcg;

/// Draws for a place: random positions saturate at a solid fraction of 0.38 in space.
const TRIES: usize = 20_000;
/// Draws for a grain after several that found no room: what is saturated is not searched at full length for each.
const FEWEST_TRIES: usize = 250;
/// Draws after which a grain does not fit into the shape at all.
const MOST_TRIES: usize = 100 * TRIES;
const CURE: &str = "use a wider shape, or smaller grains";

/// Entries of `[[insert]]` that come through one place at one velocity, and give their particles one after the other, in the order of their
/// times: none touches another, of whichever entry, as long as there is room.
#[derive(Debug, Clone)]
pub struct Insertion {
    pub(in crate::plan) feeds: Vec<Feed>,
    /// Those that the next may touch.
    ahead: Ahead,
    /// Draws for the next place.
    tries: usize,
}

/// A particle that an insertion gives.
#[derive(Debug, Clone, Copy)]
pub struct Planned {
    /// When and where it is due.
    pub entry: Entry,
    /// Whether particles before it leave it no room then: the engine has it wait, leaves it out or stops.
    pub blocked: bool,
}

/// A position across the flow.
struct Place {
    across: Vec3,
    /// Those before it are clear of it once they are this much further on [m]; 0: when it is due.
    clear_after: f64,
}

impl Insertion {
    /// Entries that come through one place.
    pub(in crate::plan) fn new(feeds: Vec<Feed>) -> Insertion {
        Insertion { feeds, ahead: Ahead::default(), tries: TRIES }
    }

    /// Names of its entries in messages.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.feeds.iter().map(|feed| feed.key.as_str())
    }

    /// Time of the next particle [s]; `None` when the insertion has ended.
    pub fn next_time(&self) -> Option<f64> {
        self.first().map(|(time, _)| time)
    }

    /// The time of the next particle [s] and the feed that gives it.
    fn first(&self) -> Option<(f64, usize)> {
        let times = self.feeds.iter().zip(0..).filter_map(|(feed, k)| Some((feed.next_time()?, k)));
        times.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    }

    /// Particles that come until a time [s] since t = 0; members of clumps count one by one.
    pub fn expected(&self, end: f64) -> Expected {
        let each = self.feeds.iter().map(|feed| feed.expected(end));
        each.fold(Expected { all: 0.0, mean: 0.0 }, |sum, more| Expected {
            all: sum.all + more.all,
            mean: sum.mean + more.mean,
        })
    }

    /// The next particle: where it touches none of those before it, or else where they are gone first.
    ///
    /// # Errors
    /// A particle that does not fit into the shape.
    pub fn next_entry(&mut self) -> Result<Option<Planned>> {
        let Some((time, at)) = self.first() else { return Ok(None) };
        let feed = &self.feeds[at];
        let mut random = feed.random.clone();
        let grain = feed.inserted.grading.next(&mut random);
        let found = self.place(at, grain.diameter / 2.0, time, &mut random);
        let feed = &mut self.feeds[at];
        feed.random = random;
        let Some(Place { across, clear_after }) = found else {
            let (size, time) = (Shown(grain.diameter), Shown(time));
            let why =
                format!("a particle of diameter {size} m, due at {time} s, does not fit into the shape");
            return Err(SceneError::file(&feed.key, why, CURE));
        };
        Ok(Some(Planned { entry: feed.entry(time, across, &grain), blocked: clear_after > 0.0 }))
    }

    /// A position across the flow where a sphere of a feed touches none of those before it, or for the shortest time.
    fn place(&mut self, feed: usize, radius: f64, time: f64, random: &mut Pcg64Mcg) -> Option<Place> {
        let Feed { section, velocity, when_blocked, .. } = &self.feeds[feed];
        let axis = section.frame[0];
        let reach = velocity.norm() * time;
        let behind = axis * (section.ranges[0].0 - reach);
        // Those further ahead of every start than the largest diameter touch nothing that comes from now on.
        let largest = |f: &Feed| f.inserted.grading.range().high;
        let start = |f: &Feed| f.section.ranges[0].0 + largest(f);
        let far = self.feeds.iter().map(start).fold(f64::NEG_INFINITY, f64::max);
        self.ahead.forget(&axis, far - reach);
        let mut best: Option<Place> = None;
        for n in 0..MOST_TRIES {
            if n >= self.tries && best.is_some() {
                break;
            }
            let Some(across) = section.candidate(radius, random) else { continue };
            let least = best.as_ref().map_or(f64::INFINITY, |place| place.clear_after);
            let clear_after = self.ahead.clear_after(across + behind, radius, &axis, least);
            if clear_after < least {
                best = Some(Place { across, clear_after });
            }
            if clear_after == 0.0 {
                break;
            }
        }
        let place = best?;
        let blocked = place.clear_after > 0.0;
        self.tries = if blocked { self.tries / 2 } else { self.tries * 2 }.clamp(FEWEST_TRIES, TRIES);
        // One that waits for long is not reckoned with: the engine looks for its room.
        let comes = match when_blocked {
            WhenBlocked::Wait => place.clear_after <= largest(&self.feeds[feed]),
            WhenBlocked::Skip | WhenBlocked::Stop => !blocked,
        };
        if comes {
            self.ahead.push(place.across + behind - axis * place.clear_after, radius);
        }
        Some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::plan::builder::PlanBuilder;
    use geom::sphere::volume;
    use std::path::Path;

    fn insertion(rate: f64) -> Result<Insertion> {
        inserted(rate, "until = 1")
    }

    fn inserted(rate: f64, end: &str) -> Result<Insertion> {
        let toml = format!(
            "[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
             [[insert]]\nmaterial = \"m\"\nshape = \"cylinder:0,0,1,0,0,1.03,0.05\"\ndiameter = [0.01, 0.02]\n\
             velocity = [0, 0, -1]\nrate = {rate}\n{end}"
        );
        let scene = Scene::new("s", toml, &[], Path::new(""))?;
        let mut builder = PlanBuilder::new(&scene);
        builder.insertions()?;
        let insertion = builder.insertions.remove(0);
        let zone = insertion.feeds[0].section.zone();
        assert!((zone.length - 0.03).abs() < 1e-12 && (zone.plane.point.z - 1.0).abs() < 1e-12);
        Ok(insertion)
    }

    #[test]
    fn an_insertion_keeps_its_rate_and_nothing_overlaps_on_the_way() {
        let mut insertion = insertion(0.8).unwrap();
        let start = insertion.clone();
        let mut all: Vec<Entry> = Vec::new();
        while let Some(Planned { entry, blocked }) = insertion.next_entry().unwrap() {
            assert!(!blocked);
            assert!((entry.particle.position.z - 1.03).abs() < 1e-12);
            all.push(entry);
        }
        let mass: f64 = all.iter().map(|e| 1000.0 * volume(e.particle.radius)).sum();
        assert!((mass - 0.8).abs() < 0.01, "{mass} kg in 1 s");
        let Expected { all: expected, mean: there } = start.expected(2.0);
        assert!((all.len() as f64 / expected - 1.0).abs() < 0.1, "{} of {expected}", all.len());
        // Open in the first half of the time: half of them in it, all of them behind it.
        assert!((there / expected - 0.75).abs() < 1e-12, "{there} of {expected} on average");
        none_touch(&all);
    }

    /// The next particle of one that has room for all.
    fn next(insertion: &mut Insertion) -> Option<Entry> {
        let Planned { entry, blocked } = insertion.next_entry().unwrap()?;
        assert!(!blocked, "{} s", entry.time);
        Some(entry)
    }

    fn none_touch(all: &[Entry]) {
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                assert!(a.time >= b.time);
                let apart =
                    a.particle.position - b.particle.position - b.particle.velocity * (a.time - b.time);
                assert!(apart.norm() >= a.particle.radius + b.particle.radius - 1e-12, "{} s", a.time);
            }
        }
    }

    /// Insertions of a text that holds all of their keys but material, shape and sizes.
    fn several(entries: &[&str]) -> Result<Vec<Insertion>> {
        let entry = |keys: &&str| {
            format!(
                "[[insert]]\nmaterial = \"m\"\nshape = \"cylinder:0,0,1,0,0,1.03,0.05\"\n\
                 diameter = [0.01, 0.02]\n{keys}\n"
            )
        };
        let head = "[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n";
        let toml = head.to_owned() + &entries.iter().map(entry).collect::<String>();
        let scene = Scene::new("s", toml, &[], Path::new(""))?;
        let mut builder = PlanBuilder::new(&scene);
        builder.insertions()?;
        Ok(builder.insertions)
    }

    #[test]
    fn two_that_follow_each_other_at_one_place_do_not_touch() {
        let layer = |from: f64| {
            format!("velocity = [0, 0, -1]\nrate = 0.8\nseed = {from}\nfrom = {from}\nuntil = {}", from + 1.0)
        };
        let mut found = several(&[&layer(0.0), &layer(1.0), &layer(2.0)]).unwrap();
        assert_eq!(found.len(), 1, "one group");
        let all: Vec<Entry> = std::iter::from_fn(|| next(&mut found[0])).collect();
        none_touch(&all);
        // Another velocity while grains of the first are on their way is refused; a little later it is not.
        let other = |from: &str| format!("velocity = [0, 0, -2]\nrate = 0.8\nfrom = {from}");
        let message = several(&[&layer(0.0), &other("1.02")]).unwrap_err().to_string();
        assert!(message.contains("insert.1.velocity") && message.contains("same place"), "{message}");
        assert_eq!(several(&[&layer(0.0), &other("1.031")]).unwrap().len(), 2);
    }

    #[test]
    fn an_insertion_that_repeats_inserts_its_mass_each_time() {
        let coke =
            "velocity = [0, 0, -1]\nrate = 0.21\nfrom = 0.5\nuntil = 1.5\nrepeat = 2\ntimes = 3\nmass = 0.2";
        let ore =
            "velocity = [0, 0, -1]\nrate = 0.8\nfrom = 1.5\nuntil = 2.5\nrepeat = 2\ntimes = 2\ncount = 30";
        let mut found = several(&[coke, ore]).unwrap();
        assert_eq!(found.len(), 1);
        let expected = found[0].expected(100.0).all;
        let all: Vec<Entry> = std::iter::from_fn(|| next(&mut found[0])).collect();
        none_touch(&all);
        let window = |from: f64| all.iter().filter(move |e| (from..from + 1.0).contains(&e.time));
        for k in 0..3 {
            let mass: f64 =
                window(0.5 + 2.0 * f64::from(k)).map(|e| 1000.0 * volume(e.particle.radius)).sum();
            assert!((mass - 0.2).abs() <= 1000.0 * volume(0.01) / 2.0, "{mass} kg");
        }
        let ores = [1.5, 3.5, 5.5].map(|from| window(from).count());
        assert_eq!(ores, [30, 30, 0]);
        assert!((expected / all.len() as f64 - 1.0).abs() < 0.1, "{expected} of {}", all.len());
        // A rate is one over the time that it is open, however short that is.
        for (until, repeat, open) in [(0.2, 0.2, 1.0), (0.001, 0.02, 0.05), (0.1, 0.2, 0.5)] {
            let keys = format!("velocity = [0, 0, -1]\nrate_count = 203\nuntil = {until}\nrepeat = {repeat}");
            let mut found = several(&[&keys]).unwrap();
            let next = || next(&mut found[0]).filter(|e| e.time < 1.0);
            let (count, due) = (std::iter::from_fn(next).count() as f64, 203.0 * open);
            // The first comes at once.
            assert!((count - due).abs() <= 1.0, "{count} of {due}: {until} of {repeat} s");
        }
        // What ends by itself is open for a period at most.
        for (keys, each, short) in
            [("rate = 0.8\nmass = 0.2", 0.2, None), ("rate = 0.8\nmass = 3", 1.6, Some("mass"))]
        {
            let keys = format!("velocity = [0, 0, -1]\n{keys}\nrepeat = 2\ntimes = 3");
            let mut found = several(&[&keys]).unwrap();
            assert_eq!(found[0].feeds[0].falls_short().map(|f| f.0), short, "{keys}");
            let all: Vec<Entry> = std::iter::from_fn(|| next(&mut found[0])).collect();
            for k in 0..3 {
                let from = 2.0 * f64::from(k);
                let come = all.iter().filter(|e| (from..from + 2.0).contains(&e.time));
                let mass: f64 = come.map(|e| 1000.0 * volume(e.particle.radius)).sum();
                assert!((mass - each).abs() <= 1000.0 * volume(0.02), "{keys}, time {k}: {mass} kg");
            }
        }
        let wrong = [
            ("until = 1\nrepeat = 0.5", "insert.0.repeat = 0.5 s: is shorter than the 1 s"),
            ("repeat = 2", "repeats what never ends; add insert.0.until"),
            ("times = 2", "add insert.0.repeat"),
            ("until = 1\nrepeat = 2\ntimes = 0", "insert.0.times = 0"),
        ];
        for (keys, part) in wrong {
            let message = several(&[&format!("velocity = [0, 0, -1]\nrate = 0.8\n{keys}")]).unwrap_err();
            assert!(message.to_string().contains(part), "{keys}: {message}");
        }
    }

    fn all(mut insertion: Insertion) -> Vec<f64> {
        std::iter::from_fn(|| next(&mut insertion)).map(|e| 1000.0 * volume(e.particle.radius)).collect()
    }

    #[test]
    fn an_insertion_ends_after_its_number_or_its_mass() {
        assert_eq!(all(inserted(0.8, "count = 37").unwrap()).len(), 37);
        let found = all(inserted(0.8, "mass = 0.2").unwrap());
        let (mass, last) = (found.iter().sum::<f64>(), found[found.len() - 1]);
        assert!((mass - 0.2).abs() <= 1000.0 * volume(0.01) / 2.0, "{mass} kg, the last {last} kg");
        // Whichever end comes first.
        assert!(all(inserted(0.8, "count = 1000000\nuntil = 0.05").unwrap()).len() < 50);
        let expected = inserted(0.8, "mass = 0.2").unwrap().expected(10.0).all;
        assert!((expected / found.len() as f64 - 1.0).abs() < 0.15, "{expected} of {}", found.len());
        for (end, part) in
            [("count = 0", "1 or more"), ("mass = -1", "above 0"), ("mass = 1\ncount = 1", "only one")]
        {
            let message = inserted(0.8, end).unwrap_err().to_string();
            assert!(message.contains(part), "{end}: {message}");
        }
    }

    #[test]
    fn a_rate_that_does_not_fit_is_refused() {
        let message = insertion(8.0).unwrap_err().to_string();
        assert!(message.contains("insert.0.rate = 8 kg/s") && message.contains("at most 30 %"), "{message}");
    }
}

//! From the runs to points with errors, and what they say.

use crate::study::{CurveError, Study, Wanted, Work};
use crate::sweep::Sweep;
use crate::sweep::measure::Measure;
use crate::sweep::script::{Counter, SweepRun};
use crate::sweep::work::{self, Made};
use crate::{Choice, Error, MeasuredRun, Point, Repeats, Truth, errors, front, percent, recommend, sentence};
use crate::{amount, change, order, share_of_time};
use measure::statistics::student;

/// Times of a point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cost {
    /// Wall time for each simulated second, median over the runs [s/s].
    pub seconds: f64,
    /// Steps for each simulated second [1/s].
    pub steps: f64,
    /// Wall time of the line that made its input, median [s].
    pub prepared: f64,
}

/// The curve.
pub struct Judged {
    /// The points, as in the grid.
    pub points: Vec<Point>,
    pub costs: Vec<Cost>,
    pub errors: Vec<Option<Error>>,
    /// Whether these are shares of the truth; else they are in the unit of the measure.
    pub relative: bool,
    /// Which of them nothing beats.
    pub front: Vec<usize>,
    /// What to take, when that was asked for in a unit that the errors have.
    pub choice: Option<Choice>,
    /// Error that is good enough, and whether it is a share.
    pub wanted: (f64, bool),
    /// Name and unit of the measure.
    pub what: (String, String),
    /// Points that are compared with, and in use.
    pub marks: (Option<usize>, Option<usize>),
    /// What a run costs: `time`, `steps`, `instructions`.
    pub of: &'static str,
    /// Phases of the step at which each point ran.
    pub phases: u64,
}

/// Points with their samples and times.
struct Measured {
    points: Vec<Point>,
    costs: Vec<Cost>,
    unit: String,
}

/// Reads and measures all runs and judges them.
///
/// # Errors
/// No run came to its end, something that cannot be measured.
pub fn judge(
    study: &Study,
    sweep: &Sweep,
    measure: &Measure,
    counter: Option<Counter>,
) -> Result<Judged, CurveError> {
    let grid = &sweep.grid;
    let Measured { points, costs, unit } = measured(study.work, sweep, measure, counter)?;
    check_failed(&points, grid.reference)?;
    let truth = match (grid.reference, study.truth) {
        (Some(reference), _) => Truth::Point(reference),
        (None, truth) => truth.map_or(Truth::Value(f64::NAN, 0.0), |t| Truth::Value(t.value, t.half_width)),
    };
    let repeats = if sweep.phases > 1 { Repeats::Phases } else { Repeats::Seeds };
    let errors = errors(&points, truth, study.norm, repeats);
    let works: Vec<f64> = points.iter().map(Point::work).collect();
    let relative = errors.iter().flatten().all(|e| e.relative);
    let (wanted, share) = match study.wanted.unwrap_or(Wanted::Share(0.01)) {
        Wanted::Share(share) => (share, true),
        Wanted::Absolute(size) => (size, false),
    };
    if study.wanted.is_some() && share != relative {
        let why = match relative {
            true => "the truth is not zero, so errors are shares of it: give a share, such as 1%",
            false => "the truth is zero, so errors are in the unit of the measure: give an error without %",
        };
        return Err(CurveError::Usage(format!("--for: {why}")));
    }
    Ok(Judged {
        front: front(&works, &errors),
        choice: (share == relative).then(|| recommend(&works, &errors, grid.reference, wanted)),
        costs,
        relative,
        wanted: (wanted, share),
        what: (measure.name.clone(), unit),
        marks: (grid.reference, grid.in_use.filter(|k| points[*k].failed.is_none())),
        of: study.work.name(),
        phases: sweep.phases,
        points,
        errors,
    })
}

/// The results of all runs, by point.
fn measured(
    work: Work,
    sweep: &Sweep,
    measure: &Measure,
    counter: Option<Counter>,
) -> Result<Measured, CurveError> {
    let empty = |setting: &Vec<(String, String)>| Point {
        setting: setting.clone(),
        samples: Vec::new(),
        failed: None,
    };
    let mut points: Vec<Point> = sweep.grid.settings.iter().map(empty).collect();
    let (mut all, mut unit) = (vec![Vec::new(); points.len()], String::new());
    for job in &sweep.jobs {
        let point = &mut points[job.setting];
        match work::read(job, work, counter)? {
            // Of several phases the first is that of the setting itself.
            Made::Failed(why) => drop(point.failed.get_or_insert(why)),
            Made::Done { work, seconds, steps, prepared } => {
                let found = measure.of(job, &sweep.tools)?;
                unit = found.unit;
                // Shorter steps are more steps; what counts is the cost of the setting.
                let share = 1.0 - job.shorten;
                point.samples.push(MeasuredRun { value: found.values, work: share * work, seed: job.repeat });
                all[job.setting].push(Cost { seconds: share * seconds, steps: share * steps, prepared });
            }
        }
    }
    // A setting that fails with some seeds cannot be relied on.
    points.iter_mut().filter(|p| p.failed.is_some()).for_each(|p| p.samples.clear());
    Ok(Measured { points, costs: all.iter().map(|runs| median(runs)).collect(), unit })
}

/// The first run of the reference, without which the others tell nothing; `None` without a reference.
pub fn first_of_reference(sweep: &Sweep) -> Option<&SweepRun> {
    let reference = sweep.grid.reference?;
    sweep.jobs.iter().find(|job| job.setting == reference)
}

/// Refuses a reference whose first run, which is made, failed.
///
/// # Errors
/// It was refused or stopped by a guard; it left nothing.
pub fn check_reference(work: Work, sweep: &Sweep, counter: Option<Counter>) -> Result<(), CurveError> {
    let Some(job) = first_of_reference(sweep) else { return Ok(()) };
    match work::read(job, work, counter)? {
        Made::Done { .. } => Ok(()),
        Made::Failed(why) => Err(CurveError::Failed(format!("{}: {why}", job.name)).at(NO_REFERENCE)),
    }
}

const NO_REFERENCE: &str = "the reference cannot be run: give another --reference";

/// Refuses a reference that failed, and a study in which all failed.
fn check_failed(points: &[Point], reference: Option<usize>) -> Result<(), CurveError> {
    let why = |k: usize| {
        let why = points.get(k)?.failed.clone()?;
        Some(CurveError::Failed(format!("{}: {why}", points[k].name())))
    };
    if let Some(error) = reference.and_then(why) {
        return Err(error.at(NO_REFERENCE));
    }
    if points.iter().all(|p| p.failed.is_some()) {
        let error = why(0).unwrap_or_else(|| CurveError::Failed("nothing to run".to_owned()));
        return Err(error.at("no point can be run"));
    }
    Ok(())
}

/// Seeds with which an error that may be chance is known to be good enough; `None` where it is too large beyond chance, or chance is not known.
///
/// The half width of n seeds is t s/√n, with Student's t of n − 1 degrees of freedom. What is within chance shrinks with it; of any other error the size stays.
fn seeds_to_tell(error: &Error, seeds: usize, wanted: f64) -> Option<usize> {
    let chance = error.within_chance();
    let (spread, room) = if chance { (error.upper(), wanted) } else { (error.interval, wanted - error.size) };
    if seeds < 2 || !(error.interval > 0.0) || !(room > 0.0) || error.upper() <= wanted {
        return None;
    }
    let width = |n: usize| student(n - 1) / (n as f64).sqrt();
    let limit = width(seeds) * room / spread;
    // Between one that is too few and one that is enough.
    let (mut few, mut enough) = (seeds, 2 * seeds);
    while width(enough) > limit && enough < MOST_SEEDS {
        (few, enough) = (enough, 2 * enough);
    }
    while enough - few > 1 {
        let middle = few + (enough - few) / 2;
        *(if width(middle) > limit { &mut few } else { &mut enough }) = middle;
    }
    (enough < MOST_SEEDS).then_some(enough)
}

/// More are out of reach.
const MOST_SEEDS: usize = 100_000;

fn median(runs: &[Cost]) -> Cost {
    let of = |get: fn(&Cost) -> f64| {
        let mut all: Vec<f64> = runs.iter().map(get).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
    };
    Cost { seconds: of(|c| c.seconds), steps: of(|c| c.steps), prepared: of(|c| c.prepared) }
}

impl Judged {
    /// What the sentences compare with: the setting in use, else the reference, else the one with the least error.
    pub fn base(&self) -> Option<usize> {
        let size = |k: &usize| self.errors[*k].map_or(f64::INFINITY, |e| e.size);
        let known = (0..self.points.len()).filter(|k| self.errors[*k].is_some());
        self.marks.1.or(self.marks.0).or_else(|| known.min_by(|a, b| size(a).total_cmp(&size(b))))
    }

    /// All results in words, a line each.
    pub fn words(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let Some(base) = self.base() else { return lines };
        let what = (self.what.0.as_str(), self.what.1.as_str());
        let role = if self.marks.1 == Some(base) { "In use" } else { "Compared with" };
        lines.push(format!("{role}: {}{}", self.points[base].name(), self.known(base)));
        for (k, point) in self.points.iter().enumerate().filter(|(k, _)| *k != base) {
            lines.push(match (&point.failed, &self.errors[k]) {
                (Some(why), _) => {
                    // Not the command that continues it: it names folders of this machine.
                    let why = why.split("; to go past the guard").next().unwrap_or_default();
                    format!("{} cannot be run: {why}", change(&self.points[base], point))
                }
                (None, Some(_)) if self.marks.0 == Some(k) => {
                    let time = share_of_time(point.work(), self.points[base].work(), self.of);
                    format!("{}, the reference, {time}", change(&self.points[base], point))
                }
                (None, Some(error)) => {
                    let base = (&self.points[base], self.errors[base].as_ref());
                    sentence(base, (point, error), what, self.of)
                }
                (None, None) => format!("{} cannot be compared", change(&self.points[base], point)),
            });
        }
        if self.points.first().is_some_and(|p| p.setting.len() == 1) {
            lines.extend(order(&self.points, &self.errors, (&self.what.0, self.of)));
        }
        lines.extend((self.phases > 1).then(|| {
            format!("Each error is the worst of {} phases of the step at which contacts begin", self.phases)
        }));
        lines.extend(self.advice());
        lines
    }

    /// `, with an error of 0.3 % in heap angle`
    fn known(&self, k: usize) -> String {
        match (&self.errors[k], self.marks.0 == Some(k)) {
            (_, true) => format!(", the reference for {}", self.what.0),
            (Some(error), _) if error.size == 0.0 && !(error.interval > 0.0) => {
                format!(", with no error in {}", self.what.0)
            }
            (Some(error), _) => {
                format!(", with an error of {} in {}", amount(error, &self.what.1), self.what.0)
            }
            _ => String::new(),
        }
    }

    fn size(&self, size: f64) -> String {
        match self.relative {
            true => percent(size),
            false if self.what.1 == "1" => geom::Shown(size).to_string(),
            false => format!("{} {}", geom::Shown(size), self.what.1),
        }
    }

    /// What to do where chance hides whether a setting is good enough: how many seeds would tell, of the setting that needs the fewest.
    fn seeds_needed(&self) -> Option<String> {
        let of = |k: usize| {
            let (error, seeds) = (self.errors[k]?, self.points[k].samples.len());
            Some((seeds, error, seeds_to_tell(&error, seeds, self.wanted.0)?))
        };
        if self.phases > 1 {
            return None;
        }
        let others = (0..self.points.len()).filter(|k| self.marks.0 != Some(*k));
        let (seeds, error, needed) = others.filter_map(of).min_by_key(|(.., needed)| *needed)?;
        let (interval, wanted) = (self.size(error.interval), self.size(self.wanted.0));
        Some(format!(
            "with {seeds} seeds the error is known to ± {interval}, which is too wide to tell {wanted}: about {needed} seeds would tell (--repeat)"
        ))
    }

    /// The recommended setting.
    pub fn advice(&self) -> Option<String> {
        let (wanted, of) = (self.size(self.wanted.0), self.of);
        let within = format!("within {wanted} in {}", self.what.0);
        Some(match self.choice? {
            Choice::Point(k) => {
                let time = match self.base().filter(|base| *base != k) {
                    Some(base) => {
                        let time = share_of_time(self.points[k].work(), self.points[base].work(), of);
                        format!("; it {time}")
                    }
                    None => String::new(),
                };
                format!("Recommended, the least {of} {within}: {}{time}", self.points[k].name())
            }
            Choice::OnlyReference(k) => {
                let cure = self.seeds_needed().unwrap_or_else(|| "try settings between".to_owned());
                format!("None but the reference ({}) is {within}: {cure}", self.points[k].name())
            }
            Choice::None(Some(k)) => {
                let upper = self.errors[k].map_or(f64::NAN, |e| e.upper());
                let cure = self.seeds_needed().map_or(String::new(), |cure| format!(": {cure}"));
                format!(
                    "None is {within}; nearest is {} with {}{cure}",
                    self.points[k].name(),
                    self.size(upper)
                )
            }
            Choice::None(None) => format!("None is {within}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seeds(size: f64, interval: f64, seeds: usize, wanted: f64) -> Option<usize> {
        seeds_to_tell(&Error { size, interval, relative: true }, seeds, wanted)
    }

    #[test]
    fn so_many_seeds_make_the_interval_narrow_enough() {
        let width = |n: usize| student(n - 1) / (n as f64).sqrt();
        for (size, interval, n, wanted) in [
            (0.000_92, 0.0086, 3, 0.0005),
            (0.05, 0.066, 8, 0.1),
            (0.04, 0.02, 3, 0.05),
            (0.04, 0.039, 2, 0.05),
        ] {
            let needed = seeds(size, interval, n, wanted).expect("too wide");
            let (spread, room) =
                if interval >= size { (size + interval, wanted) } else { (interval, wanted - size) };
            let of = |seeds: usize| spread * width(seeds) / width(n);
            assert!(needed > n && of(needed) <= room && of(needed - 1) > room, "{needed} seeds for {size}");
        }
        assert_eq!(seeds(0.05, 0.066, 8, 0.1), Some(10));
        // Good enough, too large beyond chance, or chance not known.
        assert_eq!(seeds(0.01, 0.01, 3, 0.05), None);
        assert_eq!(seeds(0.2, 0.1, 3, 0.05), None);
        assert_eq!(seeds(0.2, f64::NAN, 1, 0.05), None);
    }
}

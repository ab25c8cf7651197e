//! News of the paths of particles on their way in.

use crate::model::in_range::out_of_range;
use crate::model::{SetupError, Subject};
use crate::setup::{Entry, Guide, Sample, Setup};
use crate::state::{PathEnd, Zones};

impl Zones {
    /// Whether an entry only goes on with a path that was said to end, and has not come to that yet.
    pub fn comes_back(&mut self, entry: &Entry, setup: &Setup) -> Result<bool, SetupError> {
        let p = &entry.particle;
        let Some(path) = self.paths.get_mut(&p.id).filter(|path| path.end == PathEnd::Gone) else {
            return Ok(false);
        };
        path.end = PathEnd::Open;
        self.guide(p.id, Guide::At(Sample::of(entry)), setup)?;
        Ok(true)
    }

    /// Takes news of a path.
    pub fn guide(&mut self, id: u32, guide: Guide, setup: &Setup) -> Result<(), SetupError> {
        let wrong = |name, value: f64, allowed: &'static str| {
            Err(out_of_range(Subject::Path(id).quantity(name), value, "s", allowed))
        };
        let Some(path) = self.paths.get_mut(&id).filter(|p| p.end == PathEnd::Open) else {
            return wrong("news", f64::NAN, "the particles that are on their way in");
        };
        let mut add = |mut sample: Sample| {
            let last = path.samples.back().copied().unwrap_or(sample);
            if !(sample.time >= last.time)
                || !sample.position.iter().chain(&sample.velocity).all(|x| x.is_finite())
            {
                return wrong("time", sample.time, "times after the sample before, with finite states");
            }
            // The way to the next sample is the short one, also through a periodic face.
            for (axis, range) in setup.periodic.iter().enumerate() {
                if let Some((lo, hi)) = range {
                    let period = hi - lo;
                    sample.position[axis] -=
                        period * ((sample.position[axis] - last.position[axis]) / period).round();
                }
            }
            if sample.time == last.time {
                path.samples.pop_back();
            }
            path.samples.push_back(sample);
            Ok(())
        };
        match guide {
            Guide::At(sample) => add(sample)?,
            Guide::Free(sample) => {
                add(sample)?;
                path.end = PathEnd::Free;
            }
            Guide::Gone => path.end = PathEnd::Gone,
        }
        Ok(())
    }
}

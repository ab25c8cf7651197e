//! Which steps are frames, checkpoints, and the last one.
//!
//! The time step is never changed to hit a time: frame k is the step nearest to k · every / Δt.

use scene::keys::{Every, MOST_FRAMES, MOST_STEPS};
use scene::plan::SOFT;
use scene::{Scene, SceneError};

/// Steps of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Time step [s].
    pub dt: f64,
    /// Last step.
    pub last: u64,
    /// Time between frames [s].
    pub every: f64,
    checkpoint: Option<f64>,
}

impl Schedule {
    /// The schedule of a scene for a time step [s].
    ///
    /// # Errors
    /// An end that is missing or before the first step, frames closer than steps.
    pub fn new(scene: &Scene, dt: f64) -> Result<Schedule, SceneError> {
        let Some(until) = scene.keys.time.until else {
            let cure = "add until [s] to [time], or use --until";
            return Err(scene.wrong("time.until", "(nothing)", "the end of the run is missing", cure));
        };
        let output = &scene.keys.output;
        let every = match output.every {
            None => (until / 100.0).max(dt),
            Some(Every::Step) => dt,
            Some(Every::Given(every)) => every,
        };
        for (key, value) in [("output.every", Some(every)), ("output.checkpoint", output.checkpoint)] {
            if let Some(value) = value.filter(|value| *value < dt) {
                let why = format!("is shorter than the time step, {dt:.4e} s");
                return Err(scene.wrong(key, format!("{value} s"), &why, "make it longer"));
            }
        }
        let steps = (until / dt).round();
        if steps < 1.0 {
            let why = format!("is less than half the time step, {dt:.4e} s");
            return Err(scene.wrong("time.until", format!("{until} s"), &why, &longer(scene)));
        }
        counts(scene, until, steps, every, dt)?;
        let last = nearest(until, dt);
        Ok(Schedule { dt, last, every, checkpoint: output.checkpoint })
    }

    /// Time of the last step [s].
    pub fn end(&self) -> f64 {
        self.last as f64 * self.dt
    }

    /// Whether a frame is written after `step` steps; the last step always is one.
    pub fn is_frame(&self, step: u64) -> bool {
        step == self.last || self.hits(step, self.every)
    }

    /// The step of the frame after that of `step`; the last step after that.
    pub fn frame_after(&self, step: u64) -> u64 {
        let k = (step as f64 * self.dt / self.every).round();
        let next = [k, k + 1.0, k + 2.0].into_iter().map(|k| nearest(k * self.every, self.dt));
        next.into_iter().find(|next| *next > step).unwrap_or(self.last).min(self.last)
    }

    /// Whether a checkpoint is; the last step always is one.
    pub fn is_checkpoint(&self, step: u64) -> bool {
        step == self.last || (step > 0 && self.checkpoint.is_some_and(|every| self.hits(step, every)))
    }

    fn hits(&self, step: u64, every: f64) -> bool {
        let k = (step as f64 * self.dt / every).round();
        // Rounding may move the nearest multiple by one.
        [k - 1.0, k, k + 1.0].iter().any(|k| *k >= 0.0 && nearest(k * every, self.dt) == step)
    }
}

/// Refuses a run of more steps, frames or checkpoints than anybody waits for or stores.
fn counts(scene: &Scene, until: f64, steps: f64, every: f64, dt: f64) -> Result<(), SceneError> {
    let guards = &scene.keys.guards;
    let (most, key) = (guards.steps.unwrap_or(MOST_STEPS), "guards.steps");
    if steps > most {
        let why = format!("is {steps:.3e} steps of {dt:.4e} s, more than {key} = {most:e}");
        let cure = format!("end earlier, make the step longer, or raise {key}");
        return Err(scene.wrong("time.until", format!("{until} s"), &why, &cure));
    }
    let (most, key) = (guards.frames.unwrap_or(MOST_FRAMES), "guards.frames");
    let checkpoint = scene.keys.output.checkpoint;
    // The state at the start is a frame, and no checkpoint. A last one that is less than a step behind a multiple is that one.
    for (name, what, every, first) in
        [("output.every", "frames", Some(every), 1.0), ("output.checkpoint", "checkpoints", checkpoint, 0.0)]
    {
        let Some(every) = every else { continue };
        let count = first + ((until - 0.5 * dt) / every).ceil();
        if count > most {
            let count = if count < 1e6 { count.to_string() } else { format!("{count:.3e}") };
            let why = format!("is {count} {what} until {until} s, more than {key} = {most:e}");
            let cure = format!("make it longer, end earlier, or raise {key}");
            return Err(scene.wrong(name, format!("{every} s"), &why, &cure));
        }
    }
    Ok(())
}

/// The cure for a step that is too long for the run: the modulus may be in another unit.
fn longer(scene: &Scene) -> String {
    let softest = scene.keys.material.iter().min_by(|a, b| a.young.total_cmp(&b.young));
    match softest.filter(|m| m.young < SOFT) {
        Some(m) => format!(
            "material '{}' has young = {} Pa, which makes the step so long: give it in Pa (1 MPa is 1e6, 1 GPa is 1e9)",
            m.name, m.young
        ),
        None => "run longer".to_owned(),
    }
}

/// The step nearest to a time [s].
fn nearest(time: f64, dt: f64) -> u64 {
    (time / dt).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As many frames as a run writes, the first at t = 0, and no fewer.
    #[test]
    fn the_guard_counts_the_frames_that_are_written() {
        let dt = 1e-4;
        for (until, every) in [(0.01, 1e-3), (0.0105, 1e-3), (0.01, 3e-3), (0.01, 0.02), (0.01, dt)] {
            let toml = |frames: u64| {
                format!("[time]\nuntil = {until}\n[output]\nevery = {every}\n[guards]\nframes = {frames}\n")
            };
            let new = |frames: u64| {
                let scene = Scene::new("s", toml(frames), &[], std::path::Path::new("")).expect("a scene");
                Schedule::new(&scene, dt)
            };
            let schedule = new(1000).expect("enough");
            let written = (0..=schedule.last).filter(|step| schedule.is_frame(*step)).count() as u64;
            assert!(new(written).is_ok(), "{until} {every} {written}");
            let error = new(written - 1).map(drop).expect_err("one too few").to_string();
            assert!(error.contains(&format!("is {written} frames")), "{error}");
        }
    }

    #[test]
    fn every_multiple_has_one_frame() {
        let schedule = Schedule { dt: 7e-4, last: 1429, every: 0.01, checkpoint: Some(0.3) };
        let frames: Vec<u64> = (0..=1429).filter(|s| schedule.is_frame(*s)).collect();
        assert_eq!(frames.len(), 101);
        assert!(frames.iter().enumerate().all(|(k, s)| (*s as f64 * 7e-4 - k as f64 * 0.01).abs() <= 3.6e-4));
        let saved: Vec<u64> = (0..=1429).filter(|s| schedule.is_checkpoint(*s)).collect();
        assert_eq!(saved, [429, 857, 1286, 1429]);
    }
}

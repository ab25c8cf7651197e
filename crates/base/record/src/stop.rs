//! What stopped a run: the same record in the run's log, in the report of a tool, and between the two.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;

/// Signals by which a user, a closed terminal or a scheduler ends a program: HUP, INT, QUIT, TERM.
const ENDING: [i32; 4] = [1, 2, 3, 15];

/// What stopped a run before its end: `{"by": "guard", "guard": "overlap"}`, `{"by": "signal"}`, `{"by": "device"}`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "by", rename_all = "snake_case")]
pub enum StopCause {
    /// A signal: the same command would not stop there again.
    Signal,
    /// The device that makes the steps has failed.
    Device,
    /// A guard: the same scene would stop there again.
    Guard {
        /// Which one.
        guard: Guard,
    },
}

/// What a guard watches. The first four are switched by the keys `guards.*` of a scene; the others are always on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guard {
    /// Overlaps: `guards.overlap`.
    Overlap,
    /// Distances moved in one step: `guards.motion`.
    Motion,
    /// Energy that the time step makes: `guards.energy`.
    Energy,
    /// Particles that go back through the whole zone of an inlet: `guards.zones`.
    Zones,
    /// Positions and forces that are not numbers.
    NotANumber,
    /// Walls that follow a force or hang on a spring.
    Walls,
    /// The size of the periodic domain.
    Domain,
    /// Bonds that are made during the run.
    Bonds,
    /// Grains that are inserted without room, or into a wall.
    Insertion,
    /// Contact wrenches that are asked for and were not recorded.
    Wrenches,
}

impl StopCause {
    /// What an exit status alone tells, of a program that left no report; `None`: nothing stopped it from outside.
    ///
    /// A signal to a group of processes may end a program before the one that waits for it has noticed its own.
    pub fn of_exit(status: ExitStatus) -> Option<StopCause> {
        // Shells, and programs that end in order, give 128 and the number.
        let number = status.signal().or(status.code().map(|code| code - 128));
        number.filter(|number| ENDING.contains(number)).map(|_| StopCause::Signal)
    }

    /// What a message calls it, as in "stopped by a signal".
    pub fn name(self) -> &'static str {
        match self {
            StopCause::Signal => "signal",
            StopCause::Device => "device failure",
            StopCause::Guard { .. } => "guard",
        }
    }
}

/// What a report (`--report FILE`) holds of a stop.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ReportedStop {
    /// What stopped the run.
    #[serde(rename = "stop")]
    pub cause: StopCause,
    /// The sentence of the guard.
    #[serde(rename = "stopped")]
    pub text: String,
    /// Time reached [s].
    pub time: Option<f64>,
    /// Time at which the run was to end [s].
    pub until: Option<f64>,
}

impl ReportedStop {
    /// Reads a report; `None`: nothing stopped that run.
    ///
    /// # Errors
    /// A `stop` of another form.
    pub fn read(report: &Value) -> Result<Option<ReportedStop>, serde_json::Error> {
        if report["stop"].is_null() { Ok(None) } else { ReportedStop::deserialize(report).map(Some) }
    }

    /// Whether a signal stopped the run, so that it can be continued.
    pub fn is_by_signal(report: &Value) -> bool {
        matches!(ReportedStop::read(report), Ok(Some(stop)) if stop.cause == StopCause::Signal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// With the raw status of wait(2): the signal in the low bits, the exit code above.
    #[test]
    fn signals_of_a_user_are_told_from_failures_and_kills() {
        let of = |raw| StopCause::of_exit(ExitStatus::from_raw(raw));
        for signal in ENDING {
            assert_eq!([signal, (128 + signal) << 8].map(of), [Some(StopCause::Signal); 2]);
        }
        // Done, failed, wrong usage; out of memory, a fault of the program.
        assert_eq!([0, 1 << 8, 2 << 8, 9, 11, 137 << 8].map(of), [None; 6]);
    }

    /// Scripts and other programs read this form.
    #[test]
    fn a_cause_is_written_by_its_name_and_read_back() {
        for (cause, written) in [
            (StopCause::Signal, json!({"by": "signal"})),
            (StopCause::Device, json!({"by": "device"})),
            (StopCause::Guard { guard: Guard::NotANumber }, json!({"by": "guard", "guard": "not_a_number"})),
        ] {
            assert_eq!(serde_json::to_value(cause).unwrap(), written);
            let report = json!({"stopped": "by a signal", "stop": written, "time": 1.5, "until": null});
            let stop = ReportedStop::read(&report).unwrap().unwrap();
            assert_eq!((stop.cause, stop.time, stop.until), (cause, Some(1.5), None));
            assert_eq!(
                ReportedStop::is_by_signal(&report),
                cause == StopCause::Signal,
                "whatever the text says"
            );
        }
        assert_eq!(ReportedStop::read(&json!({"stopped": null})).unwrap(), None);
        assert!(ReportedStop::read(&json!({"stop": {"by": "chance"}})).is_err());
    }
}

//! What is measured of a run: by dem-measure, a value of its summary or a column of its rows.

use super::script::SweepRun;
use crate::study::CurveError;
use measure::definition::Figure;
use measure::registry::{ALL, Entry};
use record::StopCause;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Each result that has a name, and the measure that has it.
fn figures() -> impl Iterator<Item = (&'static Entry, &'static Figure)> {
    ALL.iter().flat_map(|entry| entry.figures.iter().map(move |figure| (entry, figure)))
}

#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// As it is called in sentences.
    pub name: String,
    /// Value of the summary, or column.
    value: String,
    /// Whether a column is meant, though the summary may have a value of that name.
    each: bool,
    /// Whether its name tells that it is one number of a run.
    number: bool,
    /// Options of dem-measure.
    options: Vec<String>,
}

/// What was measured of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// One number, or one for each row of a profile.
    pub values: Vec<f64>,
    pub unit: String,
}

impl Measure {
    /// From the text of `--measure`.
    ///
    /// # Errors
    /// A name that is not known.
    pub fn parse(text: &str) -> Result<Measure, CurveError> {
        let own = |words: &str| words.split_whitespace().map(str::to_owned).collect::<Vec<String>>();
        if let Some((value, options)) = text.split_once(" of ") {
            let (value, options) = (value.trim().to_owned(), own(options));
            let (value, each) = match value.strip_prefix("each ") {
                Some(column) => (column.trim().to_owned(), true),
                None => (value, false),
            };
            return Ok(Measure { name: value.replace('_', " "), value, each, number: false, options });
        }
        let words = own(text);
        let name = words.first().map_or("", String::as_str);
        if let Some((entry, figure)) = figures().find(|(_, figure)| figure.name == name) {
            let options = [vec![format!("--{}", entry.name)], words[1..].to_vec()].concat();
            let (name, value, number) = (name.replace('-', " "), figure.value.to_owned(), !figure.is_column);
            return Ok(Measure { name, value, each: false, number, options });
        }
        let near = scene::nearest(name, figures().map(|(_, figure)| figure.name));
        let hint = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
        let names: Vec<&str> = figures().map(|(_, figure)| figure.name).collect();
        Err(CurveError::Usage(format!(
            "--measure {text}: is not known{hint}: give one of {}, or 'VALUE of --MEASURE …' of dem-measure",
            names.join(", ")
        )))
    }

    /// Whether it is known to be one number of a run, of which a norm makes nothing else.
    pub fn is_number(&self) -> bool {
        self.number
    }

    /// Measures a run, or reads what was measured before.
    ///
    /// # Errors
    /// What dem-measure says, a missing value, a value that is not a number.
    pub fn of(&self, job: &SweepRun, tools: &Path) -> Result<Measured, CurveError> {
        let key = stream::sha256(format!("{}\n{}", job.stamp, self.options.join("\n")).as_bytes());
        let kept = job.file(&format!("measure-{:.12}.json", key));
        let program = tools.join("dem-measure");
        if !fresh(&kept, &job.file("run.mcap"), &program) {
            let mut command = Command::new(&program);
            command.arg(job.file("run.mcap")).args(&self.options).args(["--json", "-q", "-o"]).arg(&kept);
            let start = format!("{}: cannot be started", program.display());
            let done = command.output().map_err(CurveError::io(start))?;
            if StopCause::of_exit(done.status).is_some() {
                let why = "stopped by a signal while runs were measured: the same command continues";
                return Err(CurveError::Signal(why.to_owned()));
            }
            if !done.status.success() {
                return Err(CurveError::Failed(String::from_utf8_lossy(&done.stderr).trim().to_owned()));
            }
        }
        let text = std::fs::read_to_string(&kept).map_err(CurveError::io(kept.display().to_string()))?;
        let sheet: Value = serde_json::from_str(&text)
            .map_err(|e| CurveError::Failed(format!("{}: {e}", kept.display())))?;
        self.find(&sheet).map_err(|e| e.at(job.file("run.mcap").display().to_string()))
    }

    fn find(&self, sheet: &Value) -> Result<Measured, CurveError> {
        let no_number = || {
            CurveError::Failed(format!(
                "'{}' is not a number in this run: choose another measure",
                self.value
            ))
        };
        let unit = |head: &Value| head["unit"].as_str().unwrap_or("1").to_owned();
        if let Some(found) = sheet["summary"].get(&self.value).filter(|_| !self.each) {
            let value = found["value"].as_f64().ok_or_else(no_number)?;
            return Ok(Measured { values: vec![value], unit: unit(found) });
        }
        let columns = sheet["columns"].as_array().map(Vec::as_slice).unwrap_or_default();
        let Some(at) = columns.iter().position(|c| c["name"] == self.value.as_str()) else {
            let summary = sheet["summary"].as_object().into_iter().flat_map(|s| s.keys().cloned());
            let names = summary.chain(columns.iter().filter_map(|c| c["name"].as_str().map(str::to_owned)));
            let names = names.collect::<Vec<_>>().join(", ");
            return Err(CurveError::Usage(format!(
                "{} has no '{}': it has {names}",
                self.options.join(" "),
                self.value
            )));
        };
        let rows = sheet["rows"].as_array().map(Vec::as_slice).unwrap_or_default();
        // A cell of a profile without grains has no number; it counts as 0 in every run.
        let values: Vec<f64> = rows.iter().map(|row| row[at].as_f64().unwrap_or(0.0)).collect();
        if values.is_empty() { Err(no_number()) } else { Ok(Measured { values, unit: unit(&columns[at]) }) }
    }
}

/// Whether what was measured is younger than the run and the program.
fn fresh(kept: &Path, run: &Path, program: &Path) -> bool {
    let time = |path: &Path| std::fs::metadata(path).and_then(|m| m.modified()).ok();
    let kept = time(kept);
    kept.is_some() && kept >= time(run) && kept >= time(program)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_stand_for_options_and_values() {
        let m = Measure::parse("discharge-rate 0,0,0.6,0,0,-1 --from 0.2").unwrap();
        assert_eq!(m.options, ["--flow", "0,0,0.6,0,0,-1", "--from", "0.2"]);
        assert_eq!((m.name.as_str(), m.value.as_str()), ("discharge rate", "mass_flow"));
        let m = Measure::parse("height of --repose --sectors 4").unwrap();
        assert_eq!((m.value.as_str(), m.options.len()), ("height", 3));
        let why = Measure::parse("heap-angel").unwrap_err().to_string();
        assert!(why.contains("did you mean 'heap-angle'?"), "{why}");
    }

    #[test]
    fn values_are_found_in_summary_and_columns() {
        let sheet = json!({"columns": [{"name": "z", "unit": "m"}, {"name": "vx", "unit": "m/s"}],
            "rows": [[0.1, 1.0], [0.2, null]], "summary": {"angle": {"value": 30.5, "unit": "deg"}, "bad": {"value": null}}});
        let find = |value: &str| {
            let (name, value, options) = (String::new(), value.into(), vec!["--x".into()]);
            Measure { name, value, each: false, number: false, options }.find(&sheet)
        };
        let measured = |values: &[f64], unit: &str| Measured { values: values.to_vec(), unit: unit.into() };
        assert_eq!(find("angle").unwrap(), measured(&[30.5], "deg"));
        assert_eq!(find("vx").unwrap(), measured(&[1.0, 0.0], "m/s"));
        assert!(find("bad").unwrap_err().to_string().contains("not a number"));
        assert!(find("vz").unwrap_err().to_string().contains("it has angle, bad, z, vx"));
    }
}

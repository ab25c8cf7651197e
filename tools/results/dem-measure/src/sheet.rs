//! Writes rows as they come, as CSV or as one JSON document.

use anyhow::Context;
use cli::OutputStream;
use measure::{Head, Row, Summary};
use serde_json::{Map, Value, json};
use std::io::Write;

/// Where rows go.
pub struct Sheet {
    out: OutputStream,
    json: bool,
    measure: String,
    begun: bool,
    rows: u64,
}

impl Sheet {
    /// Nothing written yet.
    pub fn new(out: OutputStream, json: bool, option: &str) -> Sheet {
        let measure = option.trim_start_matches('-').to_owned();
        Sheet { out, json, measure, begun: false, rows: 0 }
    }

    /// Writes rows and sends them on: a reader may be waiting at the other end of a pipe.
    pub fn rows(&mut self, heads: &[Head], rows: &[Row]) -> anyhow::Result<()> {
        if rows.is_empty() {
            return Ok(());
        }
        self.write(heads, rows).and_then(|()| self.out.flush()).context("cannot write")
    }

    /// Writes the last rows and the sum, and gives the output its name; returns the number of rows.
    pub fn finish(mut self, heads: &[Head], rows: &[Row], summary: &Summary) -> anyhow::Result<u64> {
        self.write(heads, rows).context("cannot write")?;
        if self.json {
            let value = |(head, value): &(Head, f64)| {
                (head.name.clone(), json!({"value": number(*value), "unit": head.unit}))
            };
            let values: Map<String, Value> = summary.values.iter().map(value).collect();
            let values = Value::Object(values);
            let notes = json!(summary.notes);
            write!(self.out, "\n ],\n \"summary\": {values},\n \"notes\": {notes}\n}}\n")
                .context("cannot write")?;
        }
        self.out.commit()?;
        Ok(self.rows)
    }

    fn write(&mut self, heads: &[Head], rows: &[Row]) -> std::io::Result<()> {
        if !self.begun {
            self.begun = true;
            self.head(heads)?;
        }
        if self.json { self.json_rows(rows) } else { self.csv_rows(rows) }
    }

    fn json_rows(&mut self, rows: &[Row]) -> std::io::Result<()> {
        for row in rows {
            let comma = if self.rows == 0 { "" } else { "," };
            let row = Value::Array(row.iter().map(|v| number(*v)).collect());
            write!(self.out, "{comma}\n  {row}")?;
            self.rows += 1;
        }
        Ok(())
    }

    fn csv_rows(&mut self, rows: &[Row]) -> std::io::Result<()> {
        let mut table = csv::Writer::from_writer(&mut self.out);
        for row in rows {
            table.write_record(row.iter().map(|v| cell(*v)))?;
            self.rows += 1;
        }
        table.flush()
    }

    fn head(&mut self, heads: &[Head]) -> std::io::Result<()> {
        if !self.json {
            let mut table = csv::Writer::from_writer(&mut self.out);
            table.write_record(heads.iter().map(title))?;
            return table.flush();
        }
        let columns: Vec<Value> = heads.iter().map(|h| json!({"name": h.name, "unit": h.unit})).collect();
        let (what, columns) = (json!(self.measure), Value::Array(columns));
        write!(self.out, "{{\n \"measure\": {what},\n \"columns\": {columns},\n \"rows\": [")
    }
}

/// `mass_flow [kg/s]`
fn title(head: &Head) -> String {
    format!("{} [{}]", head.name, head.unit)
}

/// Twelve significant digits: what follows is rounding. Whole numbers, such as ids, keep theirs; −0 is 0.
fn tidy(value: f64) -> f64 {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    if value.fract() == 0.0 { value + 0.0 } else { rounded }
}

/// Empty if the value is missing.
fn cell(value: f64) -> String {
    if value.is_finite() { tidy(value).to_string() } else { String::new() }
}

fn number(value: f64) -> Value {
    // What JSON has no number for is null.
    serde_json::Number::from_f64(tidy(value)).map_or(Value::Null, Value::Number)
}

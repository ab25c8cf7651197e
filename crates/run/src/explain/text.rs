//! The answer in words.

use super::{Effect, Fields};
use std::fmt::Write;

/// Shares below this are not distinguished from 0 [–].
const UNSURE: f64 = 0.02;

/// All lines.
pub(super) fn text(fields: &Fields) -> String {
    let mut out = String::new();
    let mut line = |head: &str, words: String| {
        // Writing to a string does not fail.
        let _ = writeln!(out, "{head:<15}{words}");
    };
    let Fields { dt, critical_dt, .. } = fields;
    line("time step", format!("{dt:.4e} s, {:.3} of the critical {critical_dt:.4e} s", dt / critical_dt));
    if let Some(chosen) = &fields.chosen_by {
        line("chosen by", chosen.clone());
    }
    line("limited by", fields.limiting_pair.clone());
    line("steps", fields.steps.to_string());
    line("particles", format!("{} at the start, and {} wall spheres", fields.particles, fields.wall_spheres));
    coming(fields).into_iter().for_each(|words| line("", words));
    if let Some(c) = &fields.calibration {
        let at = format!("{} particles and {} contacts that touch", c.particles, c.touching);
        line("measured", format!("{:.3e} s a step at t = {:.3e} s, with {at}", c.seconds_per_step, c.time));
    }
    if fields.calibration.is_some() || fields.unmeasured.is_some() {
        line("expected", expected(fields));
    }
    let _ = writeln!(out, "\n{:22} {:>10} {:>8}  called for by", "effect", "B/contact", "share");
    for e in &fields.effects {
        let _ = writeln!(out, "{:22} {:>10} {:>8}  {}", e.name, e.bytes_per_contact, share(e), e.why);
    }
    memory(&mut out, fields);
    for key in &fields.dropped {
        let _ = writeln!(out, "dropped        {key}");
    }
    out
}

fn coming(fields: &Fields) -> Vec<String> {
    let coming = &fields.coming;
    let mut lines = Vec::new();
    if !coming.insertions.is_empty() {
        let (all, there) = coming.particles;
        let (from, bring) =
            (coming.insertions.join(", "), if coming.insertions.len() == 1 { "brings" } else { "bring" });
        lines.push(format!(
            "{from} {bring} some {all:.0} until the end; {there:.0} of them are there on average"
        ));
    }
    if !coming.streams.is_empty() {
        lines.push(format!(
            "{} bring as many as they hold, which is not known before",
            coming.streams.join(", ")
        ));
    }
    lines
}

/// The time of the run, and what it rests on.
fn expected(fields: &Fields) -> String {
    let coming = &fields.coming;
    if !coming.streams.is_empty() {
        return "unknown: grains still come in, and how many is not known before".to_owned();
    }
    let Some(seconds) = fields.expected_seconds else {
        return format!("unknown: {}", fields.unmeasured.as_deref().unwrap_or("nothing was measured"));
    };
    let mean = fields.particles as f64 + coming.particles.1;
    let grows = match coming.insertions.is_empty() {
        true => String::new(),
        false => format!(" for each particle, of which there are {mean:.0} on average when none leaves"),
    };
    format!("{} for the run without its output, if a step goes on to take as long{grows}", duration(seconds))
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

fn share(effect: &Effect) -> String {
    match effect.share {
        None => "–".to_owned(),
        Some(share) if share.abs() < UNSURE => format!("< {:.0} %", 100.0 * UNSURE),
        Some(share) => format!("{:.0} %", 100.0 * share),
    }
}

fn memory(out: &mut String, fields: &Fields) {
    let turns = if fields.rotation { "" } else { ", without rotation: nothing here turns a particle" };
    let _ = writeln!(out, "\nmemory         {} B a particle{turns}", fields.bytes_per_particle);
    let mut line = |words: String| {
        let _ = writeln!(out, "{:15}{words}", "");
    };
    let bytes = &fields.bytes_per_contact;
    line(format!("{} B a listed contact, and B/contact of its effects", bytes.listed));
    line(format!("{} B more for its point on a wall, or across a periodic face", bytes.point));
    line(format!(
        "{} B more for its load, between tiles of particles or where each is looked at",
        bytes.load
    ));
    if bytes.ledger > 0 {
        line(format!("{} B more for its energies", bytes.ledger));
    }
    if let Some(bytes) = fields.bytes_per_bond {
        line(format!("{bytes:.0} B a bond, {} bonds", fields.bonds));
    }
    if fields.calibration.is_some_and(|c| c.touching == 0) {
        let _ = writeln!(
            out,
            "shares         not measured of what acts in contacts: nothing touched in the calibration run"
        );
    }
}

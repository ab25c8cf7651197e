//! The answer in words.

use super::{Coming, Effect, Fields};
use dem::{ContactBytes, MatchedDamping};
use scene::plan::ImpactError;
use std::fmt::{Display, Write};

/// Shares below this are not distinguished from 0 [–].
const UNSURE: f64 = 0.02;

/// What the step does not show.
const STIFFNESS: &str = "softer grains allow a longer step and change results; by how much: cost-curve SCENE.toml --vary stiffness=1,4,10 --measure …";

/// All lines.
pub(super) fn text(fields: &Fields) -> String {
    let mut out = String::new();
    let Fields { dt, critical_dt, .. } = fields;
    let share_of_critical = format!("{:.3} of the critical {critical_dt:.4e} s", dt / critical_dt);
    line(&mut out, "time step", format!("{dt:.4e} s, {share_of_critical}"));
    if let Some(chosen) = &fields.chosen_by {
        line(&mut out, "chosen by", chosen);
    }
    if let Some(impact) = &fields.impact_error {
        line(&mut out, "impact", off_by(impact, dt / critical_dt));
    }
    line(&mut out, "limited by", &fields.limiting_pair);
    if let Some(dt) = fields.critical_dt_half_overlap {
        let overlap = geom::Shown(fields.guard_overlap);
        line(
            &mut out,
            "",
            format!("at guards.overlap = {overlap}; half of that would allow a critical step of {dt:.4e} s"),
        );
    }
    line(&mut out, "stiffness", STIFFNESS);
    if let Some(elastic) = fields.critical_dt_elastic {
        let times = elastic / critical_dt;
        let words = format!(
            "1 instead of what the scene has would allow a critical step of {elastic:.4e} s, {times:.1} times as long"
        );
        line(&mut out, "restitution", words);
    }
    for (k, matched) in fields.matched_damping.iter().enumerate() {
        line(&mut out, if k == 0 { "damping" } else { "" }, damping(matched));
    }
    line(&mut out, "steps", fields.steps);
    let Fields { particles, wall_spheres, .. } = fields;
    line(&mut out, "particles", format!("{particles} at the start, and {wall_spheres} wall spheres"));
    coming(&mut out, &fields.coming);
    if let Some(c) = &fields.calibration {
        let at = format!("{} particles and {} contacts that touch", c.particles, c.touching);
        let step = format!("{:.3e} s a step at t = {:.3e} s", c.seconds_per_step, c.time);
        line(&mut out, "measured", format!("{step}, with {at}"));
    }
    if fields.calibration.is_some() || fields.unmeasured.is_some() {
        line(&mut out, "expected", expected(fields));
    }
    line(&mut out, "GPU", gpu(&fields.not_on_a_gpu));
    let _ = writeln!(out, "\n{:22} {:>10} {:>8}  called for by", "effect", "B/contact", "share");
    for e in &fields.effects {
        let _ = writeln!(out, "{:22} {:>10} {:>8}  {}", e.name, e.bytes_per_contact, share(e), e.why);
    }
    memory(&mut out, fields);
    fields.dropped.iter().for_each(|key| line(&mut out, "dropped", key));
    out
}

/// What an impact is off by, and what another accuracy costs.
fn off_by(impact: &ImpactError, share: f64) -> String {
    let ImpactError { law, error, at_most, within_percent } = *impact;
    // Two digits that count.
    let percent = |error: f64| geom::Shown(format!("{:.1e}", 100.0 * error).parse().unwrap_or(100.0 * error));
    let less = if at_most { "less than " } else { "up to " };
    let off = format!("off by {less}{} % in its restitution at this step (law \"{law}\")", percent(error));
    let other = match within_percent {
        None => "no step was measured to reach 1 %".to_owned(),
        Some(safety) if safety < share => {
            format!("1 % takes {:.1} times the steps (time.accuracy = \"1%\")", share / safety)
        }
        Some(safety) => {
            format!("1 % takes {:.0} % of the steps (time.accuracy = \"1%\")", 100.0 * share / safety)
        }
    };
    format!("{off}; {other}")
}

/// Whether a GPU computes it.
fn gpu(refused: &[String]) -> String {
    match refused {
        [] => "computes it: --device cuda".to_owned(),
        all => format!("does not compute {}", all.join(", ")),
    }
}

/// Adds a line under a heading.
fn line(out: &mut String, head: &str, words: impl Display) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{head:<15}{words}");
}

/// What the damping of a pair is matched to.
fn damping(matched: &MatchedDamping) -> String {
    let (MatchedDamping { between: (a, b), restitution, ratios: [gamma, first, second] }, e) =
        (matched, geom::Shown);
    let ratio = format!("{gamma:.4} {first:+.4} x² {second:+.4} x⁴ of √(S m*), x = Δt √(S/m*)");
    format!("matched to the step, so that restitution is {} ({a}–{b}): {ratio}", e(*restitution))
}

fn coming(out: &mut String, coming: &Coming) {
    let (insertions, streams) = (coming.insertions.join(", "), coming.streams.join(", "));
    if !insertions.is_empty() {
        let (all, there) = coming.particles;
        let bring = if coming.insertions.len() == 1 { "brings" } else { "bring" };
        let present = format!("{there:.0} of them present on average");
        line(out, "", format!("{insertions} {bring} about {all:.0} until the end, {present}"));
    }
    coming.repeats.iter().for_each(|words| line(out, "", words));
    if !streams.is_empty() {
        let words = "bring as many particles as they hold, which is not known in advance";
        line(out, "", format!("{streams} {words}"));
    }
}

/// The time of the run, and what it rests on.
fn expected(fields: &Fields) -> String {
    let coming = &fields.coming;
    if !coming.streams.is_empty() {
        return "unknown: streams bring particles, and their number is not known in advance".to_owned();
    }
    let Some(seconds) = fields.expected_seconds else {
        return format!("unknown: {}", fields.unmeasured.as_deref().unwrap_or("nothing was measured"));
    };
    let mean = fields.particles as f64 + coming.particles.1;
    let grows = match coming.insertions.is_empty() {
        true => String::new(),
        false => format!(" per particle, with {mean:.0} particles on average if none leaves"),
    };
    let time = duration(seconds);
    // Grains that fall cost less than grains in a bed, of which each has four to six contacts.
    let loose = fields.calibration.is_some_and(|c| c.touching < c.particles);
    match loose {
        true => format!(
            "at least {time} for the run without its output: hardly any grains touch yet, and those in a bed take longer{grows}"
        ),
        false => format!("{time} for the run without its output, if later steps take as long{grows}"),
    }
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
    let turns =
        if fields.rotation { "" } else { ", without rotation: nothing in this scene turns a particle" };
    out.push('\n');
    line(out, "memory", format!("{} B per particle{turns}", fields.bytes_per_particle));
    let ContactBytes { listed, point, wrench, ledger, .. } = fields.bytes_per_contact;
    line(out, "", format!("{listed} B per listed contact, plus B/contact of its effects"));
    line(out, "", format!("{point} B more for a contact point on a wall or across a periodic face"));
    let kept = "for a force that is kept: between tiles, or where contacts are recorded";
    line(out, "", format!("{wrench} B more {kept}"));
    if ledger > 0 {
        line(out, "", format!("{ledger} B more for the energy ledger"));
    }
    if let Some(bytes) = fields.bytes_per_bond {
        line(out, "", format!("{bytes:.0} B per bond, {} bonds", fields.bonds));
    }
    if fields.calibration.is_some_and(|c| c.touching == 0) {
        line(out, "shares", "not measured for contact effects: nothing touched in the calibration run");
    }
}

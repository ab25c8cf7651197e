//! What physics keeps.

use super::{is_placed, jumps};
use crate::metamorphic::answer::{Answer, Frame};
use crate::metamorphic::campaign::{Case, Verdict, refused};
use crate::metamorphic::compare::{PARTICLES, Rule};
use crate::metamorphic::scene::{File, Scene};
use rand_pcg::Pcg64Mcg;
use record::topic;
use toml::{Table, Value};

/// A linear spring that yields but loses nothing is a linear spring.
pub fn elastic_laws(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let law = |c: &Table| c.get("law").and_then(Value::as_str) == Some("walton_braun");
    if !case.scene.list("contact").any(law) || jumps(&case.scene) || !case.is_double() {
        return None;
    }
    let with = |name: &str| {
        let mut scene = case.scene.clone();
        scene.set("time", "contacts", "sampled");
        for contact in scene.list_mut("contact").filter(|c| law(c)) {
            contact.insert("law".to_owned(), name.into());
            contact.insert("restitution".to_owned(), 1.0.into());
        }
        scene
    };
    let (one, other) = match (case.run(&with("walton_braun"), &[]), case.run(&with("hooke"), &[])) {
        (Ok(one), Ok(other)) => (one, other),
        (Err(refusal), _) | (_, Err(refusal)) => return Some(refused(&refusal)),
    };
    Some(case.judge(&one, &other, &Rule { tolerance: case.rounding(1e-9), ..Rule::bits(PARTICLES) }))
}

/// Whether nothing outside acts on grains.
fn is_alone(scene: &Scene) -> bool {
    let fixed = |p: &Table| p.get("fixed").and_then(Value::as_bool).unwrap_or(false);
    !scene.has(&["wall", "gravity", "drag", "local_damping", "sleep", "insert", "outlet", "clump"])
        && scene.get("domain.strain").is_none()
        && !scene.list("particles").any(fixed)
}

/// Σ m v and Σ |m v|, with masses of one density for each material.
fn momentum(frame: &Frame, densities: &[f64]) -> Option<([f64; 3], f64)> {
    let rows = frame.get(topic::PARTICLES)?;
    let at = |name: &str| rows.columns.iter().position(|c| c == name);
    let (v, r, m) = (at("vx")?, at("radius")?, at("material")?);
    let (mut sum, mut size) = ([0.0; 3], 0.0);
    for row in &rows.rows {
        let mass = densities.get(row[m] as usize)? * row[r].powi(3);
        (0..3).for_each(|k| sum[k] += mass * row[v + k]);
        size += mass * row[v..v + 3].iter().map(|x| x * x).sum::<f64>().sqrt();
    }
    Some((sum, size))
}

fn momentum_stays(case: &Case) -> Option<Verdict> {
    let densities: Vec<f64> =
        case.scene.list("material").filter_map(|m| m.get("density")?.as_float()).collect();
    let mut frames = case.base.frames.values().filter_map(|f| momentum(f, &densities));
    let (first, size) = frames.next()?;
    for (sum, now) in frames {
        let off = (0..3).map(|k| (sum[k] - first[k]).abs()).fold(0.0, f64::max);
        let limit = if case.is_double() { 1e-12 } else { 1e-5 } * size.max(now);
        if off > limit {
            return Some(Verdict::Differs(format!("momentum is {off:e} off, of {size:e}")));
        }
    }
    Some(Verdict::Same)
}

/// Nothing acts from outside: momentum stays.
pub fn momentum_question(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    is_alone(&case.scene).then(|| momentum_stays(case)).flatten()
}

/// Every contact without friction, dashpot and pull; `None` of a scene that is driven.
fn elastic(scene: &Scene) -> Option<Scene> {
    let drives = ["motion", "servo", "spring", "surface_velocity", "surface_rotation"];
    if scene.has(&["drag", "local_damping", "sleep", "insert", "outlet", "bond"])
        || scene.list("wall").any(|w| drives.iter().any(|k| w.contains_key(*k)))
        || scene.get("domain.strain").is_some()
    {
        return None;
    }
    let mut scene = scene.clone();
    for contact in scene.list_mut("contact") {
        let keep = [
            "between",
            "law",
            "stiffness",
            "contact_modulus",
            "effective_modulus",
            "characteristic_velocity",
        ];
        contact.retain(|key, _| keep.contains(&key));
        let law = contact.get("law").and_then(Value::as_str).unwrap_or("hertz").to_owned();
        if law == "jkr" {
            contact.insert("law".to_owned(), "hertz".into());
        }
        contact.insert("restitution".to_owned(), 1.0.into());
    }
    scene.set("output", "energy", true);
    scene.keys.remove("precision");
    Some(scene)
}

/// Energy of motion and springs, of each frame.
fn energies(answer: &Answer) -> Vec<f64> {
    let of = |frame: &Frame| {
        let rows = frame.get(topic::ENERGY)?;
        let term = |name: &str| rows.names.iter().position(|n| n == name).map_or(0.0, |k| rows.rows[k][0]);
        Some(["translation", "rotation", "potential", "elastic"].map(term).iter().sum())
    };
    answer.frames.values().filter_map(of).collect()
}

/// Energy of grains that touch up to the rounding of their places, without motion [J].
const NOTHING: f64 = 1e-24;

/// The largest change of the sum of a run, over its largest kinetic and elastic energy.
pub fn made(answer: &Answer) -> Option<f64> {
    let all = energies(answer);
    let first = *all.first()?;
    let scale = answer.frames.values().filter_map(|frame| {
        let rows = frame.get(topic::ENERGY)?;
        let term = |name: &str| rows.names.iter().position(|n| n == name).map_or(0.0, |k| rows.rows[k][0]);
        Some(term("translation") + term("elastic") + term("rotation"))
    });
    let scale = scale.fold(NOTHING, f64::max);
    Some(all.iter().map(|e| (e - first).abs()).fold(0.0, f64::max) / scale)
}

/// Elastic contacts without friction keep the energy of motion and springs, to the order of the step.
pub fn elastic_energy(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = elastic(&case.scene)?;
    let dt = case.base.dt / 8.0;
    scene.set("time", "dt", dt);
    let fine = match case.run(&scene, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let made = made(&fine)?;
    Some(if made > ELASTIC {
        Verdict::Differs(format!("{made:e} of the energy is made or lost"))
    } else {
        Verdict::Same
    })
}

/// Most energy that an eighth of the step of a scene may make [–].
const ELASTIC: f64 = 4e-3;

/// Elastic contacts, run and then run back.
pub fn reversal(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    if !is_placed(&case.scene) || case.scene.has(&["clump"]) || jumps(&case.scene) || !case.is_double() {
        return None;
    }
    // Contacts that count a part of a step are not symmetric in time.
    let mut scene = elastic(&case.scene)?;
    scene.set("time", "contacts", "sampled");
    let there = match case.run(&scene, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let rows = there.last()?.get(topic::PARTICLES)?;
    let back = reversed(&scene, &rows.columns, &rows.rows)?;
    let again = match case.run(&back, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    // The end of the way back is the start of the way there.
    let end = |answer: &Answer, sign: f64| {
        let mut frame = answer.last()?.clone();
        let rows = frame.get_mut(topic::PARTICLES)?;
        let v = rows.columns.iter().position(|c| c == "vx")?;
        rows.rows.iter_mut().for_each(|row| row[v..v + 3].iter_mut().for_each(|x| *x *= sign));
        Some(frame)
    };
    let start = there.frames.get(&0)?.clone();
    let frames =
        |frame: Frame| Answer { frames: [(0, frame.clone()), (1, frame)].into(), ..Answer::default() };
    let (start, end) = (frames(start), frames(end(&again, -1.0)?));
    Some(case.judge(&start, &end, &Rule { tolerance: case.rounding(1e-8), ..Rule::bits(PARTICLES) }))
}

/// The scene that starts where another ended, with velocities reversed.
fn reversed(scene: &Scene, columns: &[String], rows: &[Vec<f64>]) -> Option<Scene> {
    let at = |name: &str| columns.iter().position(|c| c == name);
    let (v, m) = (at("vx")?, at("material")?);
    let names = ["x", "y", "z", "vx", "vy", "vz", "radius", "id"];
    let of: Vec<usize> = names.iter().map(|n| at(n)).collect::<Option<_>>()?;
    let mut scene = scene.clone();
    let fixed = |p: &Table| p.get("fixed").and_then(Value::as_bool).unwrap_or(false);
    let mut entries: Vec<Value> =
        scene.list("particles").filter(|p| fixed(p)).cloned().map(Value::Table).collect();
    let materials: Vec<Value> = scene.list("material").filter_map(|m| m.get("name").cloned()).collect();
    for (k, material) in materials.into_iter().enumerate() {
        let of_it = rows.iter().filter(|row| row[m] as usize == k);
        let back = |c: &usize, x: f64| if (v..v + 3).contains(c) { -x } else { x };
        let rows: Vec<Vec<f64>> = of_it.map(|row| of.iter().map(|c| back(c, row[*c])).collect()).collect();
        if rows.is_empty() {
            continue;
        }
        let name = format!("grains-back{k}.csv");
        scene.files.insert(name.clone(), File::Rows(names.map(str::to_owned).to_vec(), rows));
        let entry = [("source".to_owned(), name.into()), ("material".to_owned(), material)];
        entries.push(Value::Table(entry.into_iter().collect()));
    }
    scene.keys.insert("particles".to_owned(), Value::Array(entries));
    Some(scene)
}

/// The sum of all terms of the ledger stays.
pub fn ledger(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    (!case.scene.has(&["clump"])).then(|| balance(case)).flatten()
}

/// The same with clumps.
pub fn ledger_of_clumps(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    case.scene.has(&["clump"]).then(|| balance(case)).flatten()
}

fn balance(case: &Case) -> Option<Verdict> {
    let of = |frame: &Frame, name: &str| {
        let rows = frame.get(topic::ENERGY)?;
        Some(rows.rows[rows.names.iter().position(|n| n == name)?][0])
    };
    let mut first = None;
    let mut answer = Verdict::Same;
    for (step, frame) in &case.base.frames {
        let Some(balance) = of(frame, "balance") else { continue };
        let rows = frame.get(topic::ENERGY)?;
        let size: f64 = rows.rows.iter().map(|row| row[0].abs()).sum();
        let first = *first.get_or_insert(balance);
        let limit = if case.is_double() { 1e-10 } else { 1e-4 } * size;
        if (balance - first).abs() > limit {
            answer = Verdict::Differs(format!(
                "step {step}: the balance is {:e} off, of {size:e}",
                balance - first
            ));
        }
    }
    first.map(|_| answer)
}

/// Half the step, and half of that: the second change is smaller.
pub fn halved(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    if jumps(&case.scene) || !case.is_double() || !is_placed(&case.scene) {
        return None;
    }
    let with = |parts: f64| {
        let mut scene = case.scene.clone();
        scene.set("time", "dt", case.base.dt / parts);
        case.run(&scene, &[])
    };
    let runs: Result<Vec<Answer>, _> = [4.0, 8.0, 16.0].into_iter().map(with).collect();
    let runs = match runs {
        Ok(runs) => runs,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let end = |a: &Answer, b: &Answer| {
        let last = |answer: &Answer| Answer {
            frames: answer.last().into_iter().flat_map(|f| [(0, f.clone()), (1, f.clone())]).collect(),
            ..Answer::default()
        };
        crate::metamorphic::compare::deviations(&last(a), &last(b))
            .get("/particles x")
            .copied()
            .unwrap_or(0.0)
    };
    let (first, second) = (end(&runs[0], &runs[1]), end(&runs[1], &runs[2]));
    // Far below a grain's radius both are the noise of when contacts begin.
    let grows = second > 0.75 * first && second > 2e-5;
    Some(if grows {
        Verdict::Differs(format!(
            "an eighth of the step moves grains by {first:e} m, a sixteenth by {second:e} m"
        ))
    } else {
        Verdict::Same
    })
}

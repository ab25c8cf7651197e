//! Walls as commands: a plane is a region with a `fix wall/gran/region` for each type of grains; wall spheres are atoms, frozen or moved.

use crate::error::Refusal;
use crate::law::{Target, coefficients};
use crate::motion::Movement;
use crate::types::{Kind, Types, law};
use dem::effects::Elastic;
use dem::setup::{Setup, Wall, WallShape};
use geom::{Plane, Vec3};
use record::name::lammps_comment;
use std::fmt::Write;

/// Three numbers, as LAMMPS reads them.
fn three(v: &Vec3) -> String {
    format!("{:?} {:?} {:?}", v.x, v.y, v.z)
}

/// Commands of all walls; `touches`: planes tell what they bear.
///
/// # Errors
/// What LAMMPS cannot do, all of it.
pub fn commands(
    setup: &Setup,
    types: &Types,
    (target, touches): (Target, bool),
    bent: &mut Vec<Refusal>,
) -> Result<String, Vec<Refusal>> {
    let (mut text, mut refused, mut still) = (String::new(), Vec::new(), Vec::new());
    for (index, wall) in setup.walls.iter().enumerate() {
        let one = match &wall.shape {
            WallShape::Plane(p) => plane(setup, types, (target, touches), (index, wall, p), bent),
            WallShape::Spheres(_) => spheres(types, (index, wall), &mut still),
            // Refused with all other walls of its kind.
            WallShape::Mesh(_) => Ok(String::new()),
        };
        match one {
            Ok(commands) => text += &commands,
            Err(refusal) => refused.push(refusal),
        }
    }
    if !still.is_empty() {
        let numbers: Vec<String> = still.iter().map(usize::to_string).collect();
        let _ = writeln!(
            text,
            "\n# wall spheres at rest\ngroup still type {}\nfix still still freeze",
            numbers.join(" ")
        );
    }
    let walls: Vec<String> = (1..)
        .zip(&types.0)
        .filter(|(_, t)| t.kind != Kind::Grain)
        .map(|(n, _): (usize, _)| n.to_string())
        .collect();
    if !walls.is_empty() {
        let _ =
            writeln!(text, "group walls type {}\nneigh_modify exclude group walls walls", walls.join(" "));
    }
    if refused.is_empty() { Ok(text) } else { Err(refused) }
}

/// Formulas of a shift as variables `NAMEx`, `NAMEy`, `NAMEz`.
fn variables(name: &str, formulas: &[String; 3]) -> String {
    ["x", "y", "z"]
        .iter()
        .zip(formulas)
        .map(|(axis, f)| format!("variable {name}{axis} equal {f}\n"))
        .collect()
}

fn plane(
    setup: &Setup,
    types: &Types,
    (target, touches): (Target, bool),
    (index, wall, plane): (usize, &Wall, &Plane),
    bent: &mut Vec<Refusal>,
) -> Result<String, Refusal> {
    let name = lammps_comment(&wall.name);
    let mut text = format!("\n# wall '{name}': a plane; grains are on the side of its normal\n");
    let region =
        format!("region wall{index} plane {} {} units box", three(&plane.point), three(&plane.normal));
    match Movement::of_plane(wall, plane)? {
        Movement::Still => text += &format!("{region}\n"),
        Movement::Shift { by, .. } => {
            text += &variables(&format!("wall{index}"), &by);
            text += &format!("{region} move v_wall{index}x v_wall{index}y v_wall{index}z\n");
        }
        Movement::Turn { .. } => {
            return Err(Refusal::new(
                format!("wall '{}'.motion", wall.name),
                "a region that turns drives grains at another speed than its own",
                "use wall spheres, which turn exactly",
            ));
        }
    }
    for (number, grain) in types.grains() {
        let Some(law) = law(setup, grain.material, wall.material) else { continue };
        if law.model("law") == Some("jkr") && law.number("work_of_adhesion") != Some(0.0) {
            return Err(Refusal::new(
                format!("law = \"jkr\" at wall '{}'", wall.name),
                "a region lets go of grains where they touch, not where they part",
                "use wall spheres, or law = \"hertz\" at this wall",
            ));
        }
        let elastic = elastic(setup, grain.material, wall.material);
        let words = coefficients(law, elastic, Types::at_plane(setup, grain), target, bent)?;
        let _ = writeln!(
            text,
            "fix wall{index}_{number} type{number} wall/gran/region granular {words} region wall{index}{}",
            if touches { " contacts" } else { "" }
        );
    }
    Ok(text)
}

fn spheres(types: &Types, (index, wall): (usize, &Wall), still: &mut Vec<usize>) -> Result<String, Refusal> {
    let numbers: Vec<usize> =
        (1..).zip(&types.0).filter(|(_, t)| t.kind == Kind::Wall(index)).map(|(n, _)| n).collect();
    let moves = match Movement::of(&wall.name, &wall.motion)? {
        Movement::Still => {
            still.extend(numbers);
            return Ok(String::new());
        }
        Movement::Shift { by, velocity } => {
            let (place, speed) = (format!("wall{index}"), format!("speed{index}"));
            let v = |name: &str| format!("v_{name}x v_{name}y v_{name}z");
            let variables = variables(&place, &by) + &variables(&speed, &velocity);
            (variables, format!("variable {} {}", v(&place), v(&speed)))
        }
        Movement::Turn { rate, through } => {
            let period = std::f64::consts::TAU / rate.norm();
            (String::new(), format!("rotate {} {} {period:?}", three(&through), three(&rate)))
        }
    };
    let list: Vec<String> = numbers.iter().map(usize::to_string).collect();
    Ok(format!(
        "\n# wall '{}': spheres that move; their mass makes m* that of the grain\n{}group wall{index} type {}\nfix wall{index} wall{index} move {} units box\n",
        lammps_comment(&wall.name),
        moves.0,
        list.join(" "),
        moves.1
    ))
}

/// Elastic constants of two materials.
pub fn elastic(setup: &Setup, a: u16, b: u16) -> Elastic {
    Elastic::of(&setup.materials[a as usize], &setup.materials[b as usize])
}

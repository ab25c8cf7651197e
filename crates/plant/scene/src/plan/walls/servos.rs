//! Servos of walls: what they follow, and the walls that bound their areas.

use crate::error::{Result, nearest};
use crate::input::{LOAD_COLUMNS, read_load};
use crate::keys::{Servo, Side};
use crate::plan::builder::{PlanBuilder, ServoArea};
use dem::setup::{self, Length, Target, WallShape};
use geom::Vec3;

/// Two directions are the same from this cosine on: within 2.6°.
const PARALLEL: f64 = 0.999;

impl PlanBuilder<'_> {
    /// The servo of the wall that is added next.
    pub(in crate::plan) fn servo(&mut self, key: &str, entry: &Servo) -> Result<setup::Servo> {
        let target = match &entry.path {
            Some(path) => {
                let (at, value) = (format!("{key}.path.source"), format!("\"{}\"", path.source));
                let (rows, column, hash) =
                    self.file(&at, &path.source, |file| read_load(file, &LOAD_COLUMNS))?;
                let of_stress = column == 1;
                self.inputs.push(("load".to_owned(), hash));
                if of_stress != (entry.area.is_some() || entry.area_between.is_some()) {
                    let (why, cure) = match of_stress {
                        true => (
                            "has stresses, and the area that they act on is missing",
                            "add area or area_between",
                        ),
                        false => {
                            ("has forces, which need no area", "take area out, or name the column stress")
                        }
                    };
                    return Err(self.check.wrong(&at, value, why, cure));
                }
                let factor = entry.area.unwrap_or(1.0);
                let rows = rows.into_iter().map(|[t, x]| [t, x * factor]).collect();
                self.target(&at, &value, rows)?
            }
            None => {
                let stress = entry.stress.map(|stress| stress * entry.area.unwrap_or(1.0));
                Target::constant(entry.force.or(stress).unwrap_or(0.0))
            }
        };
        if let Some(sides) = &entry.area_between {
            let key = format!("{key}.area_between");
            self.servo_areas.push(ServoArea { wall: self.walls.len(), key, sides: sides.clone() });
        }
        let (direction, speed_limit) = (Vec3::from(entry.direction).normalize(), entry.speed_limit);
        Ok(setup::Servo { direction, target, area: None, speed_limit })
    }

    /// Finds the walls that bound the areas of servos, once all walls are known.
    ///
    /// # Errors
    /// Names of no wall, walls that do not face each other.
    pub(in crate::plan) fn servo_areas(&mut self) -> Result<()> {
        for ServoArea { wall, key, sides } in std::mem::take(&mut self.servo_areas) {
            let [one, other] = &sides;
            let area = [self.side(&key, one)?, self.side(&key, other)?];
            self.are_sides(wall, &key, &sides, &area)?;
            if let Some(servo) = &mut self.walls[wall].servo {
                servo.area = Some(area);
            }
        }
        Ok(())
    }

    /// Refuses sides that do not lie across the servo's direction, or are one and the same.
    fn are_sides(&self, wall: usize, key: &str, sides: &[Side; 2], area: &[Length; 2]) -> Result<()> {
        let normal = |length: &Length| match length {
            Length::Between(one, _) => match &self.walls[*one].shape {
                WallShape::Plane(plane) => Some(plane.normal),
                _ => None,
            },
            Length::Fixed(_) => None,
        };
        let (normals, direction) =
            (area.each_ref().map(normal), self.walls[wall].servo.as_ref().map(|s| s.direction));
        let cure = "name the walls that bound the servo's wall on its two sides";
        for (side, normal) in sides.iter().zip(normals) {
            let along = normal.zip(direction).is_some_and(|(n, d)| n.dot(&d).abs() > PARALLEL);
            if let (true, Side::Walls([a, b])) = (along, side) {
                let why = "lie apart along the servo's direction, and not along a side of its wall";
                return Err(self.check.wrong(key, format!("[\"{a}\", \"{b}\"]"), why, cure));
            }
        }
        if let ([Some(one), Some(other)], [Side::Walls([a, b]), _]) = (normals, sides)
            && one.dot(&other).abs() > PARALLEL
        {
            let why = "give the length of one side twice";
            return Err(self.check.wrong(key, format!("[\"{a}\", \"{b}\"] and the other two"), why, cure));
        }
        Ok(())
    }

    fn side(&self, key: &str, side: &Side) -> Result<Length> {
        let [a, b] = match side {
            Side::Length(length) => return Ok(Length::Fixed(*length)),
            Side::Walls(names) => names,
        };
        let (one, other) = (self.wall_named(key, a)?, self.wall_named(key, b)?);
        if dem::face_distance(&self.walls, one, other).is_none() {
            let why = "are not two parallel planes that face each other, so that they have no distance";
            let cure = "name two planes or faces of a box that face each other, or give the length [m]";
            return Err(self.check.wrong(key, format!("[\"{a}\", \"{b}\"]"), why, cure));
        }
        Ok(Length::Between(one, other))
    }

    fn wall_named(&self, key: &str, name: &str) -> Result<usize> {
        let names = || self.walls.iter().map(|w| w.name.as_str());
        if names().filter(|n| *n == name).count() > 1 {
            let cure = "give each of them a name that no other wall has";
            return Err(self.check.wrong(key, format!("\"{name}\""), "is the name of several walls", cure));
        }
        names().position(|n| n == name).ok_or_else(|| {
            let near = nearest(name, names()).map_or(String::new(), |n| format!("did you mean \"{n}\"? "));
            let all: Vec<String> = names().map(|n| format!("\"{n}\"")).collect();
            let cure = format!(
                "{near}the walls are {}; a face of a box is named after it, such as \"box z+\"",
                all.join(", ")
            );
            self.check.wrong(key, format!("\"{name}\""), "is no wall of this scene", &cure)
        })
    }
}

//! Where in a scene the cause of an error of the engine stands.

use crate::advice::SceneSetupError;
use crate::error::Place;
use crate::keys::Wall;
use crate::plan::most_specific;
use crate::scene::Scene;
use dem::{Quantity, SetupError, Subject};
use std::error::Error;

impl Scene {
    /// Where the cause of an error of the engine stands; the scene alone where no one key is the cause.
    pub fn place_of(&self, error: &SceneSetupError) -> Place {
        let key = match &error.0 {
            SetupError::StepTooLarge { .. } | SetupError::StepAbovePeriod { .. } => {
                Some("time.dt".to_owned())
            }
            SetupError::OutOfRange(number) => self.key_of(&number.quantity),
            SetupError::TooFar { quantity, .. } => self.key_of(quantity),
            SetupError::PeriodBelowSkin { .. } => Some("neighbours.skin".to_owned()),
            SetupError::StrainedWith(_) | SetupError::StrainedOpen { .. } => Some("domain.strain".to_owned()),
            SetupError::PrecisionWithout { .. } => Some("precision".to_owned()),
            SetupError::DragAndSleep => Some("drag".to_owned()),
            SetupError::LocalDampingWith(_) => Some("local_damping".to_owned()),
            SetupError::BondsAndSleep => Some("bond.0".to_owned()),
            SetupError::ClumpSleep(_) => Some("sleep".to_owned()),
            SetupError::WallSlowerThanSleep { .. } => Some("sleep.speed".to_owned()),
            SetupError::BondJoinsNothing { between, .. } => self.bond(between, "gap"),
            SetupError::WallTooFast { wall, .. } => self.wall(wall, "motion"),
            SetupError::BeltLeavesPlane(wall) => self.wall(wall, "surface_velocity"),
            SetupError::RotatingPlane(wall) => self.wall(wall, "motion"),
            _ => None,
        };
        key.map_or_else(|| Place { file: self.text.name.clone(), at: None }, |key| self.text.place(&key))
    }

    /// The same for any error; `None`: none of the engine is among its causes.
    pub fn place_in(&self, error: &(dyn Error + 'static)) -> Option<Place> {
        let mut next = Some(error);
        while let Some(cause) = next {
            if let Some(of_engine) = cause.downcast_ref() {
                return Some(self.place_of(of_engine));
            }
            next = cause.source();
        }
        None
    }

    /// The key of a number of the engine's setup.
    fn key_of(&self, quantity: &Quantity) -> Option<String> {
        let name = quantity.name.split(' ').next().unwrap_or_default();
        let indexed = |table: &str, at: Option<usize>| at.map(|at| format!("{table}.{at}.{name}"));
        match &quantity.of {
            Subject::TimeStep => Some(format!("time.{name}")),
            Subject::Guards => Some(format!("guards.{name}")),
            Subject::NeighbourLists => Some(format!("neighbours.{name}")),
            Subject::Drag => Some(format!("drag.{name}")),
            Subject::Sleep => Some(format!("sleep.{name}")),
            Subject::Precision(_) => Some("precision".to_owned()),
            Subject::PeriodicEnd(end) => Some(format!("domain.{end}")),
            Subject::Material(of) => {
                indexed("material", self.keys.material.iter().position(|m| m.name == *of))
            }
            Subject::Contact(Some([a, b])) => indexed("contact", most_specific(&self.keys.contact, a, b)),
            Subject::Bond(Some(between)) => self.bond(between, name),
            Subject::ClumpShape(of) => indexed("clump", self.keys.clump.iter().position(|c| c.name == *of)),
            Subject::Wall(of) => self.wall(of, name),
            _ => None,
        }
    }

    /// A key of the `[[bond]]` between two materials.
    fn bond(&self, [a, b]: &[String; 2], key: &str) -> Option<String> {
        let of = |[p, q]: &[String; 2]| (p == a && q == b) || (p == b && q == a);
        self.keys.bond.iter().position(|bond| of(&bond.between)).map(|at| format!("bond.{at}.{key}"))
    }

    /// A key of the `[[wall]]` with a surface of this name: those of a file have the name of the entry in front.
    pub(crate) fn wall(&self, name: &str, key: &str) -> Option<String> {
        let has = |(i, wall): (usize, &Wall)| wall.names(&wall.name_at(i)).iter().any(|own| own == name);
        let starts = |(i, wall): (usize, &Wall)| name.starts_with(&format!("{} ", wall.name_at(i)));
        let walls = || self.keys.wall.iter().enumerate();
        let at = walls().position(has).or_else(|| walls().position(starts))?;
        Some(format!("wall.{at}.{key}"))
    }
}

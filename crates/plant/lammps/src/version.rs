//! The version of a LAMMPS program.

use dem::setup::Setup;
use std::fmt;

/// Date of a release.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    pub year: u16,
    /// Month, 1 to 12.
    pub month: u8,
    pub day: u8,
}

const MONTHS: [&str; 12] =
    ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

impl Version {
    /// That of Debian 12, which decks are written for where no program is asked.
    pub const DEBIAN: Version = Version { year: 2021, month: 9, day: 29 };
    /// The first whose bonds are tested.
    const BONDS: Version = Version { year: 2025, month: 7, day: 22 };
    /// The first with the granular models of today.
    const NEW_MODELS: Version = Version { year: 2022, month: 12, day: 1 };

    /// The version in the text of `lmp -h`: "… Massively Parallel Simulator - 29 Sep 2021 - Update 2".
    pub fn of_help(text: &str) -> Option<Version> {
        let line = text.lines().find(|line| line.contains("Massively Parallel Simulator"))?;
        let mut words = line.split(" - ").nth(1)?.split_whitespace();
        let day = words.next()?.parse().ok()?;
        let month = words.next()?;
        let month = MONTHS.iter().position(|name| *name == month)? as u8 + 1;
        Some(Version { year: words.next()?.parse().ok()?, month, day })
    }

    /// One that can run a scene, where none is asked.
    pub fn that_runs(setup: &Setup) -> Version {
        if setup.bonds.is_empty() { Version::DEBIAN } else { Version::BONDS }
    }

    /// Whether bonds of the package BPM need not break.
    pub fn has_bonds(self) -> bool {
        self >= Version::BONDS
    }

    /// Whether rigid bodies get no gravity in the first half of the first step.
    pub fn starts_clumps_without_gravity(self) -> bool {
        self < Version::NEW_MODELS
    }

    /// Whether `damping tsuji` is refused with a cohesive law.
    pub fn refuses_damped_jkr(self) -> bool {
        self >= Version::NEW_MODELS
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {} {}", self.day, MONTHS[usize::from(self.month) - 1], self.year)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_help() {
        let of = |date: &str| {
            Version::of_help(&format!(
                "\nLarge-scale Atomic/Molecular Massively Parallel Simulator - {date}\n\nUsage"
            ))
        };
        assert_eq!(of("29 Sep 2021 - Update 2"), Some(Version::DEBIAN));
        let newer = of("22 Jul 2025 - Update 4").unwrap();
        assert!(newer.refuses_damped_jkr() && newer > Version::DEBIAN);
        assert_eq!(newer.to_string(), "22 Jul 2025");
        assert_eq!(Version::of_help("GNU ls"), None);
    }
}

//! What is known of a part of a wall, by name: densities over its area where a sum depends on how large it is.

use crate::PartLoad;

/// A quantity of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WearField {
    /// Sliding work per area [J/m²].
    SlidingWork,
    /// Energy of approach per area [J/m²].
    ImpactEnergy,
    /// The same along the normal [J/m²].
    ImpactNormal,
    /// The same along the surface [J/m²].
    ImpactTangential,
    /// Grains that came to touch it, per area [1/m²].
    Impacts,
    /// Largest normal force of one contact [N].
    LargestNormal,
    /// Mean normal force over its area [Pa].
    Pressure,
}

impl WearField {
    /// All, in the order of messages.
    pub const ALL: [WearField; 7] = [
        WearField::SlidingWork,
        WearField::ImpactEnergy,
        WearField::ImpactNormal,
        WearField::ImpactTangential,
        WearField::Impacts,
        WearField::LargestNormal,
        WearField::Pressure,
    ];

    /// The field of that name.
    pub fn named(name: &str) -> Option<WearField> {
        WearField::ALL.into_iter().find(|field| field.name() == name)
    }

    /// Its name, as it is asked for.
    pub fn name(self) -> &'static str {
        match self {
            WearField::SlidingWork => "sliding_work",
            WearField::ImpactEnergy => "impact_energy",
            WearField::ImpactNormal => "impact_normal",
            WearField::ImpactTangential => "impact_tangential",
            WearField::Impacts => "impacts",
            WearField::LargestNormal => "largest_normal",
            WearField::Pressure => "pressure",
        }
    }

    /// Its name in a legend.
    pub fn words(self) -> &'static str {
        match self {
            WearField::SlidingWork => "sliding work",
            WearField::ImpactEnergy => "impact energy",
            WearField::ImpactNormal => "normal impact energy",
            WearField::ImpactTangential => "tangential impact energy",
            WearField::Impacts => "impacts",
            WearField::LargestNormal => "largest normal force",
            WearField::Pressure => "mean pressure",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            WearField::Impacts => "1/m²",
            WearField::LargestNormal => "N",
            WearField::Pressure => "Pa",
            _ => "J/m²",
        }
    }

    /// Its value for a part of this area [m²] after a time of this length [s]; 0 for a part without area.
    pub fn of(self, load: &PartLoad, area: f64, length: f64) -> f64 {
        let [normal, tangential] = load.impact_energy;
        let over_area = |sum: f64| if area > 0.0 { sum / area } else { 0.0 };
        match self {
            WearField::SlidingWork => over_area(load.work),
            WearField::ImpactEnergy => over_area(normal + tangential),
            WearField::ImpactNormal => over_area(normal),
            WearField::ImpactTangential => over_area(tangential),
            WearField::Impacts => over_area(load.impacts as f64),
            WearField::LargestNormal => load.largest_normal,
            WearField::Pressure if length > 0.0 => over_area(load.normal_impulse / length),
            WearField::Pressure => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_told_per_area_and_forces_as_they_are() {
        let load = PartLoad {
            normal_impulse: 6.0,
            largest_normal: 7.0,
            work: 2.0,
            impacts: 4,
            impact_energy: [1.0, 3.0],
        };
        let values = WearField::ALL.map(|field| field.of(&load, 0.5, 3.0));
        assert_eq!(values, [4.0, 8.0, 2.0, 6.0, 8.0, 7.0, 4.0]);
        assert!(WearField::ALL.iter().all(|f| WearField::named(f.name()) == Some(*f)));
    }
}

//! Laws of the pairs that can meet, and the extent in which they do.

use crate::error::SceneError;
use crate::plan::Draft;
use dem::setup;

/// μ at rest.
fn friction(law: &setup::ContactLaw) -> Option<f64> {
    law.number("sliding_friction").or(law.number("sliding_friction.static"))
}

impl Draft<'_> {
    /// The laws of pairs that can meet; what wall files say fills in where the scene is silent.
    pub(crate) fn meeting(&mut self, mut laws: Vec<setup::ContactLaw>) -> Vec<setup::ContactLaw> {
        let mut grains: Vec<u16> = self.particles.iter().map(|p| p.material).collect();
        grains.extend(&self.entry_materials);
        let shapes =
            self.clumps.bodies.iter().map(|b| b.shape).chain(self.clumps.entries.iter().map(|e| e.0));
        grains.extend(shapes.map(|s| self.clumps.shapes[s as usize].material));
        grains.sort_unstable();
        grains.dedup();
        let of = |laws: &[setup::ContactLaw], a: u16, b: u16| {
            laws.iter().position(|l| l.between == (a, b) || l.between == (b, a))
        };
        for (wall, info) in &self.wall_infos {
            for &grain in &grains {
                match (of(&laws, grain, *wall), info.restitution) {
                    (None, Some(restitution)) => {
                        let mut law = setup::ContactLaw::new((grain.min(*wall), grain.max(*wall)), "hertz");
                        law.set("restitution", restitution);
                        info.friction
                            .filter(|mu| *mu > 0.0)
                            .into_iter()
                            .for_each(|mu| law.set("sliding_friction", mu));
                        laws.push(law);
                    }
                    (Some(at), _) if info.friction.is_some() && info.friction != friction(&laws[at]) => {
                        let (a, b) = (&self.materials[grain as usize].name, &info.name);
                        let scene = friction(&laws[at]).unwrap_or(0.0);
                        let file = info.friction.unwrap_or(0.0);
                        self.notes.push(format!(
                            "{a}–{b}: sliding_friction {scene} of the scene, not {file} of the wall file"
                        ));
                    }
                    _ => {}
                }
            }
        }
        let walls: Vec<u16> = self.walls.iter().map(|w| w.material).collect();
        let grain = |m: u16| grains.contains(&m);
        laws.retain(|l| {
            let (a, b) = l.between;
            (grain(a) && (grain(b) || walls.contains(&b))) || (grain(b) && walls.contains(&a))
        });
        laws
    }

    pub(crate) fn periodic(&self) -> Result<[Option<(f64, f64)>; 3], SceneError> {
        let domain = &self.model().domain;
        let mut periodic = [None; 3];
        for axis in &domain.periodic {
            let a = *axis as usize;
            let (Some(low), Some(high)) = (domain.low, domain.high) else {
                let why = "needs the corners of the domain";
                return Err(self.check.wrong(
                    "domain.periodic",
                    format!("{axis:?}"),
                    why,
                    "add low and high, in metres",
                ));
            };
            if low[a].is_nan() || high[a].is_nan() || low[a] >= high[a] {
                let value = format!("{} m", high[a]);
                return Err(self.check.wrong(
                    "domain.high",
                    value,
                    "is not above low",
                    "swap them, or widen the domain",
                ));
            }
            periodic[a] = Some((low[a], high[a]));
        }
        if domain.periodic.is_empty() && (domain.low.is_some() || domain.high.is_some()) {
            let why = "no axis is periodic, and a domain does not hold particles back";
            return Err(self.check.wrong(
                "domain",
                "(low, high)",
                why,
                "add periodic = [\"x\"], or a [[wall]] with box",
            ));
        }
        Ok(periodic)
    }
}

//! The scenes of a specimen: the sample, what the request changes, and what the test adds.

use crate::composing::compose::Composition;
use crate::composing::walls;
use crate::error::Result;
use crate::lab::Lab;
use crate::recipes::{Context, Part, Prepared};
use crate::sample::is_drawn;
use geom::Vec3;
use toml_edit::value;

/// Which scene is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    Preparation,
    /// That of the test, with the specimen as high as it is expected to become.
    Test,
}

impl Lab {
    /// A scene of the first specimen, with files as the sample names them; `None` where the test has no preparation.
    ///
    /// # Errors
    /// A specimen that cannot be prepared.
    pub fn scene(&self, which: Which) -> Result<Option<String>> {
        let of = self.context(&self.loadings[0]);
        let prepared = self.recipe.preparation(&of)?;
        if which == Which::Preparation {
            return Ok(prepared.map(|part| self.compose_preparation(&of, &part, self.sample.compose())));
        }
        let mut expected = Prepared::default();
        for wall in self.recipe.placed().iter().filter(|wall| **wall == "lid") {
            let fall = self.specimen.height - (self.specimen.high.z - self.specimen.low.z);
            expected.shifts.insert((*wall).to_owned(), Vec3::z() * fall);
        }
        let part = self.recipe.test(&of, &expected)?;
        Ok(Some(self.compose_test(&of, &part, prepared.is_some(), self.sample.compose())))
    }

    pub(crate) fn compose_preparation(&self, of: &Context, part: &Part, mut scene: Composition) -> String {
        if let Some(mass) = self.specimen.mass {
            scene.set("fill.0", "shape", self.recipe.space(of));
            scene.set("fill.0", "mass", mass);
            scene.set("fill.0", "seed", of.loading.seed as i64);
        }
        if let Some(friction) = self.request.friction.or(self.recipe.friction()) {
            scene.entries("contact").for_each(|contact| walls::set_friction(contact, friction));
        }
        if !self.sample.has("local_damping") {
            scene
                .entries("contact")
                .for_each(|contact| walls::raise_restitution(contact, self.recipe.restitution()));
        }
        self.finish(of, part, scene)
    }

    pub(crate) fn compose_test(
        &self,
        of: &Context,
        part: &Part,
        prepared: bool,
        mut scene: Composition,
    ) -> String {
        if let Some(grains) = &part.grains {
            for particles in scene.entries("particles") {
                ["units", "scale"].iter().for_each(|key| drop(particles.remove(key)));
                particles.insert("source", value(grains));
            }
        } else if let Some(pour) = &part.pour {
            scene.rename("fill", "insert");
            scene.set("insert.0", "shape", pour.shape.clone());
            scene.set(
                "insert.0",
                "velocity",
                [0.0, 0.0, -pour.speed].into_iter().collect::<toml_edit::Value>(),
            );
            scene.set("insert.0", "rate", pour.rate);
            scene.set("insert.0", "mass", self.specimen.mass(&self.sample.grains));
            scene.set("insert.0", "seed", of.loading.seed as i64);
        } else if prepared {
            scene.remove("fill");
            scene.remove("particles");
            scene.remove("body");
            scene.add("[[particles]]\nsource = \"prepare.mcap\"\n");
        }
        let recorded = format!("{}\n", part.text.replacen("[output]\n", "[output]\ncontacts = true\n", 1));
        let part = &Part { text: recorded, ..part.clone() };
        self.finish(of, part, scene)
    }

    /// What both scenes have.
    fn finish(&self, of: &Context, part: &Part, mut scene: Composition) -> String {
        scene.set("time", "until", part.until);
        if part.to_rest {
            scene.set("time", "until_unbalanced", self.request.rest.unwrap_or(self.recipe.rest()));
        }
        if !part.bonds {
            scene.remove("bond");
        }
        for bond in scene.entries("bond").filter(|bond| is_drawn(bond)) {
            let own = bond.get("seed").and_then(toml_edit::Item::as_integer).unwrap_or(0);
            bond.insert("seed", value(own.wrapping_add(of.loading.seed as i64)));
        }
        walls::add_materials(&mut scene);
        scene.add(&part.text);
        scene.text()
    }
}

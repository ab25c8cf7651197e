//! Time, output, domain, guards, fluid, damping and sleep.

use super::{Draw, TIME};
use crate::metamorphic::scene::File;

impl Draw {
    /// Everything that is neither material, grain nor wall.
    pub(super) fn calculation(&mut self) {
        self.top();
        self.time();
        self.output();
        self.domain();
        self.guards();
        self.surroundings();
        if !self.choices.strained {
            self.outlet();
        }
    }

    fn top(&mut self) {
        let gravity = match self.pick(&[0, 1, 1, 2]) {
            _ if self.choices.sleep => [0.0, 0.0, -9.81],
            _ if self.choices.strained => [0.0; 3],
            0 => [0.0; 3],
            1 => [0.0, 0.0, -9.81],
            _ => self.vector(9.81),
        };
        if gravity != [0.0; 3] {
            self.line(format!("gravity = {gravity:?}"));
        }
        self.maybe(0.1, "first_id = 100");
        let precision = if self.choices.single { self.pick(&["f64", "mixed", "f32"]) } else { "f64" };
        self.maybe(0.7, format!("precision = \"{precision}\""));
    }

    fn time(&mut self) {
        self.line(format!("[time]\nuntil = {TIME:?}"));
        self.maybe(0.1, "dt = \"auto\"");
        if self.chance(0.1) {
            let accuracy = self.pick(&["\"1%\"", "0.02"]);
            self.line(format!("accuracy = {accuracy}"));
        } else {
            let safety = self.between(0.1, 0.5);
            self.maybe(0.6, format!("safety = {safety:?}"));
        }
        self.key(0.1, "shorten", 0.01, 0.3);
        let contacts = self.pick(&["averaged", "sampled", "sampled"]);
        self.maybe(0.4, format!("contacts = \"{contacts}\""));
        let patch = self.pick(&["shared", "plain"]);
        self.maybe(0.2, format!("patch = \"{patch}\""));
        if !self.choices.strained {
            self.maybe(0.05, "until_unbalanced = 1e-12");
            self.maybe(0.05, "until_kinetic = 1e-15");
        }
    }

    fn output(&mut self) {
        self.line("[output]");
        self.maybe(0.1, "every = 0.0025");
        self.maybe(0.1, "checkpoint = 0.005");
        for key in ["energy", "contacts", "wall_forces"] {
            let on = self.pick(&["true", "true", "true", "false"]);
            self.maybe(0.9, format!("{key} = {on}"));
        }
        // No random choice: the scenes of all seeds stay as they are.
        if self.choices.inserted {
            self.line("wear = true");
        }
        self.maybe(0.2, "precision = \"f64\"");
    }

    fn domain(&mut self) {
        let names = ["x", "y", "z"].into_iter().zip(self.choices.periodic).filter(|(_, p)| *p);
        let names: Vec<&str> = names.map(|(name, _)| name).collect();
        let (low, high, periodic) = (self.choices.low, self.high(), self.choices.periodic);
        if !names.is_empty() {
            let far = |k: usize, edge: f64, away: f64| {
                if periodic[k] { edge } else { super::digits(edge + away, 6) }
            };
            let (low, high) =
                ([0, 1, 2].map(|k| far(k, low[k], -0.1)), [0, 1, 2].map(|k| far(k, high[k], 0.1)));
            self.line(format!("[domain]\nperiodic = {names:?}\nlow = {low:?}\nhigh = {high:?}"));
        } else if self.chance(0.1) {
            self.line("[domain]\noutside = \"keep\"");
        }
        if self.choices.strained {
            self.line("[domain.strain]");
            for axis in ["x", "y", "z"] {
                match self.pick(&[0, 1, 2, 3]) {
                    0 => {
                        let rate = self.between(-5.0, 5.0);
                        self.line(format!("{axis} = {{ rate = {rate:?} }}"));
                    }
                    1 => {
                        let stress = self.scale(100.0, 2000.0);
                        self.line(format!("{axis} = {{ stress = {stress:?}, rate_limit = 5 }}"));
                    }
                    2 => {
                        let most = self.between(-0.02, 0.02);
                        let rows = vec![vec![0.0, 0.0], vec![TIME, most], vec![1.0, most]];
                        let file = File::Rows(vec!["t".to_owned(), "strain".to_owned()], rows);
                        let name = self.file("strain", "csv", file);
                        self.line(format!("{axis} = {{ path = {{ source = \"{name}\" }} }}"));
                    }
                    _ => {}
                }
            }
        }
    }

    fn guards(&mut self) {
        self.line("[guards]\noverlap = 0.4\nenergy = 1e6");
        self.key(0.1, "motion", 0.3, 0.5);
        let zones = self.pick(&["true", "false", "\"remove\""]);
        self.maybe(0.05, format!("zones = {zones}"));
        self.maybe(0.05, "steps = 1e7");
        self.maybe(0.05, "frames = 1e6");
        if self.chance(0.1) {
            let skin = self.scale(2e-4, 2e-3);
            self.line(format!("[neighbours]\nskin = {skin:?}"));
        }
    }

    fn surroundings(&mut self) {
        if self.choices.sleep {
            let speed = self.scale(0.003, 0.04);
            self.line(format!("[sleep]\nspeed = {speed:?}"));
            self.key(0.9, "time", 5e-4, 3e-3);
            self.key(0.5, "wake", 0.05, 0.5);
            return;
        }
        if !self.choices.plain && self.chance(0.15) {
            self.line("[local_damping]");
            self.key(0.7, "factor", 0.2, 0.8);
        }
        if !self.choices.strained && self.chance(0.12) {
            let law = self.pick(&["stokes", "schiller-naumann"]);
            self.line(format!("[drag]\nlaw = \"{law}\"\ndensity = 200.0"));
            self.key(1.0, "viscosity", 1e-3, 1.0);
            let velocity = self.vector(0.5);
            self.maybe(0.5, format!("velocity = {velocity:?}"));
            self.maybe(0.5, "buoyancy = true");
        }
    }

    fn outlet(&mut self) {
        if !self.choices.plain && self.choices.periodic == [false; 3] && self.chance(0.15) {
            let at = self.choices.low[2] - 0.002;
            let at = super::digits(at, 6);
            self.line(format!("[[outlet]]\nplane = [0.0, 0.0, {at:?}, 0.0, 0.0, -1.0]"));
            self.key(0.3, "length", 0.012, 0.02);
            let motion = self.pick(&["constant", "ballistic", "recorded"]);
            self.maybe(0.7, format!("motion = \"{motion}\""));
            if motion == "recorded" {
                self.maybe(0.5, "samples = 2e-4");
            }
            let test = self.pick(&["centre", "lowest"]);
            self.maybe(0.5, format!("test = \"{test}\""));
            self.maybe(0.2, "plant = \"a b c\"");
        }
    }
}

//! Diagrams beside the picture of a page: what the runs hold over time.

use measure::{MeasureError, Panel, Run, overview::Overview};
use record::topic::{BONDS, CROSSINGS, ENERGY, PARTICLES, SURFACES, WALL_FORCES};
use stream::mcap::Event;
use view::{Diagram, DiagramCurve};

/// Reads runs for their curves while they are shown.
#[derive(Default)]
pub struct Diagrams {
    runs: Vec<(String, Run, Overview)>,
    /// Messages that cannot be measured: how many of which run, and why the first.
    wrong: Vec<(String, u64, MeasureError)>,
}

/// Whether curves need it: checkpoints, contacts and wall spheres are large.
fn is_measured(event: &Event) -> bool {
    match event {
        Event::Metadata { .. } => true,
        Event::Points { topic, .. } => [PARTICLES, BONDS, CROSSINGS].contains(&topic.as_str()),
        Event::Bytes { topic, .. } => [ENERGY, SURFACES, WALL_FORCES].contains(&topic.as_str()),
    }
}

impl Diagrams {
    /// Takes an event of a run, by its name.
    pub fn take(&mut self, name: &str, event: &Event) {
        if self.runs.last().is_none_or(|(last, ..)| last != name) {
            self.runs.push((name.to_owned(), Run::default(), Overview::default()));
        }
        let Some((_, run, overview)) = self.runs.last_mut().filter(|_| is_measured(event)) else { return };
        match run.take(event.clone()) {
            Ok(Some(message)) => overview.take(run, message),
            Ok(None) => {}
            Err(why) => match self.wrong.last_mut().filter(|(run, ..)| run == name) {
                Some((_, count, _)) => *count += 1,
                None => self.wrong.push((name.to_owned(), 1, why)),
            },
        }
    }

    /// Prints why curves may be missing.
    pub fn warn(&self) {
        for (name, count, why) in &self.wrong {
            cli::warn(&format!("{count} messages of {name} are not in the diagrams: {why}"));
        }
    }

    /// The diagrams; with the names of the runs where there are several.
    pub fn finish(self) -> Vec<Diagram> {
        let with_curves = self.runs.iter().map(|(name, _, overview)| (name, overview.panels()));
        let runs: Vec<_> = with_curves.filter(|(_, panels)| !panels.is_empty()).collect();
        let several = runs.len() > 1;
        let diagram = |name: &str, panel: Panel| match panel {
            Panel::Curves { y, curves, .. } => {
                let label = if several { format!("{name}: {y}") } else { y };
                let curves = curves.into_iter().map(|c| DiagramCurve { name: c.name, points: c.points });
                Some(Diagram { label, curves: curves.collect() })
            }
            Panel::Map { .. } => None,
        };
        let all = runs.into_iter().flat_map(|(name, panels)| panels.into_iter().map(move |p| (name, p)));
        all.filter_map(|(name, panel)| diagram(name, panel)).collect()
    }
}

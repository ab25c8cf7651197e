//! What must not change.

mod contacts;
mod laws;
mod output;
mod space;
mod starts;
mod walls;
mod words;

use super::campaign::{Case, Verdict};
use super::scene::Scene;
use rand_pcg::Pcg64Mcg;

/// The question of a relation; `None` where it does not apply.
pub type Question = fn(&Case, &mut Pcg64Mcg) -> Option<Verdict>;

/// A scene in other words, and what its answer must be.
pub struct Relation {
    /// Name, as the page has it.
    pub name: &'static str,
    /// How exact.
    pub exact: &'static str,
    /// The question.
    pub question: Question,
}

impl Relation {
    /// Asks.
    pub fn asks(&self, case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
        (self.question)(case, random)
    }
}

const fn bits(name: &'static str, question: Question) -> Relation {
    Relation { name, exact: "the same bits", question }
}

const fn rounding(name: &'static str, question: Question) -> Relation {
    Relation { name, exact: "rounding", question }
}

/// The step that the program chose, given as a number. Each scene is asked this as it is drawn.
pub static AUTOMATIC: Relation = rounding(super::campaign::AUTO, |_, _| None);

/// Every relation.
pub static RELATIONS: &[Relation] = &[
    bits("1, 2 and 3 threads", output::threads),
    bits("`--device local`", output::device),
    bits("output interval and checkpoints", output::interval),
    bits("outputs and ledger on or off", output::switches),
    bits("`--set` instead of the file", words::set),
    bits("resumed", output::resumed),
    bits("resumed, `--whole`", output::whole),
    bits("names", words::names),
    bits("numbers with units", words::units),
    rounding("order of materials", words::materials),
    bits("order of particles", words::particles),
    rounding("order of walls", words::walls),
    rounding("order of triangles", words::triangles),
    bits("effects of coefficient 0", words::idle_effects),
    bits("unused materials", words::unused_materials),
    bits("walls far away", words::far_walls),
    bits("similarity", space::similarity),
    rounding("mirror", space::mirror),
    rounding("axes exchanged", space::permuted),
    rounding("shift", space::shifted),
    rounding("shift of a periodic cell", space::rolled),
    rounding("rotation", space::rotated),
    rounding("moving frame", space::boosted),
    rounding("doubled periodic cell", space::doubled),
    Relation { name: "two runs in a row", exact: "order of the step", question: starts::unchanged },
    Relation {
        name: "two runs in a row on fixed grains",
        exact: "order of the step",
        question: starts::on_fixed,
    },
    rounding("two runs in a row, walls in other words", starts::reworded),
    rounding("plane = mesh", walls::plane_as_mesh),
    rounding("plane = face of a box", walls::plane_as_box),
    rounding("face of a box = mesh", walls::box_as_mesh),
    rounding("finer triangles", walls::finer),
    rounding("belt = moving wall", walls::belt),
    rounding("hooke = walton_braun of restitution 1", laws::elastic_laws),
    rounding("loading of walton_braun = hooke", contacts::loading),
    rounding("energy of a grain on a seam", contacts::seam),
    rounding("momentum", laws::momentum_question),
    rounding("time reversal", laws::reversal),
    rounding("ledger", laws::ledger),
    rounding("ledger of clumps", laws::ledger_of_clumps),
    Relation {
        name: "energy of elastic contacts",
        exact: "order of the step",
        question: laws::elastic_energy,
    },
    Relation { name: "halved step", exact: "order of the step", question: laws::halved },
];

/// Whether what happens depends on random numbers or on axes, so that the scene cannot be turned or numbered otherwise.
fn is_placed(scene: &Scene) -> bool {
    !scene.has(&["fill", "insert"])
}

/// Whether a bond's strength depends on the ids of its grains.
fn is_drawn(scene: &Scene) -> bool {
    scene.list("bond").any(|bond| bond.contains_key("deviation") || bond.contains_key("weibull_modulus"))
}

/// Whether a small change can grow at once: sleep, breaking bonds, signs of velocities.
pub fn jumps(scene: &Scene) -> bool {
    scene.has(&["sleep", "local_damping", "outlet"])
        || scene.get("domain.strain").is_some()
        || scene.list("wall").any(|w| w.contains_key("servo"))
        || scene.has_in_contacts(&["constant", "jkr"])
        || scene.list("bond").any(|b| b.keys().any(|key| key.contains("strength") || key.contains("_force")))
}

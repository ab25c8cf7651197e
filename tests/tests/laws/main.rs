//! Laws with closed answers: one contact, friction and rolling, many grains; and the orders in which errors fall with the step.

mod adhesion;
mod bond_kinds;
mod bonds;
mod direct;
mod hopper;
mod impacts;
mod limits;
mod mindlin;
mod oblique;
mod orders;
mod phases;
mod rest;
mod rubbing;
mod squeezed;
mod tangential;
mod thornton;
mod triaxial;
mod yielding;

use dem::{Setup, Simulation};

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("the setup is sound")
}

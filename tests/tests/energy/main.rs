//! The energy ledger: it closes to rounding in every kind of scene, and what the finite time step makes falls at the
//! integrator's order.

mod closing;
mod guard;
mod oblique;
mod order;
mod scenes;
mod sticking;
mod strained;
mod terms;

//! The emulator: from parameters to curves, learnt from trials.
//!
//! Curves are made white by the covariance of the data, C = L Lᵀ, so that a deviation of the data is 1, and written in their principal
//! components; each component is a Gaussian process of the parameters (Higdon, Gattiker, Williams & Rightley 2008,
//! doi:10.1198/016214507000000888).
//!
//! ```text
//! w = L⁻¹ y − w̄ = Σ_k a_k(z) φ_k        log p(data | z) = −½ [(t − a)ᵀ S⁻¹ (t − a) + ln det S],   S = s² I + V(z) + N
//! ```
//!
//! Where another emulator has learnt from like specimens, such as smaller ones, a component follows what that one says of it, m_k(z), and the process
//! is the difference (Kennedy & O'Hagan 2000, doi:10.1093/biomet/87.1.1, eq. 1):
//!
//! ```text
//! a_k(z) = β_0 + β_1 m_k(z) + f_k(z),   m_k = φ_kᵀ (w_other(z) − w̄)
//! ```
//!
//! t: components of the data; V: variances of the emulator; N: covariance of specimens, which deviate in all components at once, from the trials
//! nearest to the data, each left out; s² ≥ 1: how much the data deviate more than they say.

mod crossed;
mod gp;
mod learn;
mod likelihood;
mod prediction;
mod rprop;
mod trend;

pub(crate) use gp::{Gp, Logs, Prediction};
pub(crate) use learn::{Lessons, MOST_TRIALS};
pub(crate) use prediction::{Emulator, Expected, distance};

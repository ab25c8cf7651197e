//! Random scenes, each asked the same question in other words.
//!
//! Tests of chosen scenes seldom find a fault where two right things meet. Here scenes are drawn over all keys ([`draw`]), and each is
//! run a second time as another scene that must have the same answer ([`relations`]): turned, shifted, in other units, in another order,
//! interrupted, with another wall of the same surface. [`compare`] says where two answers differ, and [`shrink`] makes the smallest
//! scene that still fails. `pipelines/metamorphic.sh` runs thousands, a test a hundred.

pub mod answer;
pub mod campaign;
pub mod compare;
pub mod draw;
pub mod meaning;
pub mod page;
pub mod relations;
pub mod scene;
pub mod shrink;
pub mod transform;

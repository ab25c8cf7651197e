//! What became of the classes.

use serde::Serialize;

/// Tries of a class that placed no stone, by cause.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Undone {
    /// The stone would have made the content too large.
    pub too_heavy: u64,
    /// Its turned box was larger than the box.
    pub too_large: u64,
    /// It overlapped an earlier stone.
    pub overlaps: u64,
    /// A grain inside belonged to an earlier stone.
    pub shared_grains: u64,
    /// It held fewer grains than asked for.
    pub few_grains: u64,
    /// No room could be made for it.
    pub no_room: u64,
}

/// What became of a class.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassReport {
    pub class: u32,
    pub stones: usize,
    /// Content wanted of this class [–].
    pub content_wanted: f64,
    /// Content reached, of the final mass [–].
    pub content: f64,
    /// (content − wanted)/wanted.
    pub excess: f64,
    /// Share of the mass of all stones, wanted and reached [–].
    pub share_wanted: f64,
    /// See above.
    pub share: f64,
    /// Tries, those that placed a stone included.
    pub tries: u64,
    /// The others.
    pub undone: Undone,
    /// Stones for which room was made when the tries had run out.
    pub crowded: usize,
    /// Why the content is not reached; absent if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missed: Option<String>,
}

/// What is in the way of a stone that overlaps none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Obstacle {
    /// It is wider than the box.
    TooLarge,
    /// No gap becomes large enough.
    NoRoom,
    /// It, or one that moved for it, holds fewer grains than asked for.
    FewGrains,
    /// It, or one that moved for it, holds a grain of another one.
    SharedGrains,
}

const LARGE: &str = "larger than the box when turned: enlarge the box, or give smaller stones";
const FEW: &str = "held too few grains: give smaller grains, larger stones, or a lower --least-grains";
const SHARED: &str = "held a grain of an earlier stone: give smaller grains";

impl Undone {
    /// Counts a stone.
    pub(super) fn count(&mut self, obstacle: Obstacle) {
        *match obstacle {
            Obstacle::TooLarge => &mut self.too_large,
            Obstacle::NoRoom => &mut self.no_room,
            Obstacle::FewGrains => &mut self.few_grains,
            Obstacle::SharedGrains => &mut self.shared_grains,
        } += 1;
    }
}

/// Why a content was not reached: what ended making room, or the most frequent cause.
pub(super) fn missed(tries: u64, undone: &Undone, obstacle: Option<Obstacle>) -> String {
    let last = |words: &str| format!("the last stones for which room was made {words}");
    match obstacle {
        Some(Obstacle::NoRoom) => {
            return "no room could be made for the last stones: the box is full for stones of this size; lower the content, raise --crowd, or give smaller stones between the large ones"
                .to_owned();
        }
        Some(Obstacle::TooLarge) => return last(&format!("were {LARGE}")),
        Some(Obstacle::FewGrains) => return last(&format!("or that moved for them {FEW}")),
        Some(Obstacle::SharedGrains) => return last(&format!("or that moved for them {SHARED}")),
        None => {}
    }
    let causes = [
        (
            undone.overlaps,
            "overlapped an earlier stone: the gaps are smaller than stones of this size; make room for them (--crowd 300), lower the content, or give smaller stones".to_owned(),
        ),
        (
            undone.too_heavy,
            "were too heavy for what is missing: one stone is more than the tolerance; raise --tolerance, enlarge the box, or give smaller stones".to_owned(),
        ),
        (undone.too_large, format!("were {LARGE}")),
        (undone.few_grains, FEW.to_owned()),
        (undone.shared_grains, SHARED.to_owned()),
    ];
    let most = causes.iter().max_by_key(|c| c.0).filter(|c| c.0 > 0);
    most.map_or(format!("{tries} tries were not enough: raise --tries"), |(count, words)| {
        format!("{count} of {tries} tries {words}")
    })
}

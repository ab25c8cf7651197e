//! What to change where a guard stops a run: each remedy once, in the words of a scene.

use dem::{Entrance, Halt};

/// Share of a guard up to which a wider guard is the smaller change [–]: beyond, the contact is too soft.
const JUST_ABOVE: f64 = 1.2;

/// Makes [`Remedy`], and the table of all of them.
macro_rules! remedies {
    ($($remedy:ident: $text:expr,)*) => {
        /// A change of a scene or of the stages of a plant with which a run that was stopped goes on. Each that names a key or an option is tried by the tests.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[allow(missing_docs, reason = "each variant is its sentence")]
        pub enum Remedy {
            $($remedy,)*
        }

        impl Remedy {
            /// All there are.
            pub const ALL: &[Remedy] = &[$(Remedy::$remedy,)*];

            /// Its sentence; {insert} stands for the number of the `[[insert]]`, {stiff} for what a stiffer contact is made of.
            fn pattern(self) -> &'static str {
                match self {
                    $(Remedy::$remedy => $text,)*
                }
            }
        }
    };
}

remedies! {
    ShortenStep: "shorten time.dt, or time.safety of an automatic step",
    SmallerShare: "use a smaller time.safety (or time.dt)",
    RaiseOverlap: "raise guards.overlap",
    RaiseMotion: "raise guards.motion",
    RaiseEnergy: "raise guards.energy",
    Stiffen: "stiffen the material{stiff}",
    MeetSlower: "let grains meet more slowly (a lower drop or speed of insertion)",
    RecordedPaths: "let grains come in along the paths that they took (motion = \"recorded\" in both stages)",
    FreeZone: "keep its zone free at the start",
    Ahead: "let slow grains start farther back (stage-replay --ahead)",
    CutBelow: "cut where nothing piles up to the plane, 3 to 4 grain diameters below a mouth",
    CutUpstream: "cut the plant farther upstream",
    LongerZone: "take a longer zone (length)",
    RemoveReturned: "set guards.zones = \"remove\" to take out grains that came back",
    AllowReturned: "set guards.zones = false where grains get there by another way",
    InsertShape: "move insert.{insert}.shape to where nothing lies or piles up",
    SmallerShape: "make insert.{insert}.shape smaller, or move it, so that it does not cross the wall",
    WaitOrSkip: "set insert.{insert}.when_blocked = \"wait\" or \"skip\"",
    InsertUntil: "end it before (insert.{insert}.until)",
    InsertRate: "lower insert.{insert}.rate",
    LookAtStart: "look at its speed, spin and stiffness at the start: one is far too large",
    LookAtStiffness: "look at the stiffness of its contacts",
    SpringLimit: "raise wall.spring.speed_limit",
    SpringMass: "raise wall.spring.mass",
    ServoDirection: "turn wall.servo.direction round if it points away from the grains",
    ServoStart: "start the wall where it meets them",
    WithoutDevice: "go on without --device",
    EndBefore: "end the run before (time.until)",
    LargerDomain: "take a larger domain with more grains",
    RecordWrenches: "set record_wrenches in the setup",
    SofterBonds: "use softer or thinner bonds",
    MoveOne: "move one of them",
}

use Remedy::*;

impl Remedy {
    /// What helps, the smaller change first.
    pub fn of(halt: &Halt) -> Vec<Remedy> {
        match halt {
            Halt::Overlap { share, limit, .. } if *share <= JUST_ABOVE * limit => {
                widest(*share, [RaiseOverlap], [Stiffen, MeetSlower])
            }
            Halt::Overlap { share, .. } => {
                let mut all = vec![Stiffen, MeetSlower];
                all.extend(widest(*share, [RaiseOverlap], []));
                all
            }
            Halt::InletOverlap { by, share, .. } => {
                let mut all = match by {
                    Entrance::Inlet(_) => vec![RecordedPaths, FreeZone, Ahead, CutBelow, RemoveReturned],
                    Entrance::Insert(_) => vec![InsertRate, InsertShape, InsertUntil],
                };
                all.extend(widest(*share, [RaiseOverlap], []));
                all
            }
            Halt::FreeInWall { .. } => vec![SmallerShape],
            Halt::NoRoom { .. } => vec![WaitOrSkip, InsertRate, InsertShape, InsertUntil],
            Halt::Motion { .. } | Halt::TooFast { .. } => vec![ShortenStep, RaiseMotion],
            Halt::NotANumber { .. } => vec![LookAtStart, ShortenStep],
            Halt::WallNotANumber { .. } => vec![LookAtStiffness, ShortenStep],
            Halt::WallTooFast { .. } => vec![SpringLimit, SpringMass],
            Halt::WallTooLight { .. } => vec![SpringMass, SmallerShare],
            Halt::WallPastAll { .. } => vec![ServoDirection, ServoStart],
            Halt::Device { .. } => vec![WithoutDevice],
            Halt::CellTooSmall { .. } => vec![EndBefore, LargerDomain],
            Halt::NotKept { .. } => vec![RecordWrenches],
            Halt::CameBack { .. } => vec![CutUpstream, LongerZone, RemoveReturned, AllowReturned],
            Halt::BondsTooStiff { .. } => vec![SmallerShare, SofterBonds],
            Halt::Bonds { .. } => vec![MoveOne],
            Halt::Energy { .. } => vec![SmallerShare, RaiseEnergy],
        }
    }

    /// The sentence; `k` is the number of the `[[insert]]`, `stiff` what a stiffer contact is made of.
    pub fn text(self, k: u32, stiff: &str) -> String {
        self.pattern().replace("{insert}", &k.to_string()).replace("{stiff}", stiff)
    }
}

/// A wider overlap guard before the others: a limit above the smaller radius is refused.
fn widest<const N: usize>(share: f64, wider: [Remedy; 1], rest: [Remedy; N]) -> Vec<Remedy> {
    wider.into_iter().filter(|_| share < 1.0).chain(rest).collect()
}

//! Which guard a halt belongs to, as reports and run files name it.

use dem::Halt;
use record::{Guard, StopCause};

/// What stopped a run.
pub fn stop_cause(halt: &Halt) -> StopCause {
    let guard = match halt {
        Halt::Device { .. } => return StopCause::Device,
        Halt::Overlap { .. } | Halt::InletOverlap { .. } => Guard::Overlap,
        Halt::Motion { .. } | Halt::TooFast { .. } => Guard::Motion,
        Halt::Energy { .. } => Guard::Energy,
        Halt::CameBack { .. } => Guard::Zones,
        Halt::NotANumber { .. } | Halt::WallNotANumber { .. } => Guard::NotANumber,
        Halt::FreeInWall { .. } | Halt::NoRoom { .. } => Guard::Insertion,
        Halt::WallTooFast { .. } | Halt::WallTooLight { .. } | Halt::WallPastAll { .. } => Guard::Walls,
        Halt::CellTooSmall { .. } => Guard::Domain,
        Halt::BondsTooStiff { .. } | Halt::Bonds { .. } => Guard::Bonds,
        Halt::NotKept { .. } => Guard::Wrenches,
    };
    StopCause::Guard { guard }
}

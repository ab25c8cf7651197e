//! Grains, walls and clouds on a display: one self-contained HTML page ([`Page`]), a picture ([`picture`]),
//! a film ([`film`]), or files for ParaView ([`vtk`]).
//!
//! Everything shown is a table with the columns x, y, z, usually radius [m], and any others, which are fields
//! to colour by; besides, there are walls that are planes or meshes ([`WallSurface`]). [`show_run`] reads a run and gives its layers to
//! whatever can [`Show`] them: a page, one [`Moment`], or a [`Series`] of moments; those give pictures, films and files. The caller opens
//! files and reads clouds. Uses `record` for the formats of runs; knows no engine.

mod appearance;
mod error;
pub mod film;
mod page;
pub mod picture;
mod reading;
mod things;
pub mod vtk;

pub use appearance::camera::Camera;
pub use appearance::colour::{Map, Rgb};
pub use appearance::wall_scale::WallScale;
pub use error::ViewError;
pub use geom::Motion;
pub use page::{Page, PageContent, PageOptions};
pub use picture::{DrawnTable, Image, PictureOptions, Survey};
pub use reading::diagram::{Diagram, DiagramCurve};
pub use reading::hidden::Hidden;
pub use reading::moment::Moment;
pub use reading::only::{Chosen, Only, Wanted};
pub use reading::run::show_run;
pub use reading::series::{Series, Span};
pub use reading::show::{LayerHead, Show};
pub use record::SurfaceShape;
pub use things::bodies::GrainCount;
pub use things::extras::{Arrows, Extras};
pub use things::outlines::{
    Line, OutlineKind, arrow_table, box_lines, outline_table, plane_lines, shape_lines, wall_lines,
};
pub use things::surface::WallSurface;
pub use things::wear_state::{PartValues, WearState};
pub use wear::WearField;

/// What a table of spheres or points is, and so how it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Moving particles: coloured by a field.
    Grains,
    /// Points of a scan, which have no radius of their own: coloured when there are no grains.
    Cloud,
    /// Wall spheres: grey, and translucent where they hide anything else.
    Walls,
    /// Bonds and cracks, see [`Extras`].
    Bonds,
    /// Arrows, see [`Extras`].
    Arrows(Arrows),
    /// Contacts that carry a force, see [`Extras`].
    ForceChains,
    /// What a scene will do, see [`outline_table`].
    Outline(OutlineKind),
}

impl Role {
    /// Whether it is rods, not spheres or points.
    pub fn is_rods(self) -> bool {
        matches!(self, Role::Bonds | Role::Arrows(_) | Role::ForceChains | Role::Outline(_))
    }

    /// Whether grains are drawn smaller, which would hide it.
    pub(crate) fn lies_in_grains(self) -> bool {
        matches!(self, Role::Bonds | Role::Arrows(Arrows::Velocity | Arrows::Force))
    }

    /// The number for it in files for ParaView.
    fn number(self) -> u8 {
        match self {
            Role::Grains => 0,
            Role::Cloud => 1,
            Role::Walls => 2,
            Role::Bonds => 4,
            Role::Arrows(_) => 5,
            Role::ForceChains => 6,
            Role::Outline(_) => 7,
        }
    }

    /// Whether it has a state for each frame.
    pub(crate) fn moves(self) -> bool {
        self == Role::Grains || self.is_rods()
    }

    /// The word for it in a page.
    fn word(self) -> &'static str {
        match self {
            Role::Grains => "grains",
            Role::Walls => "walls",
            Role::Cloud => "cloud",
            Role::Bonds => "bonds",
            Role::Arrows(_) => "arrows",
            Role::ForceChains => "force-chains",
            Role::Outline(_) => "outlines",
        }
    }
}

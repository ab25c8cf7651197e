//! What all pictures of a film have in common: what the camera sees, and what the colours mean.

use super::{
    chains::{ChainKey, ChainSurvey},
    counts::Counts,
    drawn_table::DrawnTable,
    key::{BarKey, Key, scan_colours},
    options::PictureOptions,
    shapes::{self, ArrowKey, ArrowSurvey},
    walls::WallKey,
};
use crate::appearance::{classes::Sizes, colour, field, scale::Range, wall_scale::WallSurvey};
use crate::things::{outline::Outline, sheet::box_of, spheres::Spheres, wear_state::WORN};
use crate::{GrainCount, Role, SurfaceShape, ViewError, WallSurface};
use geom::Vec3;
use std::collections::BTreeSet;
use stream::{Table, Values};

/// Values of a moment that are kept to find the range of the colours, at most, when there are many moments.
const SAMPLE: usize = 20_000;

/// Numbers that may have names.
const CODES: usize = 64;

/// What was seen of the moments that are to be drawn.
#[derive(Clone, Default)]
pub struct Survey {
    pub(super) outline: Outline,
    colours: Option<Colours>,
    arrows: ArrowSurvey,
    chains: ChainSurvey,
    moments: usize,
    /// Most grains, wall spheres and points of a moment.
    counts: Counts,
    walls: WallSurvey,
    /// Whether any sphere, point or outline was seen.
    found: bool,
}

/// What is coloured, by what.
#[derive(Clone)]
struct Colours {
    role: Role,
    /// None: the scan's own colours.
    field: Option<String>,
    whole: bool,
    kinds: Vec<String>,
    values: Vec<f64>,
    all: Range,
    sizes: Sizes,
    /// Whole numbers that there are, up to [`CODES`].
    present: BTreeSet<usize>,
}

impl Survey {
    /// Takes in a moment: what is there, and where meshes are at the time of `options`.
    ///
    /// # Errors
    /// A broken table, an unknown field.
    pub fn add(
        &mut self,
        parts: &[DrawnTable],
        surfaces: &[WallSurface],
        options: &PictureOptions,
    ) -> Result<(), ViewError> {
        self.moments += 1;
        for part in parts.iter().filter(|p| !options.hidden.hides_layer(p.role, &p.name)) {
            match part.role {
                Role::Arrows(of) => self.arrows.add(of, part.table),
                Role::ForceChains => {
                    self.chains.add(part.table);
                    if options.hidden.hides_layer(Role::Grains, Role::Grains.word()) {
                        self.see(part.table);
                    }
                }
                Role::Outline(_) => self.see(part.table),
                _ => {}
            }
        }
        let shown = |p: &&DrawnTable| !options.hidden.hides_layer(p.role, &p.name);
        let parts = || parts.iter().filter(shown).filter(|p| p.table.rows() > 0 && !p.role.is_rods());
        for part in parts() {
            let spheres = Spheres::of(part.table, &part.name)?;
            let end = options.walls_end.filter(|_| part.role == Role::Grains);
            self.outline.add_spheres(&spheres, &part.bodies(), part.role != Role::Walls, end);
        }
        let surfaces = surfaces.iter().filter(|s| !options.hidden.hides_surface(&s.name));
        for surface in surfaces.filter(|s| self.moments == 1 || s.motion.moves()) {
            if let SurfaceShape::Mesh(mesh) = &surface.shape {
                let pose = surface.motion.pose(options.time.unwrap_or(0.0));
                self.outline.add(&mesh.vertices.iter().map(|v| pose.position(v)).collect::<Vec<Vec3>>());
            }
        }
        let tables = |role| parts().filter(move |p| p.role == role).map(|p| p.table);
        let rows = |role| tables(role).map(Table::rows).sum::<usize>();
        let grains = tables(Role::Grains).map(GrainCount::of).fold(GrainCount::default(), GrainCount::plus);
        self.counts = Counts {
            grains: self.counts.grains.most(grains),
            walls: self.counts.walls.max(rows(Role::Walls)),
            points: self.counts.points.max(rows(Role::Cloud)),
        };
        self.found |= parts().next().is_some();
        if options.walls.is_some() {
            let spheres = parts().filter_map(|part| part.table.get(WORN)).flat_map(Values::iter);
            let faces = options.surface_values.iter().flatten().flat_map(|values| values.iter());
            self.walls.add(spheres.chain(faces.map(|value| f64::from(*value))));
        }
        // Walls that are coloured by what was done to them are not coloured by anything else.
        let parts = || parts().filter(|p| p.role != Role::Walls || options.walls.is_none());
        let Some(first) = parts().min_by_key(|p| p.role) else { return Ok(()) };
        if self.colours.as_ref().is_none_or(|c| first.role < c.role) {
            self.colours = Some(Colours::of(first, options));
        }
        let Some(colours) = &mut self.colours else { return Ok(()) };
        let role = colours.role;
        parts().filter(|p| p.role == role).try_for_each(|part| colours.add(part))
    }

    /// Takes in where rods are.
    fn see(&mut self, rods: &Table) {
        self.outline.add(&shapes::ends(rods));
        self.found |= rods.rows() > 0;
    }

    /// Whether nothing was seen.
    pub(super) fn is_empty(&self) -> bool {
        !self.found
    }

    /// What is coloured.
    pub(super) fn role(&self) -> Option<Role> {
        self.colours.as_ref().map(|c| c.role)
    }

    /// Most grains, wall spheres and points of a moment.
    pub(super) fn counts(&self) -> Counts {
        self.counts
    }

    /// Most grains of a moment.
    pub fn grains(&self) -> GrainCount {
        self.counts.grains
    }

    /// What thickness and colour of force chains mean.
    pub(super) fn chains(&self, options: &PictureOptions) -> Option<ChainKey> {
        self.chains.key(options)
    }

    /// What the lengths of arrows mean.
    pub(super) fn arrows(&self) -> Option<ArrowKey> {
        self.arrows.key()
    }

    /// The box around everything but planes [m].
    pub(super) fn extent(&self) -> [Range; 3] {
        box_of(&self.outline.points())
    }

    /// What the colours of walls mean.
    pub(super) fn wall_key(&self, options: &PictureOptions) -> Option<WallKey> {
        Some(WallKey::of(&self.walls, options.walls?))
    }

    /// What the colours mean.
    pub(super) fn key(&self, options: &PictureOptions) -> Key {
        // Grains are faint behind force chains.
        let colours = self.colours.as_ref().filter(|_| !self.chains.is_seen());
        let Some(Colours { field: Some(field), whole, kinds, values, all, sizes, present, .. }) = colours
        else {
            return Key::None;
        };
        let name = field.clone();
        if let Some(classes) = sizes.classes() {
            return Key::Classes { classes, map: options.map };
        }
        let few = all.hi < colour::KIND_COUNT as f64;
        if *whole && all.lo >= 0.0 && (few || field::names_things(&name)) {
            let codes = field::codes(&name, kinds);
            let count = if few || all.hi < codes.len() as f64 { all.hi as usize + 1 } else { 0 };
            let shown = (0..count).filter(|k| present.contains(k));
            let names = shown.map(|k| (k, codes.get(k).cloned().unwrap_or_else(|| k.to_string())));
            return Key::Kinds { field: name, names: names.collect() };
        }
        let range = match options.range {
            Some([lo, hi]) => Range { lo, hi },
            None => Range::of_most(values).opened(),
        };
        let slack = 1e-9 * (range.hi - range.lo);
        let beyond = [all.lo < range.lo - slack, all.hi > range.hi + slack];
        Key::Bar(BarKey {
            unit: field::unit(&name),
            title: name,
            range,
            beyond,
            log: false,
            map: options.map,
        })
    }
}

impl Colours {
    fn of(part: &DrawnTable, options: &PictureOptions) -> Colours {
        let asked = options.colour.as_deref().map(field::canonical);
        let own = asked.is_none_or(|f| f == "rgb") && scan_colours(part.table).is_some();
        let name = || asked.map_or_else(|| field::default_of(part.table), str::to_owned);
        let field = (!own).then(name);
        let whole = field.as_deref().is_some_and(|f| field::is_whole(part.table, f));
        let (kinds, values) = (part.kinds.clone(), Vec::new());
        let (all, sizes, present) = (Range::EMPTY, Sizes::default(), BTreeSet::new());
        Colours { role: part.role, field, whole, kinds, values, all, sizes, present }
    }

    fn add(&mut self, part: &DrawnTable) -> Result<(), ViewError> {
        let Some(name) = &self.field else { return Ok(()) };
        let Some(values) = field::values(part.table, name) else {
            let known = field::known(part.table);
            return Err(ViewError::NoField { what: "colour", name: name.clone(), known });
        };
        if name == field::SIZE {
            self.sizes.add(values.into_iter());
            return Ok(());
        }
        self.all = self.all.with(Range::of(&values));
        if self.whole {
            self.present.extend(values.iter().map(|v| *v as usize).filter(|v| *v < CODES));
        }
        let step = values.len().div_ceil(SAMPLE).max(1);
        self.values.extend(values.into_iter().step_by(step));
        Ok(())
    }
}

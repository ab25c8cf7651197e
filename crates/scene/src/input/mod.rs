//! Streams that a run is given: walls or an inlet, told apart by what they hold.

use crate::clump_info::{self, ClumpInfo};
use crate::crossings::{CROSSINGS, ONLY_CLUMPS, SIZES, Sizes, WATERMARK, topic};
use crate::error::SceneError;
use crate::gate::Gate;
use crate::inlet::{INLET, InletStream, Source};
use crate::links::{self, BONDS, LINKS};
use crate::material_info::{self, MATERIALS, MaterialInfo};
use crate::run::CLUMPS;
use crate::touches::TOUCHES;
use crate::wall_file::WallFile;
use dem::setup::EntryBonds;
use stream::mcap::{Event, McapError, Reader};

/// Metadata record that every run has.
pub const SCENE: &str = "scene";

/// What a stream says of itself before its first message.
#[derive(Default)]
pub(crate) struct Said {
    pub gate: Option<Gate>,
    pub sizes: Option<Sizes>,
    pub only_clumps: bool,
    pub materials: Vec<MaterialInfo>,
    pub clumps: Vec<ClumpInfo>,
    pub bonds: Option<EntryBonds>,
}

/// A stream, as far as it had to be read to know what it is.
pub enum Input {
    /// Wall spheres; read whole.
    Walls(WallFile),
    /// Recorded particles; read as the run needs them.
    Inlet(Box<InletStream>),
}

impl Input {
    /// Opens a stream under the name that messages use.
    ///
    /// # Errors
    /// A stream that breaks off, or holds neither walls nor crossings.
    pub fn open(name: &str, source: Source) -> Result<Input, SceneError> {
        let mut reader = Reader::new(source);
        let mut said = Said::default();
        loop {
            let Some(event) = reader.next() else {
                return Err(SceneError::file(
                    name,
                    "holds no message",
                    "give walls (wallgen) or an inlet (stage-replay)",
                ));
            };
            let event = event.map_err(|e| broken(name, e))?;
            let Event::Metadata { name: record, map } = &event else {
                return Input::by_topic(name, reader, event, said);
            };
            match record.as_str() {
                MATERIALS => said.materials = material_info::from_map(name, map)?,
                CLUMPS => said.clumps = clump_info::from_map(name, map)?,
                SIZES => {
                    said.only_clumps = map.contains_key(ONLY_CLUMPS);
                    said.sizes = Some(Sizes::from_map(name, map)?);
                }
                BONDS => said.bonds = Some(links::from_map(name, map)?),
                SCENE => {
                    let why = "is a run, neither walls nor an inlet";
                    return Err(SceneError::file(
                        name,
                        why,
                        "pass it through stage-replay to let its particles in",
                    ));
                }
                // The last record of an inlet: from here on, messages may come as late as a run upstream makes them.
                INLET => {
                    said.gate = Some(Gate::from_map(name, INLET, map)?);
                    return Input::inlet(name, reader, None, said);
                }
                _ => {}
            }
        }
    }

    fn by_topic(
        name: &str,
        mut reader: Reader<Source>,
        first: Event,
        said: Said,
    ) -> Result<Input, SceneError> {
        match (topic(&first).unwrap_or_default(), &first) {
            (CROSSINGS | WATERMARK | TOUCHES | LINKS, _) => Input::inlet(name, reader, Some(first), said),
            ("/walls", Event::Points { table, .. }) => {
                let walls = WallFile::new(name, table, said.materials)?;
                // To the end, where the record is that tells a whole stream from a broken one.
                for event in reader.by_ref() {
                    let event = event.map_err(|e| broken(name, e))?;
                    if topic(&event) == Some("/walls") {
                        let why = "has walls at several times";
                        return Err(SceneError::file(
                            name,
                            why,
                            "give still walls, and their motion in the scene",
                        ));
                    }
                }
                Ok(Input::Walls(walls))
            }
            (other, _) => {
                let why = format!("begins with messages on '{other}', neither /walls nor /crossings");
                Err(SceneError::file(name, why, "give walls (wallgen) or an inlet (stage-replay)"))
            }
        }
    }

    fn inlet(
        name: &str,
        reader: Reader<Source>,
        first: Option<Event>,
        said: Said,
    ) -> Result<Input, SceneError> {
        let missing = |record: &str, what: &str| {
            SceneError::file(
                name,
                format!("the record '{record}' ({what}) is missing"),
                "write it with stage-replay",
            )
        };
        let sizes = said.sizes.ok_or_else(|| missing(SIZES, "range of the radii"))?;
        if said.materials.is_empty() {
            return Err(missing(MATERIALS, "names of the materials"));
        }
        Ok(Input::Inlet(Box::new(InletStream::new(name, reader, sizes, said, first)?)))
    }
}

fn broken(name: &str, error: McapError) -> SceneError {
    SceneError::Content { name: name.to_owned(), wanted: "walls or an inlet", source: error.into() }
}

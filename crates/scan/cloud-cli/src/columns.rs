//! Names of the columns of a text cloud: `--columns`.

use cli::usage;
use cloud::TextColumns;

/// The names of the columns of a text cloud: flatten it into the arguments of a tool that reads one.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Columns {
    /// Names of the columns of a text cloud, in the order of the file: id,x,y,z or easting,northing,height,class; - leaves a column out. They replace the names in the file; with x=NAME,y=NAME,z=NAME those stay, and these three are the coordinates
    #[arg(long, value_name = "NAMES", allow_hyphen_values = true)]
    columns: Option<TextColumns>,
}

impl Columns {
    /// The names, if some were given.
    pub fn given(&self) -> Option<&TextColumns> {
        self.columns.as_ref()
    }

    /// Refuses names where no cloud is read.
    ///
    /// # Errors
    /// Names that were given.
    pub fn none(&self, why: &str) -> anyhow::Result<()> {
        match &self.columns {
            Some(_) => Err(usage(format!("--columns: {why}: leave it out"))),
            None => Ok(()),
        }
    }
}

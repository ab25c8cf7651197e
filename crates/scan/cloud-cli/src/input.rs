//! The cloud that a tool reads, in metres and where `--transform` puts it.

use crate::Columns;
use anyhow::Context;
use cli::{Lengths, Placing, Source};
use cloud::Cloud;
use cloud::points::ReadWarning;
use cloud::points::units::UnitWarning;
use std::io::Read;
use stream::ply::Opened;

/// The cloud that a tool reads: flatten it into the tool's arguments.
#[derive(Debug, Clone, clap::Args)]
pub struct Input {
    /// Point cloud (PLY, LAS, LAZ, E57, PCD, XYZ, PTS, PTX; STL and OBJ: their corners; detected by content), - for stdin
    #[arg(value_name = "CLOUD", default_value = "-", hide_default_value = true)]
    pub cloud: Source,
    /// What a length in it is.
    #[command(flatten)]
    pub lengths: Lengths,
    /// The names of its columns.
    #[command(flatten)]
    pub columns: Columns,
    /// Where it is put.
    #[command(flatten)]
    pub placing: Placing,
}

impl Input {
    /// The name that messages use.
    pub fn name(&self) -> String {
        self.cloud.to_string()
    }

    /// Opens the cloud as a stream of bytes, for a tool that looks at them first.
    ///
    /// # Errors
    /// As [`Source::open`].
    pub fn open(&self) -> anyhow::Result<Box<dyn Read + Send>> {
        self.cloud.open()
    }

    /// Reads the cloud, whatever its format.
    ///
    /// # Errors
    /// As [`Source::open`]; content that is not a cloud.
    pub fn read_cloud(&self) -> anyhow::Result<Cloud> {
        let cloud = self.read(self.open()?)?;
        self.warn_of_marks(&cloud);
        Ok(self.in_metres(cloud))
    }

    /// Reads one of several clouds, of which only those of text get the names of `--columns`; says whether it did.
    ///
    /// # Errors
    /// As [`Input::read_cloud`].
    pub fn read_among(&self) -> anyhow::Result<(Cloud, bool)> {
        let opened = Opened::new(self.open()?).map_err(cloud::ReadError::Io);
        let read = opened.and_then(|opened| cloud::formats::go_on_among(opened, self.columns.given()));
        let (cloud, is_named) = read.with_context(|| self.name())?;
        self.warn_of_marks(&cloud);
        Ok((self.in_metres(cloud), is_named))
    }

    fn read(&self, from: impl Read) -> anyhow::Result<Cloud> {
        let opened = Opened::new(from).map_err(cloud::ReadError::Io);
        let cloud = opened.and_then(|opened| cloud::formats::go_on_as(opened, self.columns.given()));
        cloud.with_context(|| self.name())
    }

    /// Reads the cloud, with one point of each place if many lie in one: what compares each point with those around it would take time to the square.
    ///
    /// # Errors
    /// As [`Input::read_cloud`].
    pub fn read_places(&self) -> anyhow::Result<Cloud> {
        let (cloud, left_out) = cloud::points::without_crowds(self.read_cloud()?);
        if left_out > 0 {
            let repeated = geom::counted_as(left_out, "point", ["is", "are"]);
            cli::warn(&format!("{}: {repeated} left out that lie where another one lies", self.name()));
        }
        Ok(cloud)
    }

    /// Warns of points that `cloud-crop --mark` would have removed.
    fn warn_of_marks(&self, cloud: &Cloud) {
        let marks = cloud::crop::marks(cloud).unwrap_or_default().iter().filter(|m| **m != 0).count();
        if marks > 0 {
            let name = self.name();
            cli::warn(&format!(
                "{name}: {} marked as removed and used all the same: cloud-crop removes what is marked",
                geom::counted_as(marks, "point", ["is", "are"])
            ));
        }
    }

    /// Reads the rest of a cloud whose beginning was looked at.
    ///
    /// # Errors
    /// As [`Input::read_cloud`].
    pub fn go_on(&self, opened: Opened<impl Read>) -> anyhow::Result<Cloud> {
        let cloud = cloud::formats::go_on_as(opened, self.columns.given()).with_context(|| self.name())?;
        Ok(self.in_metres(cloud))
    }

    /// Reads the cloud, and its name and SHA-256 for [`cli::provenance`].
    ///
    /// # Errors
    /// As [`Input::read_cloud`].
    pub fn read_cloud_hashed(&self) -> anyhow::Result<(Cloud, (String, String))> {
        let mut from = stream::Hashed::new(self.open()?);
        let cloud = self.read(&mut from)?;
        self.warn_of_marks(&cloud);
        Ok((self.in_metres(cloud), ("cloud".to_owned(), from.sha256())))
    }

    /// Says what the reader noticed, scales and moves the cloud, and warns of implausible numbers. In a pipe only the first tool warns.
    fn in_metres(&self, mut cloud: Cloud) -> Cloud {
        let is_scaled = self.lengths.factor().is_some() || self.placing.scales();
        let is_answered = |w: &ReadWarning| is_scaled && w.is_answered_by_scale();
        for warning in std::mem::take(&mut cloud.warnings).iter().filter(|w| !is_answered(w)) {
            cli::warn(&format!("{}: {warning}", self.name()));
        }
        if let Some(factor) = self.lengths.factor().filter(|factor| *factor != 1.0) {
            cloud.scale(factor);
        }
        // Digits that are missing in the file are missing where it is moved to, too; places are named where they are then.
        let is_short = |w: &UnitWarning| matches!(w, UnitWarning::Short { .. });
        let mut found = cloud::points::units::warnings(&cloud);
        if self.placing.transform().is_some() {
            found.retain(is_short);
            place(&mut cloud, &self.placing, &self.name());
            found.extend(cloud::points::units::warnings(&cloud));
        }
        self.warn_about(&found);
        cloud
    }

    /// Warns of implausible numbers of a cloud, unless the scale is given or another tool has warned.
    pub fn warn_about(&self, warnings: &[UnitWarning]) {
        let is_scaled = self.lengths.factor().is_some() || self.placing.scales();
        if self.cloud != Source::Stdin {
            let open = warnings.iter().filter(|w| !(is_scaled && w.is_answered_by_scale()));
            open.for_each(|warning| cli::warn(&format!("{}: {warning}", self.name())));
        }
    }
}

/// Moves a cloud to where `--transform` puts it, and warns of what does not turn with it.
pub fn place(cloud: &mut Cloud, placing: &Placing, name: &str) {
    let Some(by) = placing.transform() else { return };
    placing.warn_of_digits(&cloud.points, name);
    for column in cloud.transform(by) {
        cli::warn(&format!(
            "{name}: the columns '{column}' and those of y and z stay as they are: if they are a direction, name them nx, ny, nz, and they turn"
        ));
    }
}

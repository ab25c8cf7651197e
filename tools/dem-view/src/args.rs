//! The command line.

use crate::formats::{self, Format};
use clap::Parser;
use cli::Source;
use std::path::PathBuf;
use view::{Arrows, Camera, Extras, Map, PictureOptions, Span};

const EXAMPLES: &str = "Examples:\n\
    \x20 dem-view run.mcap -o run.html\n\
    \x20 dem-view run.mcap --time 0.02 --colour speed --camera front -o run.png\n\
    \x20 dem-view bonded.mcap --bonds --colour broken --range 0,1 -o bonds.png\n\
    \x20 dem-view run.mcap --vectors velocity -o arrows.png\n\
    \x20 dem-view run.mcap --every 0.01 --size 320x180 -o run.gif\n\
    \x20 dem-view sampled.ply --pick -o pick.html";

/// Show runs, walls and clouds together: an HTML page (no network needed), a picture, a film, files for ParaView
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Runs and walls (MCAP), clouds (PLY, LAS, E57, PCD, XYZ), meshes (PLY, STL, OBJ), shown together; - or none: stdin
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<Source>,
    #[command(flatten)]
    pub lengths: cli::Lengths,
    /// Write to FILE instead of HTML to stdout; FILE appears when it is complete. Endings: .html, .png, .gif, .mp4 (needs ffmpeg), .vtp
    /// (ParaView, one moment), .pvd (ParaView, a series: NAME.pvd and a folder NAME)
    #[arg(id = "output", short = 'o', long = "output", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Field to colour by: speed, spin, radius, size (classes of diameter), material, broken (share of a grain's bonds that are
    /// broken), id, x, y, z, rgb, or any column [default: speed, else z]
    #[arg(long, visible_alias = "color", value_name = "FIELD")]
    pub colour: Option<String>,
    /// Ends of the colour scale in SI units [default: the range of 98 % of the values]
    #[arg(long, value_name = "LO,HI", value_parser = formats::range, allow_hyphen_values = true)]
    pub range: Option<[f64; 2]>,
    /// Colour map: viridis or turbo
    #[arg(long, value_name = "NAME", value_parser = formats::map, default_value = "viridis")]
    pub map: Map,
    /// Time to show [s]. HTML: shown first, paused; PNG, VTP: the nearest frame [default: the last frame with grains]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    pub time: Option<f64>,
    /// Position of the camera: iso, top, bottom, front, back, left, right; a side: x, -x, y, -y, z, -z; azimuth/elevation in
    /// degrees, from x towards y and up: 35/20; or x,y,z of the camera [m], and after it those of the point looked at (optional)
    #[arg(long, value_name = "VIEW", value_parser = formats::camera, default_value = "iso", allow_hyphen_values = true)]
    pub camera: Camera,
    /// First time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds, allow_hyphen_values = true)]
    pub from: Option<f64>,
    /// Last time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    pub to: Option<f64>,
    /// Simulated time between two pictures of a film or series [s] [default: every frame]
    #[arg(long, value_name = "S", value_parser = cli::span)]
    pub every: Option<f64>,
    /// Pictures per second of a film
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100), default_value_t = 25)]
    pub fps: u32,
    /// Size of a picture or film [pixel] [default: 1920x1080, GIF 960x540]
    #[arg(long, value_name = "WxH", value_parser = formats::size)]
    pub size: Option<[u32; 2]>,
    /// Opacity of walls in front of grains in the picture, 0 to 1
    #[arg(long, value_name = "SHARE", value_parser = formats::share, default_value_t = 0.2)]
    pub wall_opacity: f64,
    /// Draw the bonds of a run, and a disc where one broke; grains at half their size
    #[arg(long)]
    pub bonds: bool,
    /// Draw arrows: velocity of each grain, or force of each recorded contact on its first grain; grains at half their size
    #[arg(long, value_name = "FIELD", value_parser = formats::arrows)]
    pub vectors: Option<Arrows>,
    /// Leave out the nearer half of the walls in the picture
    #[arg(long)]
    pub cut: bool,
    /// Light text on dark paper: pictures and films, and a page at first [default of a page: as the system has it]
    #[arg(long)]
    pub dark: bool,
    /// Largest size of the page [MB]: a larger page loses the components of vectors, then frames at even intervals; if it is still too large, it is refused
    #[arg(long, value_name = "MB", value_parser = formats::megabytes, default_value = "60")]
    pub max_mb: f64,
    /// Keep the components of vectors in a page that is too large, and leave out more frames
    #[arg(long)]
    pub components: bool,
    /// Title of the page [default: the inputs' names]
    #[arg(long)]
    pub title: Option<String>,
    /// Write a page in which you draw regions over one cloud; it gives the --keep and --remove options for cloud-crop
    #[arg(long)]
    pub pick: bool,
}

impl Args {
    /// Refuses options of another kind of output.
    pub fn check(&self, format: Format) -> anyhow::Result<()> {
        let part =
            [("--from", self.from.is_some()), ("--to", self.to.is_some()), ("--every", self.every.is_some())];
        if let Some((name, _)) = part.iter().find(|(_, given)| *given && !format.is_series()) {
            return Err(cli::usage(format!(
                "{name} is for a film or series (.gif, .mp4, .pvd): use --time for one moment"
            )));
        }
        if self.pick && format != Format::Html {
            return Err(cli::usage("--pick writes a page: use a name that ends in .html"));
        }
        let files = matches!(format, Format::Vtp | Format::Pvd);
        let drawn = [("--bonds", self.bonds), ("--vectors", self.vectors.is_some())];
        if let Some((name, _)) = drawn.iter().find(|(_, given)| *given && (files || self.pick)) {
            let why =
                if files { "files for ParaView hold grains with their vectors" } else { "a cloud has none" };
            return Err(cli::usage(format!("{name}: {why}: leave it out")));
        }
        if self.range.is_some() && self.colour.as_deref() == Some("size") {
            return Err(cli::usage(
                "--range: size has classes, not a scale: leave it out, or give --colour radius",
            ));
        }
        if self.dark && files {
            return Err(cli::usage("--dark: files for ParaView have no colours: leave it out"));
        }
        if self.time.is_some() && format.is_series() {
            return Err(cli::usage("--time is for one moment: give a film or series its --from and --to"));
        }
        Ok(())
    }

    /// What is shown of a run besides grains and walls.
    pub fn extras(&self) -> Extras {
        let broken = self.bonds || self.colour.as_deref() == Some("broken");
        Extras { bonds: self.bonds, broken, arrows: self.vectors }
    }

    /// The part of a run that a film or series shows.
    pub fn span(&self) -> Span {
        Span {
            from: self.from.unwrap_or(f64::NEG_INFINITY),
            to: self.to.unwrap_or(f64::INFINITY),
            every: self.every,
        }
    }

    /// How pictures are drawn.
    pub fn picture(&self, format: Format) -> PictureOptions {
        let [width, height] =
            self.size.unwrap_or(if format == Format::Gif { [960, 540] } else { [1920, 1080] });
        PictureOptions {
            width,
            height,
            camera: self.camera,
            colour: self.colour.clone(),
            map: self.map,
            range: self.range,
            time: None,
            wall_opacity: self.wall_opacity,
            cut: self.cut,
            dark: self.dark,
        }
    }
}

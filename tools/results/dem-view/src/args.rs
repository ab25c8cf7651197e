//! The command line.

use crate::formats::{self, Format};
use crate::preview::Planned;
use clap::Parser;
use cli::{OutPath, Source};
use view::{Arrows, Camera, Extras, Hidden, Map, Only, PictureOptions, Span, WallScale, WearField};

/// What is smaller in a picture is hardly seen [pixel].
const SMALL: u32 = 24;

const EXAMPLES: &str = "Examples:\n\
    \x20 dem-view run.mcap -o run.html\n\
    \x20 dem-view run.mcap --time 0.02 --colour speed --camera front -o run.png\n\
    \x20 dem-view bonded.mcap --bonds --colour broken --range 0,1 -o bonds.png\n\
    \x20 dem-view bonded.mcap --only id=0,9 --colour broken -o some.png\n\
    \x20 dem-view run.mcap --vectors velocity -o arrows.png\n\
    \x20 dem-view run.mcap --force-chains --camera front -o chains.png\n\
    \x20 dem-view run.mcap --every 0.01 --size 320x180 -o run.gif\n\
    \x20 dem-view scene.toml -o preview.html\n\
    \x20 dem-view sampled.ply --pick -o pick.html";

/// Show runs, walls and clouds together: an HTML page (no network needed), a picture, a film, files for ParaView
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Runs and walls (MCAP), clouds (PLY, LAS, E57, PCD, XYZ), meshes (PLY, STL, OBJ), shown together; - or none: stdin. Or a scene (TOML),
    /// with its walls and inlets: how it starts, and outlines of what it will do
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<Source>,
    #[command(flatten)]
    pub lengths: cli::Lengths,
    #[command(flatten)]
    pub columns: cloud_cli::Columns,
    #[command(flatten)]
    pub placing: cli::Placing,
    /// Write to FILE instead of HTML to stdout; FILE appears when it is complete. Endings: .html, .png, .gif, .mp4 (needs ffmpeg), .vtp
    /// (ParaView, one moment), .pvd (ParaView, a series: NAME.pvd and a folder NAME)
    #[arg(id = "output", short = 'o', long = "output", value_name = "FILE")]
    pub file: Option<OutPath>,
    /// Field to colour by: speed, spin, radius, size (classes of diameter), material, broken (share of a grain's bonds that are
    /// broken), residence (time since the first frame with the grain), origin (there at the start, or came in later), id, x, y, z, rgb, or
    /// any column [default: speed, else z]
    #[arg(long, visible_alias = "color", value_name = "FIELD")]
    pub colour: Option<String>,
    /// Show only the grains with this value of a field, or with one from LO to HI [SI]; a material by name. Repeat: grains that have all of
    /// them
    #[arg(long, value_name = "FIELD=LO,HI", value_parser = formats::only)]
    pub only: Vec<Only>,
    /// Leave out what has this name: grains, walls, cloud, bonds, arrows, force-chains, outlines, or a wall (repeat). A page can show it again
    #[arg(long, value_name = "NAME")]
    pub hide: Vec<String>,
    /// Ends of the colour scale in SI units [default: the range of 98 % of the values]
    #[arg(long, value_name = "LO,HI", value_parser = formats::range, allow_hyphen_values = true)]
    pub range: Option<[f64; 2]>,
    /// Colour the triangles and spheres of walls by what grains did to them so far (needs [output] wear = true): sliding_work, impact_energy,
    /// impact_normal, impact_tangential, impacts, largest_normal, pressure; sums are per area
    #[arg(long, visible_alias = "walls-color", value_name = "FIELD", value_parser = formats::wear_field)]
    pub walls_colour: Option<WearField>,
    /// Ends of the scale of --walls-colour in SI units [default: 0 and what 99 % of the touched parts do not exceed]
    #[arg(long, value_name = "LO,HI", value_parser = formats::range, requires = "walls_colour")]
    pub walls_range: Option<[f64; 2]>,
    /// Colour walls along the logarithm [default range: up to four decades]
    #[arg(long, requires = "walls_colour")]
    pub walls_log: bool,
    /// Colour map: viridis, turbo or heat [default: viridis; heat of --force-chains on light paper]
    #[arg(long, value_name = "NAME", value_parser = formats::map)]
    pub map: Option<Map>,
    /// Time to show [s]. HTML: shown first, paused; PNG, VTP: the nearest frame [default: the last frame with grains]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    pub time: Option<f64>,
    /// Position of the camera: iso, top, bottom, front, back, left, right; a side: x, -x, y, -y, z, -z; azimuth/elevation in
    /// degrees, from x towards y and up: 35/20; or x,y,z of the camera [m], and after it those of the point looked at (optional)
    /// [default: iso]
    #[arg(long, value_name = "VIEW", value_parser = formats::camera, allow_hyphen_values = true)]
    pub camera: Option<Camera>,
    /// First time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds, allow_hyphen_values = true)]
    pub from: Option<f64>,
    /// Last time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds)]
    pub to: Option<f64>,
    /// Simulated time between two pictures of a film or series [s] [default: every frame]
    #[arg(long, value_name = "S", value_parser = cli::span)]
    pub every: Option<f64>,
    /// Pictures per second of a film [default: 25]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100))]
    pub fps: Option<u32>,
    /// Size of a picture or film [pixel], 36 bytes of memory each [default: 1920x1080, GIF 960x540]
    #[arg(long, value_name = "WxH", value_parser = formats::size)]
    pub size: Option<[u32; 2]>,
    /// Opacity of walls in front of grains in the picture, 0 to 1 [default: 0.2; 1 of those that --walls-colour colours]
    #[arg(long, value_name = "SHARE", value_parser = formats::share)]
    pub wall_opacity: Option<f64>,
    /// Draw the bonds of a run, and a disc where one broke; grains at half their size
    #[arg(long)]
    pub bonds: bool,
    /// Draw arrows: velocity of each grain, or force of each recorded contact on its first grain; grains at half their size
    #[arg(long, value_name = "FIELD", value_parser = formats::arrows)]
    pub vectors: Option<Arrows>,
    /// Draw a rod for each recorded contact (needs [output] contacts = true), from centre to centre of grains or to a wall: thickness and
    /// colour by normal force, --range and --map are theirs, and grains are faint. The 10 000 strongest contacts are drawn
    #[arg(long)]
    pub force_chains: bool,
    /// Leave out the nearer half of the walls in the picture
    #[arg(long)]
    pub cut: bool,
    /// Light text on dark paper: pictures and films, and a page at first [default of a page: as the system has it]
    #[arg(long)]
    pub dark: bool,
    /// Largest size of the page [MB]: a larger page loses the components of vectors, then frames at even intervals; if it is still too large, it is refused [default: 60]
    #[arg(long, value_name = "MB", value_parser = formats::megabytes)]
    pub max_mb: Option<f64>,
    /// Keep the components of vectors in a page that is too large, and leave out more frames
    #[arg(long)]
    pub components: bool,
    /// Title of the page [default: the inputs' names]
    #[arg(long)]
    pub title: Option<String>,
    /// Write a page in which you draw regions over one cloud; it gives the --keep and --remove options for cloud-crop
    #[arg(long)]
    pub pick: bool,
    /// The scene among the inputs.
    #[arg(skip)]
    pub planned: Option<Planned>,
}

impl Args {
    /// Refuses options that change nothing in this kind of output.
    pub fn check(&self, format: Format) -> anyhow::Result<()> {
        use Format::{Gif, Html, Mp4, Png, Pvd, Vtp};
        let options: [(&str, bool, &[Format]); 22] = [
            ("--pick", self.pick, &[Html]),
            ("--title", self.title.is_some(), &[Html]),
            ("--max-mb", self.max_mb.is_some(), &[Html]),
            ("--components", self.components, &[Html]),
            ("--time", self.time.is_some(), &[Html, Png, Vtp]),
            ("--from", self.from.is_some(), &[Gif, Mp4, Pvd]),
            ("--to", self.to.is_some(), &[Gif, Mp4, Pvd]),
            ("--every", self.every.is_some(), &[Gif, Mp4, Pvd]),
            ("--fps", self.fps.is_some(), &[Gif, Mp4]),
            ("--colour", self.colour.is_some(), &[Html, Png, Gif, Mp4]),
            ("--walls-colour", self.walls_colour.is_some(), &[Html, Png, Gif, Mp4]),
            ("--hide", !self.hide.is_empty(), &[Html, Png, Gif, Mp4]),
            ("--range", self.range.is_some(), &[Html, Png, Gif, Mp4]),
            ("--map", self.map.is_some(), &[Html, Png, Gif, Mp4]),
            ("--camera", self.camera.is_some(), &[Html, Png, Gif, Mp4]),
            ("--size", self.size.is_some(), &[Png, Gif, Mp4]),
            ("--wall-opacity", self.wall_opacity.is_some(), &[Png, Gif, Mp4]),
            ("--cut", self.cut, &[Png, Gif, Mp4]),
            ("--bonds", self.bonds, &[Html, Png, Gif, Mp4]),
            ("--vectors", self.vectors.is_some(), &[Html, Png, Gif, Mp4]),
            ("--force-chains", self.force_chains, &[Html, Png, Gif, Mp4]),
            ("--dark", self.dark, &[Html, Png, Gif, Mp4]),
        ];
        let foreign = options.iter().find(|(_, given, formats)| *given && !formats.contains(&format));
        let Some((name, _, formats)) = foreign else { return self.check_content() };
        let endings: Vec<String> = formats.iter().map(|f| format!(".{}", f.ending())).collect();
        let (wanted, cure) = (endings.join(", "), format.instead_of(name));
        Err(cli::usage(format!("{name} changes nothing in .{}: it is for {wanted}: {cure}", format.ending())))
    }

    /// Refuses options that change nothing in what is shown.
    fn check_content(&self) -> anyhow::Result<()> {
        let of_runs = [
            ("--bonds", self.bonds),
            ("--vectors", self.vectors.is_some()),
            ("--force-chains", self.force_chains),
            ("--walls-colour", self.walls_colour.is_some()),
        ];
        if self.walls_log
            && let Some([lo, _]) = self.walls_range.filter(|[lo, _]| *lo <= 0.0)
        {
            return Err(cli::usage(format!(
                "--walls-range: {lo} has no logarithm: give a lower end above 0, or leave --walls-log out"
            )));
        }
        if let Some((name, _)) = of_runs.iter().find(|(_, given)| *given && self.pick) {
            return Err(cli::usage(format!("{name}: a cloud has none: leave it out")));
        }
        let beside = [
            ("--bonds", self.bonds),
            ("--vectors", self.vectors.is_some()),
            ("--colour", self.colour.is_some()),
        ];
        if let Some((name, _)) = beside.iter().find(|(_, given)| *given && self.force_chains) {
            return Err(cli::usage(format!(
                "{name}: --force-chains draws grains faint, and contacts alone: leave one of them out"
            )));
        }
        let others = [
            ("--bonds", self.bonds),
            ("--vectors", self.vectors.is_some()),
            ("--force-chains", self.force_chains),
            ("--pick", self.pick),
        ];
        if let Some((name, _)) = others.iter().find(|(_, given)| *given && !self.only.is_empty()) {
            return Err(cli::usage(format!(
                "--only: chooses grains, and not what {name} shows: leave one of them out"
            )));
        }
        let unscaled = match self.colour.as_deref() {
            Some("size") => "size has classes, not a scale: leave it out, or give --colour radius",
            Some("material") => "material has kinds, not a scale: leave it out, or give another --colour",
            Some("rgb") => "rgb are colours, not a scale: leave it out, or give another --colour",
            _ => return Ok(()),
        };
        match self.range {
            Some(_) => Err(cli::usage(format!("--range: {unscaled}"))),
            None => Ok(()),
        }
    }

    /// An option about colours that is given.
    pub fn of_colour(&self) -> Option<&'static str> {
        let all = [
            ("--colour", self.colour.is_some()),
            ("--range", self.range.is_some()),
            ("--map", self.map.is_some()),
        ];
        all.iter().find(|(_, given)| *given).map(|(name, _)| *name)
    }

    /// Options of a picture that change nothing in some scenes (no wall is in front, colours of kinds), each with the picture without it.
    pub fn doubtful(&self, options: &PictureOptions) -> Vec<(&'static str, PictureOptions)> {
        let plain = PictureOptions::default();
        let all = [
            ("--cut", self.cut, PictureOptions { cut: false, ..options.clone() }),
            (
                "--wall-opacity",
                self.wall_opacity.is_some_and(|given| given != plain.wall_opacity),
                PictureOptions {
                    wall_opacity: plain.wall_opacity,
                    coloured_opacity: plain.coloured_opacity,
                    ..options.clone()
                },
            ),
            (
                "--map",
                self.map.is_some_and(|given| given != self.plain_map()),
                PictureOptions { map: self.plain_map(), ..options.clone() },
            ),
            ("--range", self.range.is_some(), PictureOptions { range: None, ..options.clone() }),
        ];
        all.into_iter().filter(|(_, given, _)| *given).map(|(name, _, without)| (name, without)).collect()
    }

    /// Warns of a picture in which hardly more than text can be seen; `subject`: longer side of what is shown [pixel].
    pub fn warn_of_size(&self, subject: u32, [width, height]: [u32; 2]) {
        if subject >= SMALL {
            return;
        }
        let nearer = if self.camera.is_some() { ", or a nearer --camera" } else { "" };
        cli::warn(&format!(
            "what is shown is only {subject} pixels large in a picture of {width} x {height}, beside its text: give a \
             larger --size, such as 320x180{nearer}"
        ));
    }

    /// The colour map.
    pub fn map(&self) -> Map {
        self.map.unwrap_or(self.plain_map())
    }

    /// The colour map where none is given: on light paper, weak forces are pale.
    fn plain_map(&self) -> Map {
        if self.force_chains && !self.dark { Map::Heat } else { Map::Viridis }
    }

    /// Where the camera is.
    pub fn camera(&self) -> Camera {
        self.camera.unwrap_or_default()
    }

    /// Pictures per second of a film.
    pub fn fps(&self) -> u32 {
        self.fps.unwrap_or(25)
    }

    /// Largest size of a page [MB].
    pub fn max_mb(&self) -> f64 {
        self.max_mb.unwrap_or(60.0)
    }

    /// What is shown of a run besides grains and walls.
    pub fn extras(&self) -> Extras {
        let asked = |name: &str| {
            self.colour.as_deref() == Some(name) || self.only.iter().any(|only| only.field == name)
        };
        let history = asked("residence") || asked("origin");
        let broken = self.bonds || self.colour.as_deref() == Some("broken");
        Extras {
            bonds: self.bonds,
            broken,
            arrows: self.vectors,
            chains: self.force_chains,
            history,
            wear: self.walls_colour,
        }
    }

    /// What is not drawn.
    pub fn hidden(&self) -> Hidden {
        Hidden(self.hide.clone())
    }

    /// What walls are coloured by.
    pub fn walls(&self) -> Option<WallScale> {
        let field = self.walls_colour?;
        Some(WallScale { field, range: self.walls_range, log: self.walls_log })
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
            camera: self.camera(),
            colour: self.colour.clone(),
            map: self.map(),
            range: self.range,
            time: None,
            wall_opacity: self.wall_opacity.unwrap_or(PictureOptions::default().wall_opacity),
            coloured_opacity: self.wall_opacity.unwrap_or(PictureOptions::default().coloured_opacity),
            cut: self.cut,
            dark: self.dark,
            hidden: self.hidden(),
            walls_end: None,
            walls: self.walls(),
            surface_values: Vec::new(),
        }
    }
}

//! Reads what is to be shown: runs and walls (MCAP), and clouds, detected by their content.

use crate::args::Args;
use crate::colours;
use ::cloud::Cloud;
use ::cloud::points::ReadWarning;
use anyhow::Context;
use cli::Source;
use record::Ending;
use serde_json::{Value, json};
use std::io::{Cursor, Read};
use stream::{
    Table, Values,
    mcap::{Event, Reader},
    ply::Opened,
};
use view::{Chosen, LayerHead, Motion, Role, Show, SurfaceShape, WallSurface};

/// The bytes that every MCAP stream begins with.
const MCAP: &[u8] = b"\x89MCAP";

/// The name without its folder.
pub fn short_name(source: &Source) -> String {
    let file = source.path().and_then(|path| path.file_name());
    file.map_or_else(|| source.to_string(), |name| name.to_string_lossy().into_owned())
}

/// Reads every input into `show`; gives what was found, for the report.
pub fn read_all(args: &Args, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    read_watched(args, show, &mut |_, _| ())
}

/// The same; `watch` also sees each event of a run, with the name of the run.
pub fn read_watched(
    args: &Args,
    show: &mut impl Show,
    watch: &mut dyn FnMut(&str, &Event),
) -> anyhow::Result<Vec<Value>> {
    let mut found = Vec::new();
    let mut chosen = Chosen::new(args.only.clone(), show);
    let (mut scaled, mut runs) = (false, false);
    if let Some(planned) = &args.planned {
        found.extend(planned.show(&mut chosen)?);
    }
    for source in args.inputs.iter().filter(|_| args.planned.is_none()) {
        let mut from = source.open()?;
        let mut head = Vec::new();
        from.by_ref()
            .take(MCAP.len() as u64)
            .read_to_end(&mut head)
            .with_context(|| format!("{source}: cannot read"))?;
        let is_mcap = head == MCAP;
        let whole = Cursor::new(head).chain(from);
        let name = short_name(source);
        if is_mcap && args.pick {
            anyhow::bail!(
                "{source}: --pick needs a cloud that cloud-crop can read, and this is MCAP (a run or walls): leave --pick out"
            );
        }
        let layers = match is_mcap {
            true => {
                if args.walls_colour.is_some() && runs {
                    return Err(cli::usage(format!(
                        "--walls-colour: {source} is a second run (MCAP), and walls that both have would need two colours: give one run"
                    )));
                }
                runs = true;
                run(whole, source, args, &mut chosen, watch)
            }
            false => {
                scaled = true;
                cloud(whole, &name, args, &mut chosen)
            }
        };
        found.extend(layers.with_context(|| source.to_string())?);
    }
    if let Some(option) = ["--bonds", "--vectors", "--force-chains", "--walls-colour"]
        .into_iter()
        .zip([args.bonds, args.vectors.is_some(), args.force_chains, args.walls_colour.is_some()])
        .find(|(_, on)| *on && !runs)
    {
        return Err(cli::usage(format!("{}: no input is a run (MCAP): leave it out", option.0)));
    }
    if !scaled && args.lengths.factor().is_some() {
        return Err(cli::usage("--scale, --units: runs and walls (MCAP) are in metres: leave it out"));
    }
    if !scaled {
        args.columns.none("no input is a cloud of text")?;
        args.placing.none("runs and walls (MCAP) are not moved, clouds and meshes are")?;
    }
    if args.planned.is_none()
        && found.iter().all(|input| input.get("triangles").is_some())
        && let Some(option) = args.of_colour()
    {
        return Err(cli::usage(format!("{option}: meshes have no field to colour by: leave it out")));
    }
    chosen.check(&args.hidden())?;
    if !args.only.is_empty() {
        match chosen.counts() {
            [_, 0] => return Err(cli::usage("--only: no input has grains: leave it out")),
            [0, _] => anyhow::bail!("--only: no grain has such a value: give another range"),
            [shown, all] if shown == all => cli::warn("--only changes nothing: all grains have such a value"),
            _ => {}
        }
    }
    Ok(found)
}

/// A run, or walls, as far as they were written.
fn run(
    from: impl Read,
    source: &Source,
    args: &Args,
    show: &mut impl Show,
    watch: &mut dyn FnMut(&str, &Event),
) -> anyhow::Result<Vec<Value>> {
    let name = short_name(source);
    let events = Reader::new(from).map_while(|event| source.as_far_as_it_goes(event).transpose());
    let mut ending = Ending::default();
    let events = events.inspect(|event| {
        if let Ok(event) = event {
            ending.take(event);
            watch(&name, event);
        }
    });
    let messages = view::show_run(events, &name, args.extras(), show)?;
    ending.warning().iter().for_each(|warning| cli::warn(&format!("{source}: {warning}")));
    Ok(messages.iter().map(|(t, n)| json!({ "input": name, "topic": t, "messages": n })).collect())
}

/// A mesh, or a cloud: its points are grains when they have a radius and an id, and wall spheres when they have a radius only.
fn cloud(from: impl Read, name: &str, args: &Args, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let cannot = || format!("{name}: cannot read");
    let factor = args.lengths.factor().unwrap_or(1.0);
    let cloud = match Opened::new(from).with_context(cannot)? {
        // A plain cloud: its bytes are never all in memory.
        Opened::Blocks(blocks) => ::cloud::formats::go_on_as(Opened::Blocks(blocks), args.columns.given())?,
        Opened::Other(mut bytes, mut from) => {
            // Bytes of an unknown format may come from an endless stream.
            if ::cloud::formats::name_of(&bytes).is_some() {
                stream::whole::rest(&mut from, &mut bytes).with_context(cannot)?;
            }
            let is_mesh = !args.pick && args.columns.given().is_none();
            if is_mesh && (has_faces(&bytes) || mesh::is_drawing(&bytes).is_some()) {
                return drawing(&bytes, name, args, show);
            }
            ::cloud::formats::from_bytes_as(bytes, args.columns.given())?
        }
    };
    let is_scaled = args.lengths.factor().is_some() || args.placing.scales();
    let is_answered = |w: &ReadWarning| is_scaled && w.is_answered_by_scale();
    for warning in cloud.warnings.iter().filter(|w| !is_answered(w)) {
        cli::warn(&format!("{name}: {warning}"));
    }
    let (mut cloud, dropped) = cloud.finite();
    if factor != 1.0 {
        cloud.scale(factor);
    }
    cloud_cli::place(&mut cloud, &args.placing, name);
    if dropped > 0 {
        let dropped = geom::counted(dropped, "point");
        cli::warn(&format!("{name}: the picture leaves out {dropped} without finite coordinates"));
    }
    let mut table = table(cloud, args.pick)?;
    colours::to_bytes(&mut table);
    let has = |column| table.get(column).is_some();
    let role = match (has("radius"), has("id")) {
        (true, true) => Role::Grains,
        (true, false) => Role::Walls,
        (false, _) => Role::Cloud,
    };
    let points = table.rows();
    let layer = show.layer(LayerHead::new(role, name));
    show.push(layer, 0.0, table)?;
    Ok(vec![json!({ "input": name, "points": points })])
}

/// A cloud as a table, in the type its coordinates came in; `pick`: marks of cloud-crop as a page takes them.
fn table(mut cloud: Cloud, pick: bool) -> anyhow::Result<Table> {
    let marks = if pick { ::cloud::crop::marks(&cloud) } else { None };
    let points = std::mem::take(&mut cloud.points);
    let mut table = Table::with_rows(points.len());
    for (k, column) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(
            column,
            match cloud.double {
                true => Values::F64(points.iter().map(|p| p[k]).collect()),
                false => Values::F32(points.iter().map(|p| p[k] as f32).collect()),
            },
        )?;
    }
    // Millions of points are held once, and so are their columns.
    drop(points);
    for (name, values) in cloud.attributes.into_columns() {
        let is_mark = pick && name == ::cloud::crop::MARK;
        let values = match &marks {
            _ if !is_mark => values,
            // A page takes bytes for marks: cloud-crop says what is one.
            Some(marks) => Values::U8(marks.clone()),
            None => Values::F64(values.to_f64()),
        };
        table.push(&name, values)?;
    }
    Ok(table)
}

/// Whether this is a PLY file with faces in it.
fn has_faces(bytes: &[u8]) -> bool {
    let head = bytes.split(|b| *b == b'\n').take_while(|line| !line.starts_with(b"end_header"));
    let mut counts = head.take(1000).filter_map(|line| line.strip_prefix(b"element face "));
    bytes.starts_with(b"ply") && counts.any(|count| count.iter().any(|digit| (b'1'..=b'9').contains(digit)))
}

/// A mesh of triangles, at rest.
fn drawing(bytes: &[u8], name: &str, args: &Args, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mesh = cli::read_mesh(bytes, name, &args.lengths, &args.placing)?;
    let faces = mesh.faces.len();
    let (shape, motion) = (SurfaceShape::Mesh(mesh), Motion::default());
    show.surface(WallSurface { name: name.to_owned(), shape, motion });
    Ok(vec![json!({ "input": name, "triangles": faces })])
}

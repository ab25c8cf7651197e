//! A scene cut in two at a plane: the stage upstream records, the stage downstream lets in.
//!
//! The text of the scene is edited, so that comments stay. [`split`] removes what the stage does not need: sources and zones by the side
//! on which they lie ([`sides`], [`sources`]); a wall only if it is at rest, has an end, and lies more than half the largest diameter beyond the cut
//! ([`walls`]). It adds the zone of the cut, and marks it with a hash of all that
//! the flow through the cut depends on ([`mark`]), so that a record of another plant is refused. [`cutting`] holds the scene and the cut.

mod cut;
mod cutting;
mod mark;
mod sides;
mod sources;
mod walls;

pub use cut::{Cut, Stage};

use cutting::{Cutting, StageText};
use dem::setup::ZoneTest;
use scene::{Result, Scene, SceneError, Text};
use sources::largest;
use toml_edit::{Item, value};

/// Cuts a scene; the text of the stage, with the comments of what it keeps, and what was left out.
///
/// # Errors
/// Particles on both sides of the plane, a length that is too short, files that cannot be read.
pub fn split(scene: &Scene, cut: &Cut) -> Result<(String, Vec<String>)> {
    let unfit = cut.test == ZoneTest::Lowest;
    if let Some(clump) = scene.keys.clump.first().filter(|_| unfit) {
        let why = format!("has clumps ('{}'): of them only centres are tested", clump.name);
        let cure = "use --test centre";
        return Err(SceneError::file(&scene.text.name, why, cure));
    }
    let (text, gone) = stage(scene, cut)?;
    // Both stages carry the mark of the one upstream: a record of another one is refused.
    let upstream = Cut { keep: Stage::Upstream, folder: scene.folder.clone(), ..cut.clone() };
    let before = Scene::new(&scene.text.name, stage(scene, &upstream)?.0, &[], &scene.folder)?;
    let plant = Cutting { scene: &before, cut: &upstream, largest: largest(&before)? }.mark()?;
    let mut document = Text::new(&scene.text.name, text).document()?;
    let kind = cut.keep.zone();
    let tables = document.get_mut(kind).and_then(Item::as_array_of_tables_mut);
    if let Some(zone) = tables.and_then(|t| t.iter_mut().last()) {
        zone.insert("plant", value(plant));
    }
    Ok((document.to_string(), gone))
}

/// The scene of one stage, but for its mark.
fn stage(scene: &Scene, cut: &Cut) -> Result<(String, Vec<String>)> {
    let cutting = Cutting { scene, cut, largest: largest(scene)? };
    cutting.check_length()?;
    cutting.check_periodic()?;
    cutting.check_whole()?;
    let mut text = StageText::new(scene.text.document()?);
    cutting.sources(&mut text)?;
    cutting.zones(&mut text)?;
    if !text.upstream {
        let why = "no grains start upstream of the plane: its normal must point in the direction of flow";
        return Err(cutting.wrong(why, "reverse the normal, or move the plane"));
    }
    cutting.clear_of_walls()?;
    cutting.walls(&mut text);
    scene::text::rebase(&mut text.document, &scene.folder, &cut.folder);
    cutting.add_zone(&mut text.document)?;
    Ok(text.done())
}

#[cfg(test)]
mod tests {
    use super::*;
    use dem::setup::ZoneMotion;
    use std::path::Path;

    const PLANT: &str = r#"# plant
gravity = [0, 0, -9.81]
[time]
until = 1
[[material]]
name = "m" # grain
density = 1000
young = 1e6
poisson = 0.2
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[fill]] # above
material = "m"
shape = "box:0,0,1,1,1,2"
diameter = 0.1
count = 5
[[fill]]
material = "m"
shape = "box:0,0,-2,1,1,-1"
diameter = 0.1
count = 5
[[wall]]
plane = "0,0,-3,0,0,1"
material = "m"
"#;

    fn cut(keep: Stage, at: &str, length: Option<f64>) -> Result<(String, Vec<String>)> {
        let scene = Scene::new("p.toml", PLANT.into(), &[], Path::new("")).unwrap();
        split(&scene, &Cut { length, ..at_plane(keep, at, Path::new("")) })
    }

    fn at_plane(keep: Stage, at: &str, folder: &Path) -> Cut {
        let (motion, test) = (ZoneMotion::Constant, ZoneTest::Centre);
        Cut { plane: at.parse().unwrap(), keep, length: None, motion, test, folder: folder.to_owned() }
    }

    #[test]
    fn both_stages_are_scenes_and_have_their_own_particles() {
        let (up, gone) = cut(Stage::Upstream, "0,0,0,0,0,-1", None).unwrap();
        assert_eq!(gone, ["fill.1"]);
        let scene = Scene::new("up", up.clone(), &[], Path::new("")).unwrap();
        assert_eq!((scene.keys.fill.len(), scene.keys.outlet.len(), scene.keys.inlet.len()), (1, 1, 0));
        assert!(up.contains("# grain") && up.contains("# above") && up.starts_with("# plant"), "{up}");
        let (down, gone) = cut(Stage::Downstream, "0,0,0,0,0,-1", Some(0.2)).unwrap();
        assert_eq!(gone, ["fill.0"]);
        let scene = Scene::new("down", down, &[], Path::new("")).unwrap();
        assert_eq!((scene.keys.fill[0].shape.0.as_str(), scene.keys.inlet.len()), ("box:0,0,-2,1,1,-1", 1));
        assert_eq!(scene.keys.first_id, 2_000_000_000);
    }

    #[test]
    fn a_cut_through_particles_or_a_short_zone_is_refused() {
        let message = cut(Stage::Upstream, "0,0,1.5,0,0,-1", None).unwrap_err().to_string();
        assert!(message.contains("fill.0 lies on both sides"), "{message}");
        let message = cut(Stage::Upstream, "0,0,0,0,0,-1", Some(0.1)).unwrap_err().to_string();
        assert!(message.contains("--length 0.1 m is not above the largest diameter, 0.1 m"), "{message}");
    }

    #[test]
    fn what_is_left_out_is_named_in_the_order_of_the_scene() {
        let folder = std::env::temp_dir().join(format!("split-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
            property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
            0 0 -2\n1 0 -2\n0 1 -2\n3 0 1 2\n";
        std::fs::write(folder.join("a.ply"), ply).unwrap();
        let wall = |name: &str| format!("[[wall]]\n{name}mesh = \"a.ply\"\nmaterial = \"m\"\n");
        let walls = [wall("name = \"chute\"\n"), wall(""), wall("name = \"lip\"\n")].concat();
        let scene = Scene::new("p.toml", format!("{PLANT}{walls}"), &[], &folder).unwrap();
        let (_, gone) = split(&scene, &at_plane(Stage::Upstream, "0,0,0,0,0,-1", &folder)).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(gone, ["fill.1", "wall 'chute'", "wall.2", "wall 'lip'"]);
    }

    #[test]
    fn what_only_the_whole_plant_can_follow_is_refused() {
        for (set, why) in [
            ("time.until_unbalanced=1e-3", "ends the plant when all its grains rest"),
            (
                "domain={ periodic = [\"x\"], low = [0,0,0], high = [9,9,9], strain = { x = { rate = 1 } } }",
                "strained",
            ),
        ] {
            let scene = Scene::new("p.toml", PLANT.to_owned(), &[set.to_owned()], Path::new("")).unwrap();
            let cut = at_plane(Stage::Upstream, "0,0,0,0,0,-1", Path::new(""));
            let message = split(&scene, &cut).unwrap_err().to_string();
            assert!(message.contains(why), "{message}");
        }
    }

    #[test]
    fn a_plane_that_looks_the_wrong_way_is_refused() {
        for keep in [Stage::Upstream, Stage::Downstream] {
            let message = cut(keep, "0,0,5,0,0,-1", None).unwrap_err().to_string();
            assert!(message.contains("its normal must point in the direction of flow"), "{message}");
        }
    }
}

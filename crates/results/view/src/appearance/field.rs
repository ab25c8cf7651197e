//! The fields of a table: what its spheres can be coloured by, under which name and in which unit.

use record::column::{BODY, ID};
use stream::{Table, table::Values};

/// Three columns whose length is a separate field.
const VECTORS: [([&str; 3], &str); 3] =
    [(["vx", "vy", "vz"], "speed"), (["wx", "wy", "wz"], "spin"), (["fx", "fy", "fz"], "force")];

/// The field of size classes: diameters [m].
pub const SIZE: &str = "size";

/// Whether the column is one component of a position or of a vector that is shown by its length.
fn is_component(table: &Table, name: &str) -> bool {
    ["x", "y", "z"].contains(&name)
        || VECTORS.iter().any(|(of, _)| of.contains(&name) && of.iter().all(|c| table.get(c).is_some()))
}

/// The field that is the length of the vector of which `name` is a component.
pub fn length_of(name: &str) -> Option<&'static str> {
    VECTORS.iter().find(|(of, _)| of.contains(&name)).map(|(_, length)| *length)
}

/// Names of the fields, lengths of vectors first; components of vectors only when `components`.
pub fn names(table: &Table, components: bool) -> Vec<String> {
    let whole = |of: &[&str; 3]| of.iter().all(|c| table.get(c).is_some());
    let lengths = VECTORS.iter().filter(|(of, name)| whole(of) && table.get(name).is_none());
    let mut names: Vec<String> = lengths.map(|(_, name)| (*name).to_owned()).collect();
    let shown = |name: &str| match name {
        "x" | "y" | "z" => false,
        _ => components || !is_component(table, name),
    };
    names.extend(table.columns().iter().map(|c| c.name.clone()).filter(|n| shown(n)));
    names
}

/// All names that a person may give, for messages.
pub fn known(table: &Table) -> Vec<String> {
    names(table, true).into_iter().chain(["x", "y", "z"].map(str::to_owned)).collect()
}

/// One value a row, or none when the table has no such field.
pub fn values(table: &Table, name: &str) -> Option<Vec<f64>> {
    if let Some(column) = table.get(name) {
        return Some(column.to_f64());
    }
    if name == SIZE {
        return table.get("radius").map(|r| r.to_f64().into_iter().map(|r| 2.0 * r).collect());
    }
    let (of, _) = VECTORS.iter().find(|(_, length)| *length == name)?;
    let [a, b, c] = [table.get(of[0])?, table.get(of[1])?, table.get(of[2])?];
    let length = |i| (a.get(i).powi(2) + b.get(i).powi(2) + c.get(i).powi(2)).sqrt();
    Some((0..table.rows()).map(length).collect())
}

/// Columns that show where and how large things are, in their own colours or by the field `asked`; none when the
/// table does not have that field.
pub fn columns(table: &Table, asked: Option<&str>) -> Option<Vec<String>> {
    let mut columns = vec!["x", "y", "z", "radius", "red", "green", "blue"];
    if table.get(BODY).is_some() {
        columns.extend([ID, BODY]); // clumps are drawn and counted as bodies
    }
    let default = default_of(table);
    let name = asked.unwrap_or(&default);
    if let Some(column) = table.columns().iter().find(|c| c.name == name) {
        columns.push(&column.name);
    } else if name != "rgb" && !(name == SIZE && table.get("radius").is_some()) {
        let (of, _) = VECTORS.iter().find(|(_, length)| *length == name)?;
        columns.extend(of.iter().map(|c| table.get(c).map(|_| *c)).collect::<Option<Vec<_>>>()?);
    }
    Some(columns.into_iter().map(str::to_owned).collect())
}

/// Whether the field holds whole numbers only.
pub fn is_whole(table: &Table, name: &str) -> bool {
    table.get(name).is_some_and(|v| !matches!(v, Values::F32(_) | Values::F64(_)))
}

/// Whether the whole numbers of a field are names: neighbouring ones have nothing in common, so each has a separate colour.
pub fn names_things(name: &str) -> bool {
    ["id", "body", "cluster", "class", "material", "wall", "region", "removed", "origin", "classification"]
        .contains(&name)
}

/// What the numbers of `removed` mean, as `cloud-crop --mark` writes them.
const REMOVED: [&str; 10] = [
    "0 stays",
    "1 shape",
    "2 beyond the outer shape",
    "3 outlier",
    "4 grazing",
    "5 ground",
    "6 scattered",
    "7 smaller part",
    "8 repeated",
    "9 by its properties",
];

/// What the numbers of `classification` mean: ASPRS (2019), LAS Specification 1.4 R15, table 17.
const CLASSIFICATION: [&str; 19] = [
    "0 never classified",
    "1 unclassified",
    "2 ground",
    "3 low vegetation",
    "4 medium vegetation",
    "5 high vegetation",
    "6 building",
    "7 low noise",
    "8 reserved",
    "9 water",
    "10 rail",
    "11 road surface",
    "12 reserved",
    "13 wire guard",
    "14 wire conductor",
    "15 tower",
    "16 wire connector",
    "17 bridge deck",
    "18 high noise",
];

/// What the numbers of a field mean; `materials` are those of `material`.
pub fn codes(name: &str, materials: &[String]) -> Vec<String> {
    match name {
        "material" => materials.to_vec(),
        "origin" => ["there at the start", "came in later"].map(str::to_owned).to_vec(),
        "classification" => CLASSIFICATION.map(str::to_owned).to_vec(),
        "removed" => REMOVED.map(str::to_owned).to_vec(),
        _ => Vec::new(),
    }
}

/// The field a person means by another name for it.
pub fn canonical(name: &str) -> &str {
    match name {
        "velocity" | "v" => "speed",
        "height" => "z",
        "omega" | "w" => "spin",
        other => other,
    }
}

/// Unit of a field [SI], empty for a pure number.
pub fn unit(name: &str) -> &'static str {
    match name {
        "x" | "y" | "z" | "radius" | "diameter" | SIZE | "roughness" | "overlap" => "m",
        "vx" | "vy" | "vz" | "speed" => "m/s",
        "wx" | "wy" | "wz" | "spin" => "rad/s",
        "fx" | "fy" | "fz" | "force" => "N",
        "stress" | "pressure" => "Pa",
        "mass" => "kg",
        "time" | "residence" => "s",
        "energy" => "J",
        _ => "",
    }
}

/// The default field: speed, else height.
pub fn default_of(table: &Table) -> String {
    let has_speed = names(table, false).iter().any(|n| n == "speed");
    if has_speed { "speed" } else { "z" }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving() -> Table {
        let mut table = Table::default();
        for name in ["x", "y", "z", "vx", "vy", "vz"] {
            table.push(name, Values::F64(vec![2.0])).expect("fits");
        }
        table.push("id", Values::U32(vec![7])).expect("fits");
        table
    }

    #[test]
    fn speed_is_the_length_of_the_velocity() {
        assert_eq!(names(&moving(), false), ["speed", "id"]);
        assert_eq!(values(&moving(), "speed"), Some(vec![12f64.sqrt()]));
        assert_eq!(default_of(&moving()), "speed");
    }

    #[test]
    fn components_are_fields_when_asked_for() {
        assert_eq!(names(&moving(), true), ["speed", "vx", "vy", "vz", "id"]);
        assert!(is_whole(&moving(), "id") && !is_whole(&moving(), "vx"));
    }
}

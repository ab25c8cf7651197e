//! Particles as text: names on the first line, then a line of numbers for each particle.

use crate::error::{Result, SceneError};
use stream::{MOST_COLUMNS, Table, Values};

/// Name of a first column without one: data frames write their index there.
pub(super) const UNNAMED: &str = "(unnamed)";

/// A table of text: names on the first line, commas, semicolons, tabs or blanks between, `#` starts a comment. Names and numbers may stand in quotes. Nothing
/// between two commas, semicolons or tabs is no value, NaN in the columns that `may_lack` it.
///
/// # Errors
/// Other text, and no value in another column, with line and column.
pub(super) fn csv(name: &str, bytes: &[u8], may_lack: impl Fn(&str) -> bool) -> Result<Table> {
    let wrong = |why: String| {
        SceneError::file(name, why, "wanted: a line of names such as id,x,y,z,radius, then numbers")
    };
    // Spreadsheets mark UTF-8 with three bytes in front.
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
    let text = text.map_err(|e| wrong(format!("byte {}: is not text, PLY or MCAP", e.valid_up_to())))?;
    let lines = text.lines().enumerate().map(|(n, l)| (n + 1, l.split('#').next().unwrap_or("")));
    let mut lines = lines.filter(|(_, l)| !l.trim().is_empty());
    let Some((first, head)) = lines.next() else { return Err(wrong("is empty".into())) };
    let by_tabs = head.contains('\t');
    let mut names = fields(head, by_tabs);
    // Tabs that align names are one separator, and a separator at the end separates nothing.
    let inner = 1..names.len().saturating_sub(1);
    if by_tabs && names.get(inner).is_some_and(|inner| inner.contains(&"")) {
        names.retain(|name| !name.is_empty());
    }
    let is_open = names.len() > 1 && names.last().is_some_and(|name| name.is_empty());
    names.truncate(names.len() - usize::from(is_open));
    if names.first().is_none_or(|name| name.parse::<f64>().is_ok()) {
        return Err(wrong(format!("line {first}: begins without a name, the line of names is missing")));
    }
    if names.len() > MOST_COLUMNS {
        let count = names.len();
        return Err(wrong(format!("line {first}: {count} names are more than {MOST_COLUMNS} columns")));
    }
    if names[0].is_empty() {
        names[0] = UNNAMED;
    }
    if let Some(k) = names.iter().position(|name| name.is_empty()) {
        return Err(wrong(format!("line {first}: column {} has no name", k + 1)));
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for (n, line) in lines {
        let mut fields = fields(line, by_tabs);
        // Tabs that align columns are one separator.
        if by_tabs && fields.len() != names.len() {
            fields.retain(|field| !field.is_empty());
        }
        if fields.len() == names.len() + 1 && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop();
        }
        if fields.len() != names.len() {
            let (numbers, names) = (fields.len(), names.len());
            return Err(wrong(format!("line {n}: {numbers} numbers where there are {names} names")));
        }
        for (k, (column, field)) in columns.iter_mut().zip(&fields).enumerate() {
            let value = match (field.is_empty(), field.parse()) {
                (false, Ok(value)) => value,
                _ if may_lack(names[k]) => f64::NAN,
                (true, _) => {
                    let (at, column) = (k + 1, names[k]);
                    return Err(wrong(format!("line {n}: column {at} ('{column}') has no value")));
                }
                (false, Err(_)) => return Err(wrong(format!("line {n}: '{field}' is not a number"))),
            };
            column.push(value);
        }
    }
    let mut table = Table::default();
    for (column, values) in names.into_iter().zip(columns) {
        table.push(column, Values::F64(values)).map_err(|e| wrong(e.to_string()))?;
    }
    Ok(table)
}

/// The fields of a line without quotes: with a comma, a semicolon or (if `by_tabs`) a tab between them a field may be empty, unless blanks separate others.
fn fields(line: &str, by_tabs: bool) -> Vec<&str> {
    let bare = |field: &str| -> bool { field.starts_with('"') || !field.contains(char::is_whitespace) };
    let unquoted = |field| str::strip_prefix(field, '"').and_then(|f| f.strip_suffix('"')).unwrap_or(field);
    let one = [',', ';', '\t'].into_iter().find(|&c| line.contains(c) && (c != '\t' || by_tabs));
    let strict = one.map(|c| line.split(c).map(str::trim).collect::<Vec<_>>());
    let fields = strict.filter(|fields| fields.iter().all(|field| bare(field)));
    let between = |c: char| c == ',' || c == ';' || c.is_whitespace();
    let fields = fields.unwrap_or_else(|| line.split(between).filter(|field| !field.is_empty()).collect());
    fields.into_iter().map(unquoted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table> {
        csv("p.csv", text.as_bytes(), |column| ["note", UNNAMED].contains(&column))
    }

    #[test]
    fn a_cell_without_a_value_does_not_take_the_next_one() {
        for (text, part) in [
            ("x,y,z,vx\n1,2,3,\n", "line 2: column 4 ('vx') has no value"),
            ("x,y,z,vx,vy\n1,2,3,,-1\n", "line 2: column 4 ('vx') has no value"),
            ("x;y;z\n1;2;3\n1; ;3\n", "line 3: column 2 ('y') has no value"),
            ("x\ty\tz\n1\t\t3\n", "line 2: column 2 ('y') has no value"),
            ("x,y,z\n,2,3\n", "line 2: column 1 ('x') has no value"),
            ("x,y,z\n1,\"\",3\n", "line 2: column 2 ('y') has no value"),
            ("id,x,y,z,vx,\n0,1,2,3,,-1\n", "line 2: 6 numbers where there are 5 names"),
            ("x,,z\n1,2,3\n", "line 1: column 2 has no name"),
            ("# a pile\n\n1,2,3\n", "line 3: begins without a name"),
            ("x,y\n1,2,3\n", "line 2: 3 numbers where there are 2 names"),
            ("x,y\n1,b\n", "line 2: 'b' is not a number"),
        ] {
            let told = read(text).unwrap_err().to_string();
            assert!(told.contains(part), "{text}: {told}");
        }
    }

    #[test]
    fn values_keep_their_columns() {
        for text in [
            "x,y,z\n1,2,3\n",
            "x;y;z;\n1;2;3;\n",
            "x y z\n1 2 3\n",
            "x, y, z\n1, 2, 3\n",
            "x y z\n1,2,3\n",
            "x,y,z\n1 2 3\n",
            "x\ty\tz\n1\t2\t3\n",
            "x\ty\tz\n1\t\t2\t3\n",
            "\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n",
            "x,note,y,z\n1,,2,3\n",
            "x,note,y,z\n1,wall,2,3 # a remark\n",
            ",x,y,z\n0,1,2,3\n",
            "\tx\ty\tz\n0\t1\t2\t3\n",
        ] {
            let table = read(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let found = ["x", "y", "z"].map(|name| table.get(name).map(|values| values.get(0)));
            assert_eq!(found, [Some(1.0), Some(2.0), Some(3.0)], "{text}");
        }
    }
}

use super::*;

/// Names with units, and the cells of all rows.
fn read(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let sheet = Sheet::parse(text).unwrap_or_else(|e| panic!("{text}: line {}: {e}", e.line));
    let name = |c: &Column| match &c.unit {
        Some(unit) => format!("{} [{unit}]", c.name),
        None => c.name.clone(),
    };
    let numbers = |(_, cells): &Row| cells.iter().map(|c| c.parse().unwrap()).collect();
    (sheet.columns.iter().map(name).collect(), sheet.rows.iter().map(numbers).collect())
}

/// The same two columns, as numpy, YADE, GrainLearning, LAMMPS-like codes, spreadsheets of two languages and testing machines write them.
#[test]
fn the_same_curve_is_read_however_it_is_written() {
    let texts = [
        "strain [%],stress [kPa]\n0.5,12.25\n1,20\n",
        "\u{feff}strain (%), stress (kPa)\r\n0.5, 12.25\r\n1, 20\r\n",
        "# strain[%] stress[kPa]\n5.0e-01 1.225e+01\n1.0e+00 2.0e+01\n",
        "# strain [%] \t stress [kPa]\n0.5 12.25\n1 20\n",
        "# made by a code\n# strain [%]\t\tstress [kPa]\n0.5\t12.25\n1\t20\n",
        "# strain [%] stress [kPa]\n  0.5   12.25\n  1   20\n",
        "strain [%];stress [kPa]\n0,5;12,25\n1;20\n",
        "strain [%]\tstress [kPa]\n0,5\t12,25\n1\t20\n",
        "strain [%] stress [kPa]\n0,5 12,25\n1 20\n",
        "\"strain [%]\",\"stress [kPa]\"\n\"0.5\",\"12.25\"\n1,20\n",
        "strain;stress\n%;kPa\n0,5;12,25\n1;20\n",
        "strain\tstress\n[%]\t[kPa]\n0.5\t12.25\n1\t20\n",
        "# strain [%],stress [kPa]\n0.5,12.25\n1,20\n",
        "% strain [%] stress [kPa]\n0.5 12.25\n# a remark\n\n1 20\n",
    ];
    for text in texts {
        assert_eq!(
            read(text),
            (vec!["strain [%]".into(), "stress [kPa]".into()], vec![vec![0.5, 12.25], vec![1.0, 20.0]]),
            "{text}"
        );
    }
}

#[test]
fn names_may_have_blanks_and_units_may_too() {
    let (names, rows) = read("axial strain [%]\tdeviator stress [kN / m²]\n1\t2\n");
    assert_eq!(
        (names, rows),
        (vec!["axial strain [%]".into(), "deviator stress [kN / m²]".into()], vec![vec![1.0, 2.0]])
    );
    let (names, _) = read("# e_a [1 / s] q\n1 2\n");
    assert_eq!(names, ["e_a [1 / s]", "q"]);
    // Numbers of one column.
    assert_eq!(read("angle\n31,5\n32\n").1, [[31.5], [32.0]]);
    assert_eq!(read("angle\n31.5\n").1, [[31.5]]);
    // A header that begins with a number sign stays one, whatever stands above it.
    assert_eq!(read("# run 7\n# a b c\n1 2 3\n").0, ["a", "b", "c"]);
}

#[test]
fn what_is_not_certain_is_refused_with_line_and_cure() {
    let why = |text: &str| {
        let e = Sheet::parse(text).unwrap_err();
        format!("{}: {}", e.line, e.message)
    };
    assert!(why("").contains("is empty") && why("# only\n").contains("has comments only"));
    assert!(
        why("1,2\n3,4\n").starts_with("1: its first line has numbers: write a header"),
        "{}",
        why("1,2\n3,4\n")
    );
    assert!(why("x,y\n1,2,3\n").starts_with("2: 3 cells between commas, but the header has 2 columns"));
    assert!(
        why("x,y\n1,2\n2,3,4\n").starts_with("3: 3 cells between commas"),
        "{}",
        why("x,y\n1,2\n2,3,4\n")
    );
    let decimal = why("x,y\n0,1,2,5\n");
    assert!(
        decimal.contains("if these are decimal commas, separate the columns by ';' or tabs"),
        "{decimal}"
    );
    assert!(why("x;y\n1.000,5;2\n").starts_with("2: '1.000,5' has a point and a comma"));
    assert!(
        why("x;y\n0,5;2\n0.6;2\n")
            .starts_with("3: '0.6' has a decimal point, and other numbers have decimal commas")
    );
    assert!(
        why("# a curve\n1 2 3\n")
            .starts_with("1: the header 'a curve' and the rows differ: 2 names and 3 numbers between blanks"),
        "{}",
        why("# a curve\n1 2 3\n")
    );
    assert!(why("x,x\n1,2\n").starts_with("1: two columns are called 'x'"));
    // The cures, tried.
    read("x;y\n0,1;2,5\n");
    read("x;y\n1000,5;2\n");
    read("x;y\n0,5;2\n0,6;2\n");
}

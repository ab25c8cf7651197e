//! Values that an option or a key is given.

/// Fourteen texts for an option of a command line.
pub const OPTION: [&str; 14] = [
    "",
    "0",
    "-1",
    "nan",
    "inf",
    "1e308",
    "1e-308",
    "18446744073709551616",
    "x\u{1b}[31m\u{202e}",
    "0.5",
    "1,2",
    "0,0,0,0,0,0",
    "box:0,0,0,1,1,1",
    "/dev/zero",
];

/// Fourteen TOML values for a key of a scene.
pub const KEY: [&str; 14] = [
    "nan",
    "inf",
    "-1",
    "0",
    "0.5",
    "1e308",
    "1e-308",
    "18446744073709551616",
    "\"\"",
    "\"x\\u001b[31m\"",
    "true",
    "[]",
    "[0, 0, 0]",
    "{}",
];

/// Texts that replace a word of a text file.
pub const WORD: [&str; 16] = [
    "",
    "0",
    "-1",
    "nan",
    "-inf",
    "1e308",
    "-1e308",
    "1e-308",
    "1e999",
    "4294967295",
    "18446744073709551616",
    "2147483648",
    "[",
    "\"",
    "\u{1b}]0;x\u{7}",
    "vertex",
];

/// Numbers that replace bytes of a binary file, little-endian.
pub fn bytes() -> Vec<Vec<u8>> {
    let doubles = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e308, 5e-324].map(|v| v.to_le_bytes().to_vec());
    let floats = [f32::NAN, f32::INFINITY, -1.0, 1e38].map(|v| v.to_le_bytes().to_vec());
    let words = [0, 1, u32::MAX, 1 << 31].map(|v: u32| v.to_le_bytes().to_vec());
    let long = [0, u64::MAX, 1 << 40].map(|v: u64| v.to_le_bytes().to_vec());
    let short = [0, u16::MAX].map(|v: u16| v.to_le_bytes().to_vec());
    let single = [0, 1, 0x7f, 0xff].map(|v: u8| vec![v]);
    doubles.into_iter().chain(floats).chain(words).chain(long).chain(short).chain(single).collect()
}

//! Coordinate reference systems of LAS.

use las::Header;

/// Longest name of a coordinate reference system that a comment holds [B].
const LONGEST: usize = 8192;
/// Mark of longitude and latitude in the keys of GeoTIFF.
const GEOGRAPHIC: u16 = 2;
/// Key of a geographic system.
const DEGREES: u16 = 2048;
/// Key of a projected system, and that of its unit of length.
const PROJECTED: u16 = 3072;
const LENGTHS: u16 = 3076;
/// Largest longitude and latitude [°].
const LARGEST: [f64; 2] = [360.0, 90.0];

/// The coordinate reference system: its EPSG code, or its well-known text.
pub(crate) fn reference_system(header: &Header) -> Option<String> {
    let geotiff = || {
        let keys = header.get_geotiff_crs().ok()??;
        let codes = [keys.get_projected_crs_geo_key_value(), keys.get_geodetic_crs_geo_key_value()];
        // Codes from 32 767 on are of the user.
        codes.into_iter().flatten().find(|code| (1..32_767).contains(code))
    };
    let text = || {
        let text = String::from_utf8_lossy(header.get_wkt_crs_bytes()?);
        let words: Vec<&str> =
            text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|w| !w.is_empty()).collect();
        Some(words.join(" ")).filter(|text| !text.is_empty() && text.len() <= LONGEST)
    };
    text().or_else(|| geotiff().map(|code| format!("EPSG:{code}")))
}

/// Whether all points may be longitude and latitude.
fn is_on_the_globe(header: &Header) -> bool {
    let (low, high) = (header.bounds().min, header.bounds().max);
    let most = |low: f64, high: f64| low.abs().max(high.abs());
    most(low.x, high.x) <= LARGEST[0] && most(low.y, high.y) <= LARGEST[1]
}

/// Refuses coordinates in degrees, which are no lengths.
pub(crate) fn projected(header: &Header) -> Result<(), String> {
    let text = String::from_utf8_lossy(header.get_wkt_crs_bytes().unwrap_or_default()).to_ascii_uppercase();
    let holds = |words: &[&str]| words.iter().any(|word| text.contains(word));
    let by_text = holds(&["GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"])
        && !holds(&["PROJCS", "PROJCRS", "PROJECTEDCRS", "GEOCCS", "LOCAL_CS", "ENGCRS"]);
    let by_keys = || {
        let Some(keys) = header.get_geotiff_crs().ok().flatten() else { return false };
        let has = |id: u16| keys.entries.iter().any(|key| key.id == id);
        match keys.get_gt_model_type_geo_key_value() {
            Some(model) => model == GEOGRAPHIC,
            // Some writers leave the model out.
            None => has(DEGREES) && !has(PROJECTED) && !has(LENGTHS) && is_on_the_globe(header),
        }
    };
    if by_text || text.is_empty() && by_keys() {
        let name = reference_system(header).unwrap_or_default();
        let name: String = name.chars().take(60).collect();
        return Err(format!(
            "the coordinates are degrees, not lengths ({name}): project them again, e.g. pdal translate IN.las OUT.las reprojection \
             --filters.reprojection.out_srs=EPSG:25832 with the code of the place"
        ));
    }
    Ok(())
}

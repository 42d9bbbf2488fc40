//! Reads a site file. Its key names contain the units; all places are in the axes of the site, X along
//! the road and Y to the left, unless a key says otherwise.
//!
//! ```toml
//! name = "Crossing of the two roads"
//!
//! [origin]                          # optional: the site in survey coordinates
//! easting_m = 512345.0              # or easting_ft (0.3048 m), easting_us_survey_ft (1200/3937 m)
//! northing_m = 5423456.0
//! x_axis_azimuth_deg = 75           # direction of X, clockwise from grid north; 90 if not given
//! # or the place of the site's origin on the earth, with the direction of X from true north
//! # latitude_deg = 52.0123456
//! # longitude_deg = -1.0123456
//!
//! [orthophoto]
//! file = "crossing.png"             # PNG, JPEG or TIFF, beside the site file or in a folder below it
//! world_file = "crossing.pgw"       # found beside the picture if not given
//! unit = "m"                        # of the world file: m, ft, us_survey_ft; if not given, that of
//!                                   # crossing.prj, else m
//! # or two of its points, [column, row] from the left top corner, with their places
//! # points_px = [[120.5, 340], [1820, 352]]
//! # points_m = [[0, 0], [42.5, 0]]
//! # or with their distance: the picture is upright, its columns run along X
//! # distance_m = 42.5
//! # first_point_m = [0, 0]          # where the first one is
//!
//! [[lane]]
//! name = "eastbound"
//! centre_line_m = [[-60, -1.75], [90, -1.75]]
//! width_m = 3.5                     # or left_edge_m and right_edge_m, seen along the lane
//! left = "dashed"                   # none, solid, dashed
//! right = "solid"
//!
//! [[kerb]]
//! line_m = [[-60, -3.6], [90, -3.6]]
//!
//! [road]
//! grade_percent = 4                 # rise along X; cross_slope_percent: along Y; or as ratios
//!
//! [[friction_zone]]                 # where zones overlap, the last one holds
//! name = "wet patch"
//! border_m = [[8, -3.5], [20, -3.5], [20, 3.5], [8, 3.5]]
//! friction = 0.35
//!
//! [[line]]                          # surveyed: a tire mark, an edge, a wall
//! name = "skid mark"
//! line_m = [[12, 0.4], [31, 0.9]]
//!
//! [[point]]
//! name = "gouge"
//! at_m = [32.1, 0.7]
//! height_m = 101.32                 # in the system of the survey; optional
//!
//! [dxf]
//! file = "survey.dxf"               # in survey coordinates, if there is an [origin]
//! unit = "m"                        # m, cm, mm, ft, us_survey_ft, in; that of the drawing if not given
//! layers = ["KERB", "ROAD"]         # all that are switched on if not given
//! ```

use std::path::{Component, Path, PathBuf};

use crate::data::{GeographicPlace, TomlError, TomlFile, TomlTable};
use crate::ranges::{
    LANE_WIDTH, LATITUDE, LONGITUDE, PIXEL_COORDINATE, POSITION, ROAD_FRICTION, SITE_AZIMUTH,
    SITE_DISTANCE, SURVEY_COORDINATE,
};
use crate::site::parts::file_name;
use crate::site::picture::{is_picture_file, picture_size_px};
use crate::site::projection_file::{projection_beside, unit_of_world_file};
use crate::site::{
    DrawingFile, EdgeLine, Kerb, Lane, LengthUnit, Orthophoto, PixelMap, Site, SiteError,
    SiteOrigin, SurveyFormat, SurveyOptions, SurveyedLine, SurveyedPoint, WorldFile, geo_tiff,
    world_file_beside,
};
use crate::units::{Quantity, US_SURVEY_FOOT};
use crate::vehicle::{FrictionZone, RoadSlope};

impl Site {
    /// The files that a site file, or an orthophoto as a site of its own, consists of beside itself:
    /// orthophoto, world file, coordinate system, drawing. They need not exist, and nothing is said of a file that is wrong;
    /// [`Site::load`] does that.
    pub fn files_named_by(path: &Path) -> Vec<PathBuf> {
        if is_picture_file(path) {
            let world = world_file_beside(path).ok();
            let projection = world.as_deref().and_then(|world| projection_beside(path, world));
            return world.into_iter().chain(projection).collect();
        }
        let Ok(text) = TomlFile::read(path) else { return Vec::new() };
        let file = TomlFile { path, text: &text };
        let Ok(root) = file.parse() else { return Vec::new() };
        let mut top = TomlTable::root(file, &root);
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut named = |table: &str, key: &str| {
            let mut table = top.optional_table(table).ok().flatten()?;
            read_file(&mut table, key, folder).ok().flatten()
        };
        let picture = named("orthophoto", "file");
        let world = named("orthophoto", "world_file");
        let is_placed = ["corner_m", "points_px"]
            .into_iter()
            .any(|key| file.contains(&format!("orthophoto.{key}")));
        let beside = picture.as_deref().filter(|_| world.is_none() && !is_placed);
        let beside = beside.and_then(|picture| world_file_beside(picture).ok());
        let drawing = named("dxf", "file");
        let of_picture = picture.as_deref().zip(world.as_deref().or(beside.as_deref()));
        let projection = of_picture.and_then(|(picture, world)| projection_beside(picture, world));
        let of_world = world.into_iter().chain(beside).chain(projection);
        picture.into_iter().chain(of_world).chain(drawing).collect()
    }

    /// Reads a site file, or a picture or surveyed lines as a site of their own ([`Site::from_picture`],
    /// [`Site::from_survey`]). Orthophoto and drawing are looked at but not decoded.
    ///
    /// # Errors
    /// [`SiteError`] with file, line, key and what is expected.
    pub fn load(path: &Path) -> Result<Self, SiteError> {
        if is_picture_file(path) {
            return Self::from_picture(path);
        }
        if let Some(format) = SurveyFormat::from_path(path) {
            return Self::from_survey(path, format, &SurveyOptions::default());
        }
        let text = TomlFile::read(path)?;
        Self::from_toml(TomlFile { path, text: &text })
    }

    /// Reads the text of a site file. The files that it names begin at its folder.
    ///
    /// # Errors
    /// The errors of [`Site::load`].
    pub fn from_toml(file: TomlFile<'_>) -> Result<Self, SiteError> {
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let folder = file.path.parent().unwrap_or(Path::new(""));
        let name = top.string("name")?;
        let (origin, geographic) =
            top.optional_table("origin")?.map(read_origin).transpose()?.unzip();
        let known_origin = origin.unwrap_or_default();
        let orthophoto = match top.optional_table("orthophoto")? {
            Some(table) => Some(read_orthophoto(table, folder, known_origin, file.path)?),
            None => None,
        };
        let lanes = top.tables("lane")?.into_iter().map(read_lane).collect::<Result<_, _>>()?;
        let kerbs = top.tables("kerb")?.into_iter().map(read_kerb).collect::<Result<_, _>>()?;
        let zones = top.tables("friction_zone")?.into_iter().map(read_zone);
        let friction_zones = zones.collect::<Result<_, _>>()?;
        let slope = top.optional_table("road")?.map(RoadSlope::read).transpose()?;
        let lines = top.tables("line")?.into_iter().map(read_surveyed_line);
        let lines = lines.collect::<Result<_, _>>()?;
        let points = top.tables("point")?.into_iter().map(read_surveyed_point);
        let points = points.collect::<Result<_, _>>()?;
        let drawing = match top.optional_table("dxf")? {
            Some(table) => Some(read_drawing_file(table, folder)?),
            None => None,
        };
        top.finish()?;
        let notes = orthophoto.as_ref().and_then(geo_tiff::note).into_iter().collect();
        Ok(Self {
            name: name.unwrap_or_else(|| file_name(file.path)),
            path: file.path.to_owned(),
            origin,
            geographic: geographic.flatten(),
            orthophoto,
            lanes,
            kerbs,
            friction_zones,
            slope,
            lines,
            points,
            drawing,
            notes,
        })
    }
}

fn read_origin(
    mut table: TomlTable<'_>,
) -> Result<(SiteOrigin, Option<GeographicPlace>), TomlError> {
    let geographic = read_geographic(&mut table)?;
    let survey_m = match geographic {
        Some(_) => [0.0; 2],
        None => [
            read_survey_coordinate(&mut table, "easting")?,
            read_survey_coordinate(&mut table, "northing")?,
        ],
    };
    let azimuth_rad = table.number("x_axis_azimuth", &SITE_AZIMUTH)?;
    table.finish()?;
    let usual = SiteOrigin::default();
    let x_axis_azimuth_rad = azimuth_rad.unwrap_or(usual.x_axis_azimuth_rad);
    Ok((SiteOrigin { survey_m, x_axis_azimuth_rad }, geographic))
}

/// The place of the origin on the earth, if the file says that.
fn read_geographic(table: &mut TomlTable<'_>) -> Result<Option<GeographicPlace>, TomlError> {
    let Some(latitude_rad) = table.number("latitude", &LATITUDE)? else { return Ok(None) };
    let Some(longitude_rad) = table.number("longitude", &LONGITUDE)? else {
        return Err(table.missing("longitude_deg"));
    };
    Ok(Some(GeographicPlace { latitude_rad, longitude_rad }))
}

/// A coordinate of the origin, whose unit may also be the foot of the United States survey.
fn read_survey_coordinate(table: &mut TomlTable<'_>, base: &str) -> Result<f64, TomlError> {
    let units = [Quantity::Length.units(), &[US_SURVEY_FOOT]].concat();
    let found = table.number_in(base, &SURVEY_COORDINATE, &units)?;
    found.ok_or_else(|| table.missing(&format!("{base}_m")))
}

/// A file beside the site file or below it, so that a site can be moved with all that belongs to it.
fn read_file(
    table: &mut TomlTable<'_>,
    key: &str,
    folder: &Path,
) -> Result<Option<PathBuf>, TomlError> {
    let Some(name) = table.string(key)? else { return Ok(None) };
    let parts = Path::new(&name).components();
    let is_below = parts.clone().all(|part| matches!(part, Component::Normal(_)));
    if !is_below || parts.count() == 0 || name.contains('\\') {
        let expected = "a file beside the site file or in a folder below it, such as \"road.png\"";
        return Err(table.refuse_last(expected));
    }
    Ok(Some(folder.join(name)))
}

fn required_file(
    table: &mut TomlTable<'_>,
    key: &str,
    folder: &Path,
) -> Result<PathBuf, TomlError> {
    read_file(table, key, folder)?.ok_or_else(|| table.missing(key))
}

fn read_orthophoto(
    mut table: TomlTable<'_>,
    folder: &Path,
    origin: SiteOrigin,
    site: &Path,
) -> Result<Orthophoto, SiteError> {
    let file = required_file(&mut table, "file", folder)?;
    if !is_picture_file(&file) {
        return Err(table.refuse_last("a .png, .jpg, .jpeg, .tif or .tiff file").into());
    }
    let size_px = picture_size_px(&file)?;
    let map = match read_map(&mut table)? {
        Some(map) => Some(map),
        None => read_points(&mut table, size_px, &file, site)?,
    };
    let world_file = match map {
        Some(_) => None,
        None => match read_file(&mut table, "world_file", folder)? {
            Some(file) => Some(file),
            None => Some(world_file_beside(&file)?),
        },
    };
    let (words, units) = LengthUnit::OF_WORLD_FILES;
    let unit = table.choice("unit", &words)?.map(|idx| units[idx]);
    if unit.is_some() && world_file.is_none() {
        let expected = "no unit, which is that of a world file: this picture is placed in metres";
        return Err(table.refuse_last(expected).into());
    }
    let world_unit = match &world_file {
        Some(world) => unit_of_world_file(&file, world, unit)?,
        None => LengthUnit::default(),
    };
    let map = match (map, &world_file) {
        (Some(map), _) => map,
        (None, Some(file)) => {
            PixelMap::from_world_file(&WorldFile::load(file, world_unit)?, &origin)
        }
        (None, None) => return Err(table.missing("world_file").into()),
    };
    table.finish()?;
    Ok(Orthophoto { file, world_file, world_unit, size_px, map, is_placed: true })
}

/// The place of a picture by its corner and its pixels, as the window writes it.
fn read_map(table: &mut TomlTable<'_>) -> Result<Option<PixelMap>, TomlError> {
    let Some(corner_m) = table.point("corner_m", &SURVEY_COORDINATE)? else { return Ok(None) };
    let Some(per_column_m) = table.point("per_column_m", &SURVEY_COORDINATE)? else {
        return Err(table.missing("per_column_m"));
    };
    let Some(per_row_m) = table.point("per_row_m", &SURVEY_COORDINATE)? else {
        return Err(table.missing("per_row_m"));
    };
    checked(PixelMap { corner_m, per_column_m, per_row_m }, table).map(Some)
}

/// The place of a picture by two of its points; `None` if the file has none.
fn read_points(
    table: &mut TomlTable<'_>,
    size_px: [u32; 2],
    picture: &Path,
    site: &Path,
) -> Result<Option<PixelMap>, SiteError> {
    let Some(points) = table.points("points_px", &PIXEL_COORDINATE)? else { return Ok(None) };
    let Ok(px) = <[[f64; 2]; 2]>::try_from(points) else {
        return Err(table.refuse_last("two points [column, row]").into());
    };
    let is_outside = |at: &&[f64; 2]| (0..2).any(|axis| at[axis] > f64::from(size_px[axis]));
    if let Some(point_px) = px.iter().find(is_outside) {
        let (path, picture) = (site.to_owned(), picture.to_owned());
        return Err(SiteError::PointOutside { path, picture, point_px: *point_px, size_px });
    }
    if px[0] == px[1] {
        return Err(table.refuse_last("two points that differ").into());
    }
    let places = table.points("points_m", &SURVEY_COORDINATE)?;
    let map = match places {
        Some(places) => {
            let two = <[[f64; 2]; 2]>::try_from(places).ok();
            let map = two.and_then(|metres| PixelMap::from_two_points(px, metres));
            map.ok_or_else(|| table.refuse_last("two points [X, Y] that differ"))?
        }
        None => {
            let Some(distance_m) = table.number("distance", &SITE_DISTANCE)? else {
                return Err(table.missing("points_m or distance_m").into());
            };
            let first_m = table.point("first_point_m", &SURVEY_COORDINATE)?.unwrap_or([0.0; 2]);
            let map = PixelMap::from_distance(px, distance_m, first_m);
            map.ok_or_else(|| table.refuse_last("the distance of two points that differ"))?
        }
    };
    Ok(Some(checked(map, table)?))
}

/// Refuses a map whose pixels are too small, too large or mirrored.
fn checked(map: PixelMap, table: &TomlTable<'_>) -> Result<PixelMap, TomlError> {
    match map.problem() {
        Some(expected) => Err(table.refuse_last(expected)),
        None => Ok(map),
    }
}

/// A line of at least two points that differ.
fn read_line(table: &mut TomlTable<'_>, key: &str) -> Result<Option<Vec<[f64; 2]>>, TomlError> {
    let Some(mut points) = table.points(key, &SURVEY_COORDINATE)? else { return Ok(None) };
    points.dedup();
    if points.len() < 2 {
        return Err(table.refuse_last("at least two points [X, Y] that differ"));
    }
    Ok(Some(points))
}

fn read_lane(mut table: TomlTable<'_>) -> Result<Lane, TomlError> {
    let name = table.string("name")?.unwrap_or_default();
    let centre = read_line(&mut table, "centre_line_m")?;
    let width_m = table.number("width", &LANE_WIDTH)?;
    let [left, right] = ["left_edge_m", "right_edge_m"].map(|key| read_line(&mut table, key));
    let (left_m, right_m) = match (centre, left?, right?) {
        (Some(centre), None, None) => {
            let Some(width_m) = width_m else { return Err(table.missing("width_m")) };
            (beside(&centre, width_m / 2.0), beside(&centre, -width_m / 2.0))
        }
        (None, Some(left), Some(right)) if width_m.is_none() => (left, right),
        (None, Some(_), None) => return Err(table.missing("right_edge_m")),
        (None, None, Some(_)) => return Err(table.missing("left_edge_m")),
        (None, None, None) => return Err(table.missing("centre_line_m")),
        _ => return Err(table.conflict("centre_line_m with width_m")),
    };
    let mut edge = |key| {
        let chosen = table.choice(key, &EdgeLine::WORDS)?;
        Ok::<_, TomlError>(chosen.map_or(EdgeLine::default(), |idx| EdgeLine::ALL[idx]))
    };
    let edges = [edge("left")?, edge("right")?];
    table.finish()?;
    Ok(Lane { name, left_m, right_m, edges })
}

/// The line at a distance to the left of another one, m; corners are mitred, sharp ones to at most twice
/// the distance.
fn beside(line_m: &[[f64; 2]], distance_m: f64) -> Vec<[f64; 2]> {
    let way = |from: [f64; 2], to: [f64; 2]| {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        [dx / length, dy / length]
    };
    let ways: Vec<[f64; 2]> = line_m.windows(2).map(|pair| way(pair[0], pair[1])).collect();
    let at = |idx: usize| {
        let before = ways[idx.saturating_sub(1)];
        let after = ways[idx.min(ways.len() - 1)];
        let [nx, ny] = [-(before[1] + after[1]), before[0] + after[0]];
        // The mitre is longer than the distance by one over the cosine of half the turn.
        let squared = (nx * nx + ny * ny).max(1.0);
        let [x, y] = line_m[idx];
        [x + 2.0 * distance_m * nx / squared, y + 2.0 * distance_m * ny / squared]
    };
    (0..line_m.len()).map(at).collect()
}

fn read_kerb(mut table: TomlTable<'_>) -> Result<Kerb, TomlError> {
    let name = table.string("name")?.unwrap_or_default();
    let line_m = read_line(&mut table, "line_m")?;
    let Some(line_m) = line_m else { return Err(table.missing("line_m")) };
    table.finish()?;
    Ok(Kerb { name, line_m })
}

fn read_surveyed_line(mut table: TomlTable<'_>) -> Result<SurveyedLine, TomlError> {
    let name = table.string("name")?.unwrap_or_default();
    let line_m = read_line(&mut table, "line_m")?;
    let Some(line_m) = line_m else { return Err(table.missing("line_m")) };
    table.finish()?;
    Ok(SurveyedLine { name, line_m })
}

fn read_surveyed_point(mut table: TomlTable<'_>) -> Result<SurveyedPoint, TomlError> {
    let name = table.string("name")?.unwrap_or_default();
    let Some(at_m) = table.point("at_m", &SURVEY_COORDINATE)? else {
        return Err(table.missing("at_m"));
    };
    let height_m = table.number("height", &SURVEY_COORDINATE)?;
    table.finish()?;
    Ok(SurveyedPoint { name, at_m, height_m })
}

fn read_zone(mut table: TomlTable<'_>) -> Result<FrictionZone, TomlError> {
    let name = table.string("name")?;
    let Some(name) = name.filter(|name| !name.trim().is_empty()) else {
        return Err(table.missing("name"));
    };
    let friction = table.require("friction", &ROAD_FRICTION)?;
    let Some(mut border_m) = table.points("border_m", &POSITION)? else {
        return Err(table.missing("border_m"));
    };
    if border_m.len() > 1 && border_m.first() == border_m.last() {
        border_m.pop();
    }
    let zone = FrictionZone { name, border_m, friction };
    if let Err(error) = zone.check() {
        let expected = format!("a border around an area whose sides do not cross ({error})");
        return Err(table.refuse_last(&expected));
    }
    table.finish()?;
    Ok(zone)
}

fn read_drawing_file(mut table: TomlTable<'_>, folder: &Path) -> Result<DrawingFile, TomlError> {
    let file = required_file(&mut table, "file", folder)?;
    let unit = table.choice("unit", &LengthUnit::WORDS)?.map(|idx| LengthUnit::ALL[idx]);
    let layers = table.strings("layers")?;
    if layers.as_ref().is_some_and(Vec::is_empty) {
        return Err(table.refuse_last("at least one layer"));
    }
    table.finish()?;
    Ok(DrawingFile { file, unit, layers })
}

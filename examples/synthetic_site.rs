//! Makes the ground of the examples: a synthetic orthophoto of a country road with its world file, a
//! drawing of its edges and the site file that names them.
//!
//! ```sh
//! cargo run --release --example synthetic_site -- assets/sites/country-road
//! ```
//!
//! The road is straight and runs at an azimuth of 78° through the origin of the site; the picture is
//! upright in survey coordinates, north at its top, as orthophotos are.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use dxf::entities::{Entity, EntityType, Line};
use dxf::enums::{AcadVersion, Units};
use image::codecs::jpeg::JpegEncoder;
use image::{Rgb, RgbImage};
use impactlab_core::site::{PixelMap, SiteOrigin, WorldFile};

/// Width and height of the picture, pixels, and the side of a pixel, m.
const SIZE_PX: [u32; 2] = [1680, 840];
const PIXEL_M: f64 = 0.08;
/// Where the origin of the site is: easting and northing, m.
const SURVEY_M: [f64; 2] = [512_345.0, 5_423_456.0];
const AZIMUTH_DEG: f64 = 78.0;
/// Place of the middle of the picture along the road, m.
const MIDDLE_M: [f64; 2] = [28.0, 2.0];
/// Edges of the carriageway and of the paved shoulder, left and right of the lane of the struck car, m.
const ROAD_M: [f64; 2] = [5.25, -1.75];
const SHOULDER_M: [f64; 2] = [6.0, -4.0];
/// Width of a marking, m, and length and gap of the dashes between the lanes.
const MARKING_M: f64 = 0.12;
const DASH_M: [f64; 2] = [3.0, 6.0];
/// Quality of the picture, per cent.
const QUALITY: u8 = 82;

/// What the site file says; its numbers are those above.
const SITE: &str = r#"# The ground of the examples: a straight country road, made by examples/synthetic_site.rs.
# Axes: X along the lane of the struck car, Y to the left; the origin is where a scenario has its own.
name = "Country road, synthetic"

[origin]
easting_m = 512345.0
northing_m = 5423456.0
x_axis_azimuth_deg = 78     # clockwise from grid north

[orthophoto]
file = "orthophoto.jpg"
world_file = "orthophoto.jgw"

[[lane]]
name = "own lane"
centre_line_m = [[-38, 0], [94, 0]]
width_m = 3.5
left = "dashed"
right = "solid"

[[lane]]
name = "oncoming lane"
centre_line_m = [[-38, 3.5], [94, 3.5]]
width_m = 3.5
left = "solid"
right = "none"              # the dashed line of the other lane

[[friction_zone]]
name = "grass verge, right"
border_m = [[-38, -4], [94, -4], [94, -12], [-38, -12]]
friction = 0.45

[[friction_zone]]
name = "grass verge, left"
border_m = [[-38, 6], [94, 6], [94, 14], [-38, 14]]
friction = 0.45

[dxf]
file = "edges.dxf"          # in survey coordinates
unit = "m"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args_os().nth(1).ok_or("expected a folder")?.into();
    fs::create_dir_all(&folder)?;
    let origin = SiteOrigin { survey_m: SURVEY_M, x_axis_azimuth_rad: AZIMUTH_DEG.to_radians() };
    let world = world_file(&origin);
    let map = PixelMap::from_world_file(&world, &origin);
    let picture = RgbImage::from_fn(SIZE_PX[0], SIZE_PX[1], |column, row| {
        Rgb(color(map.ground_m([f64::from(column) + 0.5, f64::from(row) + 0.5])))
    });
    let file = fs::File::create(folder.join("orthophoto.jpg"))?;
    JpegEncoder::new_with_quality(file, QUALITY).encode_image(&picture)?;
    fs::write(folder.join("orthophoto.jgw"), world.to_text())?;
    write_drawing(&folder.join("edges.dxf"), &origin)?;
    fs::write(folder.join("site.toml"), SITE)?;
    Ok(())
}

/// The world file of a picture that is upright in survey coordinates. Its last two numbers are the middle
/// of the left top pixel.
fn world_file(origin: &SiteOrigin) -> WorldFile {
    let [east, north] = origin.survey_from_site(MIDDLE_M);
    let [width, height] = SIZE_PX.map(f64::from);
    WorldFile {
        per_column_m: [PIXEL_M, 0.0],
        per_row_m: [0.0, -PIXEL_M],
        first_pixel_m: [
            (east - (width - 1.0) / 2.0 * PIXEL_M).round(),
            (north + (height - 1.0) / 2.0 * PIXEL_M).round(),
        ],
    }
}

/// Colour of the ground at a place.
fn color([x, y]: [f64; 2]) -> [u8; 3] {
    let is_paved = (SHOULDER_M[1]..SHOULDER_M[0]).contains(&y);
    let grain = noise([9.0 * x, 9.0 * y], 1) - 0.5;
    if let Some(share) = marking([x, y]) {
        let worn = 0.75 + 0.25 * noise([2.0 * x, 2.0 * y], 2);
        let asphalt = [94.0, 95.0, 96.0];
        return asphalt.map(|base| shade(base + (232.0 - base) * share * worn + 14.0 * grain));
    }
    if is_paved {
        let is_shoulder = !(ROAD_M[1]..ROAD_M[0]).contains(&y);
        let base = if is_shoulder { 112.0 } else { 92.0 };
        // Darker where wheels run, patches of repair, and a seam between the lanes.
        let lane_y = (y - 0.0).rem_euclid(3.5);
        let track =
            (-((lane_y - 0.8) / 0.3).powi(2)).exp() + (-((lane_y - 2.7) / 0.3).powi(2)).exp();
        let stain = noise([0.25 * x, 0.6 * y], 3) - 0.5;
        let is_patch = (41.0..47.5).contains(&x) && (-1.6..0.4).contains(&y);
        let patch = if is_patch { -22.0 } else { 0.0 };
        let gray = base - 7.0 * track + 16.0 * stain + patch + 26.0 * grain;
        return [shade(gray), shade(gray + 1.0), shade(gray + 2.0)];
    }
    let tufts = noise([0.9 * x, 0.9 * y], 4) - 0.5;
    let fields = noise([0.09 * x, 0.09 * y], 5) - 0.5;
    let tree = crown([x, y]);
    let green = [112.0, 128.0, 78.0];
    let mixed =
        [0, 1, 2].map(|i| green[i] + [34.0, 22.0, 20.0][i] * (tufts + fields) + 22.0 * grain);
    mixed.map(|value| shade(value * (1.0 - 0.55 * tree)))
}

/// How far a place is covered by a marking, 0 to 1.
fn marking([x, y]: [f64; 2]) -> Option<f64> {
    let edge = |at: f64| 1.0 - ((y - at).abs() - MARKING_M / 2.0).max(0.0) / 0.06;
    let [dash, gap] = DASH_M;
    let is_dash = (x + 38.0).rem_euclid(dash + gap) < dash;
    let between = if is_dash { edge(1.75) } else { 0.0 };
    let share = edge(ROAD_M[0] - 0.1).max(edge(ROAD_M[1] + 0.1)).max(between);
    (share > 0.0).then_some(share.min(1.0))
}

/// How far a place is covered by the crown of a tree or its shadow, 0 to 1.
fn crown([x, y]: [f64; 2]) -> f64 {
    let trees = [
        [-20.0, 13.0, 3.2],
        [2.0, 16.0, 4.0],
        [18.0, -13.5, 3.4],
        [55.0, 14.0, 3.6],
        [72.0, -15.0, 4.2],
    ];
    let cover = trees.map(|[tx, ty, radius]| {
        let ragged = radius * (0.85 + 0.3 * noise([1.4 * x, 1.4 * y], 6));
        (1.0 - ((x - tx).hypot(y - ty) / ragged).powi(6)).max(0.0)
    });
    cover.into_iter().fold(0.0, f64::max)
}

/// Smooth noise between 0 and 1, the same on every machine.
fn noise([x, y]: [f64; 2], seed: u64) -> f64 {
    let corner = |i: i64, j: i64| {
        let mut bits = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed;
        bits = (bits ^ (j as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
            .wrapping_mul(0xff51_afd7_ed55_8ccd);
        ((bits ^ (bits >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53) >> 40) as f64
            / (1_u64 << 24) as f64
    };
    let smooth = |share: f64| share * share * (3.0 - 2.0 * share);
    let (i, j) = (x.floor(), y.floor());
    let (fx, fy) = (smooth(x - i), smooth(y - j));
    let (i, j) = (i as i64, j as i64);
    let row = |j: i64| corner(i, j) + (corner(i + 1, j) - corner(i, j)) * fx;
    row(j) + (row(j + 1) - row(j)) * fy
}

fn shade(value: f64) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

/// The edges of the pavement as a survey has them.
fn write_drawing(path: &Path, origin: &SiteOrigin) -> Result<(), Box<dyn Error>> {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R12;
    drawing.header.default_drawing_units = Units::Meters;
    for y in SHOULDER_M {
        let [from, to] = [-38.0, 94.0].map(|x| {
            let [east, north] = origin.survey_from_site([x, y]);
            dxf::Point::new((1e3 * east).round() / 1e3, (1e3 * north).round() / 1e3, 0.0)
        });
        let mut edge = Entity::new(EntityType::Line(Line::new(from, to)));
        edge.common.layer = "PAVEMENT".to_owned();
        drawing.add_entity(edge);
    }
    Ok(drawing.save_file(path)?)
}

//! What a site consists of.

use std::path::{Path, PathBuf};

use crate::data::GeographicPlace;
use crate::numerics::nearest_multiple;
use crate::site::drawing::USUAL_SIDE_M;
use crate::site::projection_file::unit_of_world_file;
use crate::site::{
    DrawingSummary, GeographicFrame, PixelMap, SiteError, SiteOrigin, WorldFile, geo_tiff,
    picture_size_px, world_file_beside,
};
use crate::units::{FOOT_M, INCH_M, Quantity, US_SURVEY_FOOT, UnitSystem};
use crate::vehicle::{FrictionZone, RoadSlope};

/// Side of a pixel of a picture of which nothing says where it lies, m; its middle is then at the origin.
const ASSUMED_PIXEL_M: f64 = 0.05;

/// The ground of a scene. All places are in the axes of the site.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// What it is called.
    pub name: String,
    /// The file that it was read from.
    pub path: PathBuf,
    /// Where it lies in survey coordinates, if that is known.
    pub origin: Option<SiteOrigin>,
    /// The geographic place of its origin, if that is known; `origin` then says the direction of X alone,
    /// from true north.
    pub geographic: Option<GeographicPlace>,
    /// A picture of the ground from above.
    pub orthophoto: Option<Orthophoto>,
    /// Lanes of roads.
    pub lanes: Vec<Lane>,
    /// Kerbs.
    pub kerbs: Vec<Kerb>,
    /// Parts of the ground with their own friction, in their order: where they overlap, the last holds.
    pub friction_zones: Vec<FrictionZone>,
    /// Slope of the road, if that is known.
    pub slope: Option<RoadSlope>,
    /// Lines that were surveyed: tire marks, edges, walls.
    pub lines: Vec<SurveyedLine>,
    /// Points that were surveyed.
    pub points: Vec<SurveyedPoint>,
    /// A drawing whose lines are shown.
    pub drawing: Option<DrawingFile>,
    /// What whoever reads the file has to know of how it was read.
    pub notes: Vec<String>,
}

/// A picture of the ground from above, to scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Orthophoto {
    /// The picture.
    pub file: PathBuf,
    /// The world file that says where it lies, if it is one.
    pub world_file: Option<PathBuf>,
    /// The unit of the numbers in the world file.
    pub world_unit: LengthUnit,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Where its pixels lie.
    pub map: PixelMap,
    /// Whether its place and scale are known. Otherwise it is shown with 0.05 m per pixel about the
    /// origin, until somebody measures it.
    pub is_placed: bool,
}

/// How the edge of a lane is marked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum EdgeLine {
    /// Not at all.
    None,
    /// By a line.
    #[default]
    Solid,
    /// By a line with gaps.
    Dashed,
}

impl EdgeLine {
    /// Its words in a site file, in the order of [`EdgeLine::ALL`].
    pub const WORDS: [&str; 3] = ["none", "solid", "dashed"];
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Solid, Self::Dashed];
}

/// A lane of a road.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// What it is called; may be empty.
    pub name: String,
    /// Its left edge, seen along the lane, m.
    pub left_m: Vec<[f64; 2]>,
    /// Its right edge, m.
    pub right_m: Vec<[f64; 2]>,
    /// How the left and the right edge are marked.
    pub edges: [EdgeLine; 2],
}

/// A kerb.
#[derive(Debug, Clone, PartialEq)]
pub struct Kerb {
    /// What it is called; may be empty.
    pub name: String,
    /// Its line, m.
    pub line_m: Vec<[f64; 2]>,
}

/// A line that was surveyed.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyedLine {
    /// What it is called, or its code; may be empty.
    pub name: String,
    /// Its points, m.
    pub line_m: Vec<[f64; 2]>,
}

/// A point that was surveyed.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyedPoint {
    /// What it is called, with its code; may be empty.
    pub name: String,
    /// Where it is, m.
    pub at_m: [f64; 2],
    /// Its height in the system of the survey, if that is known, m.
    pub height_m: Option<f64>,
}

/// A drawing in the format DXF.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawingFile {
    /// The drawing.
    pub file: PathBuf,
    /// Its unit; that which the drawing states, if `None`.
    pub unit: Option<LengthUnit>,
    /// The layers that are shown; all that are switched on, if `None`.
    pub layers: Option<Vec<String>>,
}

/// The unit of a drawing or of a world file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres.
    #[default]
    Metre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
    /// Feet of 0.3048 m.
    Foot,
    /// Feet of the United States survey, 1200/3937 m.
    SurveyFoot,
    /// Inches.
    Inch,
}

impl LengthUnit {
    /// Their words in a site file, in the order of [`LengthUnit::ALL`]; the last one is another spelling.
    pub const WORDS: [&str; 7] = [
        Self::Metre.word(),
        Self::Centimetre.word(),
        Self::Millimetre.word(),
        Self::Foot.word(),
        Self::SurveyFoot.word(),
        Self::Inch.word(),
        "us-survey-ft",
    ];
    /// What the words mean.
    pub const ALL: [Self; 7] = [
        Self::Metre,
        Self::Centimetre,
        Self::Millimetre,
        Self::Foot,
        Self::SurveyFoot,
        Self::Inch,
        Self::SurveyFoot,
    ];
    /// The words for a world file, with what they mean.
    pub const OF_WORLD_FILES: ([&str; 3], [Self; 3]) = (
        [Self::Metre.word(), Self::Foot.word(), Self::SurveyFoot.word()],
        [Self::Metre, Self::Foot, Self::SurveyFoot],
    );

    /// Its word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Foot => "ft",
            Self::SurveyFoot => "us_survey_ft",
            Self::Inch => "in",
        }
    }

    /// Its length, m.
    pub fn length_m(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Foot => FOOT_M,
            Self::SurveyFoot => US_SURVEY_FOOT.si_per_unit,
            Self::Inch => INCH_M,
        }
    }
}

impl Site {
    /// A site of a picture alone. Its world file says where it lies, in the unit of the coordinate system beside it,
    /// else in metres; without one it lies about the origin, and its scale is not known.
    ///
    /// # Errors
    /// [`SiteError`] if the picture or the world file cannot be read.
    pub fn from_picture(path: &Path) -> Result<Self, SiteError> {
        let size_px = picture_size_px(path)?;
        let world_file = world_file_beside(path).ok();
        let world_unit = match &world_file {
            Some(file) => unit_of_world_file(path, file, None)?,
            None => LengthUnit::Metre,
        };
        let map = match &world_file {
            Some(file) => {
                let world = WorldFile::load(file, world_unit)?;
                PixelMap::from_world_file(&world, &SiteOrigin::default())
            }
            None => {
                let [width, height] = size_px.map(|side| ASSUMED_PIXEL_M * f64::from(side));
                PixelMap {
                    corner_m: [-width / 2.0, height / 2.0],
                    per_column_m: [ASSUMED_PIXEL_M, 0.0],
                    per_row_m: [0.0, -ASSUMED_PIXEL_M],
                }
            }
        };
        let is_placed = world_file.is_some();
        let file = path.to_owned();
        let orthophoto = Orthophoto { file, world_file, world_unit, size_px, map, is_placed };
        let notes = geo_tiff::note(&orthophoto).into_iter().collect();
        Ok(Self { orthophoto: Some(orthophoto), notes, ..Self::empty(path) })
    }

    /// A site of which nothing is known but its file.
    pub(super) fn empty(path: &Path) -> Self {
        Self {
            name: file_name(path),
            path: path.to_owned(),
            origin: None,
            geographic: None,
            orthophoto: None,
            lanes: Vec::new(),
            kerbs: Vec::new(),
            friction_zones: Vec::new(),
            slope: None,
            lines: Vec::new(),
            points: Vec::new(),
            drawing: None,
            notes: Vec::new(),
        }
    }

    /// Where it lies on the earth, if that is known.
    pub fn geographic_frame(&self) -> Option<GeographicFrame> {
        let x_axis_azimuth_rad = self.origin.unwrap_or_default().x_axis_azimuth_rad;
        self.geographic.map(|place| GeographicFrame { place, x_axis_azimuth_rad })
    }

    /// Direction of grid north in the axes of the site, counter-clockwise from X, rad.
    pub fn north_rad(&self) -> Option<f64> {
        let [x, y] = self.origin?.turned([0.0, 1.0]);
        Some(y.atan2(x))
    }

    /// What it consists of, in words.
    ///
    /// - `drawing`: what of its drawing was read, if that is known;
    /// - `units`: of its lengths.
    pub fn contents(&self, drawing: Option<&DrawingSummary>, units: UnitSystem) -> Vec<String> {
        let unit = Quantity::Length.display_unit(units);
        let counted = |n: usize, what: &str| match n {
            0 => None,
            1 => Some(format!("1 {what}")),
            n => Some(format!("{n} {what}s")),
        };
        let orthophoto = self.orthophoto.as_ref().map(|orthophoto| {
            let [width, height] = orthophoto.size_px;
            let pixel = unit.from_si(orthophoto.map.pixel_size_m()[0]);
            let [low, high] = orthophoto.extent_m();
            let side_m = (high[0] - low[0]).max(high[1] - low[1]);
            let is_odd = orthophoto.is_placed && !USUAL_SIDE_M.contains(&side_m);
            let doubt = if is_odd { ": is that its unit?" } else { "" };
            let place = match (orthophoto.is_placed, &orthophoto.world_file) {
                (false, _) => ", place and scale not known".to_owned(),
                (true, None) => extent_text(orthophoto.extent_m(), units),
                (true, Some(_)) => {
                    format!(
                        "{}, world file in {}",
                        extent_text(orthophoto.extent_m(), units),
                        orthophoto.world_unit.word()
                    )
                }
            };
            let size = format!("{width} x {height} pixels of {pixel:.4} {}", unit.symbol);
            format!("orthophoto of {size}{place}{doubt}")
        });
        let drawing = self.drawing.as_ref().map(|file| {
            let contents = drawing.map(|summary| summary.contents(units)).unwrap_or_default();
            format!("drawing {}{contents}", file_name(&file.file))
        });
        let zones = counted(self.friction_zones.len(), "friction zone");
        let counts = [counted(self.lanes.len(), "lane"), counted(self.kerbs.len(), "kerb"), zones];
        let slope = self.slope.map(|RoadSlope { grade, cross_slope }| {
            let [along, across] = [grade, cross_slope].map(|slope| 100.0 * slope);
            format!("slope of {along:.1} % along X, {across:.1} % along Y")
        });
        let counts = counts.into_iter().flatten().chain(slope);
        let counts = counts.chain(self.surveyed_text(units)).chain(self.place_text(units));
        orthophoto.into_iter().chain(counts).chain(drawing).collect()
    }

    /// What of it was surveyed, and where that lies.
    fn surveyed_text(&self, units: UnitSystem) -> Option<String> {
        let lines = self.lines.iter().flat_map(|line| line.line_m.iter().copied());
        let extent = extent_of(lines.chain(self.points.iter().map(|point| point.at_m)))?;
        let (n_lines, n_points) = (self.lines.len(), self.points.len());
        Some(format!("surveyed lines: {n_lines}, points: {n_points}{}", extent_text(extent, units)))
    }

    /// Where its origin lies, for a site with surveyed lines or on the earth.
    fn place_text(&self, units: UnitSystem) -> Option<String> {
        if let Some(place) = self.geographic {
            let [latitude_deg, longitude_deg] = place.degrees();
            return Some(format!(
                "origin at latitude {latitude_deg:.7}°, longitude {longitude_deg:.7}°"
            ));
        }
        let is_surveyed = !self.lines.is_empty() || !self.points.is_empty();
        let survey_m = self.origin.filter(|_| is_surveyed)?.survey_m;
        let unit = Quantity::Length.display_unit(units);
        let [easting, northing] = survey_m.map(|value| nearest_multiple(unit.from_si(value), 1e-3));
        let symbol = unit.symbol;
        Some(format!("origin at easting {easting} {symbol}, northing {northing} {symbol}"))
    }
}

impl Orthophoto {
    /// The rectangle along X and Y that holds it: smallest and largest `[X, Y]`, m.
    pub fn extent_m(&self) -> [[f64; 2]; 2] {
        extent_of(self.map.corners_m(self.size_px)).unwrap_or_default()
    }
}

/// Smallest and largest coordinates of points, m; `None` without points.
pub fn extent_of(points_m: impl IntoIterator<Item = [f64; 2]>) -> Option<[[f64; 2]; 2]> {
    let mut points_m = points_m.into_iter();
    let first = points_m.next()?;
    Some(points_m.fold([first; 2], |[low, high], at| {
        [std::array::from_fn(|i| low[i].min(at[i])), std::array::from_fn(|i| high[i].max(at[i]))]
    }))
}

/// Where something lies, after what it is.
pub(super) fn extent_text(extent_m: [[f64; 2]; 2], units: UnitSystem) -> String {
    let unit = Quantity::Length.display_unit(units);
    let [[x_low, y_low], [x_high, y_high]] = extent_m.map(|at| at.map(|value| unit.from_si(value)));
    let symbol = unit.symbol;
    format!(", X {x_low:.1} to {x_high:.1} {symbol}, Y {y_low:.1} to {y_high:.1} {symbol}")
}

/// The name of a file without its folder.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

//! What a site consists of.

use std::path::{Path, PathBuf};

use crate::site::{PixelMap, SiteError, SiteOrigin, WorldFile, picture_size_px, world_file_beside};
use crate::vehicle::FrictionZone;

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
    /// A picture of the ground from above.
    pub orthophoto: Option<Orthophoto>,
    /// Lanes of roads.
    pub lanes: Vec<Lane>,
    /// Kerbs.
    pub kerbs: Vec<Kerb>,
    /// Parts of the ground with their own friction, in their order: where they overlap, the last holds.
    pub friction_zones: Vec<FrictionZone>,
    /// A drawing whose lines are shown.
    pub drawing: Option<DrawingFile>,
}

/// A picture of the ground from above, to scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Orthophoto {
    /// The picture.
    pub file: PathBuf,
    /// The world file that says where it lies, if it is one.
    pub world_file: Option<PathBuf>,
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

/// A drawing in the format DXF.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawingFile {
    /// The drawing.
    pub file: PathBuf,
    /// Its unit; that which the drawing states, if `None`.
    pub unit: Option<DrawingUnit>,
    /// The layers that are shown; all that are switched on, if `None`.
    pub layers: Option<Vec<String>>,
}

/// The unit of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingUnit {
    /// Metres.
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

impl DrawingUnit {
    /// Their words in a site file, in the order of [`DrawingUnit::ALL`].
    pub const WORDS: [&str; 6] = ["m", "cm", "mm", "ft", "us-survey-ft", "in"];
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Metre, Self::Centimetre, Self::Millimetre, Self::Foot, Self::SurveyFoot, Self::Inch];

    /// Its length, m.
    pub fn length_m(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Foot => 0.3048,
            Self::SurveyFoot => 1200.0 / 3937.0,
            Self::Inch => 0.0254,
        }
    }
}

impl Site {
    /// A site of a picture alone. Its world file says where it lies; without one it lies about the
    /// origin, and its scale is not known.
    ///
    /// # Errors
    /// [`SiteError`] if the picture or the world file cannot be read.
    pub fn of_picture(path: &Path) -> Result<Self, SiteError> {
        let size_px = picture_size_px(path)?;
        let world_file = world_file_beside(path).ok();
        let map = match &world_file {
            Some(file) => PixelMap::of_world_file(&WorldFile::load(file)?, &SiteOrigin::default()),
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
        Ok(Self {
            name: file_name(path),
            path: file.clone(),
            origin: None,
            orthophoto: Some(Orthophoto { file, world_file, size_px, map, is_placed }),
            lanes: Vec::new(),
            kerbs: Vec::new(),
            friction_zones: Vec::new(),
            drawing: None,
        })
    }

    /// Direction of grid north in the axes of the site, counter-clockwise from X, rad.
    pub fn north_rad(&self) -> Option<f64> {
        let [x, y] = self.origin?.turned([0.0, 1.0]);
        Some(y.atan2(x))
    }

    /// What it consists of, in words.
    pub fn contents(&self) -> Vec<String> {
        let counted = |n: usize, what: &str| match n {
            0 => None,
            1 => Some(format!("1 {what}")),
            n => Some(format!("{n} {what}s")),
        };
        let orthophoto = self.orthophoto.as_ref().map(|of| {
            let [width, height] = of.size_px;
            let [pixel_m, _] = of.map.pixel_size_m();
            let known = if of.is_placed { "" } else { ", place and scale not known" };
            format!("orthophoto of {width} x {height} pixels of {pixel_m:.4} m{known}")
        });
        let drawing = self.drawing.as_ref().map(|of| format!("drawing {}", file_name(&of.file)));
        let zones = counted(self.friction_zones.len(), "friction zone");
        let counts = [counted(self.lanes.len(), "lane"), counted(self.kerbs.len(), "kerb"), zones];
        orthophoto.into_iter().chain(counts.into_iter().flatten()).chain(drawing).collect()
    }
}

/// The name of a file without its folder.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

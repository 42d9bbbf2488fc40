//! Pictures as lines, areas and texts, which are sharp at every size.

/// A picture of lines, areas and texts. Places are counted from its upper left corner, x to the right and y
/// downwards.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorPicture {
    /// Width and height, in the unit of all its lengths.
    pub size: [f32; 2],
    /// What it shows, from back to front.
    pub marks: Vec<VectorMark>,
}

/// A shape, and the part of the picture in which it is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorMark {
    /// Left, top, width, height.
    pub clip: [f32; 4],
    /// What is drawn.
    pub shape: VectorShape,
}

/// A shape of a picture. Colours are red, green, blue and opacity.
#[derive(Debug, Clone, PartialEq)]
pub enum VectorShape {
    /// Lines through points.
    Outline {
        /// The points of each line.
        contours: Vec<Vec<[f32; 2]>>,
        /// Whether the ends of each line meet.
        is_closed: bool,
        /// Colour of the area inside.
        fill: Option<[u8; 4]>,
        /// Width and colour of the lines.
        stroke: Option<(f32, [u8; 4])>,
    },
    /// A text on one line.
    Text {
        /// Where its base line begins.
        at: [f32; 2],
        /// Angle of the base line, rad, clockwise from the horizontal.
        angle_rad: f32,
        /// Size of the font.
        size: f32,
        /// Its colour.
        color: [u8; 4],
        /// The text.
        text: String,
    },
}

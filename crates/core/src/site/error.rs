//! Why a site cannot be read.

use std::path::PathBuf;

use crate::data::{DataError, TomlError};

/// The reason why a site file, or a file that it names, is refused.
#[derive(Debug, thiserror::Error)]
pub enum SiteError {
    /// The site file is wrong at a place.
    #[error(transparent)]
    Toml(#[from] TomlError),
    /// A file cannot be opened or written, is too large or is not text.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A line of a world file is not what it has to be.
    #[error("{}:{line}: is {text:?}, expected {expected}", path.display())]
    WorldFile {
        /// The world file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What stands there.
        text: String,
        /// What is expected.
        expected: &'static str,
    },
    /// The coordinate system of a world file is none that is read, or contradicts the site file.
    #[error("{}: {message}", path.display())]
    Projection {
        /// The file with the coordinate system.
        path: PathBuf,
        /// What is wrong, and what to do.
        message: String,
    },
    /// Nothing says where the pixels of an orthophoto lie.
    #[error(
        "{}: has no world file beside it, expected {name}, or points_px with points_m or distance_m in \
         the site file",
        path.display()
    )]
    NoPlace {
        /// The orthophoto.
        path: PathBuf,
        /// Name of the world file that was looked for.
        name: String,
    },
    /// An orthophoto cannot be decoded.
    #[error("{}: cannot be read as a picture, expected PNG, JPEG or TIFF", path.display())]
    Picture {
        /// The orthophoto.
        path: PathBuf,
        /// The error of the decoder.
        source: image::ImageError,
    },
    /// An orthophoto is too large.
    #[error(
        "{}: has {} x {} pixels, expected at most {limit} in all, which take up to 0.8 GB of memory, and \
         {side} on a side; cut it to the scene or halve its resolution",
        path.display(), size_px[0], size_px[1]
    )]
    TooManyPixels {
        /// The orthophoto.
        path: PathBuf,
        /// Its width and height, pixels.
        size_px: [u32; 2],
        /// The largest permitted number of pixels.
        limit: u64,
        /// The largest permitted width and height, pixels.
        side: u32,
    },
    /// A point of an orthophoto lies outside of it.
    #[error(
        "{}: orthophoto.points_px has [{}, {}], expected a point within the {} x {} pixels of {}",
        path.display(), point_px[0], point_px[1], size_px[0], size_px[1], picture.display()
    )]
    PointOutside {
        /// The site file.
        path: PathBuf,
        /// The orthophoto.
        picture: PathBuf,
        /// The point, pixels.
        point_px: [f64; 2],
        /// Width and height of the orthophoto, pixels.
        size_px: [u32; 2],
    },
    /// A drawing cannot be read.
    #[error("{}: cannot be read as a DXF drawing: {message}", path.display())]
    Drawing {
        /// The drawing.
        path: PathBuf,
        /// What the reader says, with the line of the file.
        message: String,
    },
    /// A drawing does not say in which unit it is.
    #[error(
        "{}: does not say in which unit it is drawn ($INSUNITS), expected unit in [dxf] of the site file",
        path.display()
    )]
    NoUnit {
        /// The drawing.
        path: PathBuf,
    },
    /// A drawing has not the layer that is asked for.
    #[error("{}: has no layer {layer:?}, expected one of {}", path.display(), known.join(", "))]
    NoLayer {
        /// The drawing.
        path: PathBuf,
        /// The layer.
        layer: String,
        /// The layers that have lines.
        known: Vec<String>,
    },
    /// A drawing has too many objects.
    #[error(
        "{}: has {got} objects, expected at most {limit}, which take 1 GB of memory; leave out what the \
         scene does not need",
        path.display()
    )]
    TooManyObjects {
        /// The drawing.
        path: PathBuf,
        /// Number of its objects.
        got: usize,
        /// The largest permitted number of objects.
        limit: usize,
    },
    /// A drawing has too many points.
    #[error("{}: has more than {limit} points; name the layers that are wanted", path.display())]
    TooManyPoints {
        /// The drawing.
        path: PathBuf,
        /// The largest permitted number of points.
        limit: usize,
    },
    /// Surveyed lines and points cannot be read.
    #[error("{}{place}: {message}", path.display())]
    Survey {
        /// The file.
        path: PathBuf,
        /// Where in it, as `:line` or `:line:column`; empty for the whole file.
        place: String,
        /// What is wrong, and what is expected.
        message: String,
    },
    /// A point cloud cannot be read.
    #[error("{}: cannot be read as a point cloud: {message}", path.display())]
    Cloud {
        /// The point cloud.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A point cloud would become too large a picture.
    #[error(
        "{}: spans {:.1} x {:.1} m, {} x {} pixels of {pixel_m} m, expected at most {limit} pixels in all and \
         65535 on a side: a pixel of {least_m} m or more would do, or a smaller part (--within)",
        path.display(), extent_m[0], extent_m[1], size_px[0], size_px[1]
    )]
    Raster {
        /// The point cloud.
        path: PathBuf,
        /// Width and height of what would be drawn, m.
        extent_m: [f64; 2],
        /// The same in pixels.
        size_px: [u64; 2],
        /// Side of a pixel, m.
        pixel_m: f64,
        /// The largest permitted number of pixels.
        limit: u64,
        /// A side of a pixel with which it would be permitted, m.
        least_m: f64,
    },
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// A site file would be larger than one that is read.
    #[error(
        "{}: its lines and points take {bytes} bytes in a site file, of which at most {limit} are read; leave \
         out what the scene does not need, or open it as it is",
        path.display()
    )]
    LongSite {
        /// The file with the lines.
        path: PathBuf,
        /// Bytes of the site file.
        bytes: usize,
        /// The largest that is read.
        limit: u64,
    },
    /// A drawing lies outside of the permitted coordinates.
    #[error(
        "{}: has a point at [{}, {}] m, expected coordinates of -2e7 to 2e7 m; is the unit right?",
        path.display(), at_m[0], at_m[1]
    )]
    FarPoint {
        /// The drawing.
        path: PathBuf,
        /// The point, m.
        at_m: [f64; 2],
    },
}

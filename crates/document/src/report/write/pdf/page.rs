//! What stands on a page, before it is drawn.

use crate::report::PictureContent;

/// Draws a picture into pixels: width, height, RGBA row by row. An error says why it cannot.
pub type Drawing<'a> = dyn Fn(&PictureContent) -> Result<Pixels, String> + Sync + 'a;

/// A picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Red, green, blue, opacity of each pixel, row by row from the top.
    pub rgba: Vec<u8>,
}

/// Colours of text and lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ink {
    /// Text.
    Text,
    /// Headings.
    Heading,
    /// Captions, headers and footers.
    Muted,
    /// What must not be overlooked.
    Warning,
    /// Lines of tables.
    Rule,
    /// The ground behind the header of a table.
    Shade,
    /// The ground behind what must not be overlooked.
    WarningShade,
}

/// Which part of the document something belongs to; `None` for what is repeated or only decoration.
pub(super) type Owner = Option<usize>;

/// Something on a page. Positions are in points from the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Item {
    /// A line of text that begins at a place on its base line.
    Text { at_pt: [f32; 2], size_pt: f32, ink: Ink, is_bold: bool, text: String, owner: Owner },
    /// A filled rectangle: left, top, width, height.
    Fill { rect_pt: [f32; 4], ink: Ink },
    /// A picture by its number among the pictures of the document, likewise.
    Picture { rect_pt: [f32; 4], number: usize, owner: Owner },
}

/// A page.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct PageItems {
    pub items: Vec<Item>,
}

/// A heading for the outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OutlineEntry {
    pub level: u8,
    pub text: String,
    pub page: usize,
    pub y_pt: f32,
}

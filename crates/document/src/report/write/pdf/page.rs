//! What stands on a page, before it is drawn.

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

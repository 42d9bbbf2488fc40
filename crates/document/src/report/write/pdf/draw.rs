//! Draws the pages.

use std::collections::BTreeMap;
use std::num::NonZeroU16;

use krilla::SerializeSettings;
use krilla::color::rgb;
use krilla::configure::{Accessibility, ConfigurationBuilder};
use krilla::destination::XyzDestination;
use krilla::geom::{PathBuilder, Point, Rect, Size, Transform};
use krilla::image::Image;
use krilla::metadata::{DateTime, Metadata};
use krilla::outline::{Outline, OutlineNode};
use krilla::page::PageSettings;
use krilla::paint::{Fill, Stroke};
use krilla::surface::Surface;
use krilla::tagging::{
    Artifact, ArtifactType, ContentTag, Identifier, ListNumbering, SpanTag, TableHeaderScope, Tag,
    TagGroup, TagKind, TagTree,
};
use krilla::text::{GlyphId, KrillaGlyph};

use crate::report::language::words_of;
use crate::report::numbers::fill;
use crate::report::write::pdf::PdfError;
use crate::report::write::pdf::flow::{Flow, MARGIN_PT, Part, Role};
use crate::report::write::pdf::fonts::{Fonts, REPLACEMENT};
use crate::report::write::pdf::page::{Ink, Item, OutlineEntry, Owner, PageItems};
use crate::report::write::pdf::vectors::draw_vectors;
use crate::report::write::pictures::{Drawing, Drawn, Medium, Pixels, drawn_pictures};
use crate::report::{ReportDocument, VectorPicture};

/// Size of header and footer, points.
const SMALL_PT: f32 = 8.5;
/// Width of the stroke around bold letters over their size.
const BOLD: f32 = 0.028;

/// The document as the bytes of a PDF file. They depend on nothing but the document.
///
/// - `drawing`: draws figures; without it, the places of the pictures say that none is drawn.
///
/// # Errors
/// [`PdfError`].
pub fn pdf(document: &ReportDocument, drawing: Option<&Drawing<'_>>) -> Result<Vec<u8>, PdfError> {
    let fonts = Fonts::load()?;
    let pictures = pictures(document, drawing)?;
    let flow = Flow::from_document(document, &fonts)?;
    let [width_pt, height_pt] = flow.size_pt;
    let mut pdf = krilla::Document::new_with(settings()?);
    let mut drawn = Pages { flow: &flow, document, pictures, contents: BTreeMap::new() };
    for (idx, page) in flow.pages.iter().enumerate() {
        let settings = PageSettings::from_wh(width_pt, height_pt)
            .ok_or(PdfError::Page { width_pt, height_pt })?;
        let mut sheet = pdf.start_page_with(settings);
        let mut surface = sheet.surface();
        drawn.page(&mut surface, page);
        drawn.header_and_footer(&mut surface, idx);
        surface.finish();
        sheet.finish();
    }
    pdf.set_tag_tree(drawn.tag_tree());
    pdf.set_outline(outline(&flow.outline));
    pdf.set_metadata(metadata(document));
    Ok(pdf.finish()?)
}

/// A file that says of itself that it can be read by ear (PDF/UA-1), and is checked for it.
fn settings() -> Result<SerializeSettings, PdfError> {
    let builder = ConfigurationBuilder::new().with_accessibility_validator(Accessibility::UA1);
    let configuration = builder.finish()?;
    Ok(SerializeSettings { configuration, ..SerializeSettings::default() })
}

/// A picture as the file holds it.
enum Held {
    Image(Image),
    Vectors(VectorPicture),
}

/// The pictures by their numbers.
fn pictures(
    document: &ReportDocument,
    drawing: Option<&Drawing<'_>>,
) -> Result<BTreeMap<usize, Held>, PdfError> {
    let held = |drawn: Drawn| match drawn {
        Drawn::Pixels(Pixels { size_px: [width, height], rgba }) => {
            Held::Image(Image::from_rgba8(rgba, width, height))
        }
        Drawn::Vectors(picture) => Held::Vectors(picture),
    };
    let drawn = drawn_pictures(document, drawing, Medium::Page)?;
    Ok(drawn.into_iter().map(|(number, drawn)| (number, held(drawn))).collect())
}

fn metadata(document: &ReportDocument) -> Metadata {
    let metadata = Metadata::new()
        .title(document.title.clone())
        .language(document.language.tag().to_owned())
        .creator(format!("impactlab {}", document.program));
    let (year, month, day) = document.day;
    metadata.creation_date(
        DateTime::new(year).month(month).day(day).hour(0).minute(0).second(0).utc_offset_hour(0),
    )
}

/// Headings within headings.
fn outline(entries: &[OutlineEntry]) -> Outline {
    let mut outline = Outline::new();
    let node = |entry: &OutlineEntry| {
        let at = Point::from_xy(MARGIN_PT, entry.y_pt);
        OutlineNode::new(entry.text.clone(), XyzDestination::new(entry.page, at))
    };
    let mut idx = 0;
    while let Some(entry) = entries.get(idx) {
        let mut chapter = node(entry);
        idx += 1;
        while let Some(inner) = entries.get(idx).filter(|inner| inner.level > entry.level) {
            chapter.push_child(node(inner));
            idx += 1;
        }
        outline.push_child(chapter);
    }
    outline
}

struct Pages<'a> {
    flow: &'a Flow<'a>,
    document: &'a ReportDocument,
    pictures: BTreeMap<usize, Held>,
    /// What was drawn of each part.
    contents: BTreeMap<usize, Vec<Identifier>>,
}

impl Pages<'_> {
    fn page(&mut self, surface: &mut Surface<'_>, page: &PageItems) {
        for item in &page.items {
            match item {
                Item::Text { at_pt, size_pt, ink, is_bold, text, owner } => {
                    self.tagged(surface, *owner, |this, surface| {
                        this.text(surface, text, *at_pt, *size_pt, *ink, *is_bold);
                    });
                }
                Item::Fill { rect_pt, ink } => {
                    self.tagged(surface, None, |_, surface| filled(surface, *rect_pt, *ink));
                }
                Item::Picture { rect_pt, number, owner } => {
                    self.tagged(surface, *owner, |this, surface| {
                        this.picture(surface, *rect_pt, *number);
                    });
                }
            }
        }
    }

    /// Draws something as a part of the document, or as decoration.
    fn tagged(
        &mut self,
        surface: &mut Surface<'_>,
        owner: Owner,
        draw: impl FnOnce(&Self, &mut Surface<'_>),
    ) {
        let tag = match owner {
            Some(_) => ContentTag::Span(SpanTag::empty()),
            None => ContentTag::Artifact(Artifact::with_kind(ArtifactType::Other)),
        };
        let id = surface.start_tagged(tag);
        draw(self, surface);
        surface.end_tagged();
        if let Some(owner) = owner {
            self.contents.entry(owner).or_default().push(id);
        }
    }

    /// Draws a line of text.
    fn text(
        &self,
        surface: &mut Surface<'_>,
        text: &str,
        at_pt: [f32; 2],
        size_pt: f32,
        ink: Ink,
        is_bold: bool,
    ) {
        let color = color(ink);
        surface.set_fill(Some(Fill { paint: color.into(), ..Fill::default() }));
        let stroke = Stroke { paint: color.into(), width: BOLD * size_pt, ..Stroke::default() };
        surface.set_stroke(is_bold.then_some(stroke));
        Lettering { fonts: self.flow.fonts, size_pt }.draw(surface, text, at_pt);
        surface.set_stroke(None);
    }

    /// A picture in its place, or a frame that says that it is not drawn.
    fn picture(&self, surface: &mut Surface<'_>, rect_pt: [f32; 4], number: usize) {
        let [left, top, width, height] = rect_pt;
        match (self.pictures.get(&number), Size::from_wh(width, height)) {
            (Some(Held::Vectors(picture)), _) => {
                draw_vectors(surface, rect_pt, picture, self.flow.fonts);
            }
            (Some(Held::Image(image)), Some(size)) => {
                surface.push_transform(&Transform::from_translate(left, top));
                surface.draw_image(image.clone(), size);
                surface.pop();
            }
            _ => {
                filled(surface, rect_pt, Ink::Shade);
                let caption = self.document.pictures().find(|picture| picture.number == number);
                let caption = caption.map_or(String::new(), |picture| picture.caption.clone());
                let words = words_of(self.document.language);
                let text = fill(words.not_drawn, &[("caption", &caption)]);
                let text = self.cut(&text, width - 16.0);
                let at = [left + 8.0, top + 0.5 * height];
                self.text(surface, &text, at, SMALL_PT, Ink::Muted, false);
            }
        }
    }

    /// Name of the case and date above, program and number of the page below.
    fn header_and_footer(&mut self, surface: &mut Surface<'_>, idx: usize) {
        let [width_pt, height_pt] = self.flow.size_pt;
        let inner_pt = width_pt - 2.0 * MARGIN_PT;
        let words = words_of(self.document.language);
        let (page, n) = ((idx + 1).to_string(), self.flow.pages.len().to_string());
        let number = fill(words.page_of, &[("page", &page), ("n", &n)]);
        let program = format!("impactlab {}", self.document.program);
        let date = self.document.date.clone();
        let date_pt = SMALL_PT * self.flow.fonts.width(&date);
        let case = self.cut(&self.document.case, inner_pt - date_pt - 20.0);
        let right = |text: &str| width_pt - MARGIN_PT - SMALL_PT * self.flow.fonts.width(text);
        let (top_pt, bottom_pt) = (37.0, height_pt - 31.0);
        let texts = [
            (case, [MARGIN_PT, top_pt]),
            (date.clone(), [right(&date), top_pt]),
            (program, [MARGIN_PT, bottom_pt]),
            (number.clone(), [right(&number), bottom_pt]),
        ];
        for (text, at) in texts {
            self.tagged(surface, None, |this, surface| {
                this.text(surface, &text, at, SMALL_PT, Ink::Muted, false);
            });
        }
        for y_pt in [top_pt + 5.0, bottom_pt - 11.0] {
            let rect_pt = [MARGIN_PT, y_pt, inner_pt, 0.5];
            self.tagged(surface, None, |_, surface| filled(surface, rect_pt, Ink::Rule));
        }
    }

    /// A text on one line, cut with … where it is wider than that.
    fn cut(&self, text: &str, width_pt: f32) -> String {
        let fonts = self.flow.fonts;
        let text: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if SMALL_PT * fonts.width(&text) <= width_pt {
            return text;
        }
        let mut room = width_pt - SMALL_PT * fonts.width("…");
        let fits = text.chars().take_while(|c| {
            room -= SMALL_PT * fonts.letter(*c).advance;
            room >= 0.0
        });
        fits.collect::<String>() + "…"
    }

    /// The parts of the document in their order, with what was drawn of them.
    fn tag_tree(&self) -> TagTree {
        let mut children: BTreeMap<Owner, Vec<usize>> = BTreeMap::new();
        for (idx, Part { parent, .. }) in self.flow.parts.iter().enumerate() {
            children.entry(*parent).or_default().push(idx);
        }
        let mut tree = TagTree::new().with_lang(Some(self.document.language.tag().to_owned()));
        for idx in children.get(&None).into_iter().flatten() {
            tree.push(self.group(*idx, &children));
        }
        tree
    }

    fn group(&self, idx: usize, children: &BTreeMap<Owner, Vec<usize>>) -> TagGroup {
        let role = self.flow.parts.get(idx).map(|part| &part.role);
        let mut group = TagGroup::new(role.map_or(TagKind::from(Tag::P), tag));
        for id in self.contents.get(&idx).into_iter().flatten() {
            group.push(*id);
        }
        for child in children.get(&Some(idx)).into_iter().flatten() {
            group.push(self.group(*child, children));
        }
        group
    }
}

/// Letters as they are set: their fonts and their size.
pub(super) struct Lettering<'a> {
    pub fonts: &'a Fonts,
    pub size_pt: f32,
}

impl Lettering<'_> {
    /// Draws a text in the colours that are set, each stretch of letters of one font by itself.
    pub fn draw(&self, surface: &mut Surface<'_>, text: &str, [mut x_pt, y_pt]: [f32; 2]) {
        let Self { fonts, size_pt } = *self;
        let text: String = text.chars().map(readable).collect();
        let mut rest = text.as_str();
        while let Some(first) = rest.chars().next() {
            let face = fonts.letter(first).face;
            let is_other = |c: char| fonts.letter(c).face != face;
            let end = rest.find(is_other).unwrap_or(rest.len());
            let (run, behind) = rest.split_at(end);
            rest = behind;
            let mut glyphs = Vec::new();
            let mut width_pt = 0.0;
            for (at, c) in run.char_indices() {
                let letter = fonts.letter(c);
                let range = at..at + c.len_utf8();
                let glyph = GlyphId::new(letter.glyph);
                glyphs.push(KrillaGlyph::new(glyph, letter.advance, 0.0, 0.0, 0.0, range, None));
                width_pt += letter.advance * size_pt;
            }
            if let Some(font) = fonts.font(face) {
                let start = Point::from_xy(x_pt, y_pt);
                surface.draw_glyphs(start, &glyphs, font.clone(), run, size_pt, false);
            }
            x_pt += width_pt;
        }
    }
}

fn tag(role: &Role) -> TagKind {
    match role {
        Role::Heading { level, text } => {
            let level = NonZeroU16::new(u16::from(*level)).unwrap_or(NonZeroU16::MIN);
            Tag::Hn(level, Some(text.clone())).into()
        }
        Role::Paragraph => Tag::P.into(),
        Role::List => Tag::L(ListNumbering::Circle).into(),
        Role::ListItem => Tag::LI.into(),
        Role::ListBody => Tag::LBody.into(),
        Role::Table { summary } => Tag::Table.with_summary(Some(summary.clone())).into(),
        Role::Row => Tag::TR.into(),
        Role::HeaderCell => Tag::TH(TableHeaderScope::Column).into(),
        Role::RowHeaderCell => Tag::TH(TableHeaderScope::Row).into(),
        Role::Cell => Tag::TD.into(),
        Role::Caption => Tag::Caption.into(),
        Role::Figure { alt } => Tag::Figure(Some(alt.clone())).into(),
    }
}

/// A letter, or what stands for one that no reader can say.
fn readable(letter: char) -> char {
    match letter.is_control() || matches!(letter, '\u{FEFF}' | '\u{FFFE}') {
        true => REPLACEMENT,
        false => letter,
    }
}

fn color(ink: Ink) -> rgb::Color {
    let [red, green, blue] = match ink {
        Ink::Text => [20, 20, 20],
        Ink::Heading => [15, 50, 85],
        Ink::Muted => [85, 85, 85],
        Ink::Warning => [150, 60, 0],
        Ink::Rule => [205, 205, 205],
        Ink::Shade => [233, 238, 243],
        Ink::WarningShade => [255, 243, 226],
    };
    rgb::Color::new(red, green, blue)
}

fn filled(surface: &mut Surface<'_>, [left, top, width, height]: [f32; 4], ink: Ink) {
    let Some(rect) = Rect::from_xywh(left, top, width, height) else { return };
    let mut builder = PathBuilder::new();
    builder.push_rect(rect);
    if let Some(path) = builder.finish() {
        surface.set_stroke(None);
        surface.set_fill(Some(Fill { paint: color(ink).into(), ..Fill::default() }));
        surface.draw_path(&path);
    }
}

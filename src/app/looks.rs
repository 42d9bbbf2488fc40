//! The looks of the window: type scale, spacing and icons.
//!
//! **Type.** One family in three sizes, each about 1.25 times the one before: 10 points for what is said
//! beside something else, 13 for everything that is read, 16 for headings. The digits of the family are
//! of one width, so that columns of figures stand below each other.
//!
//! **Space.** Distances are multiples of [`GRID`], with half of it inside buttons and between the lines of a
//! form. A part of a pane is [`PART`] from the next, a pane [`MARGIN`] from its edge.
//!
//! **Icons** are letters of the icon font [Lucide](https://lucide.dev), painted beside words and never in
//! place of them. They are no text: whoever reads the window by its words reads the words alone.

use std::sync::Arc;

use egui::{
    Align2, Atom, Button, Color32, Context, FontData, FontDefinitions, FontFamily, FontId, Margin,
    Response, Style, TextStyle, Ui, Vec2, vec2,
};
pub use lucide_icons::Icon;

/// Step of the spacing, points.
pub const GRID: f32 = 4.0;
/// Distance between two parts of a pane, points.
pub const PART: f32 = 2.0 * GRID;
/// Distance of what a pane shows from its edge, points.
pub const MARGIN: f32 = 2.0 * GRID;

/// Sizes of text, points: beside something else, everything that is read, headings.
const SIZES: [f32; 3] = [10.0, 13.0, 16.0];

/// Name of the icon font.
const ICONS: &str = "lucide";

/// Gives a window its fonts, sizes of text and distances.
pub fn install(context: &Context) {
    let mut fonts = FontDefinitions::default();
    let icons = FontData::from_static(lucide_icons::LUCIDE_FONT_BYTES);
    fonts.font_data.insert(ICONS.to_owned(), Arc::new(icons));
    fonts.families.insert(icon_family(), vec![ICONS.to_owned()]);
    context.set_fonts(fonts);
    context.all_styles_mut(set_scale);
}

fn icon_family() -> FontFamily {
    FontFamily::Name(ICONS.into())
}

fn set_scale(style: &mut Style) {
    let [small, body, heading] = SIZES;
    for (of, font) in &mut style.text_styles {
        font.size = match of {
            TextStyle::Small => small,
            TextStyle::Heading => heading,
            _ => body,
        };
    }
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(2.0 * GRID, GRID);
    spacing.button_padding = vec2(1.5 * GRID, GRID / 2.0);
    spacing.menu_margin = Margin::same(2 * GRID as i8);
    spacing.window_margin = Margin::same(3 * GRID as i8);
    spacing.indent = 4.0 * GRID;
    spacing.interact_size = vec2(10.0 * GRID, 5.0 * GRID);
}

/// An icon for a button or another widget that puts parts in a row, in the colour of its text.
pub fn icon(icon: Icon) -> Atom<'static> {
    let [_, body, _] = SIZES;
    Atom::paint(Vec2::splat(body + 2.0), move |ui, args| {
        paint(ui, icon, args.rect.center(), body + 1.0, args.fallback_text_color);
    })
}

/// Width and height of an icon on the line of a text, points.
pub fn icon_size(ui: &Ui) -> f32 {
    TextStyle::Body.resolve(ui.style()).size + 2.0
}

/// The same in a colour of its own.
pub fn colored_icon(icon: Icon, color: Color32) -> Atom<'static> {
    let [_, body, _] = SIZES;
    Atom::paint(Vec2::splat(body + 2.0), move |ui, args| {
        paint(ui, icon, args.rect.center(), body + 1.0, color);
    })
}

/// An icon on the line of a text, as a part of its own.
pub fn icon_ui(ui: &mut Ui, icon: Icon, color: Color32) -> Response {
    let size = icon_size(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(size), egui::Sense::hover());
    paint(ui, icon, rect.center(), size - 1.0, color);
    response
}

/// An icon before the right end of a line, in the colour of weak text.
///
/// - `end`: x of that end and y of the middle of the line.
pub fn icon_at(ui: &Ui, icon: Icon, end: [f32; 2]) {
    let [right, middle] = end;
    let size = TextStyle::Body.resolve(ui.style()).size + 1.0;
    let center = egui::pos2(right - size, middle);
    paint(ui, icon, center, size, ui.visuals().weak_text_color());
}

/// A button with an icon beside its words.
pub fn icon_button<'a>(of: Icon, text: impl Into<egui::WidgetText>) -> Button<'a> {
    let text: egui::WidgetText = text.into();
    Button::new((icon(of), text))
}

/// Draws nothing in a window that was given no fonts by [`install`].
fn paint(ui: &Ui, icon: Icon, center: egui::Pos2, size: f32, color: Color32) {
    let family = icon_family();
    if !ui.ctx().fonts(|fonts| fonts.definitions().families.contains_key(&family)) {
        return;
    }
    let font = FontId::new(size, family);
    ui.painter().text(center, Align2::CENTER_CENTER, char::from(icon), font, color);
}

#[cfg(test)]
mod tests {
    use egui::RawInput;

    use super::*;

    #[test]
    fn the_font_has_the_icons_and_every_style_the_sizes() {
        let context = Context::default();
        install(&context);
        let output = context.run_ui(RawInput::default(), |ui| {
            ui.add(icon_button(Icon::Car, "Case"));
            let font = FontId::new(13.0, icon_family());
            ui.ctx().fonts_mut(|fonts| {
                for icon in [Icon::Car, Icon::TriangleAlert, Icon::Play, Icon::FolderOpen] {
                    assert!(fonts.has_glyph(&font, char::from(icon)), "{icon}");
                }
            });
        });
        assert!(!output.shapes.is_empty());
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            let style = context.style_of(theme);
            assert_eq!(TextStyle::Small.resolve(&style).size, SIZES[0]);
            assert_eq!(style.spacing.item_spacing, vec2(8.0, 4.0));
        }
    }

    #[test]
    fn digits_are_of_one_width() {
        let context = Context::default();
        install(&context);
        let _ = context.run_ui(RawInput::default(), |ui| {
            for of in [TextStyle::Small, TextStyle::Body, TextStyle::Monospace] {
                let font = of.resolve(ui.style());
                let widths: Vec<f32> = ('0'..='9')
                    .map(|digit| ui.ctx().fonts_mut(|fonts| fonts.glyph_width(&font, digit)))
                    .collect();
                assert!(widths.windows(2).all(|pair| pair[0] == pair[1]), "{of}: {widths:?}");
            }
        });
    }
}

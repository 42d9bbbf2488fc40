//! Colours and line widths for the light and the dark theme.
//!
//! The palette is that of [`OkabeIto2008`](impactlab_core::bibliography::OkabeIto2008), whose colours can be
//! distinguished with any of the common colour-vision deficiencies. Colours that are too pale for a
//! white background or too dark for a black one are shifted in lightness.

use egui::{Color32, Visuals};

use impactlab_core::data::Severity;
use impactlab_document::figure::Role;

/// Width of a plotted line, points.
pub const LINE_WIDTH: f32 = 1.8;
/// Width of a plotted line in the background, points.
pub const THIN_LINE_WIDTH: f32 = 1.0;
/// Opacity of the fill of an outline, 0 to 1.
pub const FILL_OPACITY: f32 = 0.18;

/// Colours of the variants beside the one in the forms, for a light and a dark ground.
const VARIANTS: [([u8; 3], [u8; 3]); 3] = [
    ([150, 110, 0], [225, 190, 80]),
    ([110, 70, 170], [170, 140, 230]),
    ([165, 30, 60], [235, 110, 130]),
];

/// Colour of a role.
///
/// - `dark`: whether the background is dark.
pub fn color(role: Role, dark: bool) -> Color32 {
    let (light_ground, dark_ground) = match role {
        Role::Simulation | Role::ComponentX | Role::Model => ([0, 114, 178], [86, 180, 233]),
        Role::Reference => ([60, 60, 60], [215, 215, 215]),
        Role::Target | Role::LeftWheel => ([0, 128, 96], [0, 190, 140]),
        Role::Striking | Role::ComponentY | Role::Validation => ([213, 94, 0], [240, 130, 50]),
        Role::Resultant => ([60, 60, 60], [225, 225, 225]),
        Role::Pulse => ([170, 80, 140], [220, 145, 190]),
        Role::RightWheel => ([110, 70, 170], [170, 140, 230]),
        Role::Variant(idx) => VARIANTS[idx % VARIANTS.len()],
        Role::Muted => ([150, 150, 150], [120, 120, 120]),
    };
    let [r, g, b] = if dark { dark_ground } else { light_ground };
    Color32::from_rgb(r, g, b)
}

/// Colour of the time cursor.
pub fn cursor_color(dark: bool) -> Color32 {
    color(Role::Pulse, dark)
}

/// Width of the lines of a role, points.
pub fn line_width(role: Role) -> f32 {
    if role == Role::Muted { THIN_LINE_WIDTH } else { LINE_WIDTH }
}

/// Visuals of egui for a theme. The light theme has a plain background, so that figures look the
/// same on screen and on paper.
pub fn visuals(dark: bool) -> Visuals {
    if dark {
        Visuals::dark()
    } else {
        Visuals {
            panel_fill: Color32::from_gray(250),
            extreme_bg_color: Color32::WHITE,
            ..Visuals::light()
        }
    }
}

/// Colour of a data flag of a given severity.
pub fn severity_color(severity: Severity, dark: bool) -> Color32 {
    let (light_ground, dark_ground) = match severity {
        Severity::Info => ([0, 114, 178], [86, 180, 233]),
        Severity::Warning => ([160, 90, 0], [240, 190, 60]),
        Severity::Error => ([190, 30, 45], [255, 120, 110]),
    };
    let [r, g, b] = if dark { dark_ground } else { light_ground };
    Color32::from_rgb(r, g, b)
}

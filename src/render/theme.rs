//! Colours and sizes, for the light and the dark theme.
//!
//! The palette is that of [`OkabeIto2008`](crate::bibliography::OkabeIto2008), whose colours stay
//! apart for people with any of the usual colour-vision deficiencies; those too pale for a white
//! or too dark for a black ground are shifted in lightness.

use egui::{Color32, Visuals};

use crate::data::Severity;
use crate::figure::Role;

/// Width of a plotted line, points.
pub const LINE_WIDTH: f32 = 1.8;
/// Width of a line that stands back, points.
pub const THIN_LINE_WIDTH: f32 = 1.0;
/// Opacity of a filled outline.
pub const FILL_OPACITY: f32 = 0.18;

/// The colour of a role.
pub fn color(role: Role, dark: bool) -> Color32 {
    let (light_ground, dark_ground) = match role {
        Role::Simulation | Role::ComponentX | Role::Model => ([0, 114, 178], [86, 180, 233]),
        Role::Reference => ([60, 60, 60], [215, 215, 215]),
        Role::Target => ([0, 128, 96], [0, 190, 140]),
        Role::Bullet | Role::ComponentY | Role::Validation => ([213, 94, 0], [240, 130, 50]),
        Role::Resultant => ([60, 60, 60], [225, 225, 225]),
        Role::Pulse => ([170, 80, 140], [220, 145, 190]),
        Role::Muted => ([150, 150, 150], [120, 120, 120]),
    };
    let [r, g, b] = if dark { dark_ground } else { light_ground };
    Color32::from_rgb(r, g, b)
}

/// The colour of the time cursor.
pub fn cursor_color(dark: bool) -> Color32 {
    color(Role::Pulse, dark)
}

/// Width of the line of a role, points.
pub fn line_width(role: Role) -> f32 {
    if role == Role::Muted { THIN_LINE_WIDTH } else { LINE_WIDTH }
}

/// egui's visuals with a plain ground, so that figures look the same on screen and on paper.
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

/// Colour of a flag that only informs, warns, or reports an error.
pub fn severity_color(severity: Severity, dark: bool) -> Color32 {
    let (light_ground, dark_ground) = match severity {
        Severity::Info => ([0, 114, 178], [86, 180, 233]),
        Severity::Warning => ([160, 90, 0], [240, 190, 60]),
        Severity::Error => ([190, 30, 45], [255, 120, 110]),
    };
    let [r, g, b] = if dark { dark_ground } else { light_ground };
    Color32::from_rgb(r, g, b)
}

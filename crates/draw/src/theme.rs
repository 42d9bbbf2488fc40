//! Colours and line widths for the light and the dark theme.

use egui::{Color32, Visuals};

use impactlab_core::data::Severity;
use impactlab_document::figure::Role;

/// Width of a plotted line, points.
pub const LINE_WIDTH: f32 = 1.8;
/// Width of a plotted line in the background, points.
pub const THIN_LINE_WIDTH: f32 = 1.0;
/// Opacity of the fill of an outline, 0 to 1.
pub const FILL_OPACITY: f32 = 0.18;

/// Colour of a role.
///
/// - `dark`: whether the background is dark.
pub fn color(role: Role, dark: bool) -> Color32 {
    let [r, g, b] = role.rgb(dark);
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

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_document::figure::N_VARIANT_COLORS;

    /// Least difference of two colours in CIELAB, ΔE of 1976: a person sees one of 2 beside each other, and
    /// has to know a thin line again.
    const LEAST_DIFFERENCE: f64 = 20.0;
    /// Least contrast of a line to its ground (WCAG 2.1, 1.4.11).
    const LEAST_CONTRAST: f64 = 3.0;

    /// What the eye makes of linear red, green and blue: usually, and without the cones for long, medium and
    /// short waves. [`Machado2009`](impactlab_core::bibliography::Machado2009), severity 1.
    const SIGHTS: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
        [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    ];

    fn product(matrix: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    /// Red, green and blue in proportion to the light.
    fn linear(color: Color32) -> [f64; 3] {
        [color.r(), color.g(), color.b()].map(|channel| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// A colour in CIELAB, under daylight D65.
    fn lab(linear: [f64; 3]) -> [f64; 3] {
        let to_xyz = [
            [0.412_456_4, 0.357_576_1, 0.180_437_5],
            [0.212_672_9, 0.715_152_2, 0.072_175_0],
            [0.019_333_9, 0.119_192_0, 0.950_304_1],
        ];
        let xyz = product(&to_xyz, linear.map(|channel| channel.clamp(0.0, 1.0)));
        let f = |share: f64| match share > 216.0 / 24_389.0 {
            true => share.cbrt(),
            false => (24_389.0 / 27.0 * share + 16.0) / 116.0,
        };
        let [x, y, z] = [f(xyz[0] / 0.950_47), f(xyz[1]), f(xyz[2] / 1.088_83)];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let of = |color| {
            let [r, g, b] = linear(color);
            0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
        };
        let (a, b) = (of(a), of(b));
        f64::max(a, b) / f64::min(a, b)
    }

    /// Three colours came again from the fourth variant on.
    #[test]
    fn variants_and_the_simulation_are_told_apart_by_every_eye() {
        let roles: Vec<Role> = (0..N_VARIANT_COLORS).map(Role::Variant).collect();
        for dark in [false, true] {
            let colors: Vec<Color32> =
                roles.iter().chain([&Role::Simulation]).map(|role| color(*role, dark)).collect();
            for (idx, one) in colors.iter().enumerate() {
                let ground = visuals(dark).panel_fill;
                assert!(contrast(*one, ground) >= LEAST_CONTRAST, "{one:?} on {ground:?}");
                for other in &colors[..idx] {
                    for sight in &SIGHTS {
                        let [a, b] = [one, other].map(|of| lab(product(sight, linear(*of))));
                        let apart = difference(a, b);
                        assert!(apart > LEAST_DIFFERENCE, "{one:?} {other:?}: {apart:.1}, {dark}");
                    }
                }
            }
        }
    }
}

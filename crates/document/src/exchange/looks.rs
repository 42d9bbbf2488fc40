//! Names and colours of what a scene shows, for formats that are drawn by other programs.

use crate::scene::SceneRole;

/// The five values of the colours of the index of AutoCAD.
const ACI_VALUES: [f64; 5] = [255.0, 189.0, 129.0, 104.0, 79.0];

/// Name of a role, as it begins the names of layers and materials.
pub fn role_name(role: SceneRole) -> String {
    match role {
        SceneRole::Recorded => "RECORDED".to_owned(),
        SceneRole::Simulated => "SIMULATED".to_owned(),
        SceneRole::Forecast => "FORECAST".to_owned(),
        SceneRole::Striking => "STRIKING".to_owned(),
        SceneRole::Evidence => "EVIDENCE".to_owned(),
        SceneRole::Variant(idx) => format!("VARIANT_{}", idx + 1),
        SceneRole::Muted => "OTHER".to_owned(),
        SceneRole::TireMark => "TYRE_MARK".to_owned(),
        SceneRole::Crush => "CRUSH".to_owned(),
    }
}

/// Colour of a role, 8 bits each for red, green and blue: that of the pictures on a light ground, and red for
/// dented outlines, as they are in the index of AutoCAD.
pub fn role_rgb(role: SceneRole) -> [u8; 3] {
    match role.in_plots() {
        Some(role) => role.rgb(false),
        None if role == SceneRole::Crush => [190, 40, 40],
        None => [40, 40, 40],
    }
}

/// Colour of a role in the index of AutoCAD (ACI).
pub fn role_aci(role: SceneRole) -> u8 {
    match role {
        SceneRole::Simulated => 5,
        SceneRole::Forecast => 3,
        SceneRole::Striking => 30,
        SceneRole::Evidence => 6,
        SceneRole::Recorded => 8,
        SceneRole::Variant(_) => nearest_aci(role_rgb(role)),
        SceneRole::Muted => 9,
        SceneRole::TireMark => 250,
        SceneRole::Crush => 1,
    }
}

/// The colour of the index of AutoCAD that is nearest to a colour, of those that are not grey: 10 to 249.
fn nearest_aci(rgb: [u8; 3]) -> u8 {
    let distance = |aci: &u8| {
        let channels = aci_rgb(*aci).into_iter().zip(rgb);
        channels.map(|(of_index, wanted)| (of_index - f64::from(wanted)).powi(2)).sum::<f64>()
    };
    (10..250).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(7)
}

/// Red, green and blue of a colour of the index of AutoCAD, 10 to 249: 24 hues, each in five values, pure where
/// the number is even, and a third as saturated where it is odd.
fn aci_rgb(aci: u8) -> [f64; 3] {
    let sixth = f64::from(aci / 10 - 1) / 4.0;
    let high = ACI_VALUES[usize::from(aci % 10 / 2)];
    let low = if aci.is_multiple_of(2) { 0.0 } else { high * 2.0 / 3.0 };
    // How far each of red, green and blue is from the hue, in sixths of the circle of hues.
    [5.0, 3.0, 1.0].map(|of_channel| {
        let off = (of_channel + sixth) % 6.0;
        high - (high - low) * f64::min(off, 4.0 - off).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::figure::{N_VARIANT_COLORS, Role};

    #[test]
    fn the_index_of_autocad_has_its_published_colours() {
        for (aci, expected) in [
            (10, [255.0, 0.0, 0.0]),
            (11, [255.0, 170.0, 170.0]),
            (30, [255.0, 127.5, 0.0]),
            (94, [0.0, 129.0, 0.0]),
            (170, [0.0, 0.0, 255.0]),
            (218, [79.0, 0.0, 79.0]),
        ] {
            assert_eq!(aci_rgb(aci), expected, "{aci}");
        }
    }

    /// A forecast and what was found had other colours in a file.
    #[test]
    fn a_role_has_the_colour_of_the_pictures() {
        for (role, in_plots) in
            [(SceneRole::Forecast, Role::Target), (SceneRole::Evidence, Role::Pulse)]
        {
            assert_eq!(role_rgb(role), in_plots.rgb(false), "{role:?}");
        }
    }

    /// All variants had the same.
    #[test]
    fn each_variant_has_a_colour_of_its_own() {
        let roles = || (0..N_VARIANT_COLORS).map(SceneRole::Variant);
        let aci: BTreeSet<u8> = roles().map(role_aci).collect();
        let rgb: BTreeSet<[u8; 3]> = roles().map(role_rgb).collect();
        assert_eq!([aci.len(), rgb.len()], [N_VARIANT_COLORS; 2], "{aci:?} {rgb:?}");
    }
}

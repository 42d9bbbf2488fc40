//! The zones of the ground, as rows of the table of inputs.

use crate::report::InputClass;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::FrictionZone;

/// Most corners of a border that are listed.
const MAX_LISTED: usize = 12;

/// Each zone with its friction and its border.
pub(super) fn zone_rows(zones: &[FrictionZone], wording: &Wording) -> Vec<InputRow> {
    let words = wording.words;
    let unit = Quantity::Length.display_unit(wording.units);
    let corner = |[x, y]: &[f64; 2]| {
        let [x, y] = [x, y].map(|si| wording.fixed(unit.from_si(*si), 2));
        format!("({x}; {y})")
    };
    let row = |zone: &FrictionZone| {
        let listed = zone.border_m.iter().take(MAX_LISTED).map(corner);
        let more = (zone.border_m.len() > MAX_LISTED).then(|| "…".to_owned());
        let corners: Vec<String> = listed.chain(more).collect();
        let values = [
            ("friction", &*wording.given_number(zone.friction)),
            ("corners", &*wording.with_unit(&corners.join(" "), unit.symbol)),
        ];
        InputRow {
            group: words.friction_zones.to_owned(),
            label: wording.given_name(&zone.name),
            value: fill(words.zone_value, &values),
            class: InputClass::Given,
            source: words.source_file.to_owned(),
        }
    };
    zones.iter().map(row).collect()
}

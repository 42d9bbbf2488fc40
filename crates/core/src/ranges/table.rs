//! The list of all ranges.

use crate::ranges::{
    BODIES, CHANNELS, CONTACT, CONTROLS, DATA_SHEET, DRIVERS, EVIDENCE, FORCE_SETTINGS, HAND,
    MOTION, PICTURES, QUESTIONS, RESPONSE_SETTINGS, Range, SITE, TIMES, VEHICLE,
};

/// Ranges that belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeGroup {
    /// What the numbers of the group are about.
    pub title: &'static str,
    /// The ranges; their names differ from each other.
    pub ranges: &'static [Range],
}

/// Every range, in the order in which it is printed.
pub const TABLE: &[RangeGroup] = &[
    MOTION,
    CONTROLS,
    DRIVERS,
    TIMES,
    CONTACT,
    BODIES,
    VEHICLE,
    DATA_SHEET,
    CHANNELS,
    QUESTIONS,
    EVIDENCE,
    HAND,
    SITE,
    PICTURES,
    FORCE_SETTINGS,
    RESPONSE_SETTINGS,
];

impl RangeGroup {
    /// The range of this name; `None` if the group has none.
    pub fn get(&self, name: &str) -> Option<&'static Range> {
        self.ranges.iter().find(|range| range.name == name)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_range_has_a_name_a_meaning_and_room() {
        for group in TABLE {
            let names: BTreeSet<&str> = group.ranges.iter().map(|range| range.name).collect();
            assert_eq!(names.len(), group.ranges.len(), "{}: a name stands twice", group.title);
            for range in group.ranges {
                let Range { name, low, high, meaning, .. } = range;
                assert!(low < high && low.is_finite() && high.is_finite(), "{name}");
                assert!(!meaning.is_empty() && !meaning.contains('('), "{name}: {meaning}");
            }
        }
    }

    #[test]
    fn each_range_holds_its_limits_and_nothing_beyond() {
        for range in TABLE.iter().flat_map(|group| group.ranges) {
            let step = if range.is_whole { 1.0 } else { 1e-9 * (range.high - range.low) };
            for inside in [range.low, range.low + step, range.high - step, range.high] {
                assert!(range.contains(inside), "{}: {inside}", range.name);
            }
            for outside in [
                range.low - step,
                range.high + step,
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                f64::MAX,
                f64::MIN,
            ] {
                assert!(!range.contains(outside), "{}: {outside}", range.name);
            }
        }
    }
}

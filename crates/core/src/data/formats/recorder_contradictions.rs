//! Columns of one change of velocity in a table of an event data recorder that contradict each other.

use crate::data::error::quoted;
use crate::data::formats::recorder::RecordedSide;
use crate::data::formats::recorder_columns::Table563;
use crate::data::formats::recorder_table::{
    ROUNDING_M_S, delta_v_pairs, largest_of, no_delta_v, recorded_delta_v,
};
use crate::data::spelling::{is_delta_v, trailing_unit};
use crate::data::stated_side::stated_side;
use crate::ranges::SPEED;
use crate::units::Quantity;

/// By how much two columns of one change of velocity may differ beyond their rounding, as a share of the larger.
const ALIKE_SHARE: f64 = 0.1;

impl Table563<'_> {
    /// That two columns of one change of velocity contradict each other at their ends.
    pub(super) fn other_ends(
        &self,
        time_s: &[Option<f64>],
        fits: impl Fn(&str) -> bool,
        name: &str,
    ) -> Option<String> {
        let end = |(idx, (key, title)): (usize, (String, &String))| {
            let unit = trailing_unit(title, Quantity::Speed).ok().flatten();
            let unit = unit.filter(|_| fits(&key))?;
            let sign = usual_sign(title);
            let values =
                (self.numbers)(idx).into_iter().map(|value| Some(sign * unit.to_si(value?)));
            let pairs = delta_v_pairs(time_s, &values.collect::<Vec<_>>());
            let is_of_crash = no_delta_v(&pairs).is_none();
            let recorded = recorded_delta_v(&pairs).filter(|_| is_of_crash)?;
            Some((quoted(title), recorded.delta_v_m_s))
        };
        let mut ends = self.keys().into_iter().zip(&self.header).enumerate().filter_map(end);
        let (first, of_first) = ends.next()?;
        let (other, of_other) = ends.find(|(_, of_other)| are_other([of_first, *of_other]))?;
        Some(format!(
            "the change of velocity {name} ends with {of_first:.2} m/s in {first} and with {of_other:.2} m/s in \
             {other}: they contradict each other, and one of them is of another impact, or of another direction"
        ))
    }

    /// That a column with the largest change of velocity contradicts the record of it over time.
    ///
    /// - `pairs`: the record; `words`: its direction, as headers have it.
    pub(super) fn other_largest(
        &self,
        pairs: &[(f64, f64)],
        words: &str,
        name: &str,
    ) -> Option<String> {
        let (_, recorded) = largest_of(pairs)?;
        let fits = |key: &str| {
            is_delta_v(key)
                && key.contains(words)
                && key.contains("maximum")
                && !key.contains("time")
        };
        let mut columns = self.keys().into_iter().zip(&self.header).enumerate();
        let (idx, (_, title)) = columns.find(|(_, (key, _))| fits(key))?;
        let unit = trailing_unit(title, Quantity::Speed).ok().flatten()?;
        let sign = usual_sign(title);
        let values =
            (self.numbers)(idx).into_iter().flatten().map(|value| sign * unit.to_si(value));
        let values = values.filter(|value| SPEED.contains(*value));
        let stated = values.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        // A largest change without a sign may be its size.
        let has_sign = stated < 0.0 || stated_side(title).is_some();
        let stated = if has_sign { stated } else { stated.copysign(recorded) };
        are_other([recorded, stated]).then(|| {
            format!(
                "the largest change of velocity {name} is {recorded:.2} m/s by its record and {stated:.2} m/s by \
                 {}: they contradict each other; the record is read",
                quoted(title)
            )
        })
    }
}

/// By what the numbers of a column are multiplied so that they are positive to the usual side.
fn usual_sign(title: &str) -> f64 {
    if stated_side(title) == Some(RecordedSide::Left) { -1.0 } else { 1.0 }
}

/// Whether two numbers are not of one change of velocity, m/s.
fn are_other([a, b]: [f64; 2]) -> bool {
    (a - b).abs() > ROUNDING_M_S + ALIKE_SHARE * a.abs().max(b.abs())
}

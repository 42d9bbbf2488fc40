//! The numbers of one evaluation of a method.

use crate::hand::HandField;

/// The numbers that a method is evaluated with, SI.
#[derive(Debug, Clone, Copy)]
pub(super) struct HandValues<'a> {
    /// What the numbers are.
    pub fields: &'static [HandField],
    /// The numbers, as many as there are fields.
    pub numbers: &'a [Option<f64>],
    /// Points of a mark, m.
    pub points_m: &'a [[f64; 2]],
}

impl HandValues<'_> {
    /// A number, if it is known.
    pub fn get(&self, key: &str) -> Option<f64> {
        let idx = self.fields.iter().position(|field| field.key == key)?;
        self.numbers.get(idx).copied().flatten()
    }

    /// A number; NaN where it is not known, so that nothing follows from it.
    pub fn number(&self, key: &str) -> f64 {
        self.get(key).unwrap_or(f64::NAN)
    }
}

//! Time series in SI units: what every reader gives and every writer takes.

use std::collections::BTreeMap;

use crate::data::Channel;

/// Columns over a common, strictly rising time axis. All columns are as long as `time_s`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeSeries {
    time_s: Vec<f64>,
    columns: BTreeMap<Channel, Vec<f64>>,
}

/// A column that does not fit its series.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeriesError {
    /// A column is longer or shorter than the time axis.
    #[error("column {} has {got} samples, the time axis {expected}", channel.header())]
    Length {
        /// The column.
        channel: Channel,
        /// Samples on the time axis.
        expected: usize,
        /// Samples in the column.
        got: usize,
    },
    /// Time does not rise.
    #[error("time does not rise at sample {sample_idx}: {before} s, then {after} s")]
    TimeOrder {
        /// Index of the sample that is not later than the one before it.
        sample_idx: usize,
        /// The earlier sample's time, s.
        before: f64,
        /// The later sample's time, s.
        after: f64,
    },
    /// A column that this computation needs is not there.
    #[error("column {} is missing", channel.header())]
    Missing {
        /// The column.
        channel: Channel,
    },
}

impl TimeSeries {
    /// A series without columns.
    ///
    /// # Errors
    /// [`SeriesError::TimeOrder`] if time does not rise strictly (NaN does not rise).
    pub fn new(time_s: Vec<f64>) -> Result<Self, SeriesError> {
        for (i, pair) in time_s.windows(2).enumerate() {
            if pair[0].partial_cmp(&pair[1]) != Some(std::cmp::Ordering::Less) {
                let (before, after) = (pair[0], pair[1]);
                return Err(SeriesError::TimeOrder { sample_idx: i + 1, before, after });
            }
        }
        Ok(Self { time_s, columns: BTreeMap::new() })
    }

    /// Adds or replaces a column.
    ///
    /// # Errors
    /// [`SeriesError::Length`] if it is not as long as the time axis.
    pub fn insert(&mut self, channel: Channel, values: Vec<f64>) -> Result<(), SeriesError> {
        let (expected, got) = (self.time_s.len(), values.len());
        if got != expected {
            return Err(SeriesError::Length { channel, expected, got });
        }
        self.columns.insert(channel, values);
        Ok(())
    }

    /// The time axis, s, strictly rising.
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// A column, if it is there.
    pub fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.columns.get(&channel).map(Vec::as_slice)
    }

    /// A column that must be there.
    ///
    /// # Errors
    /// [`SeriesError::Missing`].
    pub fn require(&self, channel: Channel) -> Result<&[f64], SeriesError> {
        self.get(channel).ok_or(SeriesError::Missing { channel })
    }

    /// The columns that are there, in file order, without the time axis.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        self.columns.keys().copied()
    }

    /// Number of samples.
    pub fn n_samples(&self) -> usize {
        self.time_s.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_must_rise_and_columns_must_fit() {
        assert!(matches!(
            TimeSeries::new(vec![0.0, 0.1, 0.1]),
            Err(SeriesError::TimeOrder { sample_idx: 2, .. })
        ));
        assert!(TimeSeries::new(vec![0.0, f64::NAN]).is_err());
        let mut series = TimeSeries::new(vec![0.0, 0.1]).unwrap();
        let error = series.insert(Channel::Fx, vec![1.0]).unwrap_err();
        assert_eq!(error.to_string(), "column fx_n has 1 samples, the time axis 2");
        series.insert(Channel::Fx, vec![1.0, 2.0]).unwrap();
        assert_eq!(series.require(Channel::Fx).unwrap(), [1.0, 2.0]);
        assert!(series.require(Channel::Fy).is_err());
    }
}

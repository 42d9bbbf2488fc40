//! Time series in SI units: the result of every reader and the input of every writer.

use std::collections::BTreeMap;

use crate::data::Channel;

/// Columns over a common time axis that increases strictly. All columns have the length of the time
/// axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeSeries {
    time_s: Vec<f64>,
    columns: BTreeMap<Channel, Vec<f64>>,
}

/// The reason why columns do not form a time series, or why a column cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeriesError {
    /// The column is longer or shorter than the time axis.
    #[error("column {} has {got} samples, the time axis {expected}", channel.header())]
    Length {
        /// The channel of the column.
        channel: Channel,
        /// Number of samples on the time axis.
        expected: usize,
        /// Number of samples in the column.
        got: usize,
    },
    /// The time does not increase.
    #[error("time does not rise at sample {sample_idx}: {before} s, then {after} s")]
    TimeOrder {
        /// Index of the first sample that is not later than the one before it.
        sample_idx: usize,
        /// Time of the earlier sample, s.
        before: f64,
        /// Time of the later sample, s.
        after: f64,
    },
    /// A recorded motion does not start at t = 0, where its impact begins.
    #[error(
        "the recording starts at {start_s} s, expected 0 s, when the impact begins; shift the time \
         column"
    )]
    Start {
        /// Time of the first sample, s.
        start_s: f64,
    },
    /// A predicted motion ends before the motion that it is compared with.
    #[error(
        "the prediction ends at {end_s} s, expected the end of the reference at {expected_s} s"
    )]
    TooShort {
        /// Last instant of the prediction, s.
        end_s: f64,
        /// Last instant of the reference, s.
        expected_s: f64,
    },
    /// A column that the computation needs is missing.
    #[error("column {} is missing", channel.header())]
    Missing {
        /// The channel of the column.
        channel: Channel,
    },
}

impl TimeSeries {
    /// Creates a series that has a time axis and no columns.
    ///
    /// - `time_s`: instants of the samples, s, strictly increasing.
    ///
    /// # Errors
    /// [`SeriesError::TimeOrder`] if the time does not increase strictly, or if one of several
    /// instants is NaN.
    pub fn new(time_s: Vec<f64>) -> Result<Self, SeriesError> {
        for (i, pair) in time_s.windows(2).enumerate() {
            if pair[0].partial_cmp(&pair[1]) != Some(std::cmp::Ordering::Less) {
                let (before, after) = (pair[0], pair[1]);
                return Err(SeriesError::TimeOrder { sample_idx: i + 1, before, after });
            }
        }
        Ok(Self { time_s, columns: BTreeMap::new() })
    }

    /// Adds a column or replaces the column of this channel.
    ///
    /// - `values`: one value per instant, in the SI unit of the channel.
    ///
    /// # Errors
    /// [`SeriesError::Length`] if the column does not have the length of the time axis.
    pub fn insert(&mut self, channel: Channel, values: Vec<f64>) -> Result<(), SeriesError> {
        let (expected, got) = (self.time_s.len(), values.len());
        if got != expected {
            return Err(SeriesError::Length { channel, expected, got });
        }
        self.columns.insert(channel, values);
        Ok(())
    }

    /// The time axis, s, strictly increasing.
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// Checks that the time starts at 0 to within a tolerance, so that the clock of a motion that is
    /// computed from the first sample on is that of the recording.
    ///
    /// # Errors
    /// [`SeriesError::Start`].
    pub fn check_starts_at_zero(&self, tolerance_s: f64) -> Result<(), SeriesError> {
        match self.time_s.first() {
            Some(&start_s) if start_s.abs() > tolerance_s => Err(SeriesError::Start { start_s }),
            _ => Ok(()),
        }
    }

    /// The column of a channel; `None` if the series does not have it.
    pub fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.columns.get(&channel).map(Vec::as_slice)
    }

    /// The column of a channel that the computation needs.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if the series does not have it.
    pub fn require(&self, channel: Channel) -> Result<&[f64], SeriesError> {
        self.get(channel).ok_or(SeriesError::Missing { channel })
    }

    /// Returns the channels of the columns in the order of [`Channel::ALL`], without the time axis.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        self.columns.keys().copied()
    }

    /// The time axis and the columns in the order of [`TimeSeries::channels`], for whoever is to own them.
    pub fn into_columns(self) -> impl Iterator<Item = (Channel, Vec<f64>)> {
        std::iter::once((Channel::Time, self.time_s)).chain(self.columns)
    }

    /// Number of samples on the time axis.
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

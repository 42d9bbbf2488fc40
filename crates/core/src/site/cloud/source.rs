//! The points of a cloud, one after the other.

use std::io::Read;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::jobs::{Progress, ProgressCallback};
use crate::ranges::SURVEY_COORDINATE;
use crate::site::cloud::las_unit::CloudUnits;
use crate::site::cloud::{e57_points, las_points};
use crate::site::{LengthUnit, SiteError};

/// A format of point clouds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CloudFormat {
    /// LAS, or LAZ, which is LAS compressed.
    Las,
    /// E57.
    E57,
}

impl CloudFormat {
    /// The format of a file that begins with these bytes.
    pub fn from_head(head: &[u8]) -> Option<Self> {
        match () {
            () if head.starts_with(b"LASF") => Some(Self::Las),
            () if head.starts_with(b"ASTM-E57") => Some(Self::E57),
            () => None,
        }
    }

    /// The format of a file; `None` if it is none of them, or cannot be read.
    pub fn from_path(path: &Path) -> Option<Self> {
        let (file, _) = open_file(path, MAX_CLOUD_BYTES).ok()?;
        let mut head = Vec::new();
        file.take(8).read_to_end(&mut head).ok()?;
        Self::from_head(&head)
    }
}

/// A point of a cloud, in the unit and the numbers of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct CloudPoint {
    /// Easting, northing and height.
    pub at: [f64; 3],
    /// Red, green and blue.
    pub color: Option<[f32; 3]>,
    /// Strength of the echo.
    pub intensity: Option<f32>,
}

/// What is in a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudSummary {
    /// Number of points that have a place.
    pub n_points: u64,
    /// Number of points without a place, marked as noise or withdrawn.
    pub n_left_out: u64,
    /// Smallest easting, northing and height, m.
    pub low_m: [f64; 3],
    /// Largest easting, northing and height, m.
    pub high_m: [f64; 3],
    /// Largest number of a colour; `None` for a cloud without colours.
    pub largest_color: Option<f32>,
    /// Largest strength of an echo; `None` for a cloud without.
    pub largest_intensity: Option<f32>,
    /// In which unit its coordinates were taken and why, and that scans may not be registered, in words; `None` for
    /// metres beyond doubt.
    pub unit_note: Option<String>,
}

impl CloudSummary {
    /// In words.
    pub fn contents(&self) -> Vec<String> {
        let ([e0, n0, z0], [e1, n1, z1]) = (self.low_m, self.high_m);
        let color = match (self.largest_color, self.largest_intensity) {
            (Some(_), _) => "with colours",
            (None, Some(_)) => "without colours, with the strength of echoes",
            (None, None) => "without colours",
        };
        vec![
            format!("{} points {color}", self.n_points),
            format!(
                "easting {e0:.2} to {e1:.2} m, northing {n0:.2} to {n1:.2} m, height {z0:.2} to {z1:.2} m"
            ),
        ]
    }
}

/// Height beyond which there is no ground, m.
const HIGHEST_M: f64 = 10_000.0;

/// Reads all points and says what is there.
///
/// - `unit`: of the coordinates of LAS; what the file states, else metres, if `None`. Those of E57 are in metres.
///
/// # Errors
/// [`SiteError::Cloud`], [`SiteError::Data`], [`SiteError::Cancelled`].
pub fn survey_cloud(
    path: &Path,
    format: CloudFormat,
    unit: Option<LengthUnit>,
    report: &mut ProgressCallback<'_>,
) -> Result<CloudSummary, SiteError> {
    let units = CloudUnits::of(path, format, unit)?;
    let mut summary = CloudSummary {
        n_points: 0,
        n_left_out: 0,
        low_m: [f64::MAX; 3],
        high_m: [f64::MIN; 3],
        largest_color: None,
        largest_intensity: None,
        unit_note: units.note.clone(),
    };
    let mut far = None;
    let n_left_out = for_each_point(path, format, report, &mut |point| {
        let at_m = units.in_metres(point.at);
        if !at_m.iter().all(|value| value.is_finite()) {
            summary.n_left_out += 1;
            return;
        }
        if !at_m.iter().all(|value| SURVEY_COORDINATE.contains(*value)) {
            far = far.or(Some(at_m));
        }
        summary.n_points += 1;
        for (axis, value) in at_m.into_iter().enumerate() {
            summary.low_m[axis] = summary.low_m[axis].min(value);
            summary.high_m[axis] = summary.high_m[axis].max(value);
        }
        let brightest = point.color.map(|color| color.into_iter().fold(0.0, f32::max));
        let larger = |known: Option<f32>, new: Option<f32>| match (known, new) {
            (Some(known), Some(new)) => Some(known.max(new)),
            (known, new) => known.or(new),
        };
        summary.largest_color = larger(summary.largest_color, brightest);
        summary.largest_intensity = larger(summary.largest_intensity, point.intensity);
    })?;
    summary.n_left_out += n_left_out;
    // Many files have room for colours and none in it.
    summary.largest_color = summary.largest_color.filter(|largest| *largest > 0.0);
    if let Some([easting_m, northing_m, _]) = far {
        return Err(SiteError::FarPoint { path: path.to_owned(), at_m: [easting_m, northing_m] });
    }
    if summary.n_points == 0 {
        return Err(damaged(path, &"it has no points with a place"));
    }
    let nearest_m = summary.low_m[2].max(-summary.high_m[2]);
    if nearest_m > HIGHEST_M {
        let message = format!(
            "all of its points lie more than {nearest_m:.0} m above or below 0, where no ground is: are its coordinates \
             geocentric, to be brought into a projected system first, or in another unit than {} (--unit)?",
            units.height_word()
        );
        return Err(damaged(path, &message));
    }
    Ok(summary)
}

/// Hands every point of a cloud over that is not marked as noise or withdrawn, and whose place is not said
/// to be invalid.
///
/// - returns how many of those there are.
///
/// # Errors
/// [`SiteError::Cloud`], [`SiteError::Data`], [`SiteError::Cancelled`].
pub(super) fn for_each_point(
    path: &Path,
    format: CloudFormat,
    report: &mut ProgressCallback<'_>,
    take: &mut dyn FnMut(&CloudPoint),
) -> Result<u64, SiteError> {
    let mut go_on =
        |done: u64, total: u64| match report(Progress::new(done, total, "reading points")) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(SiteError::Cancelled),
        };
    // The readers may panic where a file is damaged.
    let read = catch_unwind(AssertUnwindSafe(|| match format {
        CloudFormat::Las => las_points::for_each(path, &mut go_on, take),
        CloudFormat::E57 => e57_points::for_each(path, &mut go_on, take),
    }));
    read.unwrap_or_else(|_| Err(damaged(path, &"it is damaged")))
}

/// Tells of progress and says whether to go on: points that are done, and all.
pub(super) type GoOn<'a> = dyn FnMut(u64, u64) -> Result<(), SiteError> + 'a;

/// The error of a reader, cut to what a person reads.
pub(super) fn damaged(path: &Path, error: &dyn std::fmt::Display) -> SiteError {
    let message = error.to_string();
    let message = message.chars().filter(|letter| !letter.is_control()).take(400).collect();
    SiteError::Cloud { path: path.to_owned(), message }
}

//! The points of E57: all clouds of a file, each with its pose. The checksum of every page is checked as it
//! is read.

use std::io::BufReader;
use std::path::Path;

use e57::{CartesianCoordinate, E57Reader, RecordDataType};

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::SiteError;
use crate::site::cloud::source::{CloudPoint, GoOn, damaged};

/// Points between two reports of progress.
const REPORT_EVERY: u64 = 1 << 16;

/// As [`for_each_point`](super::source::for_each_point).
pub(super) fn for_each(
    path: &Path,
    go_on: &mut GoOn<'_>,
    take: &mut dyn FnMut(&CloudPoint),
) -> Result<u64, SiteError> {
    let wrong = |error: e57::Error| damaged(path, &error);
    let (file, _) = open_file(path, MAX_CLOUD_BYTES)?;
    let mut reader = E57Reader::new(BufReader::new(file)).map_err(wrong)?;
    let clouds = reader.pointclouds();
    let total = clouds.iter().fold(0_u64, |sum, cloud| sum.saturating_add(cloud.records));
    let (mut done, mut n_left_out) = (0_u64, 0);
    for cloud in clouds.iter().filter(|cloud| cloud.records > 0) {
        if !cloud.prototype.iter().any(|record| takes_bits(&record.data_type)) {
            return Err(damaged(path, &format!("its {} points have no numbers", cloud.records)));
        }
        let has_intensity = cloud.has_intensity();
        let mut points = reader.pointcloud_simple(cloud).map_err(wrong)?;
        // The strength of an echo is told from a colour.
        points.intensity_to_color(false);
        for point in points {
            if done.is_multiple_of(REPORT_EVERY) {
                go_on(done, total)?;
            }
            done += 1;
            let point = point.map_err(wrong)?;
            let CartesianCoordinate::Valid { x, y, z } = point.cartesian else {
                n_left_out += 1;
                continue;
            };
            let color = point.color.map(|of| [of.red, of.green, of.blue]);
            let color = color.filter(|color| color.iter().all(|part| part.is_finite()));
            let intensity = point.intensity.filter(|value| has_intensity && value.is_finite());
            take(&CloudPoint { at: [x, y, z], color, intensity });
        }
    }
    go_on(total, total)?;
    Ok(n_left_out)
}

/// Whether a number takes room in the file. Without one that does, the reader would not know how many there
/// are.
fn takes_bits(data_type: &RecordDataType) -> bool {
    match data_type {
        RecordDataType::Single { .. } | RecordDataType::Double { .. } => true,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            max > min
        }
    }
}

//! The points of LAS and LAZ.

use std::io::BufReader;
use std::path::Path;

use las::{PointDataBuilder, Reader};

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::SiteError;
use crate::site::cloud::las_check::CheckedHeader;
use crate::site::cloud::source::{CloudPoint, GoOn, damaged};

/// Points that are in memory at a time, bytes.
const CHUNK_BYTES: u64 = 1 << 20;

/// Classes of noise: low points, and high ones.
const NOISE: [u8; 2] = [7, 18];

/// As [`for_each_point`](super::source::for_each_point).
pub(super) fn for_each(
    path: &Path,
    go_on: &mut GoOn<'_>,
    take: &mut dyn FnMut(&CloudPoint),
) -> Result<u64, SiteError> {
    let mut checked = CheckedHeader::read(path)?;
    let wrong = |error: las::Error| damaged(path, &error);
    let (file, _) = open_file(path, MAX_CLOUD_BYTES)?;
    let mut reader = Reader::new(BufReader::new(file)).map_err(wrong)?;
    checked.check_layers(path, reader.header())?;
    let total = reader.header().number_of_points();
    let mut points = PointDataBuilder::new().for_header(reader.header()).build();
    let n_at_once = (CHUNK_BYTES / (points.record_len() as u64).max(1)).max(1);
    let (mut done, mut n_left_out) = (0, 0);
    while done < total {
        go_on(done, total)?;
        let n = reader.fill_points(n_at_once, &mut points).map_err(wrong)?;
        if n == 0 {
            return Err(damaged(path, &format!("it ends after {done} of {total} points")));
        }
        done += n;
        for point in points.points() {
            let point = point.map_err(wrong)?;
            if point.is_withheld || NOISE.contains(&u8::from(point.classification)) {
                n_left_out += 1;
                continue;
            }
            let color = point.color.map(|of| [of.red, of.green, of.blue].map(f32::from));
            let intensity = Some(f32::from(point.intensity));
            take(&CloudPoint { at: [point.x, point.y, point.z], color, intensity });
        }
    }
    go_on(total, total)?;
    Ok(n_left_out)
}

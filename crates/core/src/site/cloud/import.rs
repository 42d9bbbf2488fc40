//! Writes the ground that a cloud becomes.

use std::io;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::data::{Existing, MAX_RASTER_PIXELS, write_atomically, write_bytes};
use crate::jobs::{Progress, ProgressCallback};
use crate::site::cloud::las_unit::CloudUnits;
use crate::site::cloud::raster::{Raster, is_possible, size_px};
use crate::site::cloud::source::{damaged, for_each_point};
use crate::site::parts::file_name;
use crate::site::{
    CloudFormat, CloudSummary, LengthUnit, Orthophoto, PixelMap, Site, SiteError, SiteOrigin,
    WorldFile, survey_cloud,
};

/// Share of pixels with points below which a coarser resolution is advised.
const SPARSE: f64 = 0.6;

/// Longer side of a cloud below which it is no ground, m.
const SMALLEST_M: f64 = 0.5;

/// Largest number of a colour with 8 bits.
const EIGHT_BITS: f32 = 255.0;

/// How a cloud becomes a ground.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudOptions {
    /// Side of a pixel, m, in the range [`PIXEL_SIZE`](crate::ranges::PIXEL_SIZE).
    pub pixel_m: f64,
    /// Unit of the coordinates of LAS; what the file states, else metres, if `None`.
    pub unit: Option<LengthUnit>,
    /// The part that is drawn: smallest and largest easting and northing, m; all, if `None`.
    pub within_m: Option<[[f64; 2]; 2]>,
    /// Points between these heights alone, m.
    pub heights_m: Option<[f64; 2]>,
}

impl Default for CloudOptions {
    fn default() -> Self {
        Self { pixel_m: 0.05, unit: None, within_m: None, heights_m: None }
    }
}

/// What became of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudReport {
    /// What is in the cloud.
    pub summary: CloudSummary,
    /// Width and height of the pictures, pixels.
    pub size_px: [u32; 2],
    /// Lowest and highest height that is drawn, m.
    pub heights_m: [f64; 2],
    /// Share of the pixels that have points.
    pub filled: f64,
    /// Names of the files that were written, the site file first.
    pub files: Vec<String>,
    /// What whoever uses the ground has to know.
    pub notes: Vec<String>,
}

/// Reads a cloud and writes a site file, an orthophoto and a picture of heights, each with its world file,
/// into a folder.
///
/// - `folder`: an empty one, such as the staging folder of an
///   [`OutputFolder`](crate::data::write::OutputFolder).
///
/// # Errors
/// [`SiteError::Cloud`], [`SiteError::Raster`], [`SiteError::Data`], [`SiteError::Cancelled`].
pub fn import_cloud(
    path: &Path,
    format: CloudFormat,
    options: &CloudOptions,
    folder: &Path,
    report: &mut ProgressCallback<'_>,
) -> Result<CloudReport, SiteError> {
    let halves = |half: u64| {
        move |Progress { done, total, message, .. }: Progress| {
            let done = half.saturating_mul(total).saturating_add(done);
            Progress::new(done, total.saturating_mul(2), message)
        }
    };
    let (first, second) = (halves(0), halves(1));
    let summary = survey_cloud(path, format, options.unit, &mut |of| report(first(of)))?;
    let [low_m, high_m] = options
        .within_m
        .unwrap_or([[summary.low_m[0], summary.low_m[1]], [summary.high_m[0], summary.high_m[1]]]);
    // Of a part that reaches beyond the cloud, what has points.
    let extent_m = [
        std::array::from_fn(|axis| low_m[axis].max(summary.low_m[axis])),
        std::array::from_fn(|axis| high_m[axis].min(summary.high_m[axis])),
    ];
    let mut raster = new_raster(path, extent_m, options.pixel_m, summary.low_m[2])?;
    let (scale, units) =
        (color_scale(format, &summary), CloudUnits::of(path, format, options.unit)?);
    let heights_m = options.heights_m.unwrap_or([f64::MIN, f64::MAX]);
    for_each_point(path, format, &mut |of| report(second(of)), &mut |point| {
        let at_m = units.in_metres(point.at);
        if (heights_m[0]..=heights_m[1]).contains(&at_m[2]) {
            let grey = point.intensity.map(|strength| [strength; 3]);
            let color = match summary.largest_color {
                Some(_) => point.color.unwrap_or([scale; 3]),
                None => grey.unwrap_or_default(),
            };
            raster.take(at_m, color.map(|part| part / scale));
        }
    })?;
    let Some(heights_m) = raster.heights_m() else {
        return Err(damaged(path, &"it has no points within what is to be drawn"));
    };
    let mut made = write(path, (&summary, heights_m), &raster, folder)?;
    made.notes.extend(units.note);
    Ok(made)
}

/// An empty raster, if it is not too large.
fn new_raster(
    path: &Path,
    extent_m: [[f64; 2]; 2],
    pixel_m: f64,
    base_m: f64,
) -> Result<Raster, SiteError> {
    let sides_m = [0, 1].map(|axis| extent_m[1][axis] - extent_m[0][axis]);
    if sides_m.iter().any(|side| *side < 0.0) {
        return Err(damaged(path, &"it has no points within what is to be drawn"));
    }
    let size = size_px(extent_m, pixel_m);
    if is_possible(size) {
        return Ok(Raster::new(extent_m, pixel_m, base_m));
    }
    // The next of 1, 2, 5 mm and their tenfolds that is coarse enough.
    let steps = (-3..6).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10_f64.powi(power)));
    let least_m = steps.into_iter().find(|step| is_possible(size_px(extent_m, *step)));
    Err(SiteError::Raster {
        path: path.to_owned(),
        extent_m: sides_m,
        size_px: size.map(|side| side as u64),
        pixel_m,
        limit: MAX_RASTER_PIXELS,
        least_m: least_m.unwrap_or(f64::MAX),
    })
}

/// The number of the brightest colour, or of the strongest echo.
fn color_scale(format: CloudFormat, summary: &CloudSummary) -> f32 {
    match (summary.largest_color, format) {
        (Some(_), CloudFormat::E57) => 1.0,
        // Some programs write colours of 8 bits into the 16 of the format.
        (Some(largest), CloudFormat::Las) if largest <= EIGHT_BITS => EIGHT_BITS,
        (Some(_), CloudFormat::Las) => f32::from(u16::MAX),
        (None, _) => summary.largest_intensity.unwrap_or(1.0).max(f32::MIN_POSITIVE),
    }
}

const SITE: &str = "site.toml";
const PHOTO: [&str; 2] = ["orthophoto.png", "orthophoto.pgw"];
const HEIGHTS: [&str; 2] = ["heights.png", "heights.pgw"];

fn write(
    path: &Path,
    (summary, heights_m): (&CloudSummary, [f64; 2]),
    raster: &Raster,
    folder: &Path,
) -> Result<CloudReport, SiteError> {
    let [low_m, high_m] = heights_m;
    let is_plain = is_plain(summary);
    let photo = raster.rgba(|color, height_m| match is_plain {
        true => [((height_m - low_m) / (high_m - low_m).max(1e-6)) as f32; 3],
        false => color,
    });
    write_png(folder, PHOTO[0], raster.size_px, &photo, ExtendedColorType::Rgba8)?;
    drop(photo);
    let heights: Vec<u8> =
        raster.heights(heights_m).into_iter().flat_map(u16::to_ne_bytes).collect();
    write_png(folder, HEIGHTS[0], raster.size_px, &heights, ExtendedColorType::L16)?;
    let half_m = raster.pixel_m / 2.0;
    let world = WorldFile {
        per_column_m: [raster.pixel_m, 0.0],
        per_row_m: [0.0, -raster.pixel_m],
        first_pixel_m: [raster.corner_m[0] + half_m, raster.corner_m[1] - half_m],
    };
    for name in [PHOTO[1], HEIGHTS[1]] {
        write_text(folder, name, &world.to_text())?;
    }
    let [_, height] = raster.size_px.map(f64::from);
    let lowest_m = [raster.corner_m[0], raster.corner_m[1] - height * raster.pixel_m];
    let origin = SiteOrigin { survey_m: lowest_m.map(f64::floor), ..SiteOrigin::default() };
    let site = Site {
        name: file_name(path),
        origin: Some(origin),
        orthophoto: Some(Orthophoto {
            file: folder.join(PHOTO[0]),
            world_file: Some(folder.join(PHOTO[1])),
            world_unit: LengthUnit::Metre,
            size_px: raster.size_px,
            map: PixelMap::from_world_file(&world, &origin),
            is_placed: true,
        }),
        ..Site::empty(&folder.join(SITE))
    };
    let text = site.to_toml(folder).map_err(|error| damaged(path, &error))?;
    let head = format!(
        "# Heights {low_m:.3} to {high_m:.3} m in {}: 0 where there is no point, else 1 at the lowest to 65535 \
         at the highest.\n",
        HEIGHTS[0]
    );
    write_text(folder, SITE, &(head + &text))?;
    Ok(CloudReport {
        summary: summary.clone(),
        size_px: raster.size_px,
        heights_m,
        filled: raster.filled(),
        files: [SITE, PHOTO[0], PHOTO[1], HEIGHTS[0], HEIGHTS[1]].map(str::to_owned).to_vec(),
        notes: notes((summary, heights_m), raster, &origin),
    })
}

/// Whether a cloud has neither colours nor echoes, so that its heights are shown.
fn is_plain(summary: &CloudSummary) -> bool {
    summary.largest_color.is_none() && summary.largest_intensity.is_none_or(|echo| echo <= 0.0)
}

/// What whoever uses the ground has to know.
fn notes(
    (summary, [low_m, high_m]): (&CloudSummary, [f64; 2]),
    raster: &Raster,
    origin: &SiteOrigin,
) -> Vec<String> {
    let (filled, [width_m, height_m]) =
        (raster.filled(), raster.size_px.map(|side| f64::from(side) * raster.pixel_m));
    let [easting_m, northing_m] = origin.survey_m;
    let mut notes = vec![
        format!(
            "heights {low_m:.3} to {high_m:.3} m; of each pixel the lowest layer of 0.15 m is shown, {:.0} % of \
             the pixels have points",
            100.0 * filled
        ),
        format!(
            "X is easting less {easting_m} m, Y is northing less {northing_m} m; the picture is {width_m:.1} x \
             {height_m:.1} m"
        ),
    ];
    let side_m = [0, 1].map(|axis| summary.high_m[axis] - summary.low_m[axis]);
    if side_m[0].max(side_m[1]) < SMALLEST_M {
        notes.push(format!(
            "all of its points lie within {:.1} mm: are its coordinates longitude and latitude, to be brought into a \
             projected system first, or in another unit (--unit)?",
            1e3 * side_m[0].max(side_m[1])
        ));
    }
    if filled < SPARSE {
        notes.push("many pixels have no point; larger pixels would show more".to_owned());
    }
    if summary.n_left_out > 0 {
        let n = summary.n_left_out;
        notes.push(format!("points left out: {n} (noise, withdrawn or without a place)"));
    }
    match (summary.largest_color, is_plain(summary)) {
        (Some(_), _) => {}
        (None, false) => notes.push("no colours; the strength of the echoes is shown".to_owned()),
        (None, true) => notes.push("no colours; heights are shown".to_owned()),
    }
    notes
}

fn write_png(
    folder: &Path,
    name: &str,
    [width, height]: [u32; 2],
    pixels: &[u8],
    color: ExtendedColorType,
) -> Result<(), SiteError> {
    write_atomically(&folder.join(name), Existing::Refuse, |out| {
        PngEncoder::new(out).write_image(pixels, width, height, color).map_err(io::Error::other)
    })?;
    Ok(())
}

fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), SiteError> {
    write_bytes(&folder.join(name), Existing::Refuse, text.as_bytes())?;
    Ok(())
}

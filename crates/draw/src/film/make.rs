//! A film from its settings to its file.

use std::io;
use std::path::Path;

use egui::ColorImage;

use crate::film::FrameRenderer;
use crate::film::encoder::FrameEncoder;
use crate::film::frames::standing_camera;
use crate::film::mp4::Mp4Film;
use crate::scene::{Camera, CameraKey, CameraKeyError, ScenePicture, check_keys};
use crate::{Canvas, RenderError};
use impactlab_core::data::{DataError, Existing, Outcome, check_target, write_atomically};
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_core::ranges::{FILM_SIDE, OutOfRange};
use impactlab_document::scene::{FilmInstant, FilmTiming, FilmTimingError};

/// What a film shows.
#[derive(Debug, Clone)]
pub struct Film {
    /// Scene and camera; the time of the picture is not used.
    pub picture: ScenePicture,
    /// Which instants, and how fast.
    pub timing: FilmTiming,
    /// Between which the camera moves, in the order of time; none leaves it as the picture has it.
    pub keys: Vec<CameraKey>,
    /// Size, scale and theme of the frames. Of an MP4 file both sides are even and in [`FILM_SIDE`].
    pub canvas: Canvas,
}

/// The reason why a film was not made.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The instants of the film are wrong.
    #[error(transparent)]
    Timing(#[from] FilmTimingError),
    /// The keys of the camera are wrong.
    #[error(transparent)]
    Keys(#[from] CameraKeyError),
    /// The size of the film is outside the permitted range.
    #[error(transparent)]
    Size(#[from] OutOfRange),
    /// A side of the film has an odd number of pixels.
    #[error(
        "the film is {width} × {height} pixels, expected even numbers, as its colours have half as many"
    )]
    OddSize {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
    },
    /// The encoder fails.
    #[error("the film cannot be encoded")]
    Encoder(#[from] openh264::Error),
    /// The encoder leaves a frame out.
    #[error("the film cannot be encoded: the encoder left a frame out")]
    FrameLeftOut,
    /// The frames do not go into a file.
    #[error("the film cannot be made into an MP4 file: {reason}")]
    Container {
        /// In the words of the library.
        reason: String,
    },
    /// There is no room for the frames until the film is written.
    #[error("the frames of the film cannot be kept until it is written")]
    Temporary(#[source] io::Error),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] DataError),
    /// A picture of a sequence cannot be written.
    #[error(transparent)]
    Picture(#[from] RenderError),
}

impl From<shiguredo_mp4::Error> for FilmError {
    fn from(error: shiguredo_mp4::Error) -> Self {
        Self::Container { reason: error.to_string() }
    }
}

impl From<shiguredo_mp4::mux::MuxError> for FilmError {
    fn from(error: shiguredo_mp4::mux::MuxError) -> Self {
        Self::Container { reason: error.to_string() }
    }
}

impl Film {
    /// The frames of the film, after a check of everything that does not depend on the scene's content.
    ///
    /// # Errors
    /// [`FilmError::Size`], [`FilmError::OddSize`], [`FilmError::Timing`] and [`FilmError::Keys`].
    pub fn instants(&self) -> Result<Vec<FilmInstant>, FilmError> {
        let [width, height] = self.canvas.size_px;
        for side in [width, height] {
            FILM_SIDE.check_count(u64::from(side))?;
        }
        // OpenH264 takes 3840 × 2160 pixels, in either direction.
        FILM_SIDE.at_most(2160.0).check_count(u64::from(width.min(height)))?;
        if !(width.is_multiple_of(2) && height.is_multiple_of(2)) {
            return Err(FilmError::OddSize { width, height });
        }
        self.timed()
    }

    /// The camera of the film where it has no keys, fitted to its scene if it is not placed.
    pub fn standing_camera(&self) -> Camera {
        standing_camera(&self.picture, self.canvas.size_px)
    }

    /// The frames, after a check of times and keys.
    fn timed(&self) -> Result<Vec<FilmInstant>, FilmError> {
        let instants = self.timing.instants(&self.picture.scene)?;
        check_keys(&self.keys, &self.timing)?;
        Ok(instants)
    }

    /// The picture of an instant.
    fn at(&self, instant: &FilmInstant) -> ScenePicture {
        ScenePicture { time_s: instant.time_s, ..self.picture.clone() }
    }
}

/// Makes a film and writes it as MP4. Nothing is written before the last frame is encoded, and nothing
/// if the work is cancelled.
///
/// - `existing`: what happens to a file that exists already;
/// - `report`: told after every frame; cancels the work.
///
/// # Errors
/// [`FilmError`], before any work for a wrong size, wrong times, wrong keys or a path that cannot be
/// written.
pub fn write_film(
    film: &Film,
    path: &Path,
    existing: Existing,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<()>, FilmError> {
    let instants = film.instants()?;
    check_target(path, existing)?;
    let size = film.canvas.size_px.map(|side| side as usize);
    let rate = film.timing.frames_per_s;
    let mut encoder = FrameEncoder::new(size, rate)?;
    let mut mp4 = Mp4Film::new(rate, instants.len())?;
    let drawn = each_frame(film, &instants, report, |_, image| mp4.push(&encoder.encode(image)?))?;
    if matches!(drawn, Outcome::Cancelled) {
        return Ok(Outcome::Cancelled);
    }
    let mut finished = mp4.finish()?;
    write_atomically(path, existing, |out| finished.write(out))?;
    Ok(Outcome::Complete(()))
}

/// Draws the frames of a film as numbered PNG files, `frame-00001.png` and so on.
///
/// - `folder`: where they are written; it holds the part that was drawn if the work is cancelled.
/// - `report`: told after every frame; cancels the work.
///
/// # Errors
/// [`FilmError`], before any work for a wrong size, wrong times or wrong keys.
pub fn write_frames(
    film: &Film,
    folder: &Path,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<()>, FilmError> {
    let instants = film.timed()?;
    each_frame(film, &instants, report, |idx, image| {
        let path = folder.join(format!("frame-{:05}.png", idx + 1));
        let [width, height] = film.canvas.size_px;
        let pixels = image::RgbaImage::from_raw(width, height, image.as_raw().to_vec());
        crate::save_png(&pixels.unwrap_or_default(), &path, Existing::Refuse)?;
        Ok(())
    })
}

/// Draws every frame while the one before it is taken.
///
/// - `take`: given number and pixels of a frame, in their order.
fn each_frame(
    film: &Film,
    instants: &[FilmInstant],
    report: &mut ProgressCallback<'_>,
    mut take: impl FnMut(usize, &ColorImage) -> Result<(), FilmError> + Send,
) -> Result<Outcome<()>, FilmError> {
    let mut renderer = FrameRenderer::new(film.canvas)?.with_keys(film.keys.clone());
    let mut before: Option<(usize, ColorImage)> = None;
    let total = instants.len() as u64;
    for (idx, instant) in instants.iter().enumerate() {
        let picture = film.at(instant);
        let (image, taken) = rayon::join(
            || renderer.draw(&picture, instant.speed).clone(),
            || before.as_ref().map_or(Ok(()), |(idx, image)| take(*idx, image)),
        );
        taken?;
        before = Some((idx, image));
        let message = format!("frame {} of {total}", idx + 1);
        if report(Progress::new(idx as u64 + 1, total, message)).is_break() {
            return Ok(Outcome::Cancelled);
        }
    }
    if let Some((idx, image)) = &before {
        take(*idx, image)?;
    }
    Ok(Outcome::Complete(()))
}

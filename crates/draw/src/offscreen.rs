//! Pictures of figures and user interfaces without a window.

use std::path::{Path, PathBuf};

use egui::epaint::ClippedShape;
use egui::{Color32, Context, FullOutput, Pos2, RawInput, Rect, Ui, Vec2};
use image::RgbaImage;
use rayon::prelude::*;

use crate::{SoftwareRenderer, picture_ui, theme};
use impactlab_core::data::{DataError, Existing, write_atomically};
use impactlab_core::ranges::{OutOfRange, PICTURE_PIXELS, PICTURE_SIDE};
use impactlab_document::figure::Figure;

/// Number of passes after which fonts, plot bounds and layout no longer change.
pub(crate) const SETTLING_PASSES: usize = 4;

/// Size, scale and theme of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Canvas {
    /// Width and height, pixels, each in [`PICTURE_SIDE`], and their product in [`PICTURE_PIXELS`].
    pub size_px: [u32; 2],
    /// Pixels per point; 2 is suitable for print and slides.
    pub scale: f32,
    /// Whether the dark theme is used.
    pub dark: bool,
}

impl Default for Canvas {
    fn default() -> Self {
        Self { size_px: [1920, 1080], scale: 2.0, dark: false }
    }
}

/// Width and height of a frame whose text has the usual size, points.
const FRAME_POINTS: [f32; 2] = [960.0, 540.0];

impl Canvas {
    /// Pixels per point of a picture of a scene in which text takes the same share of the picture at every
    /// size, but is never smaller than on a screen.
    pub fn scene_scale(size_px: [u32; 2]) -> f32 {
        let shares = [0, 1].map(|side| size_px[side] as f32 / FRAME_POINTS[side]);
        shares[0].min(shares[1]).max(1.0)
    }

    /// Width and height, points.
    pub(crate) fn size_points(&self) -> Vec2 {
        let [width, height] = self.size_px;
        Vec2::new(width as f32, height as f32) / self.scale
    }

    /// What a pass over a user interface of this size begins with.
    pub(crate) fn input(&self, pass: usize) -> RawInput {
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size_points())),
            time: Some(pass as f64),
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&input.viewport_id) {
            viewport.native_pixels_per_point = Some(self.scale);
        }
        input
    }

    /// Checks the size, before anything is allocated for it.
    ///
    /// # Errors
    /// [`OutOfRange`].
    pub fn check(&self) -> Result<(), OutOfRange> {
        let [width, height] = self.size_px.map(u64::from);
        PICTURE_SIDE.check_count(width)?;
        PICTURE_SIDE.check_count(height)?;
        PICTURE_PIXELS.check_count(width * height)?;
        Ok(())
    }
}

/// Reason for which a picture could not be drawn or saved.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The size of the picture is outside the permitted range.
    #[error(transparent)]
    Size(#[from] OutOfRange),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] DataError),
}

/// Draws any user interface off screen on the CPU, which gives the same pixels on every machine.
///
/// # Errors
/// [`RenderError::Size`] for a size that [`Canvas::check`] refuses.
pub fn draw_offscreen(canvas: Canvas, ui: impl FnMut(&mut Ui)) -> Result<RgbaImage, RenderError> {
    let mut renderer = SoftwareRenderer::default();
    let (context, output) =
        settled(canvas, ui, |output| renderer.update_textures(&mut output.textures_delta))?;
    let primitives = context.tessellate(output.shapes, output.pixels_per_point);
    let ground = if canvas.dark { Color32::from_gray(27) } else { Color32::WHITE };
    Ok(renderer.draw(&primitives, canvas.size_px, output.pixels_per_point, ground))
}

/// The shapes of a user interface before they become pixels, in points.
///
/// # Errors
/// [`RenderError::Size`] for a size that [`Canvas::check`] refuses.
pub(crate) fn shapes_offscreen(
    canvas: Canvas,
    ui: impl FnMut(&mut Ui),
) -> Result<Vec<ClippedShape>, RenderError> {
    let textures_left_out = |output: &mut FullOutput| output.textures_delta.clear();
    settled(canvas, ui, textures_left_out).map(|(_, output)| output.shapes)
}

/// Runs a user interface until its layout no longer changes.
///
/// - `each`: sees the output of every pass, the last one included.
fn settled(
    canvas: Canvas,
    mut ui: impl FnMut(&mut Ui),
    mut each: impl FnMut(&mut FullOutput),
) -> Result<(Context, FullOutput), RenderError> {
    canvas.check()?;
    let context = Context::default();
    context.set_visuals(theme::visuals(canvas.dark));
    let mut last = FullOutput::default();
    for pass in 0..SETTLING_PASSES {
        last = context.run_ui(canvas.input(pass), &mut ui);
        each(&mut last);
    }
    Ok((context, last))
}

/// Draws a figure below its title and above what restricts it ([`picture_ui`]).
///
/// # Errors
/// [`RenderError::Size`] for a size that [`Canvas::check`] refuses.
pub fn figure_image(figure: &Figure, canvas: Canvas) -> Result<RgbaImage, RenderError> {
    draw_offscreen(canvas, |ui| {
        let frame = egui::Frame::new().inner_margin(12.0);
        frame.show(ui, |ui| picture_ui(ui, figure));
    })
}

/// Draws figures on [`Canvas::default`], several side by side, and saves each as PNG ([`save_png`]).
///
/// - `existing`: what happens to files that exist already.
///
/// # Errors
/// [`RenderError::Write`], as for [`save_png`].
pub fn save_figures(figures: &[(PathBuf, &Figure)], existing: Existing) -> Result<(), RenderError> {
    figures.par_iter().try_for_each(|(path, figure)| {
        save_png(&figure_image(figure, Canvas::default())?, path, existing)
    })
}

/// Saves a picture as PNG. The file is written completely or not at all.
///
/// - `existing`: what happens to a file that exists already.
///
/// # Errors
/// [`RenderError::Write`] if the picture cannot be encoded or the file cannot be written.
pub fn save_png(image: &RgbaImage, path: &Path, existing: Existing) -> Result<(), RenderError> {
    let mut png = std::io::Cursor::new(Vec::new());
    let encoded = image.write_to(&mut png, image::ImageFormat::Png);
    write_atomically(path, existing, |file| {
        encoded.map_err(std::io::Error::other)?;
        file.write_all(png.get_ref())
    })?;
    Ok(())
}

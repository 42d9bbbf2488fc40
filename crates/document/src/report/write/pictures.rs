//! Pictures of a report as pixels.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::report::{PdfError, PictureContent, ReportDocument};

/// Draws a picture into pixels: width, height, RGBA row by row. An error says why it cannot.
pub type Drawing<'a> = dyn Fn(&PictureContent) -> Result<Pixels, String> + Sync + 'a;

/// A picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Red, green, blue, opacity of each pixel, row by row from the top.
    pub rgba: Vec<u8>,
}

/// The pictures of a document by their numbers, drawn side by side; none without a drawing.
pub(super) fn drawn_pictures(
    document: &ReportDocument,
    drawing: Option<&Drawing<'_>>,
) -> Result<BTreeMap<usize, Pixels>, PdfError> {
    let Some(drawing) = drawing else { return Ok(BTreeMap::new()) };
    let all: Vec<_> = document.pictures().collect();
    let drawn = all.into_par_iter().map(|picture| {
        let number = picture.number;
        let failed = |why| PdfError::Picture { number, why };
        let pixels = drawing(&picture.content).map_err(failed)?;
        let [width, height] = pixels.size_px;
        let bytes = u64::from(width) * u64::from(height) * 4;
        if bytes == 0 || bytes != pixels.rgba.len() as u64 {
            return Err(failed("its pixels are not as many as its size says".to_owned()));
        }
        Ok((number, pixels))
    });
    drawn.collect()
}

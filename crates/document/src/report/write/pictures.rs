//! Pictures of a report as they are drawn.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::report::{PdfError, PictureContent, ReportDocument, VectorPicture};

/// Draws a picture for a medium. An error says why it cannot.
pub type Drawing<'a> = dyn Fn(&PictureContent, Medium) -> Result<Drawn, String> + Sync + 'a;

/// What a picture is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Medium {
    /// Whatever shows pixels.
    Screen,
    /// The page of a PDF, which holds lines and letters too. Two plots stand beside each other on it.
    Page,
}

/// A picture as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawn {
    /// As pixels.
    Pixels(Pixels),
    /// As lines, areas and texts; for a page alone.
    Vectors(VectorPicture),
}

/// A picture as pixels: width, height, RGBA row by row.
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
    medium: Medium,
) -> Result<BTreeMap<usize, Drawn>, PdfError> {
    let Some(drawing) = drawing else { return Ok(BTreeMap::new()) };
    let all: Vec<_> = document.pictures().collect();
    let drawn = all.into_par_iter().map(|picture| {
        let number = picture.number;
        let failed = |why| PdfError::Picture { number, why };
        let drawn = drawing(&picture.content, medium).map_err(failed)?;
        check(&drawn, medium).map_err(|why| failed(why.to_owned()))?;
        Ok((number, drawn))
    });
    drawn.collect()
}

/// Checks that a drawing is whole and fits its medium.
fn check(drawn: &Drawn, medium: Medium) -> Result<(), &'static str> {
    match drawn {
        Drawn::Vectors(_) if medium == Medium::Screen => Err("it is not drawn as pixels"),
        Drawn::Vectors(_) => Ok(()),
        Drawn::Pixels(Pixels { size_px: [width, height], rgba }) => {
            let bytes = u64::from(*width) * u64::from(*height) * 4;
            let is_whole = bytes > 0 && bytes == rgba.len() as u64;
            is_whole.then_some(()).ok_or("its pixels are not as many as its size says")
        }
    }
}

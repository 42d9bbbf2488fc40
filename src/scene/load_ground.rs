//! Reads the ground of a scene from a site file and the files that it names.

use std::path::Path;
use std::sync::Arc;

use crate::scene::{GroundPicture, SceneGround};
use crate::site::{PixelMap, Site, SiteError, read_drawing, read_picture};

/// A ground that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedGround {
    /// What the site file says.
    pub site: Site,
    /// What is drawn of it.
    pub ground: Arc<SceneGround>,
    /// What the reader of a picture has to know: what of a drawing is left out, what is not to scale.
    pub notes: Vec<String>,
}

impl LoadedGround {
    /// Reads a site file, or an orthophoto alone, with its picture and its drawing.
    ///
    /// # Errors
    /// [`SiteError`] with the file and the place in it.
    pub fn load(path: &Path) -> Result<Self, SiteError> {
        let site = Site::load(path)?;
        let picture = site.orthophoto.as_ref().map(|of| {
            let picture = read_picture(&of.file)?;
            Ok::<_, SiteError>(Arc::new(GroundPicture::new(&picture, of.map)))
        });
        let drawing = site.drawing.as_ref();
        let drawing = drawing.map(|of| read_drawing(of, &site.origin.unwrap_or_default()));
        let (picture, drawing) = (picture.transpose()?, drawing.transpose()?);
        let mut notes = Vec::new();
        if let Some(of) = site.orthophoto.as_ref().filter(|of| !of.is_placed) {
            notes.push(format!(
                "{}: nothing says where its pixels lie and how large they are; it is shown with 0.05 m \
                 per pixel about the origin",
                of.file.display()
            ));
        }
        if let (Some(drawing), Some(of)) = (&drawing, &site.drawing)
            && !drawing.left_out.is_empty()
        {
            let counts: Vec<String> =
                drawing.left_out.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
            notes.push(format!("{}: not drawn: {}", of.file.display(), counts.join(", ")));
        }
        let ground = Arc::new(SceneGround::of(&site, picture, drawing.as_ref()));
        Ok(Self { site, ground, notes })
    }

    /// The same with the orthophoto somewhere else, of which it is known from now on that it lies there.
    #[must_use]
    pub fn placed(&self, map: PixelMap) -> Self {
        let mut moved = self.clone();
        let Some(of) = &mut moved.site.orthophoto else { return moved };
        (of.map, of.world_file, of.is_placed) = (map, None, true);
        let picture = self.ground.picture.as_ref().map(|picture| Arc::new(picture.placed(map)));
        moved.ground = Arc::new(SceneGround { picture, ..(*self.ground).clone() });
        moved.notes.retain(|note| !note.contains("nothing says where its pixels lie"));
        moved
    }
}

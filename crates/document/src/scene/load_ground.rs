//! Reads the ground of a scene from a site file and the files that it names.

use std::path::Path;
use std::sync::Arc;

use crate::scene::{GroundLineKind, GroundPicture, SceneGround};
use impactlab_core::site::{
    DrawingSummary, PixelMap, Site, SiteError, extent_of, read_drawing, read_picture,
};
use impactlab_core::units::{Quantity, UnitSystem};

/// A ground that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedGround {
    /// What the site file says.
    pub site: Site,
    /// What is drawn of it.
    pub ground: Arc<SceneGround>,
    /// What was read of its drawing.
    pub drawing: Option<DrawingSummary>,
    /// What the reader of a picture has to know: what of a drawing is left out, what is not to scale.
    pub notes: Vec<String>,
}

/// Distance between a scene and its orthophoto or drawing from which on they do not belong together, m.
const FAR_M: f64 = 200.0;

impl LoadedGround {
    /// Reads a site file, or an orthophoto alone, with its picture and its drawing.
    ///
    /// # Errors
    /// [`SiteError`] with the file and the place in it.
    pub fn load(path: &Path) -> Result<Self, SiteError> {
        let site = Site::load(path)?;
        let picture = site.orthophoto.as_ref().map(|orthophoto| {
            let picture = read_picture(&orthophoto.file)?;
            Ok::<_, SiteError>(Arc::new(GroundPicture::new(&picture, orthophoto.map)))
        });
        let drawing = site.drawing.as_ref();
        let drawing = drawing.map(|file| read_drawing(file, &site.origin.unwrap_or_default()));
        let (picture, drawing) = (picture.transpose()?, drawing.transpose()?);
        let mut notes = site.notes.clone();
        if let Some(orthophoto) =
            site.orthophoto.as_ref().filter(|orthophoto| !orthophoto.is_placed)
        {
            notes.push(format!(
                "{}: nothing says where its pixels lie and how large they are; it is shown with 0.05 m \
                 per pixel about the origin",
                orthophoto.file.display()
            ));
        }
        if let (Some(drawing), Some(file)) = (&drawing, &site.drawing) {
            notes.extend(drawing.notes(&file.file));
        }
        let ground = Arc::new(SceneGround::new(&site, picture, drawing.as_ref()));
        let drawing = drawing.map(|drawing| drawing.summary());
        Ok(Self { site, ground, drawing, notes })
    }

    /// What the site consists of, in words.
    pub fn contents(&self, units: UnitSystem) -> Vec<String> {
        self.site.contents(self.drawing.as_ref(), units)
    }

    /// What lies so far from a scene that it cannot be seen in it: an orthophoto or a drawing in survey
    /// coordinates without an origin, or in another unit than it is said to be.
    ///
    /// - `scene_m`: smallest and largest `[X, Y]` of the scene, m;
    /// - `units`: of the distance that is said.
    pub fn far_notes(&self, scene_m: [[f64; 2]; 2], units: UnitSystem) -> Vec<String> {
        let unit = Quantity::Length.display_unit(units);
        let photo = self.site.orthophoto.as_ref().map(|orthophoto| {
            let remedy = "[origin] of the site file, or unit of its world file";
            (&orthophoto.file, gap_m(orthophoto.extent_m(), scene_m), remedy)
        });
        let lines = self.ground.lines.iter().filter(|line| line.kind == GroundLineKind::Drawing);
        let sides = lines.flat_map(|line| line.points_m.windows(2));
        let gaps = sides.filter_map(|side| Some(gap_m(extent_of(side.iter().copied())?, scene_m)));
        let nearest_m = gaps.reduce(f64::min);
        let drawing = self.site.drawing.as_ref().zip(nearest_m).map(|(file, gap_m)| {
            (&file.file, gap_m, "[origin] of the site file, or unit in [dxf]")
        });
        let far = photo.into_iter().chain(drawing).filter(|(_, gap_m, _)| *gap_m > FAR_M);
        far.map(|(file, gap_m, remedy)| {
            format!(
                "{}: lies {:.0} {} away from the scene, so that nothing of it is seen there; is {remedy} \
                 missing or wrong?",
                file.display(),
                unit.from_si(gap_m),
                unit.symbol
            )
        })
        .collect()
    }

    /// The same with the orthophoto somewhere else, of which it is known from now on that it lies there.
    #[must_use]
    pub fn placed(&self, map: PixelMap) -> Self {
        let mut moved = self.clone();
        let Some(orthophoto) = &mut moved.site.orthophoto else { return moved };
        (orthophoto.map, orthophoto.world_file, orthophoto.is_placed) = (map, None, true);
        let picture = self.ground.picture.as_ref().map(|picture| Arc::new(picture.placed(map)));
        moved.ground = Arc::new(SceneGround { picture, ..(*self.ground).clone() });
        moved.notes.retain(|note| !note.contains("nothing says where its pixels lie"));
        moved
    }
}

/// Distance between two rectangles along X and Y, each by its smallest and largest `[X, Y]`, m; 0 where
/// they overlap.
fn gap_m(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| (a[0][axis] - b[1][axis]).max(b[0][axis] - a[1][axis]).max(0.0));
    x.hypot(y)
}

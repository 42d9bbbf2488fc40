//! What a GeoTIFF says of its place and its unit by keys of its own. The world file beside it says where it is shown;
//! the keys are compared with that, and say the unit that a world file lacks.
//!
//! Source: OGC 19-008r4, GeoTIFF 1.1, annex B and C.

use std::io::BufReader;
use std::path::Path;

use tiff::decoder::Decoder;
use tiff::tags::Tag;

use crate::data::{MAX_PICTURE_BYTES, open_file};
use crate::site::cloud::{StatedUnit, of_keys};
use crate::site::parts::file_name;
use crate::site::{LengthUnit, Orthophoto, PixelMap, SiteOrigin, WorldFile};

/// The key that says whether coordinates are of the corner of a pixel or of its middle, and its value for the latter.
const RASTER_TYPE: u16 = 1025;
const PIXEL_IS_POINT: u16 = 2;

/// Pixels by which both places may differ: whether corners or middles of pixels are meant makes half of one.
const REACH_PX: f64 = 1.0;

/// The keys of a picture.
#[derive(Debug, Default)]
struct Keys {
    /// Where its pixels lie, in the unit of its coordinate system.
    map: Option<PixelMap>,
    /// What its coordinate system says of that unit.
    unit: Option<StatedUnit>,
}

/// What the coordinate system of a picture says of its unit; `None` of one that is no GeoTIFF.
pub(super) fn stated_in(picture: &Path) -> Option<StatedUnit> {
    keys(picture)?.unit
}

/// That the keys of a picture place it elsewhere than its world file.
pub(super) fn note(orthophoto: &Orthophoto) -> Option<String> {
    let Orthophoto { file, world_file, world_unit, size_px, .. } = orthophoto;
    let world_file = world_file.as_ref()?;
    let Keys { map, unit } = keys(file)?;
    let unit = match unit {
        Some(StatedUnit::Length(unit)) => unit,
        _ => *world_unit,
    };
    let own = in_metres(map?, unit);
    let world = WorldFile::load(world_file, *world_unit).ok()?;
    let world = PixelMap::from_world_file(&world, &SiteOrigin::default());
    let end = size_px.map(f64::from);
    let far_m = [[0.0, 0.0], end].map(|at| {
        let [own, world] = [own.ground_m(at), world.ground_m(at)];
        (own[0] - world[0]).hypot(own[1] - world[1])
    });
    let far_m = far_m[0].max(far_m[1]);
    let [width_m, height_m] = world.pixel_size_m();
    (far_m > REACH_PX * width_m.max(height_m)).then(|| {
        format!(
            "{}: its own keys place it {far_m:.2} m from where {} does; the world file counts: check which of them is \
             of this picture",
            file_name(file),
            file_name(world_file)
        )
    })
}

fn in_metres(map: PixelMap, unit: LengthUnit) -> PixelMap {
    let metres = |pair: [f64; 2]| pair.map(|value| value * unit.length_m());
    PixelMap {
        corner_m: metres(map.corner_m),
        per_column_m: metres(map.per_column_m),
        per_row_m: metres(map.per_row_m),
    }
}

fn keys(picture: &Path) -> Option<Keys> {
    let (file, _) = open_file(picture, MAX_PICTURE_BYTES).ok()?;
    let mut decoder = Decoder::new(BufReader::new(file)).ok()?;
    let directory = decoder.find_tag(Tag::GeoKeyDirectoryTag).ok()??.into_u16_vec().ok()?;
    let value = |wanted: u16| {
        // A key, the tag that holds its value or 0, how many values there are, and the value.
        let mut entries = directory.chunks_exact(4).skip(1);
        entries.find_map(|entry| match *entry {
            [id, 0, 1, value] if id == wanted => Some(value),
            _ => None,
        })
    };
    let mut numbers = |tag| decoder.find_tag(tag).ok()??.into_f64_vec().ok();
    let matrix = numbers(Tag::ModelTransformationTag);
    let scale = numbers(Tag::ModelPixelScaleTag);
    let tie_point = numbers(Tag::ModelTiepointTag);
    let map = match (matrix.as_deref(), scale.as_deref(), tie_point.as_deref()) {
        (Some(&[a, b, _, x, d, e, _, y, ..]), ..) => {
            Some(PixelMap { corner_m: [x, y], per_column_m: [a, d], per_row_m: [b, e] })
        }
        (None, Some(&[width, height, ..]), Some(&[column, row, _, x, y, _])) => Some(PixelMap {
            corner_m: [x - column * width, y + row * height],
            per_column_m: [width, 0.0],
            per_row_m: [0.0, -height],
        }),
        _ => None,
    };
    let shift = if value(RASTER_TYPE) == Some(PIXEL_IS_POINT) { -0.5 } else { 0.0 };
    let map = map.map(|map| PixelMap { corner_m: map.ground_m([shift, shift]), ..map });
    let stated = of_keys(value);
    // One of two feet, which have to be told apart by whoever knows.
    let in_feet = stated.system_in_feet().map(|_| StatedUnit::Other);
    Some(Keys { map, unit: stated.plane.or(in_feet) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::Site;
    use tiff::encoder::{TiffEncoder, colortype::Gray8};

    /// A picture of 20 x 10 pixels of 0.1 with its left top corner at (500, 900).
    fn write(path: &Path, keys: &[u16]) {
        let mut file = std::fs::File::create(path).unwrap();
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        let mut image = encoder.new_image::<Gray8>(20, 10).unwrap();
        let directory = image.encoder();
        directory.write_tag(Tag::ModelPixelScaleTag, &[0.1, 0.1, 0.0][..]).unwrap();
        let tie_point = [0.0, 0.0, 0.0, 500.0, 900.0, 0.0];
        directory.write_tag(Tag::ModelTiepointTag, &tie_point[..]).unwrap();
        directory.write_tag(Tag::GeoKeyDirectoryTag, keys).unwrap();
        image.write_data(&[128; 200]).unwrap();
    }

    const IN_METRES: [u16; 12] = [1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9001];
    const IN_SURVEY_FEET: [u16; 12] = [1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9003];

    #[test]
    fn keys_that_contradict_the_world_file_are_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("road.tif");
        write(&path, &IN_METRES);
        let notes = |world: &str| {
            std::fs::write(folder.path().join("road.tfw"), world).unwrap();
            Site::load(&path).unwrap().notes
        };
        assert!(notes("0.1\n0\n0\n-0.1\n500.05\n899.95\n").is_empty());
        // A world file with the corner in place of the middle is half a pixel off.
        assert!(notes("0.1\n0\n0\n-0.1\n500\n900\n").is_empty());
        let elsewhere = notes("0.1\n0\n0\n-0.1\n530.05\n899.95\n");
        assert!(
            elsewhere[0].contains("place it 30.00 m from where road.tfw does"),
            "{elsewhere:?}"
        );
        assert_eq!(notes("0.2\n0\n0\n-0.2\n500.1\n899.9\n").len(), 1);
    }

    #[test]
    fn keys_say_the_unit_that_a_world_file_lacks() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("road.tif");
        std::fs::write(folder.path().join("road.tfw"), "0.1\n0\n0\n-0.1\n500.05\n899.95\n")
            .unwrap();
        write(&path, &IN_SURVEY_FEET);
        let site = Site::load(&path).unwrap();
        assert_eq!(site.orthophoto.unwrap().world_unit, LengthUnit::SurveyFoot);
        assert!(site.notes.is_empty(), "{:?}", site.notes);
        // A file beside it with the statistics of the picture says nothing of a system.
        let statistics = folder.path().join("road.tif.aux.xml");
        std::fs::write(
            &statistics,
            "<PAMDataset><MDI key=\"STATISTICS_MEAN\">91</MDI></PAMDataset>",
        )
        .unwrap();
        let site = Site::load(&path).unwrap();
        assert_eq!(site.orthophoto.unwrap().world_unit, LengthUnit::SurveyFoot);
        std::fs::remove_file(&statistics).unwrap();
        // A system of State Plane in one of two feet, and one that is not known here.
        write(&path, &[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2225]);
        let error = Site::load(&path).unwrap_err().to_string();
        assert!(error.contains("unit of its coordinates is not known here; say it"), "{error}");
        write(&path, &[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2056]);
        assert_eq!(Site::load(&path).unwrap().orthophoto.unwrap().world_unit, LengthUnit::Metre);
        // Longitude and latitude.
        write(&path, &[1, 1, 0, 1, 1024, 0, 1, 2]);
        assert!(Site::load(&path).unwrap_err().to_string().contains("road.tif: its coordinates"));
    }
}

//! The ground of a scene: site files, world files, drawings and pictures.

use std::path::Path;

use image::ImageFormat;
use impactlab_core::site::{
    DrawingFile, LengthUnit, PixelMap, Site, SiteOrigin, WorldFile, picture_size_px, read_drawing,
    read_picture,
};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

fn text_format(
    (name, n_inputs): (&'static str, u64),
    file_name: &'static str,
    load: &dyn Fn(&Path) -> Answer,
) {
    let (seeds, mutate) = (Vec::new(), Mutator::text);
    run(&Format { name, n_inputs, file_name, names_file: true, seeds, mutate, load });
}

#[test]
fn site_files() {
    text_format(("site", 8_000), "site.toml", &|path| match Site::load(path) {
        Ok(site) => Answer::accepted(&(&site, site.north_rad(), site.contents(None))),
        Err(error) => Answer::refused(&error),
    });
}

#[test]
fn world_files() {
    text_format(("world-file", 8_000), "road.pgw", &|path| match WorldFile::load(
        path,
        LengthUnit::Foot,
    ) {
        Ok(world) => {
            let map = PixelMap::from_world_file(&world, &SiteOrigin::default());
            Answer::accepted(&(world, map, map.pixel([0.0, 0.0])))
        }
        Err(error) => Answer::refused(&error),
    });
}

#[test]
fn drawings() {
    text_format(("dxf", 1_500), "survey.dxf", &|path| {
        let unit = Some(LengthUnit::Metre);
        let of = DrawingFile { file: path.to_owned(), unit, layers: None };
        match read_drawing(&of, &SiteOrigin::default()) {
            Ok(drawing) => Answer::accepted(&drawing),
            Err(error) => Answer::refused(&error),
        }
    });
}

#[test]
fn pictures() {
    pictures_of(("picture", "road.png"), &[ImageFormat::Png, ImageFormat::Jpeg], 0);
}

/// The decoder of TIFF makes tables of up to a million values of a tag, whatever the size of the file,
/// before it can be given a limit.
#[test]
fn tiff_pictures() {
    pictures_of(("tiff", "road.tif"), &[ImageFormat::Tiff], 256 << 20);
}

/// - `fixed_bytes`: memory that the decoder takes whatever the size of the file, bytes.
fn pictures_of(
    (name, file_name): (&'static str, &'static str),
    formats: &[ImageFormat],
    fixed_bytes: u64,
) {
    let picture = image::RgbImage::from_fn(9, 7, |x, y| image::Rgb([x as u8, y as u8, 90]));
    let seed = |format: &ImageFormat| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, *format).expect("a picture in memory");
        bytes.into_inner()
    };
    let load = |path: &Path| match picture_size_px(path) {
        // A picture may state more pixels than the memory that a test may take.
        Ok([width, height]) if u64::from(width) * u64::from(height) > 1 << 20 => {
            Answer::accepted(&[width, height])
        }
        Ok(size) => match read_picture(path) {
            Ok(_) => Answer::accepted(&size),
            Err(error) => Answer::refused(&error),
        },
        Err(error) => Answer::refused(&error),
    };
    run(&Format {
        name,
        n_inputs: 3_000,
        file_name,
        names_file: true,
        seeds: formats.iter().map(seed).collect(),
        mutate: changed_bytes,
        load: &|path| Answer { fixed_bytes, ..load(path) },
    });
}

/// The file with a few other bytes.
fn changed_bytes(mutator: &mut Mutator, input: &[u8], _other: &[u8]) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..1 + mutator.below(6) {
        let (at, value) = (mutator.below(bytes.len().max(1)), mutator.below(256));
        if let Some(byte) = bytes.get_mut(at) {
            *byte = value as u8;
        }
    }
    bytes
}

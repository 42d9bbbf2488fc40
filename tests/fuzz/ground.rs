//! The ground of a scene: site files, world files, drawings and pictures.

use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;

use image::ImageFormat;
use impactlab_core::site::{
    CloudFormat, DrawingFile, LengthUnit, PixelMap, Site, SiteOrigin, SurveyFormat, SurveyOptions,
    WorldFile, picture_size_px, read_drawing, read_picture, survey_cloud,
};
use impactlab_core::units::UnitSystem;

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
        Ok(site) => {
            Answer::accepted(&(&site, site.north_rad(), site.contents(None, UnitSystem::Si)))
        }
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
fn maps_in_kml() {
    surveys_of("kml", "map.kml", SurveyFormat::Kml);
}

#[test]
fn maps_in_geojson() {
    surveys_of("geojson", "map.geojson", SurveyFormat::GeoJson);
}

#[test]
fn surveyed_points() {
    surveys_of("survey-table", "points.csv", SurveyFormat::Table);
}

fn surveys_of(name: &'static str, file_name: &'static str, format: SurveyFormat) {
    let options = SurveyOptions::default();
    text_format(
        (name, 4_000),
        file_name,
        &|path| match Site::from_survey(path, format, &options) {
            Ok(site) => Answer::accepted(&(&site, site.contents(None, UnitSystem::Si))),
            Err(error) => Answer::refused(&error),
        },
    );
}

#[test]
fn las_clouds() {
    clouds_of(("las", "scan.las"), CloudFormat::Las, vec![las(0, false), las(7, false)]);
}

#[test]
fn laz_clouds() {
    clouds_of(("laz", "scan.laz"), CloudFormat::Las, vec![las(3, true), las(7, true)]);
}

#[test]
fn e57_clouds() {
    clouds_of(("e57", "scan.e57"), CloudFormat::E57, vec![e57()]);
}

fn clouds_of(
    (name, file_name): (&'static str, &'static str),
    format: CloudFormat,
    seeds: Vec<Vec<u8>>,
) {
    run(&Format {
        name,
        n_inputs: 2_000,
        file_name,
        names_file: true,
        seeds,
        mutate: if format == CloudFormat::E57 { resealed_bytes } else { changed_bytes },
        load: &|path| {
            let read = survey_cloud(path, format, None, &mut |_| ControlFlow::Continue(()));
            match read {
                Ok(summary) => Answer::accepted(&summary),
                Err(error) => Answer::refused(&error),
            }
        },
    });
}

/// A LAS file of a few points.
fn las(format: u8, is_compressed: bool) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).expect("a format");
    builder.point_format.is_compressed = is_compressed;
    let format = builder.point_format;
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).expect("a writer");
    for idx in 0..40_u16 {
        let color = las::Color { red: idx, green: 200, blue: 40 };
        let point = las::Point {
            x: f64::from(idx) * 0.25,
            y: 3.5,
            z: 0.01 * f64::from(idx),
            intensity: idx,
            gps_time: format.has_gps_time.then_some(f64::from(idx)),
            color: format.has_color.then_some(color),
            ..las::Point::default()
        };
        writer.write_point(point).expect("a point");
    }
    writer.into_inner().expect("a file").into_inner()
}

/// An E57 file of a few points.
fn e57() -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").expect("a writer");
    let records = vec![
        e57::Record::CARTESIAN_X_F64,
        e57::Record::CARTESIAN_Y_F64,
        e57::Record::CARTESIAN_Z_F64,
    ];
    let mut cloud = writer.add_pointcloud("cloud", records).expect("a cloud");
    for idx in 0..40 {
        let at = [f64::from(idx), 2.0, 0.5].map(e57::RecordValue::Double);
        cloud.add_point(at.to_vec()).expect("a point");
    }
    cloud.finalize().expect("a cloud");
    writer.finalize().expect("a file");
    drop(writer);
    file.into_inner()
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

/// The same with the checksum of every page of E57 put right.
fn resealed_bytes(mutator: &mut Mutator, input: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = changed_bytes(mutator, input, other);
    for page in bytes.chunks_exact_mut(1024) {
        let (content, checksum) = page.split_at_mut(1020);
        checksum.copy_from_slice(&crc32c(content).to_be_bytes());
    }
    bytes
}

/// The checksum of Castagnoli, by its definition.
fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |mut crc, byte| {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0x82f6_3b78 } else { crc >> 1 };
        }
        crc
    })
}

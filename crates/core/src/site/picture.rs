//! Decodes orthophotos.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use image::{ImageDecoder, ImageFormat, ImageReader, Limits, RgbaImage};

use crate::data::{DataError, MAX_PICTURE_BYTES, MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE, open_file};
use crate::site::SiteError;

/// Endings of the names of pictures that are read, with their formats.
const ENDINGS: [(&str, ImageFormat); 5] = [
    ("png", ImageFormat::Png),
    ("jpg", ImageFormat::Jpeg),
    ("jpeg", ImageFormat::Jpeg),
    ("tif", ImageFormat::Tiff),
    ("tiff", ImageFormat::Tiff),
];

/// Memory of a decoder that does not depend on the size of the picture, bytes.
const DECODER_BYTES: u64 = 16 << 20;

/// First bytes of the pictures that are read: PNG, JPEG and both byte orders of TIFF.
const SIGNATURES: [&[u8]; 4] = [b"\x89PNG", b"\xff\xd8\xff", b"II*\0", b"MM\0*"];

/// Whether a path is a picture that is read as an orthophoto, by its first bytes or by its ending.
pub fn is_picture_file(path: &Path) -> bool {
    format_of(path).is_some() || {
        let mut head = Vec::new();
        let read = |(file, _): (File, u64)| file.take(4).read_to_end(&mut head).ok();
        open_file(path, MAX_PICTURE_BYTES).ok().and_then(read).is_some() && is_picture(&head)
    }
}

/// Whether a file that begins with these bytes is a picture.
pub fn is_picture(head: &[u8]) -> bool {
    SIGNATURES.iter().any(|signature| head.starts_with(signature))
}

fn format_of(path: &Path) -> Option<ImageFormat> {
    let ending = path.extension()?.to_str()?;
    ENDINGS.iter().find(|(known, _)| known.eq_ignore_ascii_case(ending)).map(|(_, format)| *format)
}

/// Width and height of a picture by its header, pixels, without decoding it.
///
/// # Errors
/// [`SiteError::Picture`], [`SiteError::TooManyPixels`], [`SiteError::Data`].
pub fn picture_size_px(path: &Path) -> Result<[u32; 2], SiteError> {
    let (width, height) = decoder(path)?.dimensions();
    checked_size(path, [width, height])
}

/// Reads a picture whole. Its size is checked before anything is allocated for its pixels.
///
/// # Errors
/// [`SiteError::Picture`], [`SiteError::TooManyPixels`], [`SiteError::Data`].
pub fn read_picture(path: &Path) -> Result<RgbaImage, SiteError> {
    let wrong = |source| SiteError::Picture { path: path.to_owned(), source };
    let mut decoder = decoder(path)?;
    let (width, height) = decoder.dimensions();
    checked_size(path, [width, height])?;
    let mut limits = Limits::default();
    // Up to 16 bits of 4 colours, and what the decoder needs beside them. The size is that of the header,
    // so that a small file of a small picture makes no decoder take much.
    limits.max_alloc = Some(9 * u64::from(width) * u64::from(height) + DECODER_BYTES);
    decoder.set_limits(limits).map_err(wrong)?;
    Ok(image::DynamicImage::from_decoder(decoder).map_err(wrong)?.into_rgba8())
}

fn decoder(path: &Path) -> Result<impl ImageDecoder, SiteError> {
    let wrong = |source| SiteError::Picture { path: path.to_owned(), source };
    let (mut file, _) = open_file(path, MAX_PICTURE_BYTES)?;
    // The content decides which format it is, since names are wrong sometimes; other formats than those
    // of the names are refused.
    let mut head = [0; 8];
    let n = file.read(&mut head).map_err(|source| DataError::io(path, source))?;
    let format = image::guess_format(&head[..n]).map_err(wrong)?;
    let is_read = ENDINGS.iter().any(|(_, known)| *known == format);
    if !is_read {
        let hint = image::error::ImageFormatHint::Exact(format);
        return Err(wrong(image::ImageError::Unsupported(hint.into())));
    }
    let file = open_file(path, MAX_PICTURE_BYTES)?.0;
    ImageReader::with_format(BufReader::new(file), format).into_decoder().map_err(wrong)
}

fn checked_size(path: &Path, size_px: [u32; 2]) -> Result<[u32; 2], SiteError> {
    let [width, height] = size_px.map(u64::from);
    let is_long = size_px.iter().any(|side| *side > MAX_PICTURE_SIDE);
    if is_long || width * height > MAX_PICTURE_PIXELS {
        let path = path.to_owned();
        let (limit, side) = (MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE);
        return Err(SiteError::TooManyPixels { path, size_px, limit, side });
    }
    Ok(size_px)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn png_jpeg_and_tiff_are_read_by_their_content() {
        let folder = tempfile::tempdir().unwrap();
        let picture = image::RgbImage::from_pixel(9, 5, image::Rgb([200, 100, 50]));
        for (name, format) in [
            ("a.png", ImageFormat::Png),
            ("a.jpg", ImageFormat::Jpeg),
            ("a.tif", ImageFormat::Tiff),
            ("jpeg by name.tif", ImageFormat::Png),
        ] {
            let path = folder.path().join(name);
            picture.save_with_format(&path, format).unwrap();
            assert_eq!(picture_size_px(&path).unwrap(), [9, 5], "{name}");
            let Rgba(color) = *read_picture(&path).unwrap().get_pixel(4, 2);
            let off =
                color.into_iter().zip([200, 100, 50, 255]).map(|(a, b): (u8, u8)| a.abs_diff(b));
            assert!(off.max().unwrap() < 4, "{name}: {color:?}");
        }
    }

    #[test]
    fn a_huge_picture_is_refused_by_its_header() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("huge.png");
        for [width, height] in [[100_000_u32, 100_000], [8193, 8192], [70_000, 1]] {
            // A PNG of as many pixels in 60 bytes: nothing is allocated for them.
            let mut header = b"IHDR".to_vec();
            header.extend(width.to_be_bytes());
            header.extend(height.to_be_bytes());
            header.extend([8, 6, 0, 0, 0]);
            let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
            bytes.extend(&header);
            bytes.extend(crc32(&header).to_be_bytes());
            bytes.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e");
            std::fs::write(&path, bytes).unwrap();
            for error in [picture_size_px(&path).unwrap_err(), read_picture(&path).unwrap_err()] {
                let text = error.to_string();
                let expected =
                    format!("huge.png: has {width} x {height} pixels, expected at most 67108864");
                assert!(text.contains(&expected), "{text}");
            }
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        for (name, content) in [
            ("text.png", &b"not a picture"[..]),
            ("empty.png", b""),
            ("cut.png", b"\x89PNG\r\n\x1a\n"),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            let error = read_picture(&path).unwrap_err().to_string();
            assert!(error.contains(&format!("{name}: cannot be read as a picture")), "{error}");
        }
        let missing = read_picture(&folder.path().join("none.png")).unwrap_err().to_string();
        assert!(missing.contains("none.png: does not exist"), "{missing}");
    }

    /// The check sum of PNG, by its definition.
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |mut crc, byte| {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
            }
            crc
        })
    }
}

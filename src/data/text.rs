//! Reads the bytes of a text file and converts them to text: it refuses files that are too large or
//! binary, recognises the encoding and unifies the ends of lines.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

use crate::data::DataError;

/// Size of the largest file that is read, bytes.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// Number of bytes that are checked for binary content before the rest of the file is read.
const FIRST_BLOCK_BYTES: u64 = 64 << 10;

/// The text of a file, without a byte order mark, with lines that end in `\n`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    pub text: String,
    pub encoding: &'static str,
}

/// Reads a text file in UTF-8, or in UTF-16 with a byte order mark. Bytes that are neither are read
/// as Windows-1252, which contains the printable characters of Latin-1.
///
/// # Errors
/// [`DataError`] if the path cannot be read or is a folder, or if the file is too large or not
/// text.
pub(crate) fn read_text(path: &Path) -> Result<Text, DataError> {
    let to_error = |source| DataError::io(path, source);
    let metadata = std::fs::metadata(path).map_err(to_error)?;
    if metadata.is_dir() {
        let path = path.to_owned();
        return Err(DataError::IsDirectory { path });
    }
    let mut file = File::open(path).map_err(to_error)?;
    let mut content = Vec::new();
    (&mut file).take(FIRST_BLOCK_BYTES).read_to_end(&mut content).map_err(to_error)?;
    refuse_binary(path, &content)?;
    if metadata.len() > MAX_FILE_BYTES {
        return Err(DataError::TooLarge {
            path: path.to_owned(),
            bytes: metadata.len(),
            limit: MAX_FILE_BYTES,
        });
    }
    file.take(MAX_FILE_BYTES).read_to_end(&mut content).map_err(to_error)?;
    refuse_binary(path, &content)?;
    Ok(decode(&content))
}

fn decode(bytes: &[u8]) -> Text {
    let (encoding, bom) = Encoding::for_bom(bytes).unwrap_or_else(|| match str::from_utf8(bytes) {
        Ok(_) => (UTF_8, 0),
        Err(_) => (WINDOWS_1252, 0),
    });
    let (text, _) = encoding.decode_without_bom_handling(bytes.get(bom..).unwrap_or_default());
    let text = match text.contains('\r') {
        true => text.replace("\r\n", "\n").replace('\r', "\n"),
        false => text.into_owned(),
    };
    let encoding = encoding.name();
    Text { text, encoding }
}

/// Refuses bytes that contain control characters other than tab, the ends of lines, form feed and
/// the end-of-file character of DOS. Text in UTF-16 with a byte order mark is not checked.
///
/// # Errors
/// [`DataError::NotText`] at the first such byte.
fn refuse_binary(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    if Encoding::for_bom(bytes).is_some_and(|(encoding, _)| encoding != UTF_8) {
        return Ok(());
    }
    let is_binary = |byte: &u8| matches!(byte, 0..=8 | 0x0e..=0x19 | 0x1b..=0x1f);
    match bytes.iter().enumerate().find(|(_, byte)| is_binary(byte)) {
        None => Ok(()),
        Some((offset, &byte)) => Err(DataError::NotText { path: path.to_owned(), offset, byte }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_and_line_ends_become_the_same_text() {
        let utf16: Vec<u8> = "\u{feff}a;°\nb".encode_utf16().flat_map(u16::to_le_bytes).collect();
        for (bytes, encoding) in [
            (&b"a;\xc2\xb0\nb"[..], "UTF-8"),
            (b"\xef\xbb\xbfa;\xc2\xb0\r\nb", "UTF-8"),
            (b"a;\xb0\rb", "windows-1252"),
            (&utf16, "UTF-16LE"),
        ] {
            let text = decode(bytes);
            assert_eq!((&*text.text, text.encoding), ("a;°\nb", encoding));
        }
    }
}

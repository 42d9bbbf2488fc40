//! Bytes become text: size limit, binary files, encodings, line ends.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

use crate::data::DataError;

/// Largest file that is read, bytes.
pub const MAX_FILE_BYTES: u64 = 512 << 20;

/// Bytes looked at before the rest of a file is read.
const FIRST_BLOCK_BYTES: u64 = 64 << 10;

/// A file's text: without byte order mark, lines ending in `\n`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    pub text: String,
    pub encoding: &'static str,
}

/// Reads a text file in UTF-8, in UTF-16 with a byte order mark, or else in Windows-1252 (of which
/// Latin-1's printing characters are a part).
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

/// Text has no control characters but tab, line ends, form feed and the end mark of DOS.
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

//! Reads the bytes of a text file and converts them to text: it refuses files that are too large or
//! binary, recognises the encoding and unifies the ends of lines.

use std::io::Read;
use std::path::Path;

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

use crate::data::foreign::refuse_known_binary;
use crate::data::{DataError, open_file};

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
/// - `limit`: size of the largest file that is read, bytes.
///
/// # Errors
/// [`DataError`] if the path is no regular file or cannot be read, or if the file is too large or
/// not text.
pub(crate) fn read_text(path: &Path, limit: u64) -> Result<Text, DataError> {
    let to_error = |source| DataError::io(path, source);
    let (mut file, bytes) = open_file(path, u64::MAX)?;
    let mut content = Vec::with_capacity(usize::try_from(bytes.min(limit)).unwrap_or(0));
    (&mut file).take(FIRST_BLOCK_BYTES).read_to_end(&mut content).map_err(to_error)?;
    refuse_known_binary(path, &content)?;
    refuse_binary(path, &content)?;
    if bytes > limit {
        return Err(DataError::TooLarge { path: path.to_owned(), bytes, limit });
    }
    file.take(limit).read_to_end(&mut content).map_err(to_error)?;
    refuse_binary(path, &content)?;
    Ok(decode(content))
}

/// Text in UTF-8 is taken as it is, so that it is held once only.
fn decode(bytes: Vec<u8>) -> Text {
    let (encoding, bom) = Encoding::for_bom(&bytes).unwrap_or((UTF_8, 0));
    let is_plain = encoding == UTF_8 && bom == 0;
    let decoded = match is_plain {
        true => String::from_utf8(bytes).map_err(|error| (WINDOWS_1252, error.into_bytes())),
        false => Err((encoding, bytes)),
    };
    match decoded {
        Ok(text) => Text { text: with_line_feeds(text), encoding: UTF_8.name() },
        Err((encoding, bytes)) => {
            let rest = bytes.get(bom..).unwrap_or_default();
            let text = encoding.decode_without_bom_handling(rest).0.into_owned();
            drop(bytes);
            Text { text: with_line_feeds(text), encoding: encoding.name() }
        }
    }
}

fn with_line_feeds(mut text: String) -> String {
    if text.contains("\r\n") {
        text = text.replace("\r\n", "\n");
    }
    if text.contains('\r') {
        text = text.replace('\r', "\n");
    }
    text
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
            let text = decode(bytes.to_vec());
            assert_eq!((&*text.text, text.encoding), ("a;°\nb", encoding));
        }
    }
}

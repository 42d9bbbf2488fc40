//! What stands in a DXF drawing of which its reader does not know the kind: it passes over it, so that it is looked for
//! here.

use crate::site::drawing::is_binary;

/// Kinds that the reader knows; what is not drawn of them is counted where it is met.
const KNOWN: [&str; 42] = [
    "3DFACE",
    "3DLINE",
    "3DSOLID",
    "ACAD_PROXY_ENTITY",
    "ARC",
    "ARCALIGNEDTEXT",
    "ATTDEF",
    "ATTRIB",
    "BODY",
    "CIRCLE",
    "DGNUNDERLAY",
    "DIMENSION",
    "DWFUNDERLAY",
    "ELLIPSE",
    "HELIX",
    "IMAGE",
    "INSERT",
    "LEADER",
    "LIGHT",
    "LINE",
    "LWPOLYLINE",
    "MLINE",
    "MTEXT",
    "OLE2FRAME",
    "OLEFRAME",
    "PDFUNDERLAY",
    "POINT",
    "POLYLINE",
    "RAY",
    "REGION",
    "RTEXT",
    "SECTION",
    "SEQEND",
    "SHAPE",
    "SOLID",
    "SPLINE",
    "TEXT",
    "TOLERANCE",
    "TRACE",
    "VERTEX",
    "WIPEOUT",
    "XLINE",
];

/// Characters of a name of a layer or a kind; programs allow fewer.
const MAX_NAME: usize = 255;

/// Layer and kind of what the reader passes over in the drawing itself, not in its blocks and not on the sheets that it
/// is printed on. A binary drawing is not searched.
pub(super) fn unread_entities(bytes: &[u8]) -> Vec<(String, String)> {
    if is_binary(bytes) {
        return Vec::new();
    }
    let text = |bytes: &[u8]| -> String {
        let letters = String::from_utf8_lossy(bytes);
        letters.chars().filter(|letter| !letter.is_control()).take(MAX_NAME).collect()
    };
    let mut lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    let (mut found, mut in_entities, mut is_open) = (Vec::new(), false, false);
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        match (code, value) {
            (b"2", b"ENTITIES") => in_entities = true,
            (b"0", b"ENDSEC") if in_entities => break,
            (b"0", kind) if in_entities => {
                let kind = text(kind);
                is_open = !KNOWN.contains(&kind.as_str());
                if is_open {
                    found.push((String::new(), kind));
                }
            }
            // On a sheet, or invisible.
            (b"67" | b"60", b"1") if is_open => {
                found.pop();
                is_open = false;
            }
            (b"8", layer) if is_open => {
                if let Some((of, _)) = found.last_mut() {
                    *of = text(layer);
                }
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_that_the_reader_does_not_know_are_found() {
        let text = "0\nSECTION\n2\nBLOCKS\n0\nHATCH\n8\nB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
            0\nLINE\n8\nA\n0\nAECC_FEATURE_LINE\n5\n1\n8\nKERB\n0\nVIEWPORT\n67\n1\n8\n0\n\
            0\nHATCH\n8\nROAD\n0\nHATCH\n8\nROAD\n60\n1\n0\nXLINE\n8\nA\n0\nENDSEC\n0\nTABLE\n";
        let expected = [("KERB", "AECC_FEATURE_LINE"), ("ROAD", "HATCH")];
        let expected = expected.map(|(layer, kind)| (layer.to_owned(), kind.to_owned()));
        assert_eq!(unread_entities(text.as_bytes()), expected);
        assert_eq!(unread_entities(text.replace('\n', "\r\n").as_bytes()), expected);
        assert!(unread_entities(b"").is_empty());
    }
}

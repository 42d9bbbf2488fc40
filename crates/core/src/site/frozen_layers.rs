//! Which layers of a DXF drawing are frozen.
//!
//! The reader of drawings drops the flags of a layer (group code 70), whose lowest bit says that it is
//! frozen: then nothing on it is shown, while it may be switched on. So the table of layers is read here.

use crate::site::drawing::is_binary;

/// Flag of a frozen layer in group code 70.
const FROZEN: i64 = 1;

/// Whether each layer is frozen, in the order of the drawing's table; `None` for a binary drawing, which is
/// not searched.
pub(super) fn frozen_layers(bytes: &[u8]) -> Option<Vec<bool>> {
    if is_binary(bytes) {
        return None;
    }
    let mut lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    let (mut is_frozen, mut in_tables, mut in_layer) = (Vec::new(), false, false);
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        match (code, value) {
            (b"2", b"TABLES") => in_tables = true,
            (b"0", b"ENDSEC") if in_tables => break,
            (b"0", kind) => {
                in_layer = in_tables && kind == b"LAYER";
                if in_layer {
                    is_frozen.push(false);
                }
            }
            (b"70", flags) if in_layer => {
                let flags = std::str::from_utf8(flags).ok().and_then(|text| text.parse().ok());
                let frozen = flags.is_some_and(|flags: i64| flags & FROZEN != 0);
                if let Some(last) = is_frozen.last_mut() {
                    *last = frozen;
                }
            }
            _ => {}
        }
    }
    Some(is_frozen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_flag_of_a_layer_freezes_it() {
        let text = "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n3\n\
            0\nLAYER\n2\nROAD\n70\n0\n62\n7\n0\nLAYER\n2\nOLD\n70\n     5\n62\n7\n\
            0\nLAYER\n2\nLOCKED\n70\n4\n0\nENDTAB\n0\nENDSEC\n\
            0\nSECTION\n2\nENTITIES\n0\nLAYER\n70\n1\n0\nEOF\n";
        let expected = Some(vec![false, true, false]);
        assert_eq!(frozen_layers(text.as_bytes()), expected);
        assert_eq!(frozen_layers(text.replace('\n', "\r\n").as_bytes()), expected);
        assert_eq!(frozen_layers(b"AutoCAD Binary DXF\r\n\x1a\0"), None);
        assert_eq!(frozen_layers(b""), Some(Vec::new()));
    }
}

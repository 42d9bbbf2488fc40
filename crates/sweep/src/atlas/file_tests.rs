//! Atlases as files: what is written is read back, and hostile files are refused.

use super::*;
use crate::atlas::make::test_rows::{axes, rows};

fn atlas() -> Atlas {
    Atlas::from_rows(&rows(3000), axes(7)).unwrap()
}

#[test]
fn what_is_written_is_read_back_and_has_the_same_bytes() {
    let atlas = atlas();
    let bytes = atlas.to_bytes().unwrap();
    let read = Atlas::from_bytes(&bytes).unwrap();
    assert_eq!(read, atlas);
    assert_eq!(read.to_bytes().unwrap(), bytes);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.atlas");
    atlas.write(&path, Existing::Refuse).unwrap();
    assert_eq!(Atlas::read(&path).unwrap(), atlas);
    assert!(atlas.write(&path, Existing::Refuse).is_err());
}

/// The same file with one part replaced, or without it.
fn with_part(bytes: &[u8], name: &str, content: Option<Vec<u8>>) -> Vec<u8> {
    let mut old = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut new = ZipWriter::new(Cursor::new(Vec::new()));
    for i in 0..old.len() {
        let mut entry = old.by_index(i).unwrap();
        let entry_name = entry.name().unwrap().into_owned();
        let mut part = Vec::new();
        entry.read_to_end(&mut part).unwrap();
        if entry_name == name {
            let Some(content) = &content else { continue };
            part.clone_from(content);
        }
        new.start_file(entry_name.as_str(), SimpleFileOptions::default()).unwrap();
        new.write_all(&part).unwrap();
    }
    new.finish().unwrap().into_inner()
}

#[test]
fn a_hostile_file_is_refused() {
    let atlas = atlas();
    let (n, bytes) = (atlas.n_cells(), atlas.to_bytes().unwrap());
    let refused = |bytes: &[u8]| Atlas::from_bytes(bytes).unwrap_err();
    assert!(matches!(refused(b""), AtlasFileError::Zip { .. }));
    assert!(matches!(refused(&bytes[..bytes.len() / 2]), AtlasFileError::Zip { .. }));
    let missing = with_part(&bytes, "rows.npy", None);
    assert!(matches!(refused(&missing), AtlasFileError::Zip { .. }));
    let part = |name, content| with_part(&bytes, name, Some(content));
    // A part that unpacks to far more than it can have.
    let bomb = part("rows.npy", vec![0; 50 << 20]);
    assert!(bomb.len() < 1 << 20, "{} bytes", bomb.len());
    assert!(matches!(refused(&bomb), AtlasFileError::TooLarge { .. }));
    let short = part("rows.npy", npy::of_counts(&[1], [1, 1]));
    assert!(matches!(refused(&short), AtlasFileError::NotThisArray { .. }));
    let falling: Vec<u32> = (0..n as u32).rev().collect();
    let falling = part("cell.npy", npy::of_counts(&falling, [n, 1]));
    assert!(matches!(refused(&falling), AtlasFileError::Contradiction { .. }));
    let beyond: Vec<u32> = (0..n as u32).map(|i| i + 1000).collect();
    let beyond = part("cell.npy", npy::of_counts(&beyond, [n, 1]));
    assert!(matches!(refused(&beyond), AtlasFileError::Contradiction { .. }));
    let more = part("inside.npy", npy::of_counts(&vec![70_000; n], [n, 1]));
    assert!(matches!(refused(&more), AtlasFileError::Contradiction { .. }));
    let [_, _, mean, m2] = names(Outcome::TravelM);
    let infinite = part(&mean, npy::of_numbers(&vec![f32::INFINITY; n]));
    assert!(matches!(refused(&infinite), AtlasFileError::NotFinite { .. }));
    let negative = part(&m2, npy::of_numbers(&vec![-1.0; n]));
    assert!(matches!(refused(&negative), AtlasFileError::Contradiction { .. }));
}

#[test]
fn a_head_that_asks_for_too_much_is_refused() {
    let bytes = atlas().to_bytes().unwrap();
    let with = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut head = serde_json::to_value(atlas().head()).unwrap();
        change(&mut head);
        let head = serde_json::to_vec(&head).unwrap();
        Atlas::from_bytes(&with_part(&bytes, HEAD, Some(head))).unwrap_err()
    };
    let cells = with(&|head| head["n_cells"] = 4_000_000_000_u64.into());
    assert!(matches!(cells, AtlasFileError::Cells { .. }), "{cells}");
    let format = with(&|head| head["format"] = 9.into());
    assert!(matches!(format, AtlasFileError::Format { got: 9 }), "{format}");
    let rows = with(&|head| head["n_rows"] = 1.into());
    assert!(matches!(rows, AtlasFileError::Contradiction { .. }), "{rows}");
    let edges = with(&|head| head["axes"][0]["edges"] = serde_json::json!([1.0, 1.0]));
    assert!(matches!(edges, AtlasFileError::Axes(_)), "{edges}");
    let key = with(&|head| head["more"] = 1.into());
    assert!(matches!(key, AtlasFileError::Head(_)), "{key}");
}

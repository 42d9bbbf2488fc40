//! The column maps that the user has chosen, by the header of the file, so that the next file with
//! the same header needs no dialog.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use impactlab_core::data::{ColumnMap, Table};

/// Number of maps that are kept; the oldest ones are forgotten.
const MAX_MAPS: usize = 100;

/// The column maps of earlier files, the newest first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ColumnMaps {
    maps: Vec<RememberedMap>,
}

/// A column map with the header for which it was chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct RememberedMap {
    /// Digest of names and units, [`Table::fingerprint`].
    fingerprint: String,
    /// The file that was opened with the map last.
    path: PathBuf,
    map: ColumnMap,
}

impl ColumnMaps {
    /// Keeps the map with which a file was opened. It replaces the map of the same header and that
    /// of the same path.
    pub fn keep(&mut self, path: PathBuf, fingerprint: String, map: ColumnMap) {
        self.maps.retain(|entry| entry.fingerprint != fingerprint && entry.path != path);
        self.maps.insert(0, RememberedMap { fingerprint, path, map });
        self.maps.truncate(MAX_MAPS);
    }

    /// The map with which this file was opened last; `None` if there is none, or if the header of
    /// the file is another one now. The file is read if it was opened with a map.
    pub fn find_by_path(&self, path: &Path) -> Option<ColumnMap> {
        let entry = self.maps.iter().find(|entry| entry.path == path)?;
        (fingerprint(path, &entry.map)? == entry.fingerprint).then(|| entry.map.clone())
    }

    /// The map that was chosen for a file with the same header. The file is read.
    pub fn find_by_header(&self, path: &Path) -> Option<ColumnMap> {
        let mut read: Vec<(&ColumnMap, Option<String>)> = Vec::new();
        for entry in &self.maps {
            let of_settings = |(map, _): &&(&ColumnMap, _)| map.settings == entry.map.settings;
            let found = match read.iter().find(of_settings) {
                Some((_, found)) => found.clone(),
                None => {
                    let found = fingerprint(path, &entry.map);
                    read.push((&entry.map, found.clone()));
                    found
                }
            };
            if found.as_ref() == Some(&entry.fingerprint) {
                return Some(entry.map.clone());
            }
        }
        None
    }
}

/// The digest of the header of a file, where the settings of a map find it; `None` if the file
/// cannot be read so.
pub(in crate::app) fn fingerprint(path: &Path, map: &ColumnMap) -> Option<String> {
    Table::read_as(path, &map.settings).ok().map(|table| table.fingerprint())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_belongs_to_its_header() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let first = file("a.csv", "Zeit;Kraft\n0;1\n1;2\n");
        let map: ColumnMap = "time=1:ms,fx=2:kN,fy=none".parse().unwrap();
        let mut maps = ColumnMaps::default();
        maps.keep(first.clone(), fingerprint(&first, &map).unwrap(), map.clone());
        let same = file("b.csv", "Zeit;Kraft\n0;5\n1;7\n2;8\n");
        assert_eq!(maps.find_by_header(&same).as_ref(), Some(&map));
        assert_eq!((maps.find_by_path(&same), maps.find_by_path(&first)), (None, Some(map)));
        let other = file("c.csv", "Zeit;Weg\n0;5\n1;7\n");
        assert_eq!(maps.find_by_header(&other), None);
        // The same path with another header is another file.
        file("a.csv", "Kraft;Zeit\n1;0\n2;1\n");
        assert_eq!(maps.find_by_path(&first), None);
        // Without a header, only the path says that it is the same.
        let plain = file("d.csv", "0;1\n1;2\n");
        let map: ColumnMap = "time=1:ms,fx=2:kN,fy=none".parse().unwrap();
        maps.keep(plain.clone(), fingerprint(&plain, &map).unwrap(), map.clone());
        assert_eq!(maps.find_by_header(&file("e.csv", "0;1\n1;2\n")), None);
        assert_eq!(maps.find_by_path(&plain), Some(map));
    }
}

//! What users type: mappings of columns. Quantities with units are tried beside their parser, in
//! `src/cli/options/quantity.rs`.

use std::fs;
use std::path::Path;

use impactlab_core::data::ColumnMap;

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

#[test]
fn mappings_of_columns() {
    let load = |path: &Path| {
        let text = fs::read(path).expect("the file can be read");
        let Ok(text) = String::from_utf8(text) else {
            return Answer { messages: vec!["is no text".to_owned()], ..Answer::default() };
        };
        let map: ColumnMap = match text.parse() {
            Ok(map) => map,
            Err(error) => return Answer::refused(&error),
        };
        let again: Result<ColumnMap, _> = map.to_string().parse();
        assert_eq!(again.as_ref(), Ok(&map), "a mapping changes when it is written");
        Answer::accepted(&map)
    };
    run(&Format {
        name: "map",
        n_inputs: 5_000,
        file_name: "map.txt",
        names_file: false,
        seeds: Vec::new(),
        mutate: Mutator::text,
        load: &load,
    });
}

//! The page of the guide on the evidence file has the keys that are read, and no others.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use impactlab_core::collision::Side;
use impactlab_reconstruct::evidence::{
    Bounds, Choice, Damage, Evidence, EvidenceKind, Field, Fields, Item, Items, PointsMut, Section,
    Sigma, Word,
};

/// Keys that the page tells in words and that no field has: the start of a mark once more.
const ONLY_READ: [&str; 1] = ["start_m"];

/// The keys of the tables of an evidence file, with SI units.
#[derive(Default)]
struct Keys(BTreeMap<&'static str, BTreeSet<String>>);

/// The keys of one table.
struct TableKeys<'a>(&'a mut BTreeSet<String>);

impl Items for Keys {
    fn item(&mut self, section: &'static Section, _: Option<usize>, item: &mut impl Item) {
        item.fields(&mut TableKeys(self.0.entry(section.key).or_default()));
    }

    fn optional<T: Item>(&mut self, section: &'static Section, _: &mut Option<T>) {
        self.item(section, None, &mut T::default());
    }

    fn many<T: Item>(&mut self, section: &'static Section, _: &mut Vec<T>) {
        self.item(section, None, &mut T::default());
    }
}

impl Fields for TableKeys<'_> {
    fn number(&mut self, field: &Field, _: &mut Option<f64>) {
        self.0.insert(field.si_key());
    }

    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        self.0.insert(field.si_key());
        self.number(&sigma.field, points.sigma_m);
    }

    fn bounds(&mut self, field: &Field, _: &mut Option<Bounds>) {
        self.0.extend(["_min", "_max"].map(|end| field.si_key_with(end)));
    }

    fn interval(&mut self, field: &Field, _: &mut Option<Bounds>) {
        self.0.insert(field.si_key());
    }

    fn choice<W: Word>(&mut self, choice: &Choice, _: &mut W) {
        self.0.insert(choice.key.to_owned());
    }

    fn optional_choice<W: Word>(&mut self, choice: &Choice, _: &mut Option<W>) {
        self.0.insert(choice.key.to_owned());
    }

    fn choices<W: Word>(&mut self, choice: &Choice, _: &mut Option<Vec<W>>) {
        self.0.insert(choice.key.to_owned());
    }
}

/// The keys in the first columns of the tables of the page, by the tables of the file in their heading.
fn told(page: &str) -> BTreeMap<String, BTreeSet<String>> {
    let in_marks = |text: &str| -> Vec<String> {
        text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    };
    let mut told = BTreeMap::new();
    for part in page.split("\n### ").skip(1) {
        let (heading, text) = part.split_once('\n').expect("a text below the heading");
        let text = text.split("\n## ").next().unwrap_or_default();
        let first = |line: &str| line.strip_prefix("| `").map(|rest| format!("`{rest}"));
        let cells = text.lines().filter_map(first);
        let keys: BTreeSet<String> =
            cells.flat_map(|line| in_marks(line.split(" | ").next().unwrap_or_default())).collect();
        for table in in_marks(heading) {
            told.insert(table.trim_matches(['[', ']']).to_owned(), keys.clone());
        }
    }
    told
}

#[test]
fn the_page_on_the_evidence_file_has_every_key_and_no_other() {
    let mut keys = Keys::default();
    for side in Side::ALL {
        let damage = Damage { side: Some(side), ..Damage::default() };
        Evidence { damage, ..Evidence::default() }.items(&mut keys);
    }
    let kind = EvidenceKind::SingleCar;
    Evidence { kind, ..Evidence::default() }.items(&mut keys);
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/evidence-file.md");
    let told = told(&std::fs::read_to_string(page).expect("the page"));
    assert!(keys.0.len() > 10, "{:?}", keys.0.keys());
    for (table, keys) in &keys.0 {
        let mut told = told.get(*table).unwrap_or_else(|| panic!("[{table}] is not told")).clone();
        told.retain(|key| !ONLY_READ.contains(&key.as_str()));
        assert_eq!(told, *keys, "[{table}]");
    }
}

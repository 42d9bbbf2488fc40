//! What each variant asks otherwise than the first one.

use std::collections::BTreeMap;

use impactlab_core::units::UnitSystem;
use impactlab_document::report::variant_differences;
use impactlab_study::case_file::Variant;

/// What the variants ask otherwise than the first one, found anew when one of them changes.
#[derive(Default)]
pub struct VariantDifferences {
    /// The variants that are compared, and the units in which it is said.
    of: (Vec<Variant>, UnitSystem),
    /// What differs, by the names of the variants; the first one has none.
    found: BTreeMap<String, Vec<String>>,
}

impl VariantDifferences {
    /// What a variant asks otherwise; `None` for the first one.
    pub fn get(&self, name: &str) -> Option<&[String]> {
        self.found.get(name).map(Vec::as_slice)
    }

    pub(super) fn update(&mut self, variants: &[Variant], units: UnitSystem) {
        if self.of.0 == variants && self.of.1 == units {
            return;
        }
        self.of = (variants.to_vec(), units);
        self.found = match variants.split_first() {
            Some((first, others)) => others
                .iter()
                .map(|other| (other.name.clone(), variant_differences(first, other, units)))
                .collect(),
            None => BTreeMap::new(),
        };
    }
}

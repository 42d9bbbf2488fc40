//! All caveats of an answer, and how they are written: into JSON, a picture, a table or the clipboard.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use crate::units::{Phrase, PhraseValue, UnitSystem};

/// What restricts an answer and what it rests on. It stands beside the answer wherever that goes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "CaveatsJson", into = "CaveatsJson")]
pub struct Caveats(Vec<Caveat>);

impl Caveats {
    /// What restricts the answer, the warnings first.
    pub fn restrictions(&self) -> Vec<&Caveat> {
        let is_restriction =
            |caveat: &&Caveat| !(caveat.kind.is_assumption() || caveat.kind == CaveatKind::Note);
        let mut found: Vec<&Caveat> = self.0.iter().filter(is_restriction).collect();
        found.sort_by_key(|caveat| !caveat.is_warning());
        found
    }

    /// What was assumed, and what is not used.
    pub fn assumptions(&self) -> impl Iterator<Item = &Caveat> {
        self.0.iter().filter(|caveat| caveat.kind.is_assumption())
    }

    /// One caveat for all that was assumed, each subject once, and one for all that is not used.
    pub fn summaries(&self) -> Vec<Caveat> {
        let summary = |kind| {
            let mut all: Vec<(&str, Phrase)> = Vec::new();
            for caveat in self.0.iter().filter(|caveat| caveat.kind == kind) {
                let what = match caveat.subject {
                    Some(subject) => (subject.label(), subject.phrase()),
                    None => (caveat.text.as_str(), caveat.phrase()),
                };
                if all.iter().all(|(text, _)| *text != what.0) {
                    all.push(what);
                }
            }
            let (texts, phrases): (Vec<&str>, Vec<Phrase>) = all.into_iter().unzip();
            let text_phrase = Some(Phrase::joined(phrases, "; "));
            let summary = || Caveat { text_phrase, ..Caveat::new(kind, texts.join("; ")) };
            (!texts.is_empty()).then(summary)
        };
        [CaveatKind::Assumed, CaveatKind::NotUsed].into_iter().filter_map(summary).collect()
    }

    /// What a person should know about how the answer was made.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        let notes = self.0.iter().filter(|caveat| caveat.kind == CaveatKind::Note);
        notes.map(|note| note.text.as_str())
    }

    /// The same with their texts in English in the units of a reader.
    #[must_use]
    pub fn in_units(&self, units: UnitSystem) -> Self {
        self.0.iter().map(|caveat| caveat.in_units(units)).collect()
    }

    /// All of them, in the order in which they were found.
    pub fn iter(&self) -> std::slice::Iter<'_, Caveat> {
        self.0.iter()
    }

    /// Whether one is of this kind.
    pub fn has(&self, kind: CaveatKind) -> bool {
        self.0.iter().any(|caveat| caveat.kind == kind)
    }

    /// Adds one.
    pub fn push(&mut self, caveat: Caveat) {
        self.0.push(caveat);
    }

    /// The same, marked if the answer is not to what is asked any more. It is not exported then.
    #[must_use]
    pub fn outdated_if(mut self, is_outdated: bool) -> Self {
        if is_outdated && !self.is_outdated() {
            let text = Phrase::new(
                "this is not the answer to what is asked now",
                "Dies ist nicht die Antwort auf die jetzige Frage",
            );
            self.0.insert(0, Caveat::new(CaveatKind::Outdated, text));
        }
        self
    }

    /// Whether the answer is not to what is asked any more.
    pub fn is_outdated(&self) -> bool {
        self.has(CaveatKind::Outdated)
    }

    /// Adds those of another variant of the case that do not hold for this one alike.
    pub fn add_variant(&mut self, name: &str, other: &Self) {
        for caveat in &other.0 {
            if self.0.contains(caveat) {
                continue;
            }
            let (text, template) = match caveat.kind {
                CaveatKind::Outdated => (caveat.text.clone(), "{0}"),
                kind if kind.is_assumption() => (format!("{} ({name})", caveat.text), "{0} ({1})"),
                _ => (format!("{name}: {}", caveat.text), "{1}: {0}"),
            };
            let of_variant = |phrase: &Phrase| {
                Phrase::new(template, template)
                    .with(PhraseValue::phrase(phrase.clone()))
                    .with(PhraseValue::Name(name.to_owned()))
            };
            let text_phrase = caveat.text_phrase.as_ref().map(of_variant);
            self.0.push(Caveat { text, text_phrase, ..caveat.clone() });
        }
    }

    /// A text that is copied or written, with restrictions and assumptions at its end.
    pub fn appended_to(&self, text: String) -> String {
        match self.text() {
            Some(caveats) => format!("{text}\nRestrictions: {caveats}\n"),
            None => text,
        }
    }

    /// Restrictions and assumptions as one line of text, for
    /// [`RESTRICTIONS_COLUMN`](crate::data::RESTRICTIONS_COLUMN); `None` if there are none.
    pub fn text(&self) -> Option<String> {
        let line = |caveat: &Caveat| {
            let severity = if caveat.is_warning() { "warning" } else { "note" };
            format!("{severity}: {}: {}", caveat.kind.label(), caveat.statement())
        };
        let all = self.restrictions().into_iter().chain(self.assumptions());
        let text: Vec<String> = all.map(line).collect();
        (!text.is_empty()).then(|| text.join(" | "))
    }
}

impl From<Vec<Caveat>> for Caveats {
    fn from(caveats: Vec<Caveat>) -> Self {
        Self(caveats)
    }
}

impl FromIterator<Caveat> for Caveats {
    fn from_iter<I: IntoIterator<Item = Caveat>>(caveats: I) -> Self {
        Self(caveats.into_iter().collect())
    }
}

impl Extend<Caveat> for Caveats {
    fn extend<I: IntoIterator<Item = Caveat>>(&mut self, caveats: I) {
        self.0.extend(caveats);
    }
}

impl IntoIterator for Caveats {
    type Item = Caveat;
    type IntoIter = std::vec::IntoIter<Caveat>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Caveats {
    type Item = &'a Caveat;
    type IntoIter = std::slice::Iter<'a, Caveat>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// The caveats in a JSON report, and beside them the lists that stood in their place until
/// version 0.1: these are still written, and read where there are no caveats.
#[derive(Serialize, Deserialize, JsonSchema)]
struct CaveatsJson {
    /// What restricts the answer and what it rests on.
    caveats: Option<Vec<Caveat>>,
    /// Former key: what a person should know beside that.
    #[serde(default)]
    notes: Vec<String>,
    /// Former key: what was assumed, and what is not used.
    #[serde(default)]
    assumptions: Vec<AssumptionJson>,
    /// Former key: what restricts the answer, the warnings first, and what was assumed.
    #[serde(default)]
    badges: Vec<BadgeJson>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
struct AssumptionJson {
    /// What was assumed.
    quantity: AssumedJson,
    /// Its value.
    value: String,
    /// Why.
    reason: String,
}

#[derive(Serialize, Deserialize, JsonSchema)]
enum AssumedJson {
    #[serde(rename = "not_used")]
    NotUsed,
    #[serde(untagged)]
    Assumed(CaveatSubject),
}

#[derive(Serialize, Deserialize, JsonSchema)]
struct BadgeJson {
    /// What it is.
    kind: CaveatKind,
    /// For a person.
    text: String,
    /// The number that it is about, with its unit.
    quantity: Option<String>,
    /// Its value.
    value: Option<f64>,
    /// Lower and upper end within which there would be no badge.
    range: Option<[Option<f64>; 2]>,
}

impl From<Caveats> for CaveatsJson {
    fn from(caveats: Caveats) -> Self {
        let badge = |caveat: &Caveat| BadgeJson {
            kind: caveat.kind,
            text: caveat.text.clone(),
            quantity: caveat.quantity.clone(),
            value: caveat.value,
            range: caveat.range,
        };
        let assumption = |caveat: &Caveat| AssumptionJson {
            quantity: caveat.subject.map_or(AssumedJson::NotUsed, AssumedJson::Assumed),
            value: caveat.text.clone(),
            reason: caveat.reason.clone().unwrap_or_default(),
        };
        let restrictions = caveats.restrictions().into_iter().map(badge);
        let summaries = caveats.summaries();
        Self {
            notes: caveats.notes().map(str::to_owned).collect(),
            assumptions: caveats.assumptions().map(assumption).collect(),
            badges: restrictions.chain(summaries.iter().map(badge)).collect(),
            caveats: Some(caveats.0),
        }
    }
}

impl From<CaveatsJson> for Caveats {
    fn from(json: CaveatsJson) -> Self {
        if let Some(caveats) = json.caveats {
            return Self(caveats);
        }
        let badges = json.badges.into_iter().filter(|badge| !badge.kind.is_assumption());
        let badges = badges.map(|BadgeJson { kind, text, quantity, value, range }| Caveat {
            quantity,
            value,
            range,
            ..Caveat::new(kind, text)
        });
        let assumptions =
            json.assumptions.into_iter().map(|assumption| match assumption.quantity {
                AssumedJson::NotUsed => Caveat::not_used(assumption.value, assumption.reason),
                AssumedJson::Assumed(subject) => {
                    Caveat::assumed(subject, assumption.value, assumption.reason)
                }
            });
        let notes = json.notes.into_iter().map(|text| Caveat::new(CaveatKind::Note, text));
        badges.chain(assumptions).chain(notes).collect()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::units::{Language, NumberFormat, Quantity};

    fn caveats() -> Caveats {
        let unused = "no effect";
        Caveats::from(vec![
            Caveat::new(CaveatKind::NotAtRest, "still moving")
                .with_value("speed at the end [m/s]", 3.0)
                .with_range([f64::NEG_INFINITY, 0.05]),
            Caveat::new(CaveatKind::OutsideDomain, "striking vehicle's mass is 9000"),
            Caveat::new(CaveatKind::Note, "sampled at 1 kHz"),
            Caveat::assumed(CaveatSubject::VehicleParameter, "mass 1500 kg", "by the rest"),
            Caveat::assumed(CaveatSubject::VehicleParameter, "track 1.5 m", "by the rest"),
            Caveat::assumed(CaveatSubject::Speed, "15 m/s", "nobody said it"),
            Caveat::assumed(CaveatSubject::VehicleParameter, "cg 1.2 m", "by the rest"),
            Caveat::not_used("restitution, 0.3", unused),
        ])
    }

    #[test]
    fn warnings_come_first_and_every_value_that_was_assumed_is_named() {
        let expected = "warning: outside the domain: striking vehicle's mass is 9000 | \
                        note: not at rest: still moving | \
                        note: assumed: parameter of the vehicle: mass 1500 kg | \
                        note: assumed: parameter of the vehicle: track 1.5 m | \
                        note: assumed: speed before the impact: 15 m/s | \
                        note: assumed: parameter of the vehicle: cg 1.2 m | \
                        note: not used: restitution, 0.3";
        assert_eq!(caveats().text().unwrap(), expected);
        let outdated = caveats().outdated_if(true);
        assert!(outdated.text().unwrap().starts_with("warning: outdated: "));
        assert!(outdated.is_outdated() && !caveats().is_outdated());
        assert_eq!(Caveats::default().text(), None);
    }

    #[test]
    fn a_variant_adds_what_does_not_hold_for_the_first() {
        let met = |text: &str| Caveat::new(CaveatKind::SecondContact, text);
        let mut all = Caveats::from(vec![met("at 0.3 s")]);
        all.add_variant("fast", &Caveats::from(vec![met("at 0.3 s"), met("at 0.2 s")]));
        let texts: Vec<&str> = all.iter().map(|caveat| caveat.text.as_str()).collect();
        assert_eq!(texts, ["at 0.3 s", "fast: at 0.2 s"]);
    }

    #[test]
    fn the_caveats_of_a_variant_and_summaries_keep_their_languages() {
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let said = |caveat: &Caveat| caveat.text_in(&german, &str::to_owned).unwrap();
        let at =
            Phrase::new("at {0}", "bei {0}").with(PhraseValue::fixed(Quantity::Length, 1.5, 1));
        let mut all = Caveats::default();
        all.add_variant("fast", &Caveats::from(vec![Caveat::new(CaveatKind::Overlap, at)]));
        let overlap = all.iter().next().unwrap();
        assert_eq!((&*overlap.text, &*said(overlap)), ("fast: at 1.5 m", "fast: bei 1,5 m"));
        assert_eq!(all.in_units(UnitSystem::Us).iter().next().unwrap().text, "fast: at 4.9 ft");
        let summaries = caveats().summaries();
        let texts: Vec<String> = summaries.iter().map(said).collect();
        let assumed = "Parameter des Fahrzeugs; Geschwindigkeit vor dem Anstoß";
        assert_eq!(texts, [assumed, "„restitution, 0.3“"]);
    }

    #[test]
    fn the_lists_of_earlier_versions_are_written_from_the_caveats() {
        let written = serde_json::to_value(caveats()).unwrap();
        let texts = |list: &str, key: &str| -> Vec<Value> {
            written[list].as_array().unwrap().iter().map(|item| item[key].clone()).collect()
        };
        let kinds = ["outside_domain", "not_at_rest", "assumed", "not_used"];
        assert_eq!(texts("badges", "kind"), kinds);
        let summary = "parameter of the vehicle; speed before the impact";
        assert_eq!(written["badges"][2]["text"], summary);
        assert_eq!(written["badges"][3]["text"], "restitution, 0.3");
        assert_eq!(
            written["badges"][1],
            json!({"kind": "not_at_rest", "text": "still moving", "value": 3.0,
                   "quantity": "speed at the end [m/s]", "range": [null, 0.05]})
        );
        assert_eq!(
            written["assumptions"][4],
            json!({"quantity": "not_used", "value": "restitution, 0.3", "reason": "no effect"})
        );
        let assumed =
            ["vehicle_parameter", "vehicle_parameter", "speed", "vehicle_parameter", "not_used"];
        assert_eq!(texts("assumptions", "quantity"), assumed);
        assert_eq!(written["notes"], json!(["sampled at 1 kHz"]));
        assert_eq!(written["caveats"].as_array().unwrap().len(), 8);
        assert_eq!(written["caveats"][0]["severity"], "info");
    }

    #[test]
    fn reports_of_this_and_of_earlier_versions_are_read_whole() {
        let mut written = serde_json::to_value(caveats()).unwrap();
        assert_eq!(serde_json::from_value::<Caveats>(written.clone()).unwrap(), caveats());
        written.as_object_mut().unwrap().remove("caveats");
        let read: Caveats = serde_json::from_value(written.clone()).unwrap();
        assert_eq!(read.text(), caveats().text());
        assert_eq!(read.iter().count(), caveats().iter().count());
        written["badges"][0]["kind"] = json!("of_a_later_version");
        assert!(
            serde_json::from_value::<Caveats>(written).is_err(),
            "what is not known is an error"
        );
    }
}

//! An answer: what is told, what restricts it, and where it comes from.

use std::ops::Deref;

use schemars::JsonSchema;
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

use crate::Provenance;
use impactlab_core::uncertainty::Caveats;

/// An answer: what is told, what restricts it and what it rests on, and where it comes from.
///
/// JSON has all of it in one object, what is told first. It reads as its report does, since that is what
/// most of those who hold an answer are after.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Answer<R> {
    /// What is told.
    #[serde(flatten)]
    pub report: R,
    /// What restricts it and what it rests on.
    #[serde(flatten)]
    pub caveats: Caveats,
    /// Version of the program, seed and trained networks.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl<R> Answer<R> {
    /// The same with what is told in another form.
    pub fn map<T>(self, form: impl FnOnce(R) -> T) -> Answer<T> {
        let Self { report, caveats, provenance } = self;
        Answer { report: form(report), caveats, provenance }
    }
}

impl<R> Deref for Answer<R> {
    type Target = R;

    fn deref(&self) -> &R {
        &self.report
    }
}

impl<'de, R: Serialize + DeserializeOwned> Deserialize<'de> for Answer<R> {
    /// What stands in the report, such as a seed of its own, does not come from the provenance.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut all = Map::<String, Value>::deserialize(deserializer)?;
        let written = Value::Object(all.clone());
        let report = R::deserialize(&written).map_err(D::Error::custom)?;
        let caveats = Caveats::deserialize(&written).map_err(D::Error::custom)?;
        let own = serde_json::to_value(&report).map_err(D::Error::custom)?;
        all.retain(|key, _| own.get(key).is_none());
        let provenance = Provenance::deserialize(Value::Object(all)).map_err(D::Error::custom)?;
        Ok(Self { report, caveats, provenance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::data::write::ModelDigest;
    use impactlab_core::uncertainty::{Caveat, CaveatKind};

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Content {
        speed_m_s: f64,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Drawn {
        #[serde(flatten)]
        content: Content,
        seed: u64,
    }

    fn answer<R>(report: R) -> Answer<R> {
        let digest =
            ModelDigest { network: "force".into(), name: "shipped".into(), sha256: "0a".into() };
        Answer {
            report,
            caveats: Caveats::from(vec![Caveat::new(CaveatKind::Note, "sampled at 1 kHz")]),
            provenance: Provenance::default().with_models([digest]),
        }
    }

    #[test]
    fn an_answer_is_one_object_and_comes_back_from_it() {
        let content = Content { speed_m_s: 3.5 };
        let mut of_seed = answer(content.clone());
        of_seed.provenance.seed = Some(7);
        let json = serde_json::to_value(&of_seed).unwrap();
        let keys: Vec<&str> = json.as_object().unwrap().keys().map(String::as_str).collect();
        for key in ["speed_m_s", "caveats", "notes", "badges", "version", "seed", "model_digests"] {
            assert!(keys.contains(&key), "{key} is not in {keys:?}");
        }
        assert_eq!(serde_json::from_value::<Answer<Content>>(json).unwrap(), of_seed);
        // A seed that is told is not taken for that of the provenance.
        let own = answer(Drawn { content, seed: 7 });
        let json = serde_json::to_value(&own).unwrap();
        assert_eq!(json["seed"], 7);
        assert_eq!(serde_json::from_value::<Answer<Drawn>>(json).unwrap(), own);
    }
}

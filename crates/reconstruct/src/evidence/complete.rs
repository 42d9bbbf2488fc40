//! What the evidence lacks: what a form or a file has left open although nothing can stand in for it.

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PointsMut, Section, Sigma, Stated, Word,
};

/// What a single car lacks of which nobody says where it was.
const START_LACKS: &str =
    "car at the start: X and Y have not been entered: type them, or add a tire mark";

impl Evidence {
    /// What lacks although nothing can stand in for it, and what to do; `None` if the evidence is complete.
    pub fn missing(&self) -> Option<String> {
        if let Some(title) = self.foreign() {
            let why = match self.is_single_car() {
                true => "a single car strikes nothing and is struck by nothing",
                false => "only the evidence of a single car has it",
            };
            return Some(format!("{title}: {why}: remove it"));
        }
        let mut search = Search(None);
        self.clone().items(&mut search);
        search.0.or_else(|| self.lacks_start().then(|| START_LACKS.to_owned()))
    }

    /// Whether nothing says where a single car was.
    pub(super) fn lacks_start(&self) -> bool {
        self.is_single_car() && self.start.place_m().is_none() && self.marks.is_empty()
    }
}

/// A field that an item lacks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Lack {
    /// Its key in a file, with the SI unit.
    pub key: String,
    /// What a person calls it.
    pub label: &'static str,
    /// Whether it could be left out, were its standard deviation not there.
    pub is_optional: bool,
}

/// The first field that an item lacks.
pub(super) fn lack_of(item: &impl Item) -> Option<Lack> {
    let mut lacking = Lacking(None);
    item.clone().fields(&mut lacking);
    lacking.0
}

struct Search(Option<String>);

impl Search {
    fn find(&mut self, section: &Section, idx: Option<usize>, lack: Option<Lack>) {
        let number = idx.map_or(String::new(), |idx| format!(" {}", idx + 1));
        let title = format!("{}{number}", section.title);
        self.0 = self.0.take().or(match (section.missing, lack) {
            ("", None) => Some(format!(
                "{title}: nothing has been entered: type what was found, or remove the card"
            )),
            (_, Some(Lack { label, is_optional: true, .. })) => {
                Some(format!("{title}: {label} has not been entered: type it, or empty its ±"))
            }
            ("", Some(lack)) => {
                Some(format!("{title}: {} has not been entered: type it", lack.label))
            }
            (missing, _) => Some(format!("{title} {missing}")),
        });
    }
}

impl Items for Search {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        let lack = lack_of(item);
        if lack.is_some() {
            self.find(section, idx, lack);
        }
    }

    fn optional<T: Item>(&mut self, section: &'static Section, item: &mut Option<T>) {
        let Some(item) = item else { return };
        match item.is_empty() {
            true => self.find(section, None, None),
            false => self.item(section, None, item),
        }
    }

    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        for (idx, item) in items.iter_mut().enumerate() {
            self.item(section, Some(idx), item);
        }
        let again = |[first, second]: [usize; 2]| {
            format!(
                "{} {second} is the same as {first}: each would count as found by itself: remove one of them",
                section.title
            )
        };
        self.0 = self.0.take().or_else(|| twice(items).map(again));
    }
}

/// The numbers, counted from 1, of the first item that stands there twice and would count twice.
pub(super) fn twice<T: Item>(items: &[T]) -> Option<[usize; 2]> {
    if T::COUNTS_ONCE {
        return None;
    }
    items.iter().enumerate().find_map(|(idx, item)| {
        let first = items.iter().take(idx).position(|earlier| earlier == item)?;
        Some([first + 1, idx + 1])
    })
}

struct Lacking(Option<Lack>);

impl Lacking {
    fn note(&mut self, is_lacking: bool, key: &str, label: &'static str) {
        if is_lacking && self.0.is_none() {
            self.0 = Some(Lack { key: key.to_owned(), label, is_optional: false });
        }
    }
}

impl Fields for Lacking {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        self.note(field.is_required && value.is_none(), &field.si_key(), field.label);
    }

    fn measured(&mut self, field: &Field, _: &Sigma, stated: &mut Option<Stated>) {
        let is_open = stated.is_none_or(|stated| stated.value.is_none());
        let has_sigma = stated.is_some_and(|stated| stated.sigma.is_some());
        if is_open && has_sigma && !field.is_required && self.0.is_none() {
            self.0 = Some(Lack { key: field.si_key(), label: field.label, is_optional: true });
        }
        self.note(is_open && field.is_required, &field.si_key(), field.label);
    }

    fn points(&mut self, field: &Field, _: &Sigma, PointsMut { points_m, .. }: PointsMut<'_>) {
        let is_still = points_m.windows(2).all(|pair| pair[0] == pair[1]);
        self.note(is_still, &field.si_key(), field.label);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        let Some([low, high]) = bounds else { return };
        self.note(low.is_none(), &field.si_key_with("_min"), field.label);
        self.note(high.is_none(), &field.si_key_with("_max"), field.label);
    }

    fn choice<W: Word>(&mut self, _: &Choice, _: &mut W) {}

    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>) {
        self.note(choice.is_required && word.is_none(), choice.key, choice.label);
    }

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::{Edr, Mark, RestPose, VideoPosition};
    use impactlab_core::collision::Side;

    #[test]
    fn nothing_is_run_from_a_form_that_nobody_has_filled_in() {
        let mut evidence = Evidence::empty();
        let mut missing = |change: fn(&mut Evidence)| {
            change(&mut evidence);
            evidence.missing().unwrap_or_default()
        };
        assert!(missing(|_| {}).contains("struck car at rest has not been placed"));
        assert!(
            missing(|evidence| evidence.rest.as_mut().unwrap().x_m = Some(30.0))
                .contains("at rest")
        );
        let text = missing(|evidence| evidence.rest.as_mut().unwrap().y_m = Some(0.0));
        assert!(text.contains("damage of the struck car"), "{text}");
        let heading = |value| Some(Stated { value, sigma: Some(0.03) });
        let mut placed = evidence.clone();
        placed.rest.as_mut().unwrap().heading_rad = heading(None);
        let text = placed.missing().unwrap_or_default();
        assert!(text.contains("at rest: heading has not been entered"), "{text}");
        placed.rest.as_mut().unwrap().heading_rad = heading(Some(1.0));
        let text = placed.missing().unwrap_or_default();
        assert!(text.contains("damage of the struck car"), "{text}");
        let mut missing = |change: fn(&mut Evidence)| {
            change(&mut evidence);
            evidence.missing().unwrap_or_default()
        };
        let along = move |evidence: &mut Evidence| {
            evidence.damage.along_m = Some(Stated { value: Some(-1.5), sigma: None })
        };
        let text = missing(along);
        assert!(text.contains("choose the struck side"), "{text}");
        assert_eq!(missing(|evidence| evidence.damage.side = Some(Side::Right)), "");
        let text = missing(|evidence| evidence.striking_rest = Some(RestPose::default()));
        assert!(text.contains("striking car at rest has not been placed"), "{text}");
        assert_eq!(missing(|evidence| evidence.striking_rest = None), "");
        assert!(
            missing(|evidence| evidence.marks.push(Mark::default()))
                .contains("at least two points")
        );
        assert_eq!(
            missing(|evidence| evidence.marks[0].points_m = vec![[1.0, 0.0], [9.0, 1.0]]),
            ""
        );
        let text = missing(|evidence| evidence.striking_marks.push(Mark::default()));
        assert!(text.contains("tire mark of the striking car 1 needs at least two"), "{text}");
        assert_eq!(missing(|evidence| evidence.striking_marks.clear()), "");
        let text = missing(|evidence| evidence.striking_edr = Some(Edr::default()));
        assert!(text.contains("event data recorder of the striking car: nothing"), "{text}");
        assert_eq!(missing(|evidence| evidence.striking_edr = None), "");
        assert!(
            missing(|evidence| evidence.edr = Some(Edr::default())).contains("event data recorder")
        );
        let text = missing(|evidence| {
            evidence.edr.as_mut().unwrap().delta_v_y_m_s = Some([Some(-1.0), None])
        });
        assert!(text.contains("Δv to the left has not been entered"), "{text}");
        let text = missing(|evidence| {
            let sigma = Some(0.5);
            evidence.edr = Some(Edr {
                speed_before_m_s: Some(Stated { value: None, sigma }),
                ..Edr::default()
            });
        });
        assert!(text.contains("speed before the impact has not been entered"), "{text}");
        assert_eq!(missing(|evidence| evidence.edr = None), "");
        let text = missing(|evidence| evidence.positions.push(VideoPosition::default()));
        assert!(text.contains("position in a video 1 has not been entered"), "{text}");
        assert_eq!(missing(|evidence| evidence.positions.clear()), "");
        let text = missing(|evidence| evidence.marks.push(evidence.marks[0].clone()));
        assert!(text.contains("tire mark 2 is the same as 1"), "{text}");
        assert_eq!(missing(|evidence| evidence.marks[1].points_m[1] = [9.0, 1.1]), "");
        let text = missing(|evidence| evidence.struck_car.cg_to_front_axle_m = Some(1.2));
        assert!(text.contains("CG to rear axle has not been entered"), "{text}");
    }

    #[test]
    fn every_value_that_is_entered_is_a_value() {
        let mut evidence = Evidence::empty();
        let stated = |value: f64| Some(Stated { value: Some(value), sigma: None });
        evidence.damage.along_m = stated(-1.5);
        evidence.damage.side = Some(Side::Front);
        evidence.rest = Some(RestPose { x_m: Some(30.0), y_m: Some(0.0), ..RestPose::default() });
        evidence.edr = Some(Edr {
            speed_before_m_s: stated(15.0),
            delta_v_x_m_s: Some([Some(-1.0), Some(1.0)]),
            delta_v_y_m_s: Some([Some(-1.0), Some(1.0)]),
            ..Edr::default()
        });
        let at = |value| Some(value);
        let position =
            VideoPosition { time_s: at(1.0), x_m: at(15.0), y_m: at(0.0), sigma_m: None };
        evidence.positions = vec![position];
        assert_eq!(evidence.missing(), None);
    }
}

//! What names and words of questions and files are called: as the window calls them where it has a field
//! for them. The German ones stand with the other German terms.

use impactlab_core::collision::{PulseShape, RestitutionForm, Side};
use impactlab_core::vehicle::Integrator;
use impactlab_study::word;

/// Names whose words do not say what they mean.
const NAMES: [(&str, &str); 44] = [
    ("alone", "without the other method beside it"),
    ("bullet", "striking vehicle"),
    ("bullet_ending", "striking vehicle after the impact"),
    ("bullet_x_m", "X of the striking vehicle"),
    ("bullet_y_m", "Y of the striking vehicle"),
    ("cg_from_front_m", "CG behind front"),
    ("contact_height_m", "height above ground"),
    ("countersteer", "the driver countersteers"),
    ("ending", "after the impact"),
    ("engine", "the engine brakes"),
    ("equations", "equations of motion"),
    ("esc", "stability control"),
    ("friction_limit", "friction limit μ_c"),
    ("friction_model", "friction in the contact"),
    ("friction_of_critical", "share of critical ratio"),
    ("friction_sigma", "friction, one standard deviation"),
    ("from", "contact given by"),
    ("integrator", "method of integration"),
    ("n_calibrated", "motions of the calibration"),
    ("n_parameters", "weights of the network"),
    ("n_samples", "states learned from"),
    ("n_simulated", "simulated motions learned from"),
    ("n_test", "cases kept for the test"),
    ("n_train", "cases learned from"),
    ("n_validation", "cases that decide when to stop"),
    ("offset_m", "offset from its middle"),
    ("one_contact", "first contact only"),
    ("open_contact", "contact point left open"),
    ("paper", "friction always sliding, as in the paper"),
    ("pit", "the driver turns into the other car"),
    ("predicted", "force network"),
    ("response_model", "response network"),
    ("restitution_form", "restitution acts"),
    ("rise_s", "rises within"),
    ("rolling_resistance_s2_m2", "rolling resistance per squared speed"),
    ("rolling_resistance_s_m", "rolling resistance per speed"),
    ("samples", "curves drawn"),
    ("seconds", "duration in seconds"),
    ("shape", "pulse shape"),
    ("start_s", "from"),
    ("target", "struck vehicle"),
    ("vehicle_draws", "vehicles drawn"),
    ("vx_m_s", "velocity along X"),
    ("vy_m_s", "velocity along Y"),
];

/// Words by which a choice is written, with the name that the choice stands at.
const CHOICES: [(&str, &str, &str); 18] = [
    ("vehicle", "Automatic", "not named"),
    ("bullet", "Automatic", "not named"),
    ("striking", "Automatic", "not named"),
    ("bad_cases", "refuse", "refused"),
    ("bad_cases", "leave_out", "left out"),
    ("config", "default", "the model's own, else the defaults"),
    ("learning", "fleet", "the network, and how cars differ"),
    ("learning", "strengths", "the strengths of one car"),
    ("equations", "corrected", "corrected"),
    ("equations", "paper", "as the paper prints them"),
    ("friction_model", "limit", "no sliding, up to the limit"),
    ("friction_model", "paper", "always sliding"),
    ("from", "side", "a place on a side"),
    ("from", "footprints", "the outlines of both"),
    ("from", "point", "point and normal"),
    ("model", "shipped", "comes with the program"),
    ("response_model", "shipped", "comes with the program"),
    ("predicted", "shipped", "comes with the program"),
];

/// What a name is called in English; `None` if its words say it.
pub(super) fn name_label(key: &str) -> Option<&'static str> {
    NAMES.iter().find(|(name, _)| *name == key).map(|(_, label)| *label)
}

/// What a choice is called in English; `None` if it is none, such as the name of a file.
pub(super) fn choice_label(key: &str, written: &str) -> Option<&'static str> {
    let of_type = match key {
        "restitution_form" => {
            let form = RestitutionForm::ALL.into_iter().find(|form| is_written(form, written));
            form.map(RestitutionForm::label)
        }
        "shape" => {
            PulseShape::ALL.into_iter().find(|it| is_written(it, written)).map(PulseShape::label)
        }
        "integrator" => {
            // Reports have another word for it than questions.
            let is_it = |of: &Integrator| is_written(of, written) || word(of) == written;
            Integrator::ALL.into_iter().find(is_it).map(Integrator::label)
        }
        "side" => Side::ALL.into_iter().find(|side| is_written(side, written)).map(Side::label),
        _ => None,
    };
    of_type.or_else(|| {
        let found = CHOICES.iter().find(|(of, choice, _)| *of == key && *choice == written);
        found.map(|(_, _, label)| *label)
    })
}

/// Whether a choice is written by a word in files.
fn is_written(choice: &impl serde::Serialize, word: &str) -> bool {
    serde_json::to_value(choice).is_ok_and(|written| written == word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Language;
    use crate::report::keys::bare;
    use crate::report::language::phrase_of;
    use impactlab_core::collision::FrictionModel;
    use impactlab_core::vehicle::Equations;
    use impactlab_study::{ModelChoice, VehicleChoice};

    fn written(choice: impl serde::Serialize) -> String {
        let value = serde_json::to_value(choice).unwrap();
        value.as_str().unwrap_or_else(|| panic!("{value} is no word")).to_owned()
    }

    #[test]
    fn no_choice_is_told_as_it_is_written_in_either_language() {
        let mut all = vec![
            ("vehicle", written(VehicleChoice::Automatic)),
            ("bullet", written(VehicleChoice::Automatic)),
            ("integrator", written(Integrator::Rk4)),
            ("integrator", written(Integrator::Euler)),
            ("equations", written(Equations::Corrected)),
            ("equations", written(Equations::Paper)),
            ("friction_model", written(FrictionModel::Limit)),
            ("friction_model", written(FrictionModel::Paper)),
            ("model", written(ModelChoice::default())),
        ];
        all.extend(RestitutionForm::ALL.map(|form| ("restitution_form", written(form))));
        all.extend(PulseShape::ALL.map(|shape| ("shape", written(shape))));
        all.extend(Side::ALL.map(|side| ("side", written(side))));
        for (key, word) in all {
            let label = choice_label(key, &word).unwrap_or_else(|| panic!("{key}: {word}"));
            assert!(phrase_of(Language::De, label).is_some(), "{label}");
        }
        for (key, word, label) in CHOICES {
            assert!(phrase_of(Language::De, label).is_some(), "{key}: {word}");
        }
        assert_eq!(choice_label("integrator", "rk4"), choice_label("integrator", "Rk4"));
        assert_eq!(choice_label("vehicle", "a.toml"), None);
    }

    #[test]
    fn every_name_has_a_german_one() {
        for (name, label) in NAMES {
            assert!(phrase_of(Language::De, &bare(name)).is_some(), "{name}: {label}");
        }
    }
}

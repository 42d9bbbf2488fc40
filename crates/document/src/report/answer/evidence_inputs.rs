//! What was found after a collision, as rows of the table of inputs.

use crate::report::InputClass;
use crate::report::answer::evidence::measured;
use crate::report::answer::vehicle_inputs::estimate_row;
use crate::report::answer::zone_inputs::zone_rows;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::InputRow;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::sheet::SheetQuantity;
use impactlab_reconstruct::evidence::{
    CarEvidence, DriverBraked, Evidence, Mark, Measured, RestPose,
};
use impactlab_reconstruct::evidence::{
    DEFAULT_ANGLE_SIGMA_RAD, DEFAULT_DAMAGE_SIGMA_M, DEFAULT_FRICTION_SIGMA,
    DEFAULT_HEADING_SIGMA_RAD, DEFAULT_MARK_SIGMA_M, DEFAULT_MASS_SHARE, DEFAULT_REST_SIGMA_M,
    DEFAULT_VIDEO_SIGMA_M, default_edr_speed_sigma,
};
use impactlab_reconstruct::{
    BLOCKED_PROBABILITY, BRAKE_PROBABILITY, Car, Distribution, Latent, PriorComponent, PriorSource,
};
use impactlab_study::{ReconstructAnswer, ReconstructRequest, word};

/// Evidence, estimates of both cars, and the prior.
pub(super) fn evidence_rows(
    request: &ReconstructRequest,
    answer: &ReconstructAnswer,
    wording: &Wording,
) -> Vec<InputRow> {
    let words = wording.words;
    let evidence = answer.target.evidence();
    let mut rows = Rows { wording, rows: Vec::new() };
    let friction = (evidence.friction, DEFAULT_FRICTION_SIGMA);
    rows.measured(words.road, (words.road_friction, Quantity::Ratio), friction);
    rows.rows.extend(zone_rows(answer.target.model().zones(), wording));
    rows.car(words.struck_vehicle, &evidence.struck_car);
    rows.car(words.striking_vehicle, &evidence.striking_car);
    rows.scene(evidence);
    rows.recorder(evidence);
    for mark in &evidence.marks {
        rows.mark(mark);
    }
    for (found, choice, group) in [
        (&evidence.struck_car, &request.vehicle, words.struck_vehicle),
        (&evidence.striking_car, &request.striking, words.striking_vehicle),
    ] {
        // The answer is there, so that the vehicles could be read.
        let chosen = choice.chosen().ok().flatten();
        let estimates = Car::estimates_of(found, chosen.as_ref());
        // The friction of the road is what was measured, or that of the prior.
        let estimates = estimates.iter().filter(|of| of.quantity != SheetQuantity::Friction);
        rows.rows.extend(estimates.map(|of| estimate_row(of, group, wording)));
    }
    let priors = answer.report.priors.iter().map(|prior| prior_row(prior, wording));
    rows.rows.extend(priors);
    rows.rows
}

struct Rows<'a> {
    wording: &'a Wording,
    rows: Vec<InputRow>,
}

impl Rows<'_> {
    fn push(&mut self, group: &str, label: &str, value: String, class: InputClass) {
        let words = self.wording.words;
        let source = match class {
            InputClass::Measured => words.source_evidence_sigma,
            _ => words.source_evidence,
        };
        self.rows.push(InputRow {
            group: group.to_owned(),
            label: label.to_owned(),
            value,
            class,
            source: source.to_owned(),
        });
    }

    /// A value with its standard deviation.
    ///
    /// - `default`: the standard deviation that stands in where the evidence says none.
    fn measured(
        &mut self,
        group: &str,
        (label, quantity): (&str, Quantity),
        (of, default): (Option<Measured>, f64),
    ) {
        if let Some(Measured { value, sigma }) = of {
            let text = measured(quantity, [value, sigma], self.wording);
            self.push_measured(group, label, text, sigma == default);
        }
    }

    /// - `is_default`: whether the standard deviation is the one that stands in where the evidence says
    ///   none.
    fn push_measured(&mut self, group: &str, label: &str, value: String, is_default: bool) {
        self.push(group, label, value, InputClass::Measured);
        if let (Some(row), true) = (self.rows.last_mut(), is_default) {
            row.source = self.wording.words.source_default_sigma.to_owned();
        }
    }

    fn given(&mut self, group: &str, (label, quantity): (&str, Quantity), of: Option<f64>) {
        if let Some(value) = of {
            let text = self.wording.given(quantity, value);
            self.push(group, label, text, InputClass::Given);
        }
    }

    fn car(&mut self, group: &str, car: &CarEvidence) {
        let words = self.wording.words;
        let default = car.mass_kg.map_or(0.0, |mass| DEFAULT_MASS_SHARE * mass.value);
        self.measured(group, (words.mass, Quantity::Mass), (car.mass_kg, default));
        for (key, quantity, value) in [
            ("cg to front axle", Quantity::Length, car.cg_to_front_axle_m),
            ("cg to rear axle", Quantity::Length, car.cg_to_rear_axle_m),
            ("track width", Quantity::Length, car.track_m),
            ("height of the CG", Quantity::Length, car.cg_height_m),
            ("outer length", Quantity::Length, car.length_m),
            ("outer width", Quantity::Length, car.width_m),
            ("yaw inertia", Quantity::MomentOfInertia, car.yaw_inertia_kg_m2),
        ] {
            let label = self.wording.term(key);
            self.given(group, (&label, quantity), value);
        }
    }

    fn scene(&mut self, evidence: &Evidence) {
        let words = self.wording.words;
        let damage = &evidence.damage;
        let side = self.wording.term(&word(&damage.side));
        self.push(words.damage, words.struck_side, side, InputClass::Given);
        let along = (words.contact_along, Quantity::Length);
        self.measured(words.damage, along, (Some(damage.along_m), DEFAULT_DAMAGE_SIGMA_M));
        self.given(words.damage, (words.contact_depth, Quantity::Length), damage.depth_m);
        let angle = (damage.angle_rad, DEFAULT_ANGLE_SIGMA_RAD);
        self.measured(words.damage, (words.damage_angle, Quantity::Angle), angle);
        self.rest(words.struck_at_rest, evidence.rest.as_ref());
        self.rest(words.striking_at_rest, evidence.striking_rest.as_ref());
        let braked = match evidence.after.driver_braked {
            DriverBraked::Yes => words.yes,
            DriverBraked::No => words.no,
            DriverBraked::Unknown => words.unknown,
        };
        self.push(words.after_impact, words.driver_braked, braked.to_owned(), InputClass::Given);
        let blocked = match &evidence.after.blocked_wheels {
            None => words.nobody_looked.to_owned(),
            Some(wheels) if wheels.is_empty() => words.none.to_owned(),
            Some(wheels) => {
                let wheels: Vec<String> =
                    wheels.iter().map(|wheel| self.wording.term(&word(wheel))).collect();
                wheels.join(", ")
            }
        };
        self.push(words.after_impact, words.blocked_wheels, blocked, InputClass::Given);
    }

    fn rest(&mut self, group: &str, pose: Option<&RestPose>) {
        let Some(pose) = pose else { return };
        let sigma = pose.position_sigma_m;
        for (label, value) in [("X", pose.x_m), ("Y", pose.y_m)] {
            let measured = (Some(Measured { value, sigma }), DEFAULT_REST_SIGMA_M);
            self.measured(group, (label, Quantity::Length), measured);
        }
        let heading = (pose.heading_rad, DEFAULT_HEADING_SIGMA_RAD);
        self.measured(group, (self.wording.words.heading, Quantity::Angle), heading);
    }

    fn recorder(&mut self, evidence: &Evidence) {
        let words = self.wording.words;
        let edr = &evidence.edr;
        let speed = (words.speed_before, Quantity::Speed);
        let default = edr.speed_before_m_s.map_or(0.0, |of| default_edr_speed_sigma(of.value));
        self.measured(words.recorder, speed, (edr.speed_before_m_s, default));
        for (axis, bounds) in [("x", edr.delta_v_x_m_s), ("y", edr.delta_v_y_m_s)] {
            if let Some([low, high]) = bounds {
                let [low, high] = [low, high].map(|of| self.wording.given(Quantity::Speed, of));
                let label = format!("{} {axis}", words.delta_v);
                let text = format!("{low} {} {high}", words.to);
                self.push(words.recorder, &label, text, InputClass::Measured);
            }
        }
        for position in &evidence.positions {
            let time = self.wording.given(Quantity::Time, position.time_s);
            for (axis, value) in [("X", position.x_m), ("Y", position.y_m)] {
                let text = measured(Quantity::Length, [value, position.sigma_m], self.wording);
                let label = format!("{axis}, {time}");
                let is_default = position.sigma_m == DEFAULT_VIDEO_SIGMA_M;
                self.push_measured(words.video, &label, text, is_default);
            }
        }
    }

    fn mark(&mut self, mark: &Mark) {
        let words = self.wording.words;
        let ends = [mark.points_m.first(), mark.points_m.last()];
        let [Some(first), Some(last)] = ends else { return };
        let point = |[x, y]: &[f64; 2]| {
            let [x, y] = [*x, *y].map(|of| self.wording.given(Quantity::Length, of));
            format!("({x}; {y})")
        };
        let values = [
            ("n", mark.points_m.len().to_string()),
            ("first", point(first)),
            ("last", point(last)),
            ("sigma", self.wording.given(Quantity::Length, mark.sigma_m)),
        ];
        let values = values.each_ref().map(|(name, value)| (*name, value.as_str()));
        let text = fill(words.mark_value, &values);
        let kind = mark.kind.map(|kind| self.wording.term(&word(&kind)));
        let wheel = self.wording.term(&word(&mark.wheel));
        let label = kind.map_or(wheel.clone(), |kind| format!("{wheel}, {kind}"));
        self.push_measured(words.tire_mark, &label, text, mark.sigma_m == DEFAULT_MARK_SIGMA_M);
    }
}

/// A prior distribution.
fn prior_row(prior: &PriorComponent, wording: &Wording) -> InputRow {
    let words = wording.words;
    let quantity = prior.latent.quantity();
    let value = |si: f64| wording.rounded(quantity, si);
    let decision =
        |template: &str, share: f64| fill(template, &[("share", &wording.percent(share))]);
    let text = match prior.distribution {
        // Uniform draws that are compared with a bound.
        _ if prior.latent == Latent::BrakeDecision => {
            decision(words.decision_prior, BRAKE_PROBABILITY)
        }
        _ if prior.latent == Latent::BlockedWheel => {
            decision(words.decision_by_number, BLOCKED_PROBABILITY)
        }
        Distribution::Uniform { low, high } => {
            fill(words.uniform, &[("low", &value(low)), ("high", &value(high))])
        }
        Distribution::Normal { mean, sigma, low, high } => fill(
            words.normal_cut,
            &[
                ("mean", &value(mean)),
                ("sigma", &value(sigma)),
                ("low", &value(low)),
                ("high", &value(high)),
            ],
        ),
        Distribution::LogNormal { median, sigma, low, high } => fill(
            words.log_normal_cut,
            &[
                ("median", &value(median)),
                ("sigma", &wording.rounded(Quantity::Ratio, sigma)),
                ("low", &value(low)),
                ("high", &value(high)),
            ],
        ),
    };
    let (class, source) = match prior.source {
        PriorSource::Given => (InputClass::Given, words.source_prior_given),
        PriorSource::Measured => (InputClass::Measured, words.source_prior_measured),
        PriorSource::Estimated => (InputClass::Estimated, words.source_prior_rule),
        PriorSource::Assumed => (InputClass::Assumed, words.source_prior),
    };
    InputRow {
        group: words.prior.to_owned(),
        label: wording.term(prior.latent.label()),
        value: text,
        class,
        source: source.to_owned(),
    }
}

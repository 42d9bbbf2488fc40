//! The facts of an impulse solution.

use impactlab_core::collision::{FrictionModel, PrincipalDirectionOfForce, StruckSurface};
use impactlab_core::units::Quantity;

use crate::facts::{Fact, FactTable, Term, Value};
use crate::{BodyReport, ImpactReport, ImpulseRival, SkidReport};

/// Overlap or gap of outlines that counts as touching, m.
const TOUCHING_M: f64 = 5e-4;
/// Critical impulse ratio below which there is none but for rounding.
const ROUNDING: f64 = 1e-9;
/// Friction limit over the critical impulse ratio beyond which nothing is said by it.
const LARGEST_SHARE: f64 = 100.0;

impl ImpactReport {
    /// What the answer says: the contact, both vehicles after it, and whether the force network gives
    /// the same impulse.
    pub fn facts(&self) -> Vec<FactTable> {
        let beside = self.rival.iter().map(ImpulseRival::table);
        self.solution_tables().into_iter().chain(beside).collect()
    }

    /// The solution alone: the contact, and both vehicles after it.
    pub fn solution_tables(&self) -> [FactTable; 2] {
        let is_rough = self.is_rough();
        let [struck, striking] = [&self.struck, &self.striking].map(|body| body.values(is_rough));
        let terms = [
            Term::DeltaV,
            Term::VelocityAfter,
            Term::YawRateAfter,
            Term::YawRateChange,
            Term::Pdof,
            Term::ClockDirection,
        ];
        // An object that does not move has no motion after the impact.
        let (title, columns) = match self.fixed {
            Some(_) => (Term::StruckAfterImpact, &[Term::StruckVehicle][..]),
            None => (Term::VehiclesAfterImpact, &[Term::StruckVehicle, Term::StrikingVehicle][..]),
        };
        let both = terms.into_iter().zip(struck.into_iter().zip(striking));
        let row = |(term, (a, b))| {
            let values = [a, b].into_iter().take(columns.len()).collect();
            Fact::row(Value::Term(term), values)
        };
        let rows = both.map(row).collect();
        let vehicles = FactTable::new(title, rows).with_columns(columns);
        [FactTable::new(Term::Impact, self.contact()), vehicles]
    }

    /// Whether what the impact brings about has two digits: beside it stand the intervals of the same impulse,
    /// which make no more of them known.
    fn is_rough(&self) -> bool {
        self.rival.is_some()
    }

    /// The contact and what it brings about.
    fn contact(&self) -> Vec<Fact> {
        let phrase = |text: String| Value::Phrase(text);
        let restitution = vec![
            Value::Given(Quantity::Ratio, self.restitution),
            phrase(self.restitution_form.label().to_owned()),
        ];
        let mut friction = vec![match self.friction_of_critical {
            Some(_) => Value::Number(Quantity::Ratio, self.friction_limit),
            None => Value::Given(Quantity::Ratio, self.friction_limit),
        }];
        if self.friction_model == FrictionModel::Paper {
            friction.push(Value::Term(Term::AlwaysSliding));
        }
        let mut facts = vec![
            Fact::new(Term::Restitution, Value::Joined(restitution, " ")),
            Fact::new(Term::FrictionLimit, Value::Joined(friction, ", ")),
        ];
        if let Some(critical) = self.critical_impulse_ratio {
            // That of a central impact is nothing but rounding.
            let critical = if critical < ROUNDING { 0.0 } else { critical };
            facts.push(Fact::number(Term::CriticalRatio, Quantity::Ratio, critical));
            let share = self.friction_limit / critical;
            if critical > 0.0 && share < LARGEST_SHARE {
                facts.push(Fact::new(Term::ShareOfCritical, Value::Share(share)));
            }
        }
        let surface = match (&self.struck_surface, self.fixed) {
            (Some(StruckSurface::Striking(_)), Some(object)) => {
                phrase(format!("out of the {}", object.word()))
            }
            (Some(surface), _) => phrase(surface.to_string()),
            (None, _) => Value::Term(Term::AsGiven),
        };
        facts.extend([
            Fact::number(Term::ContactNormal, Quantity::Angle, self.normal_angle_rad),
            Fact::new(Term::StruckSurface, surface),
        ]);
        facts.extend(self.overlap_m.map(overlap));
        let closing = ["normal", "tangential"];
        let closing = Value::Vector(Quantity::Speed, self.closing_velocity_m_s, closing);
        let impulse = |si| number(self.is_rough(), Quantity::Impulse, si);
        facts.extend([
            Fact::new(Term::Regime, phrase(self.regime.label().to_owned())),
            Fact::new(Term::ClosingVelocity, closing),
            Fact::new(
                Term::ImpulseOnStruck,
                vector(self.is_rough(), Quantity::Impulse, self.impulse_n_s),
            ),
            Fact::new(Term::ImpulseNormal, impulse(self.impulse_normal_n_s)),
            Fact::new(Term::ImpulseTangential, impulse(self.impulse_tangential_n_s)),
            Fact::new(
                Term::EnergyLoss,
                number(self.is_rough(), Quantity::Energy, self.dissipated_energy_j),
            ),
        ]);
        facts.extend(self.skids.iter().map(SkidReport::fact));
        facts
    }
}

impl SkidReport {
    /// The speed before the skid.
    pub(super) fn fact(&self) -> Fact {
        let vehicle = match self.vehicle {
            "target" => Term::StruckVehicle,
            _ => Term::StrikingVehicle,
        };
        let name = vec![Value::Term(vehicle), Value::Term(Term::SpeedBeforeSkid)];
        let speed = Value::Number(Quantity::Speed, self.speed_before_m_s);
        Fact::row(Value::Joined(name, ", "), vec![speed])
    }
}

/// How far the outlines overlap or lie apart.
fn overlap(overlap_m: f64) -> Fact {
    match overlap_m {
        m if m.abs() < TOUCHING_M => Fact::new(Term::Overlap, Value::Term(Term::Touch)),
        m if m < 0.0 => Fact::number(Term::Gap, Quantity::Length, -m),
        m => Fact::number(Term::Overlap, Quantity::Length, m),
    }
}

/// A number without an interval, roughly if its uncertainty is known from elsewhere.
fn number(is_rough: bool, quantity: Quantity, value_si: f64) -> Value {
    match is_rough {
        true => Value::Rough(quantity, value_si),
        false => Value::Number(quantity, value_si),
    }
}

/// The same of a vector.
fn vector(is_rough: bool, quantity: Quantity, components_si: [f64; 2]) -> Value {
    match is_rough {
        true => Value::RoughVector(quantity, components_si, ["x", "y"]),
        false => Value::Vector(quantity, components_si, ["x", "y"]),
    }
}

/// A principal direction of force that has no interval, four digits.
pub(super) fn pdof_value(pdof_deg: f64) -> Value {
    let pdof = PrincipalDirectionOfForce::from_angle(pdof_deg.to_radians());
    Value::Number(Quantity::Angle, pdof.written_rad(1))
}

impl BodyReport {
    /// Change of velocity, velocity, yaw rate, its change and the direction of force.
    fn values(&self, is_rough: bool) -> [Value; 6] {
        let velocity = |value| vector(is_rough, Quantity::Speed, value);
        let yaw_rate = |value| number(is_rough, Quantity::AngularVelocity, value);
        let none = Value::Term(Term::None);
        let pdof = self.pdof_deg.map(|deg| match pdof_value(deg) {
            Value::Number(quantity, value_si) => number(is_rough, quantity, value_si),
            value => value,
        });
        [
            velocity(self.delta_v_m_s),
            velocity(self.velocity_m_s),
            yaw_rate(self.yaw_rate_rad_s),
            yaw_rate(self.delta_yaw_rate_rad_s),
            pdof.unwrap_or_else(|| none.clone()),
            self.pdof_clock.map_or(none, Value::Clock),
        ]
    }
}

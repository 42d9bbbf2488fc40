//! Writes scenarios as `SCENARIO.toml` files.

use crate::collision::scenario_file::{FRICTION_MODELS, LOCATIONS};
use crate::collision::{ContactLocation, FrictionModel, Scenario, ScenarioVehicle};
use crate::vehicle::FixedObject;

impl Scenario {
    /// Returns the text of a file from which [`Scenario::from_toml`] reads the same scenario.
    /// Quantities are in SI units and numbers are written with all their digits. A number that is
    /// not finite is written too, but the file is then refused on reading.
    pub fn to_toml(&self) -> String {
        let mut top = Lines::default();
        top.line("name", quoted(&self.name));
        top.line("notes", quoted(&self.notes));
        let mut struck = vehicle_lines("target", &self.struck);
        struck.vehicle(self.struck_vehicle.as_deref());
        struck.number("x_m", self.struck_x_world_m);
        struck.number("y_m", self.struck_y_world_m);
        let mut striking = vehicle_lines("bullet", &self.striking);
        striking.vehicle(self.striking_vehicle.as_deref());
        let mut contact = Lines("\n[contact]\n".to_owned());
        match self.contact.location {
            ContactLocation::Footprints { striking_x_world_m, striking_y_world_m } => {
                striking.number("x_m", striking_x_world_m);
                striking.number("y_m", striking_y_world_m);
                contact.line("from", quoted(LOCATIONS[0]));
            }
            ContactLocation::Side { side, offset_m } => {
                contact.line("from", quoted(LOCATIONS[1]));
                contact.line("side", quoted(side.name()));
                contact.number("offset_m", offset_m);
            }
            ContactLocation::Point {
                x_body_m,
                y_body_m,
                normal_body_rad,
                striking_x_world_m,
                striking_y_world_m,
            } => {
                striking.number("x_m", striking_x_world_m);
                striking.number("y_m", striking_y_world_m);
                contact.line("from", quoted(LOCATIONS[2]));
                contact.number("x_m", x_body_m);
                contact.number("y_m", y_body_m);
                contact.number("normal_rad", normal_body_rad);
            }
        }
        if let Some(restitution) = self.contact.restitution {
            contact.number("restitution", restitution);
        }
        contact.line("restitution_form", quoted(self.contact.restitution_form.name()));
        match (self.contact.friction_of_critical, self.contact.friction_limit) {
            (Some(share), _) => contact.number("friction_of_critical", share),
            (None, Some(limit)) => contact.number("friction_limit", limit),
            (None, None) => {}
        }
        let model = match self.contact.friction_model {
            FrictionModel::Limit => FRICTION_MODELS[0],
            FrictionModel::Paper => FRICTION_MODELS[1],
        };
        contact.line("friction_model", quoted(model));
        let mut ending = Lines::default();
        for (name, given) in [("ending", &self.ending), ("bullet_ending", &self.striking_ending)] {
            let Some(given) = given else { continue };
            ending.0.push_str(&format!("\n[{name}]\n"));
            for (key, value) in given.entries() {
                ending.line(&key, value);
            }
        }
        let mut road = Lines::default();
        if let Some(slope) = &self.road {
            road.0.push_str("\n[road]\n");
            slope.entries().into_iter().for_each(|(key, value)| road.number(key, value));
        }
        [top.0, struck.0, striking.0, contact.0, road.0, ending.0].concat()
    }
}

#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line(&mut self, key: &str, value: impl std::fmt::Display) {
        self.0.push_str(&format!("{key} = {value}\n"));
    }

    fn vehicle(&mut self, name: Option<&str>) {
        name.into_iter().for_each(|name| self.line("vehicle", quoted(name)));
    }

    fn number(&mut self, key: &str, value: f64) {
        // The Debug format keeps the decimal point or the exponent, by which TOML distinguishes
        // floats from integers.
        self.line(key, format_args!("{value:?}"));
    }
}

fn quoted(text: &str) -> toml::Value {
    toml::Value::String(text.to_owned())
}

fn vehicle_lines(name: &str, vehicle: &ScenarioVehicle) -> Lines {
    let mut lines = Lines(format!("\n[{name}]\n"));
    if let Some(object) = vehicle.fixed {
        lines.line("fixed", quoted(object.word()));
        match object {
            FixedObject::Wall => {
                lines.number("length_m", vehicle.length_m);
                lines.number("width_m", vehicle.width_m);
                lines.number("heading_rad", vehicle.heading_rad);
            }
            FixedObject::Pole => lines.number("diameter_m", vehicle.length_m),
        }
        return lines;
    }
    for (key, value) in [
        ("mass_kg", vehicle.mass_kg),
        ("yaw_inertia_kg_m2", vehicle.yaw_inertia_kg_m2),
        ("length_m", vehicle.length_m),
        ("width_m", vehicle.width_m),
        ("cg_from_front_m", vehicle.cg_from_front_m),
        ("heading_rad", vehicle.heading_rad),
        ("vx_m_s", vehicle.vx_world_m_s),
        ("vy_m_s", vehicle.vy_world_m_s),
        ("yaw_rate_rad_s", vehicle.yaw_rate_rad_s),
    ] {
        lines.number(key, value);
    }
    if let Some(skid) = vehicle.skid {
        lines.number("skid_length_m", skid.length_m);
        lines.number("skid_drag_factor", skid.drag_factor);
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::collision::RestitutionForm;
    use crate::data::TomlError;
    use crate::vehicle::{Braking, Ending, RoadSlope};

    const PIT: &str = include_str!("../../../../assets/scenarios/pit_right_rear.toml");

    fn read(text: &str) -> Result<Scenario, TomlError> {
        Scenario::from_toml(text, Path::new("scenario.toml"))
    }

    #[test]
    fn what_is_written_reads_back_the_same() {
        let mut scenario = read(PIT).unwrap();
        scenario.name = "a \"quoted\"\nname \\ µ".to_owned();
        scenario.struck_y_world_m = -1e-9;
        scenario.contact.friction_model = FrictionModel::Paper;
        scenario.ending =
            Some(Ending { brake: Some(Braking::new(0.1 + 0.2, 1.2, 0.5)), ..Ending::default() });
        scenario.striking_ending = scenario.ending.clone();
        scenario.road = Some(RoadSlope { grade: -0.1 - 0.02, cross_slope: 0.025 });
        scenario.contact.restitution_form = RestitutionForm::CommonVelocity;
        for location in [
            scenario.contact.location,
            ContactLocation::Footprints { striking_x_world_m: 0.1 + 0.2, striking_y_world_m: -3.0 },
            ContactLocation::Point {
                x_body_m: -1.4,
                y_body_m: -0.9,
                normal_body_rad: std::f64::consts::FRAC_PI_2,
                striking_x_world_m: -3.0,
                striking_y_world_m: 1e5,
            },
        ] {
            scenario.contact.location = location;
            let text = scenario.to_toml();
            assert_eq!(read(&text).unwrap(), scenario, "{text}");
            let json = serde_json::to_string(&scenario).unwrap();
            assert_eq!(serde_json::from_str::<Scenario>(&json).unwrap(), scenario, "{json}");
        }
    }
}

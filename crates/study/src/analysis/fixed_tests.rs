use std::path::Path;

use super::*;
use impactlab_core::data::Channel;

fn scenario(object: &str) -> Scenario {
    let text = format!(
        "[target]\nmass_kg = 1500\nyaw_inertia_kg_m2 = 2500\nlength_m = 4.5\nwidth_m = 1.8\n\
         cg_from_front_m = 2.2\nspeed_m_s = 14\n[bullet]\n{object}\n[contact]\nfrom = \"side\"\n\
         side = \"front\"\noffset_m = 0\nrestitution = 0.1\n"
    );
    Scenario::from_toml(&text, Path::new("s.toml")).unwrap()
}

/// A car bounces off an object that stays where it is to the last digit, and that is not dented.
#[test]
fn a_car_bounces_off_an_object_that_does_not_move() {
    for object in ["fixed = \"wall\"", "fixed = \"pole\"\ndiameter_m = 0.5"] {
        let settings = Settings { duration_s: 1.0, ..Settings::of_preset(Preset::Target) };
        let scenario = scenario(object);
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
        let striking = analysis.striking.unwrap();
        assert_eq!(striking.start.vehicle.fixed, scenario.striking.fixed);
        for channel in [Channel::X, Channel::Y, Channel::Yaw] {
            let values = striking.motion.require(channel).unwrap();
            assert!(values.iter().all(|value| value == &values[0]), "{object}: {channel:?}");
        }
        let speed_m_s = analysis.simulation.unwrap().series.require(Channel::Vx).unwrap()[15];
        assert!((-5.0..-0.3).contains(&speed_m_s), "{object}: {speed_m_s} m/s after the contact");
        let [car, wall] = analysis.dents_m.map(|dents| dents.into_iter().fold(0.0, f64::max));
        assert!(car > 0.05 && wall < 0.01, "{object}: {car} {wall} m");
    }
}

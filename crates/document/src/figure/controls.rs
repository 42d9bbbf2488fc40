//! What drivers, brakes and stability control did to the wheels of both vehicles over time.

use crate::figure::{Axis, Band, Figure, FigureElement, LineStyle, Role, Series};
use impactlab_core::collision;
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::numerics::interpolate;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem, significant};
use impactlab_core::vehicle::{BRAKE_TORQUES, DRIVE_TORQUES, Wheel};
use impactlab_study::analysis::Analysis;

/// What figures call both vehicles.
const STRUCK: &str = collision::Role::Struck.label();
pub(crate) const STRIKING: &str = collision::Role::Striking.label();

/// What they call a vehicle that is driven and touches nothing.
const ALONE: &str = "car";

/// The axis of the brakes of each wheel of such a vehicle.
pub(crate) const BRAKES_ALONE: &str = "Braking torque of each wheel (with ESC)";

/// What a figure of the inputs to the wheels shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WheelInput {
    /// The steer angle of the road wheels of both vehicles.
    Steering,
    /// The braking torque of both vehicles, summed over the wheels.
    Braking,
    /// The drive torque of both vehicles, summed over the wheels.
    Drive,
    /// The braking torque of each wheel of the struck vehicle, where it has a stability control.
    StruckBrakes,
    /// The braking torque of each wheel of the striking vehicle, where it has a stability control.
    StrikingBrakes,
}

/// Opacity of the time in contact.
const CONTACT_OPACITY: f32 = 0.25;

/// A vehicle with what was done to its wheels, SI units.
struct DrivenVehicle<'a> {
    name: &'static str,
    role: Role,
    style: LineStyle,
    motion: &'a TimeSeries,
    /// Torques of the wheels by their channels; empty where no wheel is braked or driven.
    torques_n_m: Vec<(Channel, Vec<f64>)>,
    has_stability_control: bool,
}

/// A curve over the samples of a motion, SI units.
struct Curve<'a> {
    name: String,
    role: Role,
    style: LineStyle,
    motion: &'a TimeSeries,
    values: Vec<f64>,
}

impl WheelInput {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Self; 5] =
        [Self::Steering, Self::Braking, Self::Drive, Self::StruckBrakes, Self::StrikingBrakes];

    /// As the axis of its figure calls it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Steering => "Steer angle of the road wheels",
            Self::Braking => "Braking torque of all wheels",
            Self::Drive => "Drive torque of all wheels",
            Self::StruckBrakes => "Braking torque of each wheel, struck vehicle (with ESC)",
            Self::StrikingBrakes => "Braking torque of each wheel, striking vehicle (with ESC)",
        }
    }

    /// The same in a figure of an analysis: a vehicle that touches nothing is no struck one.
    fn label_of(self, analysis: &Analysis) -> &'static str {
        match self {
            Self::StruckBrakes if analysis.is_alone() => BRAKES_ALONE,
            _ => self.label(),
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Self::Steering => Quantity::Angle,
            _ => Quantity::Moment,
        }
    }

    fn curves<'a>(self, vehicles: &[DrivenVehicle<'a>]) -> Vec<Curve<'a>> {
        let brakes_of = |role: Role| {
            let of_role = vehicles.iter().find(|of| of.role == role && of.has_stability_control);
            of_role.map_or_else(Vec::new, DrivenVehicle::brakes)
        };
        match self {
            Self::Steering => {
                curves(vehicles, |vehicle| Some(vehicle.motion.get(Channel::SteerFl)?.to_vec()))
            }
            Self::Braking => curves(vehicles, |vehicle| vehicle.summed_n_m(&BRAKE_TORQUES)),
            Self::Drive => curves(vehicles, |vehicle| vehicle.summed_n_m(&DRIVE_TORQUES)),
            Self::StruckBrakes => brakes_of(Role::Simulation),
            Self::StrikingBrakes => brakes_of(Role::Striking),
        }
    }
}

/// Every input to the wheels that is not zero throughout: without any, nobody steers, brakes or drives on.
pub fn control_figures(analysis: &Analysis, caveats: &Caveats, units: UnitSystem) -> Vec<Figure> {
    let figure = |input| control_figure(analysis, input, caveats, units);
    WheelInput::ALL.into_iter().filter_map(figure).collect()
}

/// An input to the wheels over time, with the times in contact marked; `None` where it is zero throughout.
pub fn control_figure(
    analysis: &Analysis,
    input: WheelInput,
    caveats: &Caveats,
    units: UnitSystem,
) -> Option<Figure> {
    let curves = input.curves(&vehicles(analysis));
    let y = Axis::shown(input.label_of(analysis), input.quantity(), units);
    let axes = [Axis::shown("Time", Quantity::Time, units), y];
    let caveats = caveats.in_units(units);
    (!curves.is_empty()).then(|| curves_figure(analysis, axes, &curves).with_caveats(&caveats))
}

/// The curve of each vehicle that has one.
fn curves<'a>(
    vehicles: &[DrivenVehicle<'a>],
    values: impl Fn(&DrivenVehicle<'a>) -> Option<Vec<f64>>,
) -> Vec<Curve<'a>> {
    vehicles.iter().filter_map(|vehicle| vehicle.curve(values(vehicle)?)).collect()
}

/// The values of the curves of a figure at an abscissa with their names, such as “Steer angle: struck
/// vehicle 3.1 · striking vehicle 0 deg”.
///
/// - `x_si`: the abscissa, SI units.
pub fn figure_readout(figure: &Figure, x_si: f64) -> String {
    let at = figure.x.unit.from_si(x_si);
    let value = |element: &FigureElement| {
        let FigureElement::Line(series) = element else { return None };
        let [x, y] =
            [0, 1].map(|axis| series.points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
        Some(format!("{} {}", series.name, significant(interpolate(&x, &y, at)?)))
    };
    let values: Vec<String> = figure.elements.iter().filter_map(value).collect();
    format!("{}: {} {}", figure.y.label, values.join(" · "), figure.y.unit.symbol)
}

/// The vehicles of which it is known what was done to their wheels.
fn vehicles(analysis: &Analysis) -> Vec<DrivenVehicle<'_>> {
    let struck = analysis.simulation.as_ref().map(|motion| {
        let radius_m = analysis.vehicle.tires.rolling_radius_m;
        DrivenVehicle {
            name: if analysis.is_alone() { ALONE } else { STRUCK },
            role: Role::Simulation,
            style: LineStyle::Solid,
            motion: &motion.series,
            torques_n_m: analysis.controls.torques_n_m(motion.series.time_s(), radius_m),
            has_stability_control: analysis.has_stability_control,
        }
    });
    let striking = analysis.striking.as_ref().map(|track| {
        let radius_m = track.start.vehicle.tires.rolling_radius_m;
        DrivenVehicle {
            name: STRIKING,
            role: Role::Striking,
            style: LineStyle::Dashed,
            motion: &track.motion,
            torques_n_m: track.controls.torques_n_m(track.motion.time_s(), radius_m),
            has_stability_control: track.start.controls.has_stability_control(),
        }
    });
    struck.into_iter().chain(striking).collect()
}

impl<'a> DrivenVehicle<'a> {
    /// A curve of this vehicle; `None` where it is zero throughout.
    fn curve(&self, values: Vec<f64>) -> Option<Curve<'a>> {
        let is_acting = values.iter().any(|value| *value != 0.0);
        is_acting.then(|| Curve {
            name: self.name.to_owned(),
            role: self.role,
            style: self.style,
            motion: self.motion,
            values,
        })
    }

    fn torque_n_m(&self, channel: Channel) -> Option<&[f64]> {
        self.torques_n_m.iter().find(|(of, _)| *of == channel).map(|(_, values)| &**values)
    }

    /// The sum of the torques of some channels; `None` without torques.
    fn summed_n_m(&self, channels: &[Channel; 4]) -> Option<Vec<f64>> {
        let columns: Option<Vec<&[f64]>> =
            channels.iter().map(|channel| self.torque_n_m(*channel)).collect();
        let columns = columns?;
        let sum = |sample: usize| columns.iter().map(|column| column[sample]).sum();
        Some((0..self.motion.n_samples()).map(sum).collect())
    }

    /// The braking torque of each wheel; those that are zero throughout are left out.
    fn brakes(&self) -> Vec<Curve<'a>> {
        let of_wheel = |wheel: Wheel| {
            let index = wheel.index();
            let curve = self.curve(self.torque_n_m(BRAKE_TORQUES[index])?.to_vec())?;
            let is_left = index.is_multiple_of(2);
            let line = if wheel.is_front() { "" } else { " (dashed)" };
            Some(Curve {
                name: format!("{}{line}", wheel.label()),
                role: if is_left { Role::LeftWheel } else { Role::RightWheel },
                style: if wheel.is_front() { LineStyle::Solid } else { LineStyle::Dashed },
                ..curve
            })
        };
        Wheel::ALL.into_iter().filter_map(of_wheel).collect()
    }
}

/// The curves over time, before the times in contact.
fn curves_figure(analysis: &Analysis, [x, y]: [Axis; 2], curves: &[Curve<'_>]) -> Figure {
    let line = |curve: &Curve<'_>| {
        let samples = curve.motion.time_s().iter().zip(&curve.values);
        let points = samples.map(|(&t, &v)| [x.unit.from_si(t), y.unit.from_si(v)]).collect();
        let Curve { name, role, style, .. } = curve;
        FigureElement::Line(Series { name: name.clone(), role: *role, style: *style, points })
    };
    let lines: Vec<FigureElement> = curves.iter().map(line).collect();
    let values = || curves.iter().flat_map(|curve| curve.values.iter().map(|v| y.unit.from_si(*v)));
    let [low, high] = [values().fold(0.0, f64::min), values().fold(0.0, f64::max)];
    let ends_s = curves.iter().filter_map(|curve| curve.motion.time_s().last().copied());
    let contacts_s = analysis.contacts_s(ends_s.fold(0.0, f64::max));
    let contacts = contacts_s.into_iter().map(|span_s| {
        FigureElement::Band(Band {
            name: "in contact".to_owned(),
            role: Role::Muted,
            opacity: CONTACT_OPACITY,
            x: span_s.map(|time_s| x.unit.from_si(time_s)).to_vec(),
            low: vec![low; 2],
            high: vec![high; 2],
        })
    });
    let title = format!("{}: {} over time", analysis.name, y.label);
    let elements = contacts.chain(lines).collect();
    Figure::new(title, [x, y], elements)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::Scenario;
    use impactlab_core::units::STANDARD_GRAVITY_M_S2;
    use impactlab_core::vehicle::{
        Braking, Ending, Integrator, PitDriver, Preset, StabilityControl, VehicleState,
    };
    use impactlab_study::analysis::{
        DriveSetup, PulseSetup, Settings, analyse_drive, analyse_scenario,
    };

    fn analysis(struck: Ending, striking: Ending) -> Analysis {
        let mut scenario = Scenario::example();
        scenario.striking_ending = Some(striking);
        analyse_scenario(&scenario, &PulseSetup::default(), &settings(struck)).unwrap()
    }

    fn settings(struck: Ending) -> Settings {
        Settings {
            struck: Preset::Target.parameters(),
            striking: Preset::Bullet2000.parameters(),
            ending: struck,
            integrator: Integrator::Rk4,
            duration_s: 2.0,
            ends_at_rest: false,
            one_contact: false,
            friction_zones: Vec::new(),
        }
    }

    fn figures(analysis: &Analysis) -> Vec<Figure> {
        control_figures(analysis, &Caveats::default(), UnitSystem::Si)
    }

    fn names(figure: &Figure) -> Vec<&str> {
        figure.elements.iter().map(FigureElement::name).collect()
    }

    #[test]
    fn what_both_vehicles_are_given_is_in_their_curves() {
        let brake = Braking::new(0.5, 0.6, 0.2);
        let struck = Ending { brake: Some(brake), ..Ending::default() };
        let pit = PitDriver::default();
        let esc = Some(StabilityControl::default());
        let striking = Ending { pit: Some(pit), esc, ..Ending::default() };
        let analysis = analysis(struck, striking);
        let figures = figures(&analysis);
        let labels: Vec<&str> = figures.iter().map(|figure| &*figure.y.label).collect();
        let expected = WheelInput::ALL.map(WheelInput::label);
        assert_eq!(labels[..3], expected[..3], "{labels:?}");
        let [steer, brakes, drive] = [0, 1, 2].map(|i| &figures[i]);
        assert_eq!(names(steer)[..], ["in contact", "striking vehicle"][..]);
        assert!(names(brakes).contains(&"struck vehicle"), "{:?}", names(brakes));
        assert_eq!(*names(drive).last().unwrap(), "striking vehicle");
        // The torque of the brakes is that of the ending: a share of what the road holds.
        let (mass_kg, tires) = (analysis.vehicle.mass.mass_kg, analysis.vehicle.tires);
        let force_n = 0.6 * tires.friction * mass_kg * STANDARD_GRAVITY_M_S2;
        let expected = force_n * tires.rolling_radius_m / 1e3;
        let of_struck = |element: &&FigureElement| element.name() == "struck vehicle";
        let Some(FigureElement::Line(series)) = brakes.elements.iter().find(of_struck) else {
            panic!("no line of the struck vehicle")
        };
        let [t, torque_kn_m] = series.points[150];
        assert!((t - 1.5).abs() < 1e-9 && (torque_kn_m / expected - 1.0).abs() < 1e-9);
        assert_eq!(series.points[40][1], 0.0, "nobody brakes before 0.5 s");
        assert_eq!(series.style, LineStyle::Solid);
        // The driver turns the wheels by the angle of the steering wheel over the ratio.
        let Some(FigureElement::Line(series)) = steer.elements.last() else { panic!("no line") };
        let largest = series.points.iter().map(|point| point[1]).fold(0.0, f64::max);
        let asked = pit.acting().road_wheel_rad().to_degrees();
        assert!((largest - asked).abs() < 0.2, "{largest} deg, asked for {asked}");
        assert_eq!(series.style, LineStyle::Dashed);
        let readout = figure_readout(brakes, 1.5);
        let torque = significant(torque_kn_m);
        assert!(readout.starts_with("Braking torque of all wheels: struck vehicle "), "{readout}");
        assert!(readout.contains(&torque) && readout.ends_with(" kN m"), "{readout}");
        // A contact is marked within the curves.
        let FigureElement::Band(band) = &steer.elements[0] else { panic!("no contact") };
        assert_eq!(band.x[0], analysis.phases[0].start_s);
    }

    #[test]
    fn the_brakes_of_each_wheel_are_those_that_the_stability_control_uses() {
        let esc = Some(StabilityControl::default());
        let analysis = analysis(Ending { esc, ..Ending::default() }, Ending::default());
        let figures = figures(&analysis);
        let labels: Vec<&str> = figures.iter().map(|figure| &*figure.y.label).collect();
        let expected = [WheelInput::Braking, WheelInput::StruckBrakes].map(WheelInput::label);
        assert_eq!(labels, expected);
        let of_wheels = |element: &FigureElement| match element {
            FigureElement::Line(series) => {
                Some((series.name.clone(), series.points.iter().map(|p| p[1]).sum::<f64>()))
            }
            _ => None,
        };
        let wheels: Vec<_> = figures[1].elements.iter().filter_map(of_wheels).collect();
        let total: f64 = figures[0].elements.iter().filter_map(of_wheels).map(|of| of.1).sum();
        let sum: f64 = wheels.iter().map(|of| of.1).sum();
        assert!((sum / total - 1.0).abs() < 1e-9, "{sum} of {total}");
        let is_wheel = |name: &str| Wheel::ALL.iter().any(|wheel| name.starts_with(wheel.label()));
        assert!(wheels.iter().all(|(name, _)| is_wheel(name)), "{wheels:?}");
    }

    /// A car that nothing strikes had no curves of its single brakes.
    #[test]
    fn the_brakes_of_each_wheel_are_those_of_a_car_without_a_force_as_well() {
        let esc = Some(StabilityControl::default());
        let setup = DriveSetup {
            initial: VehicleState {
                vx_body_m_s: 20.0,
                yaw_rate_rad_s: 1.0,
                ..VehicleState::default()
            },
            load: None,
            steer: None,
            wheels: None,
            notes: Vec::new(),
        };
        let settings = settings(Ending { esc, ..Ending::default() });
        let analysis = analyse_drive("spin", setup, &settings).unwrap();
        let figures = figures(&analysis);
        let labels: Vec<&str> = figures.iter().map(|figure| &*figure.y.label).collect();
        assert_eq!(labels, [WheelInput::Braking.label(), BRAKES_ALONE]);
        assert!(!names(&figures[1]).is_empty());
        // Nothing has struck it.
        assert_eq!(names(&figures[0]), ["car"]);
    }

    #[test]
    fn nobody_acts_in_a_scenario_that_coasts() {
        assert!(figures(&analysis(Ending::default(), Ending::default())).is_empty());
    }
}

//! Later contacts of the cars: whether they meet again after the impact, and their motion through all of
//! them.
//!
//! The impulse of the first contact is that of the momentum solution. Whether the cars meet again is seen on
//! the motions that follow from it alone: they do where, after the contact, the depth D(t) to which one
//! outline lies in the other one grows again,
//!
//! ```text
//! D(t) > max(0, min over t' < t of D(t')) + 2 cm
//! ```
//!
//! Both cars are then followed together ([`VehiclePair`]): the pulse of the first contact drives both, and
//! the contact law, scaled by the work of the pulse, takes over at its end.

use impactlab_core::collision::Pose;
use impactlab_core::collision::contact::{
    ContactBody, ContactConditions, ContactOutline, CoupledSettings, FaceLaws, PairMotion, PairRun,
    PairVehicle, VehiclePair, way_to_touch_m,
};
use impactlab_core::data::{ForceHistory, Sampling};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Manoeuvre, Motion, Path, PathEnd, PathLimit, PathPoint,
    SimulationRun,
};

use crate::Cars;
use crate::forward::CONTACT_HEIGHT_M;

/// Growth of the depth of one outline in the other one from which on the cars push each other again, m.
const GROWTH_M: f64 = 0.02;

/// Interval at which it is asked how deep one outline lies in the other one, s.
const INTERVAL_S: f64 = 0.01;

/// Length of the elements of an outline, m: of thousands of motions none is told by itself.
const LONGEST_ELEMENT_M: f64 = 0.2;

/// Longest way of the striking car that closes the gap between rounded outlines, m.
const LONGEST_WAY_M: f64 = 1.0;

/// Accelerations that the equations of motion leave out: none.
const NOTHING_ELSE: [[f64; 4]; 2] = [[0.0; 4]; 2];

/// The outlines of the two cars of a case; arrays are struck, striking.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LaterContacts {
    outlines: [ContactOutline; 2],
    /// Radius about the CG in which each outline lies, m.
    reach_m: [f64; 2],
}

/// What becomes of later contacts.
#[derive(Debug, Clone)]
pub(crate) enum Later {
    /// Nobody looks for them.
    LeftOut,
    /// It is told where the cars meet again.
    Watched(LaterContacts),
    /// The cars are followed together where they meet again.
    Followed(LaterContacts),
}

impl Later {
    pub fn contacts(&self) -> Option<&LaterContacts> {
        match self {
            Self::LeftOut => None,
            Self::Watched(contacts) | Self::Followed(contacts) => Some(contacts),
        }
    }

    pub fn are_followed(&self) -> bool {
        matches!(self, Self::Followed(_))
    }
}

/// Contact of the cars of one particle beside their impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ParticleContact {
    /// Loads of the faces of both cars over those of their class.
    pub stiffness_factor: f64,
    /// Coefficient of friction between the cars.
    pub friction: f64,
    /// Direction of the contact normal, which points into the struck car, world axes, rad.
    pub normal_rad: f64,
}

/// A car on its way.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FollowedCar {
    /// What was done to it, with the forces of all contacts that are followed.
    pub manoeuvre: Manoeuvre,
    /// Its path.
    pub path: Path,
}

impl FollowedCar {
    pub fn new(manoeuvre: Manoeuvre, path: Path) -> Self {
        Self { manoeuvre, path }
    }

    /// A car with the force of all contacts along its recorded motion.
    fn from_motion(manoeuvre: &Manoeuvre, motion: &Motion, is_far: bool) -> Option<Self> {
        let force = ForceHistory::from_series(&motion.series, Sampling::ComingMean).ok()?;
        // Its yaw moment is recorded, so that its place in the plane does not count.
        let contact = ContactPoint { x_body_m: 0.0, y_body_m: 0.0, height_m: CONTACT_HEIGHT_M };
        let contact_load = Some(ContactLoad { force, contact, recorded_moment: true });
        let manoeuvre = Manoeuvre { contact_load, ..manoeuvre.clone() };
        Some(Self::new(manoeuvre, path(motion, is_far)?))
    }
}

impl LaterContacts {
    /// `None` for cars whose outer dimensions make no outline.
    pub fn new(cars: &Cars) -> Option<Self> {
        let outline =
            |car: &crate::Car| ContactOutline::of_elements(&car.parameters, LONGEST_ELEMENT_M).ok();
        let outlines = [outline(&cars.struck)?, outline(&cars.striking)?];
        let reach = |outline: &ContactOutline| {
            let away_m =
                outline.elements().iter().map(|it| it.point_body_m[0].hypot(it.point_body_m[1]));
            away_m.fold(0.0, f64::max)
        };
        let reach_m = [reach(&outlines[0]), reach(&outlines[1])];
        Some(Self { outlines, reach_m })
    }

    /// Whether cars on their paths meet again after a time, s.
    pub fn meet_again(&self, paths: [&Path; 2], from_s: f64) -> bool {
        let mut cursors = paths.map(|path| PathCursor { points: &path.points, next: 0 });
        let ends_s = paths.map(|path| path.points.last().map_or(0.0, |last| last.time_s));
        let n = ((ends_s[0].max(ends_s[1]) - from_s) / INTERVAL_S).ceil().max(0.0) as usize;
        let mut least_m = f64::INFINITY;
        for i in 0..=n {
            let time_s = from_s + i as f64 * INTERVAL_S;
            let [Some(struck), Some(striking)] = [0, 1].map(|i| cursors[i].pose_at(time_s)) else {
                return false;
            };
            let depth_m = self.depth_m([&struck, &striking]);
            if depth_m > least_m.max(0.0) + GROWTH_M {
                return true;
            }
            least_m = least_m.min(depth_m);
        }
        false
    }

    /// Depth to which one outline lies in the other one, m; 0 or less where they are apart.
    fn depth_m(&self, poses: [&Pose; 2]) -> f64 {
        let [struck, striking] = poses;
        let between_m = (striking.x_m - struck.x_m).hypot(striking.y_m - struck.y_m);
        let [of_struck, of_striking] = self.reach_m;
        let near_m = of_struck + of_striking - between_m;
        if near_m < 0.0 {
            return near_m;
        }
        let depths = (0..2).flat_map(|own| {
            let (entered, outline) = (poses[1 - own], &self.outlines[1 - own]);
            self.outlines[own].elements().iter().map(move |element| {
                let point = poses[own].world_from_body(element.point_body_m);
                outline.depth_of_body_point_m(entered.body_from_world(point))
            })
        });
        depths.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Both cars through all contacts, to rest; `None` where they cannot be computed.
    ///
    /// - `cars`: the struck one with the pulse of the first contact; that of the striking one is the
    ///   opposite one and is not used.
    pub fn follow(
        &self,
        [struck, striking]: [SimulationRun<'_>; 2],
        contact: &ParticleContact,
        limit: PathLimit,
    ) -> Option<[FollowedCar; 2]> {
        let mut initial = striking.manoeuvre.initial;
        let pose = |manoeuvre: &Manoeuvre| Pose::from_state(&manoeuvre.initial);
        // Rounded corners leave a gap where the momentum solution has the cars touch.
        let poses = [&pose(struck.manoeuvre), &pose(striking.manoeuvre)];
        let outlines = [&self.outlines[0], &self.outlines[1]];
        let way_m = way_to_touch_m(outlines, poses, contact.normal_rad, LONGEST_WAY_M);
        let (sin, cos) = contact.normal_rad.sin_cos();
        initial.x_m += way_m.unwrap_or(0.0) * cos;
        initial.y_m += way_m.unwrap_or(0.0) * sin;
        let striking_manoeuvre =
            Manoeuvre { initial, contact_load: None, ..striking.manoeuvre.clone() };
        let of_pair = |i: usize, vehicle, manoeuvre| {
            let faces = FaceLaws::by_class(vehicle).ok()?;
            let faces = faces.map(|face| face.scaled(contact.stiffness_factor));
            let body = ContactBody { outline: &self.outlines[i], faces };
            Some(PairVehicle { vehicle, manoeuvre, body })
        };
        let vehicles = [
            of_pair(0, struck.vehicle, struck.manoeuvre)?,
            of_pair(1, striking.vehicle, &striking_manoeuvre)?,
        ];
        let pair = VehiclePair {
            vehicles,
            conditions: ContactConditions {
                friction: contact.friction,
                height_m: CONTACT_HEIGHT_M,
                ..ContactConditions::default()
            },
            settings: CoupledSettings {
                has_long_steps: true,
                until_both_rest: true,
                first_force_is_whole: true,
                ..CoupledSettings::default()
            },
        };
        let starts = [pose(struck.manoeuvre), pose(&striking_manoeuvre)];
        let mut run = PairRun::new(&pair).ok()?;
        let mut are_far = [false; 2];
        while run.goes_on(&NOTHING_ELSE).ok()? {
            let (states, at_rest) = (run.states(), run.are_at_rest());
            are_far = [0, 1].map(|i| {
                let [dx, dy] = [states[i].x_m - starts[i].x_m, states[i].y_m - starts[i].y_m];
                dx.hypot(dy) > limit.distance_m
            });
            // A car that is far away does not come back to one that is at rest.
            if (0..2).all(|i| are_far[i] || at_rest[i]) {
                break;
            }
        }
        let PairMotion { motions: [of_struck, of_striking], .. } = run.finish().ok()?;
        Some([
            FollowedCar::from_motion(struck.manoeuvre, &of_struck, are_far[0])?,
            FollowedCar::from_motion(&striking_manoeuvre, &of_striking, are_far[1])?,
        ])
    }
}

/// The path of a recorded motion.
fn path(motion: &Motion, is_far: bool) -> Option<Path> {
    let mut points = PathPoint::of_series(&motion.series).ok()?;
    let rest_s = motion.rest_s.unwrap_or(f64::INFINITY);
    points.retain(|point| point.time_s <= rest_s);
    let end = match motion.rest_s {
        Some(_) => PathEnd::Rest,
        None if is_far => PathEnd::Far,
        None => PathEnd::Time,
    };
    Some(Path { points, end })
}

/// A place on a path that goes on with time.
struct PathCursor<'a> {
    points: &'a [PathPoint],
    /// First point that is later than the last time asked for.
    next: usize,
}

impl PathCursor<'_> {
    /// The pose at a time that is not before the last one, s: the last one after the end of the path.
    fn pose_at(&mut self, time_s: f64) -> Option<Pose> {
        while self.points.get(self.next).is_some_and(|point| point.time_s <= time_s) {
            self.next += 1;
        }
        let pose = |at: &PathPoint| Pose { x_m: at.x_m, y_m: at.y_m, yaw_rad: at.yaw_rad };
        let Some(to) = self.points.get(self.next) else { return self.points.last().map(pose) };
        let Some(from) = self.next.checked_sub(1).and_then(|before| self.points.get(before)) else {
            return Some(pose(to));
        };
        let share = (time_s - from.time_s) / (to.time_s - from.time_s);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Some(Pose {
            x_m: mix(from.x_m, to.x_m),
            y_m: mix(from.y_m, to.y_m),
            yaw_rad: mix(from.yaw_rad, to.yaw_rad),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use crate::{CollisionMotion, ForwardModel};
    use impactlab_core::data::Channel;
    use impactlab_core::vehicle::Integrator;

    /// Particles that differ in every component, most of all in how much faster the striking car is.
    fn particles(dim: usize) -> Vec<Vec<f64>> {
        let at = |i: usize, k: usize| 0.5 * (1.7 * i as f64 + 2.3 * k as f64 + 0.4).sin();
        (0..16)
            .map(|i| {
                let mut z: Vec<f64> = (0..dim).map(|k| at(i, k)).collect();
                (z[0], z[1]) = (-0.4, -1.5 + 0.25 * i as f64);
                z
            })
            .collect()
    }

    fn deepest_m(later: &LaterContacts, motion: &CollisionMotion) -> f64 {
        let paths = [&motion.path, &motion.striking.as_ref().unwrap().path];
        let mut cursors = paths.map(|path| PathCursor { points: &path.points, next: 0 });
        let depth_m = |i: usize| {
            let time_s = 0.3 + 0.01 * i as f64;
            let [struck, striking] = [0, 1].map(|i| cursors[i].pose_at(time_s).unwrap());
            later.depth_m([&struck, &striking])
        };
        (0..400).map(depth_m).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn cars_that_part_move_as_by_the_impact_and_those_that_meet_do_not_drive_through_each_other() {
        let evidence = read(SPIN);
        let cars = Cars::new(&evidence, None, None);
        let later = LaterContacts::new(&cars).unwrap();
        let model = ForwardModel::new(&evidence, cars).through_later_contacts(&evidence);
        let alone = model.clone().with_contacts_left_out();
        let z = particles(model.prior().components().len());
        let [through, alone] = [&model, &alone].map(|model| model.motions(&z, |motion| motion));
        let mut n_meet = 0;
        for (through, alone) in through.iter().zip(&alone) {
            assert_eq!(through.meet_again, alone.meet_again);
            if through.meet_again == Some(false) {
                assert_eq!((&through.path, &through.striking), (&alone.path, &alone.striking));
                continue;
            }
            n_meet += 1;
            assert_ne!(through.path, alone.path);
            let [kept_m, driven_through_m] = [through, alone].map(|it| deepest_m(&later, it));
            assert!(kept_m < 0.7 && driven_through_m > kept_m, "{kept_m} {driven_through_m}");
            for path in [&through.path, &through.striking.as_ref().unwrap().path] {
                assert_eq!(path.end, PathEnd::Rest);
            }
            // The forces of all contacts are those that lead there.
            let again = through.vehicle.simulate(&through.manoeuvre, Integrator::Rk4).unwrap();
            let [x, y] = [Channel::X, Channel::Y].map(|channel| again.series.get(channel).unwrap());
            let last = through.path.points.last().unwrap();
            let off_m = (x[x.len() - 1] - last.x_m).hypot(y[y.len() - 1] - last.y_m);
            assert!(off_m < 0.5, "{off_m} m");
        }
        assert!(n_meet > 1 && n_meet < z.len(), "{n_meet}");
    }

    #[test]
    fn a_depth_grows_again_where_a_car_is_followed_by_a_faster_one() {
        let evidence = read(SPIN);
        let later = LaterContacts::new(&Cars::new(&evidence, None, None)).unwrap();
        let path = |x_m: f64, speed_m_s: f64| {
            let at = |i: i32| {
                let time_s = 0.1 * f64::from(i);
                PathPoint {
                    time_s,
                    x_m: x_m + speed_m_s * time_s,
                    y_m: 0.0,
                    yaw_rad: 0.0,
                    vx_body_m_s: speed_m_s,
                    vy_body_m_s: 0.0,
                    yaw_rate_rad_s: 0.0,
                }
            };
            Path { points: (0..20).map(at).collect(), end: PathEnd::Time }
        };
        let behind_m = -5.2;
        let meets = |struck_m_s, striking_m_s| {
            later.meet_again([&path(0.0, struck_m_s), &path(behind_m, striking_m_s)], 0.1)
        };
        assert!(meets(10.0, 12.0), "it catches up");
        assert!(!meets(12.0, 10.0), "it falls behind");
    }
}

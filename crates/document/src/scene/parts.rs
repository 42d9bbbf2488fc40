//! What a scene consists of.

use std::sync::Arc;

use crate::figure::{Dashes, Role};
use crate::scene::{CarMotion, CarShape, CarState, SceneGround};
use impactlab_core::collision::Pose;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Language, UnitSystem};
use impactlab_core::vehicle::TireMarkPoint;
use impactlab_study::analysis::DensityMap;

/// Least length of the longer side of what a scene shows, m.
const LEAST_EXTENT_M: f64 = 12.0;
/// Half the least length of the sides, m: around a point where nothing moves.
const LEAST_HALF_M: f64 = 4.0;

/// Opacity of a ghost.
pub const GHOST_OPACITY: f32 = 0.45;

/// What something in a scene is, which gives its colour. It means the same in every view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneRole {
    /// Recorded or measured.
    Recorded,
    /// The struck vehicle as the 4DOF model simulates it.
    Simulated,
    /// A forecast with a network.
    Forecast,
    /// The striking vehicle.
    Striking,
    /// What was found after a collision.
    Evidence,
    /// The same in another variant of the case; the number counts the variants.
    Variant(usize),
    /// In the background.
    Muted,
    /// Rubber on the ground that is computed.
    TireMark,
    /// Outlines that are dented by construction.
    Crush,
}

impl SceneRole {
    /// Whether the path of a car of this role is dashed: that of a recording or of a variant beside the
    /// simulation.
    pub fn is_dashed(self) -> bool {
        matches!(self, Self::Recorded | Self::Variant(_))
    }

    /// What has the same colour and the same dashes in a plot; `None` of what no plot shows.
    pub fn in_plots(self) -> Option<Role> {
        match self {
            Self::Recorded => Some(Role::Reference),
            Self::Simulated => Some(Role::Simulation),
            Self::Forecast => Some(Role::Target),
            Self::Striking => Some(Role::Striking),
            Self::Evidence => Some(Role::Pulse),
            Self::Variant(idx) => Some(Role::Variant(idx)),
            Self::Muted => Some(Role::Muted),
            Self::TireMark | Self::Crush => None,
        }
    }

    /// How its lines are dashed where they are, as in a plan.
    pub fn dashes(self) -> Dashes {
        self.in_plots().map(Role::dashes).unwrap_or_default()
    }
}

/// How a car is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CarLook {
    /// As a body.
    Solid,
    /// As a body that lets what lies behind it shine through.
    Ghost,
}

/// A car that drives or stands.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneCar {
    /// Name in the legend; the same for cars that belong together.
    pub name: String,
    /// Short name beside the car; none if it is empty.
    pub tag: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// How it is drawn.
    pub look: CarLook,
    /// Its meshes.
    pub shape: Arc<CarShape>,
    /// Its motion.
    pub motion: Arc<CarMotion>,
}

impl SceneCar {
    /// Where the car is, and how its wheels stand.
    pub fn at(&self, time_s: f64) -> CarState {
        self.motion.at(time_s)
    }

    /// Whether it is one of many draws of a forecast, of which only the paths are of use to other programs.
    pub fn is_draw(&self) -> bool {
        self.look == CarLook::Ghost && self.role == SceneRole::Forecast && self.tag.is_empty()
    }
}

/// The path of a car.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenePath {
    /// Name in the legend.
    pub name: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// Whether it is dashed: a recording or a variant beside a simulation.
    pub is_dashed: bool,
    /// Whether ticks show the heading along it.
    pub has_ticks: bool,
    /// The motion along it.
    pub motion: Arc<CarMotion>,
}

/// A line on the ground: a mark, an outline, the edge of a region.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneLine {
    /// Name in the legend; none if it is empty.
    pub name: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// Whether it is dashed.
    pub is_dashed: bool,
    /// Whether cars do not hide it.
    pub is_above_cars: bool,
    /// Points `[X, Y]`, m.
    pub points_m: Vec<[f64; 2]>,
}

/// The mark of a tire on the ground, which grows as time passes.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMark {
    /// Name in the legend.
    pub name: String,
    /// Its points in the order of time.
    pub points: Vec<TireMarkPoint>,
}

impl SceneMark {
    /// Its parts without the gaps between them.
    pub fn pieces(&self) -> impl Iterator<Item = &[TireMarkPoint]> {
        let pieces = self.points.split(|point| point.darkness <= 0.0);
        pieces.filter(|piece| piece.len() > 1)
    }
}

/// The outline of a car that another one has dented, from a time on.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneCrush {
    /// Name in the legend, with how it was made.
    pub name: String,
    /// From when on it is shown, s.
    pub from_s: f64,
    /// The whole outline in body axes `[x, y]`, m, closed.
    pub outline_m: Vec<[f64; 2]>,
    /// The part of it that the other car has dented.
    pub dent_m: Vec<[f64; 2]>,
    /// The motion of the car.
    pub motion: Arc<CarMotion>,
}

/// A point on the ground that was found or measured.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenePoint {
    /// Name in the legend.
    pub name: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// Place `[X, Y]`, m.
    pub at_m: [f64; 2],
}

/// An arrow on the ground, such as the impulse on the struck vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneArrow {
    /// What it stands for, with its size.
    pub name: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// From where to where, `[X, Y]`, m.
    pub ends_m: [[f64; 2]; 2],
}

/// A force that acts over time, as an arrow.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneForce {
    /// Name in the legend, with the largest size.
    pub name: String,
    /// Meaning of its colour.
    pub role: SceneRole,
    /// Instants, s, ascending.
    pub time_s: Vec<f64>,
    /// From where to where it acts from each instant on, `[X, Y]`, m; `None` where it does not act.
    pub arrows_m: Vec<Option<[[f64; 2]; 2]>>,
}

/// A cross where and from when something is not computed: a second contact.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneCross {
    /// What it stands for.
    pub name: String,
    /// Place `[X, Y]`, m.
    pub at_m: [f64; 2],
    /// From when on, s.
    pub time_s: f64,
}

/// A density on the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneDensity {
    /// Name in the legend.
    pub name: String,
    /// The density.
    pub map: Arc<DensityMap>,
    /// Its largest value, 1/m²; more than 0.
    pub peak: f64,
}

/// Something that was measured on the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMeasure {
    /// The places that were clicked, `[X, Y]`, m.
    pub points_m: Vec<[f64; 2]>,
    /// Whether the last place is joined to the first.
    pub is_closed: bool,
    /// The value with its unit.
    pub text: String,
    /// Where the value stands.
    pub text_at: MeasureTextAt,
}

/// Where the value of what was measured stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasureTextAt {
    /// At the last place.
    End,
    /// At the second place: the vertex of an angle.
    Vertex,
    /// In the middle of all places.
    Middle,
}

/// A scene over the whole course of events.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// What the scene is of.
    pub title: String,
    /// What lies below everything else, if it is known.
    pub ground: Option<Arc<SceneGround>>,
    /// Cars, from back to front.
    pub cars: Vec<SceneCar>,
    /// Paths of cars.
    pub paths: Vec<ScenePath>,
    /// Lines on the ground.
    pub lines: Vec<SceneLine>,
    /// Computed marks of tires.
    pub marks: Vec<SceneMark>,
    /// Dented outlines of cars.
    pub crushes: Vec<SceneCrush>,
    /// Points on the ground.
    pub points: Vec<ScenePoint>,
    /// Arrows on the ground.
    pub arrows: Vec<SceneArrow>,
    /// Forces over time.
    pub forces: Vec<SceneForce>,
    /// Where cars meet again.
    pub crosses: Vec<SceneCross>,
    /// What was measured on the ground.
    pub measures: Vec<SceneMeasure>,
    /// Density of a position.
    pub density: Option<SceneDensity>,
    /// The last instant, s.
    pub end_s: f64,
    /// System of units of grid, scale bar and labels.
    pub units: UnitSystem,
    /// What restricts the scene.
    pub caveats: Caveats,
    /// Language of its names and of what a picture says beside them.
    pub language: Language,
}

impl Scene {
    /// What the scene shows at a time, in words.
    ///
    /// - `view`: how it is seen, such as “from above”.
    pub fn heading(&self, view: &str, time_s: f64) -> String {
        format!("{}: scene {view} at {time_s:.2} s{}", self.title, self.after(time_s))
    }

    /// The same where the time stands beside it. A scene without a title has that below the picture.
    pub fn heading_beside_time(&self, view: &str, time_s: f64) -> String {
        let after = self.after(time_s);
        match self.title.is_empty() {
            true => after.trim_start_matches(", ").to_owned(),
            false => format!("{}: scene {view}{after}", self.title),
        }
    }

    /// The same without the view, for a narrow picture.
    pub fn heading_without_view(&self, time_s: f64) -> String {
        let text = format!("{}{}", self.title, self.after(time_s));
        text.trim_start_matches(", ").to_owned()
    }

    /// What a heading adds once the vehicles have met again.
    fn after(&self, time_s: f64) -> &'static str {
        let met = self.crosses.iter().any(|cross| cross.time_s <= time_s);
        match (met, self.language) {
            (false, _) => "",
            (true, Language::En) => ", after a second contact that is not computed",
            (true, Language::De) => ", nach einem zweiten Kontakt, der nicht berechnet ist",
        }
    }

    /// Lowest and highest `[X, Y]` of everything that is shown at any time, m.
    pub fn extent_m(&self) -> [[f64; 2]; 2] {
        extent_of(&self.places_m())
    }

    /// Places on the ground that hold between them everything that is shown at any time, `[X, Y]`, m. The
    /// ground itself counts where nothing is on it.
    pub fn places_m(&self) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for car in &self.cars {
            let reach_m = car.shape.body.length_m / 2.0;
            for state in ends_of(&car.motion) {
                let Pose { x_m, y_m, .. } = state.pose;
                points.extend([[x_m - reach_m, y_m - reach_m], [x_m + reach_m, y_m + reach_m]]);
            }
        }
        let of_paths = self.paths.iter().flat_map(|path| path.motion.states());
        points.extend(of_paths.map(|state| [state.pose.x_m, state.pose.y_m]));
        points.extend(self.lines.iter().flat_map(|line| &line.points_m));
        points.extend(self.points.iter().map(|point| point.at_m));
        points.extend(self.arrows.iter().flat_map(|arrow| arrow.ends_m));
        points.extend(self.crosses.iter().map(|cross| cross.at_m));
        if points.is_empty() {
            points.extend(self.ground.iter().filter_map(|ground| ground.extent_m()).flatten());
        }
        points.retain(|point| point.iter().all(|value| value.is_finite()));
        let [low, high] = extent_of(&points);
        let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
        // Where hardly anything moves there is room about it.
        let reach = [LEAST_HALF_M, -LEAST_HALF_M];
        points.extend(reach.iter().flat_map(|x| reach.map(|y| [middle[0] + x, middle[1] + y])));
        points
    }

    /// The car that is followed by default: the first solid one that is no striking vehicle.
    pub fn struck(&self) -> Option<&SceneCar> {
        let is_struck = |car: &&SceneCar| car.role != SceneRole::Striking;
        let solid = self.cars.iter().filter(|car| car.look == CarLook::Solid);
        solid.clone().find(is_struck).or_else(|| self.cars.iter().find(is_struck))
    }

    /// The striking car: a solid one, if there is one.
    pub fn striking(&self) -> Option<&SceneCar> {
        let all = self.cars.iter().filter(|car| car.role == SceneRole::Striking);
        all.clone().find(|car| car.look == CarLook::Solid).or_else(|| all.clone().next())
    }
}

/// First and last state of a motion.
fn ends_of(motion: &CarMotion) -> impl Iterator<Item = &CarState> {
    motion.states().first().into_iter().chain(motion.states().last())
}

/// Lowest and highest coordinates of finite points, widened where they lie close together.
fn extent_of(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let finite = points.iter().filter(|point| point.iter().all(|value| value.is_finite()));
    let mut extent: Option<[[f64; 2]; 2]> = None;
    for point in finite {
        let [low, high] = extent.unwrap_or([*point; 2]);
        let (low, high) = (
            std::array::from_fn(|i| low[i].min(point[i])),
            std::array::from_fn(|i| high[i].max(point[i])),
        );
        extent = Some([low, high]);
    }
    let [mut low, mut high] = extent.unwrap_or([[0.0; 2]; 2]);
    let longest = (high[0] - low[0]).max(high[1] - low[1]);
    for axis in 0..2 {
        let least_m = if longest < LEAST_EXTENT_M { LEAST_EXTENT_M } else { 2.0 * LEAST_HALF_M };
        let lack_m = (least_m - (high[axis] - low[axis])).max(0.0);
        low[axis] -= lack_m / 2.0;
        high[axis] += lack_m / 2.0;
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extent_holds_every_point_and_has_room() {
        let [low, high] = extent_of(&[[1.0, 2.0], [41.0, 2.5], [f64::NAN, 1e9]]);
        assert_eq!((low[0], high[0]), (1.0, 41.0));
        assert!(low[1] < 0.0 && high[1] > 4.0, "{low:?} {high:?}");
        let [low, high] = extent_of(&[]);
        assert_eq!([high[0] - low[0], high[1] - low[1]], [LEAST_EXTENT_M; 2]);
    }
}

//! A scene at a moment, as it is to be seen: what a picture of it is drawn from.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::scene::Scene;

/// How a scene is seen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ViewKind {
    /// From above, to scale: X to the right, Y up.
    #[default]
    Above,
    /// In perspective.
    Perspective,
}

impl ViewKind {
    /// The view in a sentence.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::Above => "from above",
            Self::Perspective => "in perspective",
        }
    }
}

/// A scene at a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneStill {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The moment, s.
    pub time_s: f64,
    /// How it is seen.
    pub view: ViewKind,
    /// Distance of the camera from the struck car, m; `None` to see all of the scene.
    pub near_m: Option<f64>,
    /// Whether half of the width of a page is enough for it.
    pub is_half_wide: bool,
}

impl SceneStill {
    /// What it shows.
    pub fn title(&self) -> String {
        self.scene.heading(self.view.phrase(), self.time_s)
    }

    /// Names of what can be seen: cars, paths, marks and everything else that has a name.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let scene = &*self.scene;
        let cars = scene.cars.iter().map(|car| &car.name);
        let paths = scene.paths.iter().map(|path| &path.name);
        let lines = scene.lines.iter().map(|line| &line.name);
        let marks = scene.marks.iter().map(|mark| &mark.name);
        let crushes = scene.crushes.iter().map(|crush| &crush.name);
        let points = scene.points.iter().map(|point| &point.name);
        let arrows = scene.arrows.iter().map(|arrow| &arrow.name);
        let forces = scene.forces.iter().map(|force| &force.name);
        let crosses = scene.crosses.iter().map(|cross| &cross.name);
        let density = scene.density.iter().map(|density| &density.name);
        let moving = cars.chain(paths).chain(lines).chain(marks).chain(crushes);
        let points = points.chain(arrows).chain(forces);
        moving.chain(points).chain(crosses).chain(density).map(String::as_str)
    }
}

//! Edits the evidence in the scene: places of rest are dragged, marks are clicked.

use egui::{Id, TextStyle, Ui};

use crate::app::reconstruction::MarkKey;
use impactlab_core::collision::Footprint;
use impactlab_core::numerics::nearest_multiple;
use impactlab_core::ranges::{EVIDENCE_HEADING, EVIDENCE_POSITION};
use impactlab_core::units::Unit;
use impactlab_document::figure::{FigureElement, Role, STRIKING_AT_REST, struck_at_rest};
use impactlab_draw::FigureResponse;
use impactlab_reconstruct::Cars;
use impactlab_reconstruct::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PointsMut, RestPose, Section, Sigma, Word,
};

/// Distance from the pointer at which a handle is taken, points.
const REACH: f64 = 14.0;

/// Where the dot of the struck car waits to be dragged, m.
const WAITING_STRUCK_M: [f64; 2] = [30.0, 0.0];
/// Where that of the striking car does, m.
const WAITING_STRIKING_M: [f64; 2] = [30.0, 5.0];

/// What is dragged of a car at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Handle {
    /// The CG.
    Position,
    /// The front end.
    Heading,
}

/// A car at rest that is being dragged.
#[derive(Debug, Clone, Copy)]
struct Drag {
    is_struck: bool,
    handle: Handle,
    /// The pose when the drag began.
    before: RestPose,
    /// The view, which stays while something is dragged.
    view: [[f64; 2]; 2],
}

/// The editing of one frame.
pub struct SceneEdit {
    id: Id,
    /// Lengths from the CG to the front ends, struck car first, m.
    front_m: [f64; 2],
    adds_to: Option<MarkKey>,
    drag: Option<Drag>,
    /// Whether the pointer was over a handle in the frame before.
    is_near: bool,
}

impl SceneEdit {
    /// What is being edited in this frame.
    ///
    /// - `adds_to`: the mark to which clicks add points.
    pub fn begin(ui: &Ui, cars: &Cars, adds_to: Option<MarkKey>) -> Self {
        let id = Id::unique("edit of the reconstructed scene");
        let front = |car: &impactlab_reconstruct::Car| {
            Footprint::from(&car.parameters.geometry).cg_from_front_m
        };
        Self {
            id,
            front_m: [front(&cars.struck), front(&cars.striking)],
            adds_to,
            drag: ui.data(|data| data.get_temp::<Drag>(id)),
            is_near: ui.data(|data| data.get_temp::<bool>(id)).unwrap_or(false),
        }
    }

    /// The view while something is dragged.
    pub fn view(&self) -> Option<[[f64; 2]; 2]> {
        self.drag.map(|drag| drag.view)
    }

    /// Whether the primary button moves the view.
    pub fn pans(&self) -> bool {
        self.drag.is_none() && !self.is_near
    }

    /// What can be done.
    pub fn hint(&self) -> &'static str {
        match self.adds_to {
            Some(_) => "Click along the mark from where it starts; Add points ends that.",
            None => "Drag a dot: the middle of a car at rest moves it, its front turns it.",
        }
    }

    /// Room for the hint below the figure, points.
    pub fn hint_height(&self) -> f32 {
        3.0 * TextStyle::Body.resolve(&egui::Style::default()).size
    }

    /// The dots by which the cars at rest are dragged.
    pub fn handles(&self, evidence: &Evidence, unit: Unit) -> Vec<FigureElement> {
        let dot = |(is_struck, _, place): (bool, Handle, [f64; 2])| {
            let name = if is_struck { struck_at_rest(evidence) } else { STRIKING_AT_REST };
            let at = place.map(|value| unit.from_si(value));
            FigureElement::points(name, Role::Reference, vec![at])
        };
        self.places(evidence).into_iter().map(dot).collect()
    }

    /// Changes the evidence as the user drags and clicks.
    pub fn apply(&mut self, ui: &Ui, shown: &FigureResponse, unit: Unit, evidence: &mut Evidence) {
        let si = |point: [f64; 2]| point.map(|value| unit.to_si(value));
        let reach_m = unit.to_si(shown.x_per_point * REACH);
        let near = shown.pointer.and_then(|at| self.nearest(evidence, si(at), reach_m));
        ui.data_mut(|data| data.insert_temp(self.id, near.is_some()));
        if let (Some(mark), Some(at)) = (self.adds_to, shown.clicked) {
            AddPoint { mark, at_m: si(at) }.add_to(evidence);
        }
        let Some([from, to]) = shown.drag.map(|ends| ends.map(si)) else {
            ui.data_mut(|data| data.remove::<Drag>(self.id));
            return;
        };
        let drag = self.drag.or_else(|| {
            let (is_struck, handle) = self.nearest(evidence, from, reach_m)?;
            let rest = if is_struck { evidence.rest } else { evidence.striking_rest };
            Some(Drag { is_struck, handle, before: rest?, view: shown.view })
        });
        if let Some(drag) = drag {
            let rest = match drag.is_struck {
                true => &mut evidence.rest,
                false => &mut evidence.striking_rest,
            };
            if let Some(rest) = rest.as_mut().filter(|_| from != to) {
                drag.apply([from, to], rest);
            }
            ui.data_mut(|data| data.insert_temp(self.id, drag));
        }
    }

    /// The handles with their places, m: whether of the struck car, which, and where.
    fn places(&self, evidence: &Evidence) -> Vec<(bool, Handle, [f64; 2])> {
        let [struck_m, striking_m] = self.front_m;
        let of = |(is_struck, rest, front_m): (bool, &Option<RestPose>, f64)| {
            let Some(rest) = rest else { return Vec::new() };
            let front = rest
                .pose()
                .map(|pose| (is_struck, Handle::Heading, pose.world_from_body([front_m, 0.0])));
            let middle = (is_struck, Handle::Position, place_of(rest, is_struck));
            std::iter::once(middle).chain(front).collect()
        };
        [(true, &evidence.rest, struck_m), (false, &evidence.striking_rest, striking_m)]
            .into_iter()
            .flat_map(of)
            .collect()
    }

    /// The handle that is nearest to a point, if one is within reach.
    fn nearest(
        &self,
        evidence: &Evidence,
        [x, y]: [f64; 2],
        reach_m: f64,
    ) -> Option<(bool, Handle)> {
        let apart = |[px, py]: [f64; 2]| (px - x).hypot(py - y);
        let near = self.places(evidence).into_iter().filter(|(.., at)| apart(*at) <= reach_m);
        near.min_by(|a, b| apart(a.2).total_cmp(&apart(b.2))).map(|(of, handle, _)| (of, handle))
    }
}

impl Drag {
    /// Puts the car to where the pointer is. What is not possible is left as it was.
    fn apply(&self, [from, to]: [[f64; 2]; 2], rest: &mut RestPose) {
        let before = &self.before;
        match self.handle {
            Handle::Position => {
                let [x_m, y_m] = place_of(before, self.is_struck);
                let place = [x_m + to[0] - from[0], y_m + to[1] - from[1]];
                if place.iter().all(|value| EVIDENCE_POSITION.contains(*value)) {
                    [rest.x_m, rest.y_m] = place.map(|value| Some(nearest_multiple(value, 0.01)));
                }
            }
            Handle::Heading => {
                let [x_m, y_m] = place_of(rest, self.is_struck);
                let heading = nearest_multiple((to[1] - y_m).atan2(to[0] - x_m), 0.001);
                if let Some(stated) = &mut rest.heading_rad
                    && EVIDENCE_HEADING.contains(heading)
                {
                    stated.value = Some(heading);
                }
            }
        }
    }
}

/// Where the dot of a car at rest is. That of a car that has not been placed is no place: it only waits to be
/// dragged.
fn place_of(rest: &RestPose, is_struck: bool) -> [f64; 2] {
    rest.place_m().unwrap_or(if is_struck { WAITING_STRUCK_M } else { WAITING_STRIKING_M })
}

/// Adds a point at the end of a mark.
struct AddPoint {
    mark: MarkKey,
    at_m: [f64; 2],
}

impl AddPoint {
    fn add_to(mut self, evidence: &mut Evidence) {
        if self.at_m.iter().all(|value| EVIDENCE_POSITION.contains(*value)) {
            evidence.items(&mut self);
        }
    }
}

impl Items for AddPoint {
    fn item(&mut self, section: &'static Section, idx: Option<usize>, item: &mut impl Item) {
        if section.key == self.mark.section && idx == Some(self.mark.idx) {
            item.fields(self);
        }
    }
}

impl Fields for AddPoint {
    fn points(&mut self, _: &Field, _: &Sigma, points: PointsMut<'_>) {
        points.points_m.push(self.at_m.map(|value| nearest_multiple(value, 0.01)));
    }

    fn number(&mut self, _: &Field, _: &mut Option<f64>) {}

    fn bounds(&mut self, _: &Field, _: &mut Option<Bounds>) {}

    fn choice<W: Word>(&mut self, _: &Choice, _: &mut W) {}

    fn optional_choice<W: Word>(&mut self, _: &Choice, _: &mut Option<W>) {}

    fn choices<W: Word>(&mut self, _: &Choice, _: &mut Option<Vec<W>>) {}
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;
    use impactlab_core::data::TomlFile;
    use impactlab_core::units::{Quantity, UnitSystem};

    const EVIDENCE: &str = r#"
        case = "a"
        [struck_car]
        mass_kg = 1500
        [striking_car]
        mass_kg = 1500
        [damage]
        side = "right"
        x_m = -1.6
        [rest]
        x_m = 30
        y_m = -5
        heading_rad = 0
        [[mark]]
        wheel = "RR"
        points_m = [[1, 0], [9, 1]]
        [[striking_mark]]
        wheel = "RL"
        points_m = [[2, 3], [8, 3]]
    "#;

    fn evidence() -> Evidence {
        let path = std::path::Path::new("evidence");
        Evidence::from_toml(TomlFile { path, text: EVIDENCE }).unwrap()
    }

    /// The evidence after frames in each of which the figure said something, in the unit of its axes.
    fn edited(adds_to: Option<MarkKey>, frames: &[FigureResponse]) -> Evidence {
        edited_from(evidence(), adds_to, frames)
    }

    fn edited_from(
        mut evidence: Evidence,
        adds_to: Option<MarkKey>,
        frames: &[FigureResponse],
    ) -> Evidence {
        let context = Context::default();
        let cars = Cars::new(&evidence, None, None);
        for shown in frames {
            let _ = context.run_ui(RawInput::default(), |ui| {
                let mut edit = SceneEdit::begin(ui, &cars, adds_to);
                let unit = Quantity::Length.display_unit(UnitSystem::Us);
                edit.apply(ui, shown, unit, &mut evidence);
            });
        }
        evidence
    }

    fn shown(points_m: [[f64; 2]; 2]) -> FigureResponse {
        let unit = Quantity::Length.display_unit(UnitSystem::Us);
        let drag = points_m.map(|point| point.map(|value| unit.from_si(value)));
        FigureResponse { drag: Some(drag), x_per_point: 0.1, ..FigureResponse::default() }
    }

    #[test]
    fn a_car_at_rest_is_moved_by_its_middle_and_turned_by_its_front() {
        let from = [30.1, -5.1];
        let drag = [shown([from, from]), shown([from, [32.1, -2.1]]), FigureResponse::default()];
        let moved = edited(None, &drag).rest.unwrap();
        let [x_m, y_m] = moved.place_m().unwrap();
        assert!((x_m - 32.0).abs() < 0.011 && (y_m + 2.0).abs() < 0.011, "{moved:?}");
        assert_eq!(moved.heading_rad, evidence().rest.unwrap().heading_rad);

        let cars = Cars::new(&evidence(), None, None);
        let front =
            [30.0 + Footprint::from(&cars.struck.parameters.geometry).cg_from_front_m, -5.0];
        let turned = edited(None, &[shown([front, [30.0, -3.0]])]).rest.unwrap();
        assert!((turned.heading().unwrap().value - 1.571).abs() < 1e-9, "{turned:?}");
        assert_eq!(turned.place_m(), Some([30.0, -5.0]));
        // Beside the handles, the view is moved.
        assert_eq!(edited(None, &[shown([[10.0, 0.0], [20.0, 0.0]])]), evidence());
    }

    #[test]
    fn a_car_that_has_not_been_placed_is_dragged_from_where_its_dot_waits() {
        let mut waiting = evidence();
        waiting.rest = Some(RestPose::default());
        let drag = [shown([WAITING_STRUCK_M, [41.0, -3.0]]), FigureResponse::default()];
        let [x_m, y_m] = edited_from(waiting, None, &drag).rest.unwrap().place_m().unwrap();
        assert!((x_m - 41.0).abs() < 0.011 && (y_m + 3.0).abs() < 0.011, "{x_m} {y_m}");
    }

    #[test]
    fn a_click_adds_a_point_to_the_mark_that_is_asked_for() {
        let unit = Quantity::Length.display_unit(UnitSystem::Us);
        let clicked = Some([unit.from_si(15.0), unit.from_si(2.5)]);
        let click = FigureResponse { clicked, ..FigureResponse::default() };
        assert_eq!(edited(None, std::slice::from_ref(&click)), evidence());
        let mark = |section| Some(MarkKey { section, idx: 0 });
        let marked = edited(mark("mark"), std::slice::from_ref(&click));
        assert_eq!(marked.marks[0].points_m[2], [15.0, 2.5]);
        assert_eq!(marked.striking_marks, evidence().striking_marks);
        let marked = edited(mark("striking_mark"), &[click]);
        assert_eq!(marked.striking_marks[0].points_m[2], [15.0, 2.5]);
        assert_eq!(marked.marks, evidence().marks);
    }
}

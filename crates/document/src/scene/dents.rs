//! The dents that the contact law leaves in both cars.

use std::sync::Arc;

use crate::scene::{Scene, SceneCrush, SceneRole};
use impactlab_core::collision::contact::ContactOutline;
use impactlab_study::analysis::Analysis;

/// Dent below which an outline counts as whole, m.
const LEAST_DENT_M: f64 = 0.005;

/// Adds the dented outlines of two cars that were followed through all contacts, from the end of their
/// first contact on. A car without a dent has none.
pub(super) fn add_dents(scene: &mut Scene, analysis: &Analysis) {
    let (Some(pair), Some(phase)) = (&analysis.pair, analysis.phases.first()) else { return };
    let from_s = phase.end_s.unwrap_or(scene.end_s);
    let struck = scene.cars.iter().find(|car| car.role == SceneRole::Simulated);
    let cars = [struck, scene.striking()];
    let mut crushes = Vec::new();
    for ((car, outline), dents_m) in cars.iter().zip(&pair.outlines).zip(&analysis.dents_m) {
        let (Some(car), Some([outline_m, dent_m])) = (car, dented(outline, dents_m)) else {
            continue;
        };
        crushes.push(SceneCrush {
            name: "dents that stay, by the contact law".to_owned(),
            from_s,
            outline_m,
            dent_m,
            motion: Arc::clone(&car.motion),
        });
    }
    scene.crushes.extend(crushes);
}

/// The whole outline, closed, and the dented part of it, in body axes, m; `None` without a dent.
fn dented(outline: &ContactOutline, dents_m: &[f64]) -> Option<[Vec<[f64; 2]>; 2]> {
    let points: Vec<[f64; 2]> = outline
        .elements()
        .iter()
        .zip(dents_m)
        .map(|(element, dent_m)| {
            let ([x, y], [nx, ny]) = (element.point_body_m, element.normal_body);
            [x - dent_m * nx, y - dent_m * ny]
        })
        .collect();
    let n = points.len();
    let is_dented = |idx: usize| dents_m.get(idx % n.max(1)).is_some_and(|m| *m > LEAST_DENT_M);
    // Begins behind an element that is whole, so that the dented part hangs together.
    let whole = (0..n).find(|idx| !is_dented(*idx))?;
    let first = (whole..whole + n).find(|idx| is_dented(*idx))?;
    let last = (whole..whole + n).rev().find(|idx| is_dented(*idx))?;
    let at = |idx: usize| points.get(idx % n).copied();
    let closed = (0..=n).filter_map(at).collect();
    Some([closed, (first.saturating_sub(1)..=last + 1).filter_map(at).collect()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::Footprint;
    use impactlab_core::numerics::line_length;

    #[test]
    fn a_dent_over_the_first_element_hangs_together() {
        let footprint = Footprint { length_m: 4.0, width_m: 2.0, cg_from_front_m: 2.0 };
        let outline = ContactOutline::new(footprint, 0.4, 0.1).unwrap();
        let n = outline.elements().len();
        let mut dents_m = vec![0.0; n];
        assert_eq!(dented(&outline, &dents_m), None);
        for idx in [n - 2, n - 1, 0, 1, 2] {
            dents_m[idx] = 0.1;
        }
        let [closed, dent] = dented(&outline, &dents_m).unwrap();
        assert_eq!(closed.len(), n + 1);
        assert_eq!(closed[0], closed[n]);
        assert_eq!(dent.len(), 7);
        let longest = dent.windows(2).map(line_length);
        assert!(longest.fold(0.0, f64::max) < 0.25, "{dent:?}");
    }
}

//! The inputs of regressions and baselines: a canonical scenario as a row of numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::{ForceCase, ForceScenario, MomentumModel};
use impactlab_core::collision::ImpactSolution;

/// Speed above which the scale of the lateral closing speed is logarithmic rather than linear, m/s. It
/// is about the smallest closing speed of a PIT manoeuvre.
const LATERAL_SPEED_SCALE_M_S: f64 = 0.5;

/// From the CG of a striking vehicle to the corner that touches, in its axes, m, where a scenario does not
/// say where it stands.
const USUAL_ARM_M: [f64; 2] = [1.9, 0.9];
/// The right flank of a struck vehicle, m, where a scenario does not say where it is touched.
const USUAL_FLANK_Y_M: f64 = -0.92;

/// The columns of a scenario that a model may use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColumnSet {
    /// θ alone: masses, velocities and heading of the striking vehicle.
    #[default]
    Theta,
    /// θ, the contact point along the struck vehicle, and the kinds of the bodies of both vehicles.
    ThetaContactAndBody,
}

/// Turns scenarios into rows of equal length.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FeatureMap {
    columns: ColumnSet,
    /// Mean contact point along the struck vehicle, m, which replaces an unknown one.
    contact_x_m: f64,
    /// Whether yaw rates before the impact are columns.
    #[serde(default)]
    turns: bool,
    /// Kinds of body of the striking vehicle, sorted. The first has no column of its own.
    bodies: Vec<String>,
    /// The same of the struck vehicle, with an empty name for cases that do not name it; none where there
    /// is one kind only.
    #[serde(default, rename = "target_bodies")]
    struck_bodies: Vec<String>,
}

impl ColumnSet {
    /// Both sets of columns.
    pub const ALL: [Self; 2] = [Self::Theta, Self::ThetaContactAndBody];

    /// Name in tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Theta => "θ",
            Self::ThetaContactAndBody => "θ + contact + body",
        }
    }
}

impl FeatureMap {
    /// Takes mean contact point and kinds of body from training cases.
    pub fn fit(cases: &[&ForceCase], columns: ColumnSet) -> Self {
        let scenarios = || cases.iter().map(|case| &case.scenario);
        let contacts: Vec<f64> = scenarios().filter_map(|s| Some(s.contact_m?[0])).collect();
        let mut bodies: Vec<String> = scenarios().filter_map(|s| s.striking_body.clone()).collect();
        bodies.sort();
        bodies.dedup();
        let contact_x_m = contacts.iter().sum::<f64>() / contacts.len().max(1) as f64;
        let turns = scenarios().any(|scenario| scenario.yaw_rate_rad_s != [0.0; 2]);
        let mut struck_bodies: Vec<String> =
            scenarios().map(|s| s.struck_body.clone().unwrap_or_default()).collect();
        struck_bodies.sort();
        struck_bodies.dedup();
        struck_bodies.truncate(if struck_bodies.len() > 1 { struck_bodies.len() } else { 0 });
        Self { columns, contact_x_m, turns, bodies, struck_bodies }
    }

    /// The row of a scenario: relative velocity of the contact points along X; the same across on a scale
    /// that is logarithmic for large values, since forces and impulses are powers of it; heading;
    /// logarithms of the masses; yaw rates, if any case has one; and, with all columns, the contact point
    /// along the struck vehicle and, for each kind of body of either vehicle but the first, a 1 if the
    /// vehicle is of this kind, else a 0. For an unknown kind all of them have the same share.
    ///
    /// ```text
    /// [v_x, asinh(v_y / 0.5 m/s), θ_b, ln m_t, ln m_b (, r_t, r_b) (, x_c, b's body …, t's body …)]
    /// ```
    pub fn row(&self, scenario: &ForceScenario) -> Vec<f64> {
        let mut known = scenario.clone();
        if self.columns == ColumnSet::Theta {
            (known.contact_m, known.striking_position_m) = (None, None);
        }
        let contact_m = known.contact_m.unwrap_or([self.contact_x_m, USUAL_FLANK_Y_M]);
        let of_cgs = scenario.relative_velocity_m_s();
        let turning = match self.turns {
            true => known.turning_velocity_m_s(contact_m, USUAL_ARM_M),
            false => [0.0; 2],
        };
        let [vx, vy] = [of_cgs[0] + turning[0], of_cgs[1] + turning[1]];
        let [m_t, m_b] = scenario.mass_kg.map(f64::ln);
        let lateral = (vy / LATERAL_SPEED_SCALE_M_S).asinh();
        let mut row = vec![vx, lateral, scenario.theta_b_rad, m_t, m_b];
        if self.turns {
            row.extend(scenario.yaw_rate_rad_s);
        }
        if self.columns == ColumnSet::ThetaContactAndBody {
            row.push(contact_m[0]);
            row.extend(shares(&self.bodies, scenario.striking_body.as_deref()));
            let struck = scenario.struck_body.as_deref().unwrap_or_default();
            row.extend(shares(&self.struck_bodies, Some(struck)));
        }
        row
    }

    /// The row of a scenario with two more columns: logarithm of the size and direction of the momentum
    /// solution's impulse.
    pub fn row_with_impulse(
        &self,
        scenario: &ForceScenario,
        solution: &ImpactSolution,
    ) -> Vec<f64> {
        let [px, py] = solution.impulse_world_n_s;
        let mut row = self.row(scenario);
        row.extend([px.hypot(py).max(f64::MIN_POSITIVE).ln(), px.atan2(py)]);
        row
    }
}

/// For each kind but the first a 1 if it is that of the name, else a 0; the same share of all for a name
/// that is none of them.
fn shares(kinds: &[String], name: Option<&str>) -> impl Iterator<Item = f64> {
    let idx = kinds.iter().position(|kind| Some(kind.as_str()) == name);
    let share = 1.0 / kinds.len().max(1) as f64;
    (1..kinds.len()).map(move |kind| match idx {
        Some(idx) => f64::from(u8::from(idx == kind)),
        None => share,
    })
}

impl ColumnSet {
    /// The momentum solution that uses these columns.
    pub(crate) fn fit_momentum(self, cases: &[&ForceCase]) -> MomentumModel {
        MomentumModel::fit(cases, self == Self::ThetaContactAndBody)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::example;
    use crate::force::input::shipped;
    use impactlab_core::data::StruckSide;

    #[test]
    fn columns_that_must_not_be_known_change_nothing() {
        let cases = shipped("fea");
        let cases: Vec<&ForceCase> = cases.iter().collect();
        let [theta, all] = ColumnSet::ALL.map(|columns| FeatureMap::fit(&cases, columns));
        let known = example(StruckSide::Right);
        let unknown = ForceScenario {
            contact_m: None,
            striking_body: None,
            struck_body: None,
            ..known.clone()
        };
        assert_eq!(theta.row(&known), theta.row(&unknown));
        assert_ne!(all.row(&known), all.row(&unknown));
        assert_eq!(all.row(&known)[5..], [-1.5, 0.0]);
        assert_eq!(all.row(&unknown)[6], 0.5);
        assert!((all.row(&unknown)[5] - -1.54).abs() < 0.05);
        assert_eq!(theta.row(&known).len(), 5);
    }

    /// In a row stand the velocities of the points of contact, and the yaw rates themselves.
    #[test]
    fn turning_is_in_the_row_where_a_case_turns() {
        let mut cases = shipped("fea");
        let standing = FeatureMap::fit(&cases.iter().collect::<Vec<_>>(), ColumnSet::Theta);
        cases[0].scenario.yaw_rate_rad_s = [0.3, 0.0];
        let cases: Vec<&ForceCase> = cases.iter().collect();
        let all = FeatureMap::fit(&cases, ColumnSet::ThetaContactAndBody);
        let still = example(StruckSide::Right);
        let turning = ForceScenario { yaw_rate_rad_s: [0.3, 0.0], ..still.clone() };
        assert_eq!(standing.row(&still), standing.row(&turning));
        let (before, after) = (all.row(&still), all.row(&turning));
        let [x, y] = still.contact_m.unwrap();
        assert!((after[0] - before[0] - 0.3 * y).abs() < 1e-12, "{after:?} {before:?}");
        let across = |row: &[f64]| LATERAL_SPEED_SCALE_M_S * row[1].sinh();
        assert!((across(&after) - across(&before) + 0.3 * x).abs() < 1e-12);
        assert_eq!(after[5..7], [0.3, 0.0]);
    }
}

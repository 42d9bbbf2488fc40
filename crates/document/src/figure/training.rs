//! Figures of the loss and of the balance of its terms during the training of a network.

use crate::figure::{Axis, Figure, FigureElement, Role};
use impactlab_core::units::{Quantity, UnitSystem};

/// Roles of the loss curves, in order; they repeat if there are more curves.
const ROLES: [Role; 6] =
    [Role::Model, Role::Validation, Role::Pulse, Role::Target, Role::Reference, Role::Muted];

/// One loss term over the epochs.
#[derive(Debug, Clone, PartialEq)]
pub struct LossCurve {
    /// Name of the loss term.
    pub name: String,
    /// Loss on training cases, one value for each epoch.
    pub train: Vec<f64>,
    /// Loss on validation cases, one value for each epoch; empty if there are none.
    pub validation: Vec<f64>,
}

/// Losses over the epochs, with a vertical line at the best epoch. A single loss has one colour for
/// training and another for validation cases; several losses have one colour each. Losses on
/// validation cases are dashed.
///
/// - `first_epoch`: number of the epoch of the first value;
/// - `log`: whether the vertical axis should be logarithmic; it is linear if any loss is not
///   positive and finite.
pub fn loss_figure(
    title: &str,
    curves: &[LossCurve],
    first_epoch: usize,
    best_epoch: Option<usize>,
    log: bool,
) -> Figure {
    let x = Axis::shown("Epoch", Quantity::Ratio, UnitSystem::Si);
    let name = match curves {
        [curve] => format!("Loss, {}", curve.name),
        _ => "Loss".to_owned(),
    };
    let y = Axis::shown(name, Quantity::Ratio, UnitSystem::Si);
    let points = |values: &[f64]| -> Vec<[f64; 2]> {
        let values = values.iter().enumerate();
        values.map(|(i, loss)| [(first_epoch + i) as f64, *loss]).collect()
    };
    let mut elements = Vec::new();
    for (curve, &role) in curves.iter().zip(ROLES.iter().cycle()) {
        let ([train, validation], of_validation) = match curves {
            [_] => (["train".to_owned(), "validation".to_owned()], Role::Validation),
            _ if curve.validation.is_empty() => ([curve.name.clone(), String::new()], role),
            _ => (["train", "validation"].map(|kind| format!("{}, {kind}", curve.name)), role),
        };
        elements.push(FigureElement::line(train, role, points(&curve.train)));
        if !curve.validation.is_empty() {
            elements.push(FigureElement::dashed(
                validation,
                of_validation,
                points(&curve.validation),
            ));
        }
    }
    if let Some(best) = best_epoch {
        let (name, role) = ("best".to_owned(), Role::Muted);
        elements.push(FigureElement::VerticalLine { name, role, x: best as f64 });
    }
    let is_positive = |curve: &LossCurve| {
        curve.train.iter().chain(&curve.validation).all(|loss| *loss > 0.0 && loss.is_finite())
    };
    let log_y = log && curves.iter().all(is_positive);
    Figure { log_y, ..Figure::new(title, [x, y], elements) }
}

/// Share of the data in the loss, and weight of the physics, over the epochs. The vertical axis is
/// logarithmic if all values are positive.
///
/// - `balances`, `physics_weights`: points [epoch, value].
pub fn balance_figure(balances: Vec<[f64; 2]>, physics_weights: Vec<[f64; 2]>) -> Figure {
    let log_y = balances.iter().chain(&physics_weights).all(|[_, value]| *value > 0.0);
    let axes =
        ["Epoch", "Share, weight"].map(|label| Axis::shown(label, Quantity::Ratio, UnitSystem::Si));
    let elements = vec![
        FigureElement::line("share of data in the loss", Role::Model, balances),
        FigureElement::dashed("weight of physics", Role::Validation, physics_weights),
    ];
    Figure { log_y, ..Figure::new("Balance of data and physics", axes, elements) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_below_zero_has_no_logarithm() {
        let curve = |train: Vec<f64>| LossCurve {
            name: "total".to_owned(),
            validation: train.clone(),
            train,
        };
        let figure = |train| loss_figure("t", &[curve(train)], 1, Some(2), true);
        assert!(figure(vec![3.0, 0.1]).log_y);
        assert!(!figure(vec![3.0, -0.1]).log_y);
        assert!(!figure(vec![3.0, 0.0]).log_y);
        assert_eq!(figure(vec![3.0, 1.0]).elements.len(), 3);
    }
}

//! How a loss falls while a network learns.

use crate::figure::{Axis, Figure, FigureElement, Role};
use crate::units::{Quantity, UnitSystem};

/// Colours of several losses, one a loss; they come round again.
const ROLES: [Role; 6] =
    [Role::Model, Role::Validation, Role::Pulse, Role::Target, Role::Reference, Role::Muted];

/// One loss over the epochs.
#[derive(Debug, Clone, PartialEq)]
pub struct LossCurve {
    /// Name of the term.
    pub name: String,
    /// On what is learned from, an entry an epoch.
    pub train: Vec<f64>,
    /// On what is kept back, an entry an epoch; none if nothing is.
    pub validation: Vec<f64>,
}

/// Losses over the epochs, with a line at the best one. A single loss has a colour for either kind
/// of case, several have a colour each; what is kept back is dashed.
///
/// - `first_epoch`: number of the first entry;
/// - `log`: whether the axis should be logarithmic; it is not where a loss is zero or less.
pub fn loss_figure(
    title: &str,
    curves: &[LossCurve],
    (first_epoch, best_epoch): (usize, Option<usize>),
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
    Figure { title: title.to_owned(), x, y, equal_aspect: false, log_y, elements }
}

/// How much of the loss is data, and the weight of physics, over the epochs: pairs of epoch and value.
pub fn balance_figure(balances: Vec<[f64; 2]>, physics_weights: Vec<[f64; 2]>) -> Figure {
    let mut all = balances.iter().chain(&physics_weights);
    Figure {
        log_y: all.all(|[_, value]| *value > 0.0),
        title: "Balance of data and physics".to_owned(),
        x: Axis::shown("Epoch", Quantity::Ratio, UnitSystem::Si),
        y: Axis::shown("Share, weight", Quantity::Ratio, UnitSystem::Si),
        equal_aspect: false,
        elements: vec![
            FigureElement::line("share of data in the loss", Role::Model, balances),
            FigureElement::dashed("weight of physics", Role::Validation, physics_weights),
        ],
    }
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
        let figure = |train| loss_figure("t", &[curve(train)], (1, Some(2)), true);
        assert!(figure(vec![3.0, 0.1]).log_y);
        assert!(!figure(vec![3.0, -0.1]).log_y);
        assert!(!figure(vec![3.0, 0.0]).log_y);
        assert_eq!(figure(vec![3.0, 1.0]).elements.len(), 3);
    }
}

//! Figures of the force network for an artificial prediction. They are written below
//! `target/pictures` for inspection, and one of them is compared pixel by pixel.

use std::ops::ControlFlow;
use std::path::Path;

use egui_kittest::image_snapshot;
use impactlab_core::data::Dataset;
use impactlab_core::uncertainty::{Caveats, CurveComponent, CurveMixture, ForceCurve, PeakFactors};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_document::figure::{
    CoveragePoint, Figure, FigureElement, ForceComponent, ForecastFigure, LossCurve, ParityPoint,
    RecordedCurve, Role, coverage_figure, forecast_figure, loss_figure, parity_figure, pit_figure,
};
use impactlab_draw::{Canvas, figure_image};
use impactlab_networks::force::ForceCase;
use impactlab_study::analysis::{ForceForecast, ForecastSettings, pulse_curves};
use nalgebra::DMatrix;

fn cases() -> Vec<ForceCase> {
    let mut report = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(Path::new("datasets/fea"), &mut report).expect("shipped data");
    ForceCase::from_dataset(&dataset.complete().expect("nothing cancels")).0
}

/// Returns a distribution around a curve in which the height and the tilt are uncertain.
fn about(curve: &ForceCurve) -> CurveMixture {
    let mut mean = curve.to_values();
    let n = mean.len();
    for value in mean.iter_mut().take(n - 1) {
        *value *= 0.9;
    }
    let height = mean.iter().map(|value| 0.2 * value);
    let tilt =
        mean.iter().enumerate().map(|(i, value)| value * ((i % 250) as f64 / 80.0 - 0.5) * 0.3);
    let factors = DMatrix::from_iterator(n, 2, height.chain(tilt));
    let mut variance: Vec<f64> = mean.iter().map(|value| 1e5 + (0.06 * value).powi(2)).collect();
    for i in 0..n {
        if mean[i] == 0.0 {
            variance[i] = 1.0;
        }
    }
    variance[n - 1] = 1e-4;
    CurveMixture::new(vec![CurveComponent {
        weight: 1.0,
        mean,
        factors,
        variance,
        lag_correlation: 0.0,
        peak: PeakFactors::default(),
    }])
    .expect("a mixture")
}

fn save(figure: &Figure, name: &str) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    for dark in [false, true] {
        let canvas = Canvas { size_px: [960, 540], scale: 1.5, dark };
        let ending = if dark { "-dark" } else { "" };
        let image = figure_image(figure, canvas).expect("a picture");
        image.save(folder.join(format!("{name}{ending}.png"))).expect("it is written");
    }
}

#[test]
fn a_forecast_with_everything_over_it() {
    let case = &cases()[2];
    let settings = ForecastSettings { n_curves: 12, seed: 1 };
    let forecast = ForceForecast::new(&about(&case.curve), settings).expect("a forecast");
    let pulses = pulse_curves(case.impulse_n_s, 0.09).expect("pulses");
    let recorded = RecordedCurve { name: "c003, FEA", curve: &case.curve, cut_at_s: None };
    for component in ForceComponent::ALL {
        let figure = forecast_figure(
            component,
            &ForecastFigure {
                name: "c003",
                forecast: &forecast,
                levels: &[0.5, 0.8, 0.9, 0.95],
                recorded: Some(recorded),
                pulses: &pulses,
                physics: Some(&case.curve),
                units: UnitSystem::Si,
                caveats: &Caveats::default(),
            },
        );
        save(&figure, &format!("forecast-{component:?}"));
    }
    let cut = RecordedCurve { cut_at_s: Some(0.05), ..recorded };
    let figure = forecast_figure(
        ForceComponent::Y,
        &ForecastFigure {
            name: "c003",
            forecast: &forecast,
            levels: &[],
            recorded: Some(cut),
            pulses: &[],
            physics: None,
            units: UnitSystem::Si,
            caveats: &Caveats::default(),
        },
    );
    let drawn = figure.elements.iter().find_map(|element| match element {
        FigureElement::Line(series) if series.name == "c003, FEA, cut at 50.0 ms" => Some(series),
        _ => None,
    });
    let last_ms = drawn.expect("the recorded force").points.last().expect("a point")[0];
    assert!((49.0..=50.0).contains(&last_ms), "drawn until {last_ms} ms");
    let figure = forecast_figure(
        ForceComponent::Y,
        &ForecastFigure {
            name: "c003",
            forecast: &ForceForecast { curves: Vec::new(), ..forecast },
            levels: &[0.5, 0.9],
            recorded: Some(recorded),
            pulses: &[],
            physics: None,
            units: UnitSystem::Si,
            caveats: &Caveats::default(),
        },
    );
    let canvas = Canvas { size_px: [360, 220], scale: 1.0, dark: false };
    image_snapshot(&figure_image(&figure, canvas).expect("a picture"), "forecast");
}

#[test]
fn learning_and_calibration() {
    let falling = |from: f64, noise: f64| -> Vec<f64> {
        (0..120)
            .map(|i| {
                let i = f64::from(i);
                from * ((-i / 20.0).exp() + 0.02) * (1.0 + noise * (i * 1.7).sin())
            })
            .collect()
    };
    let curve = |name: &str, from| LossCurve {
        name: name.to_owned(),
        train: falling(from, 0.03),
        validation: falling(1.3 * from, 0.1),
    };
    let figure = loss_figure("Losses", &[curve("total", 30.0)], 1, Some(88), true);
    save(&figure, "losses");
    let both = [curve("total", 30.0), curve("impulse", 0.3)];
    save(&loss_figure("Losses", &both, 1, None, true), "losses-two");
    save(&loss_figure("Losses", &both, 1, None, false), "losses-linear");
    let points: Vec<ParityPoint> = cases()
        .iter()
        .take(30)
        .enumerate()
        .map(|(i, case)| {
            let [px, py] = case.impulse_n_s;
            let observed = px.hypot(py);
            let predicted = observed * (1.0 + 0.1 * (i as f64).sin());
            ParityPoint {
                observed,
                predicted,
                interval: Some([0.85 * predicted, 1.15 * predicted]),
                is_clean: case.is_clean(),
            }
        })
        .collect();
    let (interval, quantity) = ("90 % interval", Quantity::Impulse);
    let parity = parity_figure("Impulse", "|P|", interval, &points, quantity, UnitSystem::Si);
    save(&parity, "parity");
    save(&pit_figure("PIT of the force", &[5, 8, 11, 9, 12, 14, 9, 8, 13, 20]), "pit");
    let points = |off: f64| {
        let point = |level: f64| CoveragePoint { level, share: level - off, standard_error: 0.04 };
        [0.5, 0.8, 0.9, 0.95].map(point).to_vec()
    };
    let rows = [
        ("force", Role::Model, points(0.05)),
        ("impulse", Role::Validation, points(-0.02)),
        ("peak", Role::Pulse, points(0.1)),
    ];
    save(&coverage_figure("Coverage", &rows), "coverage");
}

//! The form that says what happens to the wheels of the struck vehicle after the first contact.

use egui::{CollapsingHeader, Grid, Ui};
use strum::VariantArray;

use crate::app::widgets::{
    EmptyField, choice_row, optional_quantity, quantity_field, salted_choice_row,
};
use impactlab_core::ranges::{
    BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, DEAD_TIME, DRAG_SHARE, DRIVE_TORQUE, ENGINE_BRAKING,
    ESC_THRESHOLD, LARGEST_STEERING_WHEEL_ANGLE, PIT_START, REACTION_TIME, Range, SIDESLIP,
    STEER_ANGLE, STEERING_RATIO, STEERING_WHEEL_ANGLE, STRUCK_TURN,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{
    AntiLock, Braking, Countersteer, DEFAULT_BRAKE_RISE_S, DamagedWheel, DrivenAxle, Driving,
    Ending, EngineBraking, HeldSteer, PitDriver, PitEnd, StabilityControl, TurnSide,
    USUAL_STEERING_RATIO, Wheel,
};

/// What a vehicle does for which nothing is chosen.
const COASTS: &str = "coasts";
/// Share of the friction with which a driver brakes hard.
const HARD_BRAKING: f64 = 0.8;
/// Time from the impact to the reaction of a driver, s.
const REACTION_S: f64 = 0.7;
/// Drag of bent bodywork on a tire, as a share of the friction.
const USUAL_DRAG: f64 = 0.5;
/// Deceleration by an engine in a high gear, m/s².
const USUAL_ENGINE_BRAKING_M_S2: f64 = 0.5;
/// Torque at the wheels of a car that accelerates briskly, N m: some 0.2 g at 1500 kg.
const USUAL_DRIVE_TORQUE_N_M: f64 = 1000.0;
/// Time for which a driver pushes another car, s.
const USUAL_PUSHING_S: f64 = 1.5;
/// A small steer angle, rad: 3°.
const SMALL_STEER_RAD: f64 = 0.0524;

/// Draws the choices of an ending with their numbers. A vehicle for which nothing is chosen coasts; who takes
/// a choice back says so.
///
/// - `whose`: from when on and whose wheels they are: “After the impact: the struck vehicle”.
/// - `steering_ratio`: with one, steer angles are those of the steering wheel.
pub(super) fn ending_form(
    ui: &mut Ui,
    whose: &str,
    ending: &mut Option<Ending>,
    steering_ratio: &mut Option<f64>,
    units: UnitSystem,
) {
    let title = format!("{whose} {}", ending_in_words(ending.as_ref()));
    CollapsingHeader::new(title).id_salt(("ending", whose)).show(ui, |ui| {
        let mut edited = ending.clone().unwrap_or_default();
        Grid::new(("ending", whose)).num_columns(2).show(ui, |ui| {
            brake_fields(ui, &mut edited.brake, units);
            engine_fields(ui, &mut edited.engine, units);
            drive_fields(ui, &mut edited.drive, units);
            for wheel in Wheel::ALL {
                wheel_fields(ui, wheel, &mut edited.damage, units);
            }
            steer_fields(ui, &mut edited.steer, steering_ratio, units);
            esc_fields(ui, &mut edited.esc, units);
            countersteer_fields(ui, &mut edited.countersteer, units);
            pit_fields(ui, &mut edited.pit, units);
        });
        if ending.clone().unwrap_or_default() != edited {
            *ending = Some(edited);
        }
    });
}

/// What a vehicle does after the impact, such as “brakes, steers”.
pub(in crate::app) fn ending_in_words(ending: Option<&Ending>) -> String {
    let Some(ending) = ending else { return COASTS.to_owned() };
    let parts = [
        (ending.brake.is_some(), "brakes"),
        (ending.engine.is_some(), "is slowed by its engine"),
        (ending.drive.is_some(), "accelerates"),
        (!ending.damage.is_empty(), "drags damaged wheels"),
        (ending.steer.is_some(), "steers"),
        (ending.esc.is_some(), "has ESC"),
        (ending.countersteer.is_some(), "countersteers"),
        (ending.pit.is_some(), "turns into the other car"),
    ];
    let told: Vec<&str> = parts.into_iter().filter_map(|(is, word)| is.then_some(word)).collect();
    if told.is_empty() { COASTS.to_owned() } else { told.join(", ") }
}

/// Draws a check box that adds or removes a part of the ending.
fn switch<T>(ui: &mut Ui, label: &str, part: &mut Option<T>, usual: T) {
    let mut is_on = part.is_some();
    if ui.checkbox(&mut is_on, label).changed() {
        *part = is_on.then_some(usual);
    }
    ui.end_row();
}

/// A driver who brakes hard after the usual time of reaction.
pub(super) fn hard_braking() -> Braking {
    Braking::new(REACTION_S, HARD_BRAKING, DEFAULT_BRAKE_RISE_S)
}

fn brake_fields(ui: &mut Ui, brake: &mut Option<Braking>, units: UnitSystem) {
    switch(ui, "The driver brakes", brake, hard_braking());
    let Some(brake) = brake else { return };
    quantity_field(ui, "from", &mut brake.start_s, &CONTROL_TIME, units);
    quantity_field(ui, "share of friction", &mut brake.share_of_friction, &BRAKE_SHARE, units);
    quantity_field(ui, "rises over", &mut brake.rise_s, &BRAKE_RISE, units);
    switch(ui, "with an anti-lock system", &mut brake.abs, AntiLock::default());
}

fn esc_fields(ui: &mut Ui, esc: &mut Option<StabilityControl>, units: UnitSystem) {
    switch(ui, "Stability control (with anti-lock system)", esc, StabilityControl::default());
    let Some(esc) = esc else { return };
    let usual = StabilityControl::default().acting();
    let mut field =
        |label, value, usual, range| optional_field(ui, label, value, usual, range, units);
    let threshold = &mut esc.threshold_rad_s;
    field("on from an oversteer of", threshold, usual.threshold_rad_s, &ESC_THRESHOLD);
    field("dead time", &mut esc.dead_time_s, usual.dead_time_s, &DEAD_TIME);
    let gives_up = &mut esc.gives_up_sideslip_rad;
    let label = "gives up at a side slip of (90°: never)";
    field(label, gives_up, usual.gives_up_sideslip_rad, &SIDESLIP);
}

fn countersteer_fields(ui: &mut Ui, driver: &mut Option<Countersteer>, units: UnitSystem) {
    switch(ui, "The driver countersteers", driver, Countersteer::default());
    let Some(driver) = driver else { return };
    let usual = Countersteer::default().acting();
    let mut field =
        |label, value, usual, range| optional_field(ui, label, value, usual, range, units);
    field("reaction time", &mut driver.delay_s, usual.delay_s, &REACTION_TIME);
    let (largest_rad, usual_rad) =
        (&mut driver.largest_steering_wheel_rad, usual.largest_steering_wheel_rad);
    let label = "angle of the steering wheel at most";
    field(label, largest_rad, usual_rad, &LARGEST_STEERING_WHEEL_ANGLE);
}

fn pit_fields(ui: &mut Ui, driver: &mut Option<PitDriver>, units: UnitSystem) {
    switch(ui, "The driver turns into the other car (PIT)", driver, PitDriver::default());
    let Some(driver) = driver else { return };
    let usual = driver.acting();
    let mut field =
        |label, value, usual, range| optional_field(ui, label, value, usual, range, units);
    field("from (less than 0: before it)", &mut driver.start_s, usual.start_s, &PIT_START);
    let angle_rad = &mut driver.steering_wheel_rad;
    let usual_rad = usual.steering_wheel_rad;
    field("steering wheel, to the left", angle_rad, usual_rad, &STEERING_WHEEL_ANGLE);
    if driver.steering_wheel_rad.is_none() {
        let sides: Vec<_> =
            [None].into_iter().chain(TurnSide::ALL.iter().copied().map(Some)).collect();
        let word = |side: Option<TurnSide>| side.map_or("of the other car", TurnSide::word);
        choice_row(ui, "to the side", &mut driver.side, &sides, word);
    }
    let turn_s = &mut driver.turn_s;
    optional_field(ui, "turned within", turn_s, usual.turn_s, &BRAKE_RISE, units);
    let ends: Vec<_> = [None].into_iter().chain(PitEnd::ALL.iter().copied().map(Some)).collect();
    choice_row(ui, "in the end", &mut driver.end, &ends, pit_end_label);
    if driver.end != Some(PitEnd::KeepPushing) {
        let (label, turn_rad) = ("once the struck car has turned by", &mut driver.struck_turn_rad);
        optional_field(ui, label, turn_rad, usual.struck_turn_rad, &STRUCK_TURN, units);
        switch(ui, "or after a time", &mut driver.longest_s, USUAL_PUSHING_S);
        if let Some(longest_s) = &mut driver.longest_s {
            quantity_field(ui, "time", longest_s, &CONTROL_TIME, units);
        }
    }
}

fn pit_end_label(end: Option<PitEnd>) -> &'static str {
    match end {
        None => "not known",
        Some(PitEnd::Straighten) => "straightens and coasts",
        Some(PitEnd::Brake) => "straightens and brakes",
        Some(PitEnd::KeepPushing) => "keeps pushing",
    }
}

/// Draws a row for a number of a driver or system, which has its usual value where it is empty, and is drawn in a
/// forecast of both vehicles.
fn optional_field(
    ui: &mut Ui,
    label: &str,
    value: &mut Option<f64>,
    usual_si: f64,
    range: &Range,
    units: UnitSystem,
) {
    let name = ui.label(label);
    let text = format!("({})", range.quantity.shown(usual_si, units));
    let empty = EmptyField { text: &text, start_si: usual_si };
    optional_quantity(ui, value, empty, range, units).labelled_by(name.id);
    ui.end_row();
}

fn engine_fields(ui: &mut Ui, engine: &mut Option<EngineBraking>, units: UnitSystem) {
    let usual =
        EngineBraking { deceleration_m_s2: USUAL_ENGINE_BRAKING_M_S2, axle: DrivenAxle::default() };
    switch(ui, "The engine brakes", engine, usual);
    let Some(engine) = engine else { return };
    quantity_field(ui, "deceleration", &mut engine.deceleration_m_s2, &ENGINE_BRAKING, units);
    axle_field(ui, "driven axle", &mut engine.axle);
}

fn drive_fields(ui: &mut Ui, drive: &mut Option<Driving>, units: UnitSystem) {
    let usual = Driving {
        torque_n_m: USUAL_DRIVE_TORQUE_N_M,
        axle: DrivenAxle::default(),
        start_s: REACTION_S,
        rise_s: DEFAULT_BRAKE_RISE_S,
    };
    switch(ui, "The driver accelerates", drive, usual);
    let Some(drive) = drive else { return };
    quantity_field(ui, "torque at an axle", &mut drive.torque_n_m, &DRIVE_TORQUE, units);
    axle_field(ui, "accelerated axle", &mut drive.axle);
    quantity_field(ui, "from", &mut drive.start_s, &CONTROL_TIME, units);
    quantity_field(ui, "rises over", &mut drive.rise_s, &BRAKE_RISE, units);
}

fn axle_field(ui: &mut Ui, label: &str, axle: &mut DrivenAxle) {
    choice_row(ui, label, axle, DrivenAxle::ALL, DrivenAxle::word);
}

/// How a wheel is after the impact.
#[derive(Clone, Copy, PartialEq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
enum Condition {
    #[strum(to_string = "rolls freely")]
    Free,
    Dragged,
    Locked,
}

impl Condition {
    fn from_damage(damaged: Option<&DamagedWheel>) -> Self {
        match damaged {
            None => Self::Free,
            Some(DamagedWheel { drag_share_of_friction: Some(_), .. }) => Self::Dragged,
            Some(_) => Self::Locked,
        }
    }

    fn label(self) -> &'static str {
        self.into()
    }
}

fn wheel_fields(ui: &mut Ui, wheel: Wheel, damage: &mut Vec<DamagedWheel>, units: UnitSystem) {
    let before = Condition::from_damage(damage.iter().find(|damaged| damaged.wheel == wheel));
    let mut condition = before;
    let label = format!("Wheel, {}", wheel.label());
    let options = Condition::VARIANTS;
    salted_choice_row(ui, wheel.label(), &label, &mut condition, options, Condition::label);
    if condition != before {
        damage.retain(|damaged| damaged.wheel != wheel);
        let drag_share_of_friction = (condition == Condition::Dragged).then_some(USUAL_DRAG);
        if condition != Condition::Free {
            damage.push(DamagedWheel { wheel, start_s: 0.0, drag_share_of_friction });
        }
    }
    for damaged in damage.iter_mut().filter(|damaged| damaged.wheel == wheel) {
        if let Some(share) = &mut damaged.drag_share_of_friction {
            quantity_field(ui, "share of friction", share, &DRAG_SHARE, units);
        }
        quantity_field(ui, "from", &mut damaged.start_s, &CONTROL_TIME, units);
    }
}

fn steer_fields(
    ui: &mut Ui,
    steer: &mut Option<HeldSteer>,
    steering_ratio: &mut Option<f64>,
    units: UnitSystem,
) {
    let usual =
        HeldSteer { start_s: 0.0, rise_s: DEFAULT_BRAKE_RISE_S, road_wheel_rad: SMALL_STEER_RAD };
    switch(ui, "The front wheels are turned", steer, usual);
    let Some(steer) = steer else { return };
    switch(ui, "by the steering wheel", steering_ratio, USUAL_STEERING_RATIO);
    match steering_ratio {
        None => {
            let angle = &mut steer.road_wheel_rad;
            quantity_field(ui, "angle, to the left", angle, &STEER_ANGLE, units);
        }
        Some(ratio) => steering_wheel_fields(ui, &mut steer.road_wheel_rad, ratio, units),
    }
    quantity_field(ui, "from", &mut steer.start_s, &CONTROL_TIME, units);
    quantity_field(ui, "turned over", &mut steer.rise_s, &BRAKE_RISE, units);
}

/// Draws the ratio of the steering and the angle of the steering wheel. Another ratio keeps the angle of
/// the steering wheel, as far as road wheels can follow it.
fn steering_wheel_fields(
    ui: &mut Ui,
    road_wheel_rad: &mut f64,
    ratio: &mut f64,
    units: UnitSystem,
) {
    let mut angle_rad = *road_wheel_rad * *ratio;
    let mut is_changed = quantity_field(ui, "steering ratio", ratio, &STEERING_RATIO, units);
    let range =
        STEERING_WHEEL_ANGLE.within([STEER_ANGLE.low, STEER_ANGLE.high].map(|end| end * *ratio));
    let label = "angle of the steering wheel, to the left";
    is_changed |= quantity_field(ui, label, &mut angle_rad, &range, units);
    if is_changed {
        *road_wheel_rad = (angle_rad / *ratio).clamp(STEER_ANGLE.low, STEER_ANGLE.high);
    }
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui::{Event, Key};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    /// A number of a driver or system that nobody states shows its usual value and stays unstated until one
    /// is typed, be it the usual one; who empties the field takes it back.
    #[test]
    fn a_usual_value_is_stated_where_somebody_types_it() {
        let asked = Ending {
            esc: Some(StabilityControl::default()),
            countersteer: Some(Countersteer::default()),
            pit: Some(PitDriver::default()),
            ..Ending::default()
        };
        let mut harness = Harness::builder().with_size([600.0, 900.0]).build_ui_state(
            |ui, ending: &mut Option<Ending>| {
                let whose = "After the impact: the struck vehicle";
                ending_form(ui, whose, ending, &mut None, UnitSystem::Si);
            },
            Some(asked.clone()),
        );
        let said = "has ESC, countersteers, turns into the other car";
        harness.get_by_label(&format!("After the impact: the struck vehicle {said}")).click();
        harness.run();
        assert_eq!(harness.state(), &Some(asked.clone()), "what is drawn is not stated");
        for (typed, stated) in [("0.15", Some(0.15)), (" ", None)] {
            harness.get_by_role_and_label(Role::SpinButton, "dead time").focus();
            harness.run();
            harness.event(Event::Text(typed.to_owned()));
            harness.run();
            harness.key_press(Key::Enter);
            harness.run();
            let esc = StabilityControl { dead_time_s: stated, ..StabilityControl::default() };
            let expected = Ending { esc: Some(esc), ..asked.clone() };
            assert_eq!(harness.state(), &Some(expected), "{typed:?}");
        }
        harness.get_by_role_and_label(Role::ComboBox, "to the side");
    }

    /// Who takes the brake back has said what the driver does, and is not asked any more.
    #[test]
    fn a_driver_who_brakes_no_more_coasts_and_is_not_open() {
        let braking = Ending { brake: Some(hard_braking()), ..Ending::default() };
        let mut harness = Harness::builder().with_size([600.0, 900.0]).build_ui_state(
            |ui, ending: &mut Option<Ending>| {
                let whose = "After the impact: the struck vehicle";
                ending_form(ui, whose, ending, &mut None, UnitSystem::Si);
            },
            Some(braking),
        );
        harness.get_by_label("After the impact: the struck vehicle brakes").click();
        harness.run();
        harness.get_by_label("The driver brakes").click();
        harness.run();
        assert_eq!(harness.state(), &Some(Ending::default()));
    }
}

//! The menu of the keys between which the camera of a scene moves.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Checkbox, Grid, PopupCloseBehavior, Ui};

use crate::app::command::Command;
use crate::app::looks::{Icon, icon};
use crate::app::playback::PlaybackCommand;
use crate::app::scene::SceneSettings;
use crate::app::widgets::quantity_value;
use impactlab_core::data::Severity;
use impactlab_core::ranges::{
    CAMERA_AZIMUTH, CAMERA_DISTANCE, CAMERA_ELEVATION, INSTANT, POSITION,
};
use impactlab_core::units::UnitSystem;
use impactlab_draw::scene::{Camera, CameraKey, Follow, move_key, set_key};

/// The columns of numbers of the table of keys.
const HEADS: [&str; 6] = ["Time", "Centre X", "Centre Y", "Distance", "Azimuth", "Elevation"];

/// Draws the menu.
///
/// - `camera`: the one on screen, at the time that is shown, s;
/// - returns the camera of the key to which the user goes.
pub fn camera_menu_ui(
    ui: &mut Ui,
    keys: &mut Vec<CameraKey>,
    settings: &mut SceneSettings,
    (camera, time_s): (Option<Camera>, f64),
    units: UnitSystem,
    commands: &mut Vec<Command>,
) -> Option<Camera> {
    // A click on one of its buttons leaves it open.
    let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let menu = MenuButton::new((icon(Icon::Video), "Camera keys")).config(stays);
    let (button, shown) = menu.ui(ui, |ui| {
        let set = ui.add_enabled(camera.is_some(), Button::new("Key the camera here"));
        let set = set.on_hover_text(
            "The camera on screen, at the time that is shown; a key at that time is replaced",
        );
        if let Some(camera) = camera.filter(|_| set.clicked()) {
            set_key(keys, CameraKey::new(time_s, &camera, settings.follow));
        }
        let choice = Checkbox::new(&mut settings.shows_keyed_camera, "Show the keyed camera");
        ui.add_enabled(!keys.is_empty(), choice).on_hover_text(
            "While the time goes on, the scene is seen as its film shows it; while it stands, the camera \
             can be moved and keyed",
        );
        keys_ui(ui, keys, units, commands)
    });
    button.on_hover_text("The camera of a film moves from key to key");
    let key = shown?.inner?;
    settings.follow = key.follow;
    commands.push(Command::Playback(PlaybackCommand::SetTime(key.time_s)));
    Some(key.camera(settings.camera.kind))
}

/// What a user wants of a key.
#[derive(Clone, Copy)]
enum Wanted {
    /// To see its camera at its time.
    Shown,
    /// To have it at another time, s.
    At(f64),
    /// To have it no more.
    Removed,
}

/// Draws the table of the keys; returns the one that the user wants to see, or whose camera he has changed.
fn keys_ui(
    ui: &mut Ui,
    keys: &mut Vec<CameraKey>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) -> Option<CameraKey> {
    if keys.is_empty() {
        ui.weak("No key yet: the camera of a film is the one on screen");
        return None;
    }
    ui.separator();
    let mut wanted = None;
    Grid::new("camera keys").num_columns(HEADS.len() + 2).show(ui, |ui| {
        ui.label("");
        HEADS.iter().for_each(|head| drop(ui.weak(*head)));
        ui.end_row();
        for (idx, key) in keys.iter_mut().enumerate() {
            wanted = key_row(ui, idx + 1, key, units).map(|of| (idx, of)).or(wanted);
            ui.end_row();
        }
    });
    let (idx, wanted) = wanted?;
    match wanted {
        Wanted::Shown => keys.get(idx).copied(),
        Wanted::At(time_s) => {
            let moved = move_key(keys, idx, time_s);
            if moved.is_none() {
                let text = format!("there is a camera key at {time_s:.3} s already");
                commands.push(Command::Say(Severity::Warning, text));
            }
            moved
        }
        Wanted::Removed => {
            keys.remove(idx);
            None
        }
    }
}

/// Draws the row of a key: its numbers as fields, and what can be done with it.
///
/// - `n`: its number, from 1.
fn key_row(ui: &mut Ui, n: usize, key: &mut CameraKey, units: UnitSystem) -> Option<Wanted> {
    let followed = match key.follow {
        Follow::Nothing => "",
        Follow::Struck => ", follows the struck car",
        Follow::Striking => ", follows the striking car",
    };
    let mut wanted = None;
    let text = format!("Key {n}: {:.3} s{followed}", key.time_s);
    if ui.button(text).on_hover_text("Go to its time and camera").clicked() {
        wanted = Some(Wanted::Shown);
    }
    wanted = time_ui(ui, n, key.time_s, units).map(Wanted::At).or(wanted);
    let stands = key.follow == Follow::Nothing;
    let CameraKey { target_m: [x_m, y_m], distance_m, azimuth_rad, elevation_rad, .. } = key;
    let fields = [
        (x_m, &POSITION, stands),
        (y_m, &POSITION, stands),
        (distance_m, &CAMERA_DISTANCE, true),
        (azimuth_rad, &CAMERA_AZIMUTH, true),
        (elevation_rad, &CAMERA_ELEVATION, true),
    ];
    for ((value, range, is_used), head) in fields.into_iter().zip(HEADS.iter().skip(1)) {
        let field = |ui: &mut Ui| quantity_value(ui, value, range, units);
        let (response, is_changed) = ui.add_enabled_ui(is_used, field).inner;
        response
            .accessible_name(format!("{head} of key {n}"))
            .on_disabled_hover_text("The camera looks at the car that it follows");
        if is_changed {
            wanted = Some(Wanted::Shown);
        }
    }
    if ui.small_button(format!("Remove key {n}")).clicked() {
        wanted = Some(Wanted::Removed);
    }
    wanted
}

/// Draws the field of the time of a key; returns the time to which it is moved. While it is dragged the keys
/// stay in their order, so that no row moves under the pointer.
fn time_ui(ui: &mut Ui, n: usize, time_s: f64, units: UnitSystem) -> Option<f64> {
    let id = ui.scope_id().with(("time of camera key", n));
    let mut shown_s = ui.data(|data| data.get_temp::<f64>(id)).unwrap_or(time_s);
    let (response, is_changed) = quantity_value(ui, &mut shown_s, &INSTANT, units);
    let response = response.accessible_name(format!("Time of key {n}"));
    if response.dragged() {
        ui.data_mut(|data| data.insert_temp(id, shown_s));
        return None;
    }
    ui.data_mut(|data| data.remove::<f64>(id));
    let is_moved = (is_changed || response.drag_stopped()) && shown_s != time_s;
    is_moved.then_some(shown_s)
}

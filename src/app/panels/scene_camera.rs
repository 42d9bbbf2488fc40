//! The menu of the keys between which the camera of a scene moves.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Checkbox, Grid, PopupCloseBehavior, Ui};

use crate::app::command::Command;
use crate::app::looks::{Icon, icon};
use crate::app::playback::PlaybackCommand;
use crate::app::scene::SceneSettings;
use impactlab_draw::scene::{Camera, CameraKey, Follow, set_key};

/// Draws the menu.
///
/// - `camera`: the one on screen, at the time that is shown, s;
/// - returns the camera of the key to which the user goes.
pub fn camera_menu_ui(
    ui: &mut Ui,
    keys: &mut Vec<CameraKey>,
    settings: &mut SceneSettings,
    (camera, time_s): (Option<Camera>, f64),
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
        keys_ui(ui, keys)
    });
    button.on_hover_text("The camera of a film moves from key to key");
    let key = shown?.inner?;
    settings.follow = key.follow;
    commands.push(Command::Playback(PlaybackCommand::SetTime(key.time_s)));
    Some(key.camera(settings.camera.kind))
}

/// Draws the list of the keys; returns the one on which the user clicks.
fn keys_ui(ui: &mut Ui, keys: &mut Vec<CameraKey>) -> Option<CameraKey> {
    if keys.is_empty() {
        ui.weak("No key yet: the camera of a film is the one on screen");
        return None;
    }
    ui.separator();
    let (mut wanted, mut removed) = (None, None);
    Grid::new("camera keys").num_columns(2).show(ui, |ui| {
        for (idx, key) in keys.iter().enumerate() {
            let followed = match key.follow {
                Follow::Nothing => "",
                Follow::Struck => ", follows the struck car",
                Follow::Striking => ", follows the striking car",
            };
            let n = idx + 1;
            let text = format!("Key {n}: {:.3} s{followed}", key.time_s);
            if ui.button(text).on_hover_text("Go to its time and camera").clicked() {
                wanted = Some(*key);
            }
            if ui.small_button(format!("Remove key {n}")).clicked() {
                removed = Some(idx);
            }
            ui.end_row();
        }
    });
    if let Some(idx) = removed {
        keys.remove(idx);
    }
    wanted
}

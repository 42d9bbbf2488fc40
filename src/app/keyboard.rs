//! The keyboard shortcuts and the commands that they give.

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use crate::app::case::{CaseCommand, Leaving};
use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::output::Output;
use crate::app::playback::{PlaybackCommand, TIME_STEP_S};
use crate::app::workspaces::Workspace;

/// Shortcut that undoes the last change of the project.
pub const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
/// Shortcut that redoes the change that was undone last.
pub const REDO: KeyboardShortcut =
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
/// Shortcut that asks for files to open.
pub const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
/// Shortcut that asks for a folder to open.
pub const OPEN_FOLDER: KeyboardShortcut =
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::O);

/// Shortcut that begins a new case.
pub const NEW: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::N);
/// Shortcut that saves the case.
pub const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
/// Shortcut that saves the case under another name.
pub const SAVE_AS: KeyboardShortcut =
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);

/// The keys that act without a modifier, with the description that the help menu shows.
pub const PLAIN_KEYS: [(Key, &str); 8] = [
    (Key::Space, "play or pause"),
    (Key::ArrowLeft, "a step back in time"),
    (Key::ArrowRight, "a step on in time"),
    (Key::Home, "to the impact"),
    (Key::End, "to the end of the contact"),
    (Key::ArrowUp, "previous case"),
    (Key::ArrowDown, "next case"),
    (Key::F, "fit plots to their data"),
];

/// The keys that act with Shift, likewise.
pub const SHIFT_KEYS: [(Key, &str); 2] =
    [(Key::ArrowLeft, "a millisecond back"), (Key::ArrowRight, "a millisecond on")];

/// The keys that show a workspace with Ctrl, in the order of [`Workspace::ALL`].
const WORKSPACE_KEYS: [Key; Workspace::ALL.len()] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];

/// Number of steps of an arrow key in a millisecond.
const STEPS_PER_MS: f64 = 1e-3 / TIME_STEP_S;

/// What takes keys before the window does.
#[derive(Debug, Clone, Copy)]
pub struct KeyFocus {
    /// Whether a dialog is open.
    pub has_dialog: bool,
    /// Whether something was typed into the text field that has the focus.
    pub is_typing: bool,
}

/// Adds the commands of the keys that were pressed in this frame. While a text field has the focus,
/// the keys without a modifier are left to it, and Space to any control that has it; once something was typed
/// into it, undo and redo are those of the text. While a dialog is open, all keys are left to that.
pub fn commands(context: &Context, focus: KeyFocus, commands: &mut Vec<Command>) {
    if focus.has_dialog {
        return;
    }
    let shortcuts = [
        (REDO, Command::Redo),
        (UNDO, Command::Undo),
        (OPEN_FOLDER, Command::Ask(Purpose::Folder)),
        (OPEN, Command::Ask(Purpose::Files)),
        (NEW, Command::Case(CaseCommand::Leave(Leaving::New))),
        (SAVE_AS, Command::Ask(Purpose::Save(Output::Case))),
        (SAVE, Command::Case(CaseCommand::Save)),
    ];
    for (shortcut, command) in shortcuts {
        if focus.is_typing && matches!(command, Command::Undo | Command::Redo) {
            continue;
        }
        if context.input_mut(|input| input.consume_shortcut(&shortcut)) {
            commands.push(command);
        }
    }
    for (workspace, key) in Workspace::ALL.into_iter().zip(WORKSPACE_KEYS) {
        if context.input_mut(|input| input.consume_key(Modifiers::COMMAND, key)) {
            commands.push(Command::ShowWorkspace(workspace));
        }
    }
    if context.text_edit_focused() {
        return;
    }
    for (key, sign) in [(Key::ArrowLeft, -1.0), (Key::ArrowRight, 1.0)] {
        if context.input_mut(|input| input.consume_key(Modifiers::SHIFT, key)) {
            commands.push(Command::Playback(PlaybackCommand::Step(sign * STEPS_PER_MS)));
        }
    }
    let has_focus = context.memory(|memory| memory.focused().is_some());
    for (key, _) in PLAIN_KEYS {
        if key == Key::Space && has_focus {
            continue;
        }
        if context.input_mut(|input| input.consume_key(Modifiers::NONE, key)) {
            commands.extend(plain(key));
        }
    }
}

fn plain(key: Key) -> Option<Command> {
    match key {
        Key::Space => Some(Command::Playback(PlaybackCommand::Toggle)),
        Key::ArrowLeft => Some(Command::Playback(PlaybackCommand::Step(-1.0))),
        Key::ArrowRight => Some(Command::Playback(PlaybackCommand::Step(1.0))),
        Key::Home => Some(Command::Playback(PlaybackCommand::SetTime(0.0))),
        Key::End => Some(Command::Playback(PlaybackCommand::ToContactEnd)),
        Key::ArrowUp => Some(Command::SelectNeighbour(-1)),
        Key::ArrowDown => Some(Command::SelectNeighbour(1)),
        Key::F => Some(Command::FitPlots),
        _ => None,
    }
}

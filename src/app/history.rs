//! The history for undo and redo, with a step for each edit.
//!
//! [`Undoer`] takes up what has stood for a second, so that a drag is one step. Edits that follow each other
//! faster are told apart here: what was done before a pointer is pressed, or before the focus went to another
//! field, is an edit of its own.

use egui::util::undoer::Undoer;
use egui::{Context, Event, Id, Key};

use crate::app::project::Project;

/// Frames in which the number of a field is taken at the latest after that has lost the focus.
const SETTLING_FRAMES: u8 = 2;

/// What was done, and what was undone.
#[derive(Default)]
pub struct EditHistory {
    undoer: Undoer<Project>,
    /// The control that had the focus in the last frame.
    focused: Option<Id>,
    /// Frames that the edit before the focus changed may still take.
    settling: u8,
    /// Whether something was typed into the control with the focus.
    has_typed: bool,
}

impl EditHistory {
    /// Takes up the project of this frame.
    pub fn feed(&mut self, context: &Context, project: &Project) {
        let focused = context.memory(|memory| memory.focused());
        if focused != self.focused {
            (self.focused, self.settling, self.has_typed) = (focused, SETTLING_FRAMES, false);
        }
        let (now, is_pressed, is_down, types) = context.input(|input| {
            let pointer = &input.pointer;
            let types = input.events.iter().any(is_typing);
            (input.time, pointer.any_pressed(), pointer.any_down(), types)
        });
        self.has_typed |= types && context.text_edit_focused();
        let ends_edit = is_pressed || self.settling > 0;
        // A drag that pauses is one edit. What was undone is forgotten with the next edit, which is seen here.
        if ends_edit || !is_down {
            self.undoer.feed_state(now, project);
        }
        if ends_edit {
            self.undoer.add_undo(project);
            self.settling = self.settling.saturating_sub(1);
        }
    }

    /// Whether a text is being typed, which is undone by itself.
    pub fn is_typing(&self, context: &Context) -> bool {
        let focused = context.memory(|memory| memory.focused());
        self.has_typed && focused == self.focused && context.text_edit_focused()
    }

    /// Whether there is something to undo.
    pub fn has_undo(&self, project: &Project) -> bool {
        self.undoer.has_undo(project)
    }

    /// Whether there is something to redo.
    pub fn has_redo(&self, project: &Project) -> bool {
        self.undoer.has_redo(project)
    }

    /// The project before the last edit.
    pub fn undo(&mut self, project: &Project) -> Option<&Project> {
        self.undoer.undo(project)
    }

    /// The project after the edit that was undone last.
    pub fn redo(&mut self, project: &Project) -> Option<&Project> {
        self.undoer.redo(project)
    }

    /// Forgets what was done: the project is of another variant.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

fn is_typing(event: &Event) -> bool {
    match event {
        Event::Text(_) | Event::Paste(_) | Event::Cut => true,
        Event::Key { key: Key::Backspace | Key::Delete, pressed, .. } => *pressed,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use egui::{PointerButton, Pos2, RawInput};

    use super::*;

    /// Feeds a project in a frame with an event, and gives the history the time of a frame.
    fn frame(history: &mut EditHistory, context: &Context, duration_s: f64, press: Option<bool>) {
        let pressed = press.map(|pressed| Event::PointerButton {
            pos: Pos2::ZERO,
            button: PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        });
        let input = RawInput { events: pressed.into_iter().collect(), ..RawInput::default() };
        let mut project = Project::default();
        project.simulate.duration_s = duration_s;
        let _ = context.run_ui(input, |ui| history.feed(ui.ctx(), &project));
    }

    fn of(duration_s: f64) -> Project {
        let mut project = Project::default();
        project.simulate.duration_s = duration_s;
        project
    }

    /// Two edits within a second were taken back together.
    #[test]
    fn each_click_is_a_step_and_a_drag_is_one() {
        let (mut history, context) = (EditHistory::default(), Context::default());
        frame(&mut history, &context, 1.0, None);
        for (before, after) in [(1.0, 2.0), (2.0, 3.0)] {
            frame(&mut history, &context, before, Some(true));
            frame(&mut history, &context, after, Some(false));
        }
        let undone = history.undo(&of(3.0)).map(|project| project.simulate.duration_s);
        assert_eq!(undone, Some(2.0));
        let undone = history.undo(&of(2.0)).map(|project| project.simulate.duration_s);
        assert_eq!(undone, Some(1.0));
        assert!(!history.has_undo(&of(1.0)) && history.has_redo(&of(1.0)));

        // What is dragged goes on changing while the pointer is down.
        frame(&mut history, &context, 1.0, Some(true));
        for dragged in [4.0, 5.0, 6.0] {
            frame(&mut history, &context, dragged, None);
        }
        frame(&mut history, &context, 6.0, Some(false));
        let undone = history.undo(&of(6.0)).map(|project| project.simulate.duration_s);
        assert_eq!(undone, Some(1.0));
        assert!(!history.has_undo(&of(1.0)));
    }

    /// What was undone came back over an edit that was made since.
    #[test]
    fn an_edit_while_the_focus_changes_forgets_what_was_undone() {
        let (mut history, context) = (EditHistory::default(), Context::default());
        frame(&mut history, &context, 1.0, None);
        frame(&mut history, &context, 1.0, Some(true));
        frame(&mut history, &context, 2.0, Some(false));
        history.undo(&of(2.0));
        assert!(history.has_redo(&of(1.0)));
        context.memory_mut(|memory| memory.request_focus(Id::unique("a field")));
        frame(&mut history, &context, 1.0, Some(true));
        frame(&mut history, &context, 3.0, None);
        assert!(!history.has_redo(&of(3.0)));
        let undone = history.undo(&of(3.0)).map(|project| project.simulate.duration_s);
        assert_eq!(undone, Some(1.0));
    }
}

//! What panes are drawn with.

pub use crate::app::pane::Pane;

use crate::app::command::Command;
use crate::app::contents::ContentsEntry;
use crate::app::project::Project;
use crate::app::state::{Session, View};
use crate::app::variants::AnsweredVariant;
use crate::app::widgets::BetweenCursors;
use impactlab_study::case_file::Expert;

/// The context in which the panes are drawn: the parts of the state, and the list of commands.
pub struct PaneContext<'a> {
    /// What the user works on. Panes edit their own settings in it.
    pub project: &'a mut Project,
    /// How the project is shown. The layout of the workspace that is shown is empty while the panes are drawn.
    pub view: &'a mut View,
    /// Loaded data, answers and running work.
    pub session: &'a mut Session,
    /// The two cursors of the figures over time.
    pub between: BetweenCursors,
    /// The variants of the case with their answers.
    pub variants: Vec<AnsweredVariant>,
    /// Who gives the opinion of the case, and for whom.
    pub expert: &'a mut Expert,
    /// What the case consists of.
    pub contents: Vec<ContentsEntry>,
    /// The commands that the panes add.
    pub commands: &'a mut Vec<Command>,
}

//! The atlas in the window: which of its maps is shown, where the case at hand lies in it, and variants that
//! are made of its cells. The panes Atlas, Map and What moves it show them.

mod command;
mod map;
mod session;
mod update;
mod variant;
mod view;
mod words;

pub use command::AtlasCommand;
pub use map::{CaseInput, OUTSIDE_REMEDY, ShownMap};
pub use session::{AtlasSession, ReadAtlas};
pub use variant::SHIPPED_PLAN;
pub use view::{AtlasView, MapChoice, can_be_beside};
pub use words::LEGEND;

//! What the import dialog reads in the background.

use std::sync::Arc;

use crate::app::import::preview::{Preview, Refusal};
use impactlab_core::data::{ColumnMap, ReadSettings, Table};

/// What the dialog reads in the background.
#[derive(Clone)]
pub enum ImportAnswer {
    /// The table, with the lines of header and units that were chosen.
    Table(ReadSettings, Result<Arc<Table>, String>),
    /// The curve with the choices of a map.
    Preview(ColumnMap, ReadPreview),
}

/// The curve, or why there is none.
pub(super) type ReadPreview = Result<Arc<Preview>, Arc<Refusal>>;

//! The columns and rows of the case table.

use impactlab_core::compare::MotionError;
use impactlab_core::data::{Case, DatasetKind, Flag, Value};
use impactlab_core::units::{Quantity, UnitSystem, significant};

/// A column of the case table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CaseColumn {
    /// Name of the attribute of the case, or [`AVERAGE_ERROR`].
    pub key: &'static str,
    /// Heading of the column, without the unit.
    pub title: &'static str,
    /// Physical quantity of the column. The values are in SI units; the table shows them in display
    /// units.
    pub quantity: Quantity,
}

/// Key of the column with the average position error of the simulation, which is no attribute of
/// the case.
pub const AVERAGE_ERROR: &str = "average_error";

const fn column(key: &'static str, title: &'static str, quantity: Quantity) -> CaseColumn {
    CaseColumn { key, title, quantity }
}

pub(in crate::app) const FORCE_COLUMNS: &[CaseColumn] = &[
    column("bullet_body", "Body", Quantity::Ratio),
    column("side", "Side", Quantity::Ratio),
    column("m_b_kg", "Striking mass", Quantity::Mass),
    column("v_tx_m_s", "v_x struck", Quantity::Speed),
    column("theta_b_rad", "θ_b", Quantity::Angle),
    column("impulse_y_n_s", "P_y", Quantity::Impulse),
    column("peak_force_n", "Peak", Quantity::Force),
    column("t_end_s", "End", Quantity::Time),
];

pub(in crate::app) const TRAJECTORY_COLUMNS: &[CaseColumn] = &[
    column("side", "Side", Quantity::Ratio),
    column("speed_m_s", "Speed", Quantity::Speed),
    column("mu", "μ", Quantity::Ratio),
    column("impulse_y_n_s", "P_y", Quantity::Impulse),
    column("spin", "Spin", Quantity::Ratio),
    column(AVERAGE_ERROR, "Error", Quantity::Length),
];

/// A row of the case table: one case of the listed data set.
pub struct CaseRow<'a> {
    /// Name of the case.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// Flags that the check of the data set raised for the case.
    pub flags: &'a [Flag],
    /// Difference between the simulated and the recorded motion; `None` before the data set has
    /// been simulated, and for a case that could not be simulated.
    pub error: Option<&'a MotionError>,
}

impl CaseColumn {
    /// Returns the columns of the table for a kind of data set.
    pub fn for_kind(kind: DatasetKind) -> &'static [Self] {
        match kind {
            DatasetKind::Force => FORCE_COLUMNS,
            DatasetKind::Trajectory => TRAJECTORY_COLUMNS,
        }
    }

    /// Returns the heading with the display unit in brackets, or the title alone for a
    /// dimensionless quantity.
    pub fn heading(&self, units: UnitSystem) -> String {
        match self.quantity.display_unit(units).symbol {
            "" => self.title.to_owned(),
            symbol => format!("{} [{symbol}]", self.title),
        }
    }
}

impl CaseRow<'_> {
    /// Returns the number of a column in SI units; `None` if the case has no such number.
    pub fn number(&self, key: &str) -> Option<f64> {
        match key {
            AVERAGE_ERROR => self.error.map(|error| error.average_error_m),
            _ => self.case.attributes.number(key),
        }
    }

    /// Returns the text of a cell: a number in display units, the text of an attribute, or an empty
    /// string.
    pub fn text(&self, column: &CaseColumn, units: UnitSystem) -> String {
        if let Some(number) = self.number(column.key) {
            if column.quantity == Quantity::Ratio {
                return number.to_string();
            }
            return significant(column.quantity.display_unit(units).from_si(number));
        }
        match self.case.attributes.get(column.key) {
            Some(Value::Text(text)) => text.clone(),
            _ => String::new(),
        }
    }
}

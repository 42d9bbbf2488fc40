//! Restitution and friction of a contact.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use impactlab_core::collision::{DEFAULT_FRICTION_LIMIT, RestitutionForm, default_restitution};

/// Restitution and friction of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactLaw {
    /// Coefficient of restitution e, 0 to 1.
    pub restitution: f64,
    /// What restitution acts on.
    #[serde(default)]
    pub restitution_form: RestitutionForm,
    /// Friction limit μ_c, the largest ratio of tangential to normal impulse, 0 to 10.
    pub friction_limit: f64,
}

impl ContactLaw {
    /// What holds where nothing is known.
    ///
    /// - `closing_m_s`: speed at which the contact points approach each other, in all directions, m/s.
    pub fn at_closing_speed(closing_m_s: f64) -> Self {
        Self {
            restitution: default_restitution(closing_m_s),
            restitution_form: RestitutionForm::default(),
            friction_limit: DEFAULT_FRICTION_LIMIT,
        }
    }
}

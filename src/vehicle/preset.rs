//! Vehicles that come with the program: `assets/vehicles/*.toml`.

use std::path::Path;

use crate::vehicle::VehicleParameters;

macro_rules! presets {
    ($($(#[$doc:meta])* $variant:ident: $file:literal;)+) => {
        /// A vehicle that comes with the program.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Preset {
            $($(#[$doc])* $variant,)+
        }

        impl Preset {
            /// Every preset, in the order of lists.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name on the command line: the file's name without its ending.
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $file),+ }
            }

            /// The text of its file.
            pub fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => {
                        include_str!(concat!("../../assets/vehicles/", $file, ".toml"))
                    })+
                }
            }
        }
    };
}

presets! {
    /// The multibody car of the trajectory datasets.
    Reference: "reference-2000";
    /// The target of the finite-element runs.
    Target: "target-2000";
    /// The lightest bullet of the finite-element runs.
    Bullet1500: "bullet-1500";
    /// The middle bullet of the finite-element runs.
    Bullet2000: "bullet-2000";
    /// The heaviest bullet of the finite-element runs.
    Bullet2500: "bullet-2500";
    /// The paper's 1:4 scaled bullet.
    ScaledBullet: "scaled-bullet-290";
    /// The paper's 1:4 scaled target.
    ScaledTarget: "scaled-target-100";
}

impl Preset {
    /// The preset of this [`Preset::id`].
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|preset| preset.id() == id)
    }

    /// Its parameters.
    pub fn parameters(self) -> VehicleParameters {
        let path = Path::new("assets/vehicles").join(self.id()).with_extension("toml");
        match VehicleParameters::parse(self.text(), &path) {
            Ok(parameters) => parameters,
            Err(error) => unreachable!("a shipped vehicle is bad (a test reads them all): {error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_loads_and_every_estimate_names_a_key() {
        for &preset in Preset::ALL {
            let vehicle = preset.parameters();
            assert_eq!(Preset::from_id(preset.id()), Some(preset));
            let values = toml::Table::try_from(&vehicle).unwrap();
            for key in vehicle.estimates.keys() {
                let (table, name) = key.split_once('.').unwrap();
                assert!(values[table].get(name).is_some(), "{}: no {key}", preset.id());
            }
        }
    }
}

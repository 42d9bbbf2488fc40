//! The library: ordinary vehicles whose data sheets are part of the program, compiled in from
//! `assets/vehicles/library/*.toml`. Each file names the source of its numbers; what it does not state
//! is estimated by rule.

use crate::vehicle::VehicleParameters;
use crate::vehicle::preset::shipped_vehicle;

macro_rules! library {
    ($($file:literal,)+) => {
        /// Every vehicle, in the order in which they are listed to the user.
        const LIBRARY: &[LibraryVehicle] = &[$(LibraryVehicle {
            id: $file,
            text: include_str!(concat!("../../../../../assets/vehicles/library/", $file, ".toml")),
        }),+];
    };
}

/// A vehicle of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LibraryVehicle {
    id: &'static str,
    text: &'static str,
}

library! {
    "generic-car",
    "generic-suv",
    "generic-pickup",
    "generic-van",
    "chevrolet-tahoe-2004",
    "chevrolet-tahoe-2022",
    "chevrolet-tahoe-4wd-2022",
    "chevrolet-trailblazer-2004",
    "chrysler-pacifica-2004",
    "dodge-charger-2022",
    "ford-crown-victoria-2010",
    "ford-escape-2005",
    "ford-explorer-2004",
    "ford-explorer-2020",
    "ford-explorer-sport-trac-2003",
    "ford-f-150-2004",
    "hyundai-accent-2004",
    "hyundai-elantra-2004",
    "hyundai-tiburon-2004",
    "hyundai-xg350-2004",
    "jeep-liberty-2003",
    "kia-amanti-2004",
    "mazda-3-2004",
    "mazda-rx-8-2004",
    "nissan-murano-2003",
    "nissan-quest-2004",
    "toyota-4runner-2003",
    "toyota-camry-2018",
    "toyota-corolla-2020",
    "toyota-highlander-2017",
    "toyota-prius-2004",
    "toyota-rav4-2019",
    "toyota-sienna-2004",
    "toyota-sienna-2021",
    "toyota-solara-2004",
    "toyota-tacoma-2003",
    "volkswagen-golf-2015",
    "volvo-xc90-2004",
}

impl LibraryVehicle {
    /// Every vehicle, in the order in which they are listed to the user.
    pub const ALL: &'static [Self] = LIBRARY;

    /// The vehicle with a given [`LibraryVehicle::id`]; `None` if there is none.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|vehicle| vehicle.id == id)
    }

    /// Name of the vehicle on the command line: its file name without the extension.
    pub const fn id(self) -> &'static str {
        self.id
    }

    /// Text of the data sheet.
    pub const fn text(self) -> &'static str {
        self.text
    }

    /// Parameters of the vehicle.
    pub fn parameters(self) -> VehicleParameters {
        shipped_vehicle("assets/vehicles/library", self.id, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{DataSheet, Preset};

    #[test]
    fn every_file_of_the_library_is_listed_and_read() {
        let files = std::fs::read_dir(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../assets/vehicles/library"
        ))
        .unwrap()
        .count();
        assert_eq!(files, LibraryVehicle::ALL.len());
        for vehicle in LibraryVehicle::ALL {
            assert_eq!(LibraryVehicle::from_id(vehicle.id()), Some(*vehicle));
            assert_eq!(Preset::from_id(vehicle.id()), None, "{vehicle:?}");
            let parameters = vehicle.parameters();
            assert_eq!(parameters.check_relations(), Ok(()), "{vehicle:?}");
            assert_eq!((parameters.substeps(1e-3), parameters.roll_substeps(0.01)), (1, 1));
            assert!(!parameters.source.is_empty(), "{vehicle:?}");
        }
    }

    #[test]
    fn the_real_vehicles_state_mass_size_and_axles() {
        use crate::vehicle::sheet::SheetQuantity as Q;
        let real =
            LibraryVehicle::ALL.iter().filter(|vehicle| !vehicle.id().starts_with("generic"));
        assert_eq!(real.clone().count(), 34);
        for vehicle in real {
            let parameters = vehicle.parameters();
            let sheet: &DataSheet = parameters.sheet.as_ref().unwrap();
            for quantity in [Q::Mass, Q::Length, Q::Width, Q::Wheelbase, Q::Track] {
                assert!(sheet.known(quantity).is_some(), "{}: {quantity:?}", vehicle.id());
            }
            let geometry = &parameters.geometry;
            let overhangs = geometry.outer_length_m - geometry.wheelbase_m();
            assert!((1.2..2.7).contains(&overhangs), "{}: {overhangs}", vehicle.id());
            let beside = geometry.outer_width_m - geometry.track_width_m;
            assert!((0.15..0.40).contains(&beside), "{}: {beside}", vehicle.id());
        }
    }
}

//! Places by latitude and longitude, and the plane that touches the ellipsoid at one of them.
//!
//! Every reader of latitudes and longitudes uses this plane: the columns of a log, KML and GeoJSON. Within
//! 1 km of its place it deviates from distances on the ellipsoid by less than 0.01 mm, within 10 km by 10 mm.

use serde::{Deserialize, Serialize};

/// Semi-major axis of the ellipsoid WGS 84, m.
const EARTH_RADIUS_M: f64 = 6_378_137.0;
/// Square of its first eccentricity.
const ECCENTRICITY_2: f64 = 6.694_379_990_141e-3;

/// Steps after which the place of a point of the plane is found; each makes the error some 10⁻⁴ of it.
const STEPS: usize = 6;

/// A place on the ellipsoid WGS 84, at its altitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeographicPlace {
    /// Positive to the north.
    pub latitude_rad: f64,
    /// Positive to the east.
    pub longitude_rad: f64,
}

impl GeographicPlace {
    /// A place by its degrees; `None` beyond ±90° and ±180°.
    pub fn from_degrees(latitude_deg: f64, longitude_deg: f64) -> Option<Self> {
        let is_place = latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0;
        let [latitude_rad, longitude_rad] = [latitude_deg, longitude_deg].map(f64::to_radians);
        is_place.then_some(Self { latitude_rad, longitude_rad })
    }

    /// Latitude and longitude, degrees.
    pub fn degrees(self) -> [f64; 2] {
        [self.latitude_rad, self.longitude_rad].map(f64::to_degrees)
    }

    /// From the centre of the earth, m.
    fn geocentric_m(self) -> [f64; 3] {
        let (sin, cos) = self.latitude_rad.sin_cos();
        let radius_m = EARTH_RADIUS_M / (1.0 - ECCENTRICITY_2 * sin * sin).sqrt();
        let (sin_lon, cos_lon) = self.longitude_rad.sin_cos();
        [
            radius_m * cos * cos_lon,
            radius_m * cos * sin_lon,
            radius_m * (1.0 - ECCENTRICITY_2) * sin,
        ]
    }

    fn difference_m(self, other: Self) -> [f64; 3] {
        let ([x, y, z], [x0, y0, z0]) = (other.geocentric_m(), self.geocentric_m());
        [x - x0, y - y0, z - z0]
    }

    /// To another place along the plane that touches the ellipsoid here, eastwards.
    pub fn to_east_m(self, other: Self) -> f64 {
        let [x, y, _] = self.difference_m(other);
        let (sin, cos) = self.longitude_rad.sin_cos();
        cos * y - sin * x
    }

    /// The same northwards.
    pub fn to_north_m(self, other: Self) -> f64 {
        let [x, y, z] = self.difference_m(other);
        let (sin_lon, cos_lon) = self.longitude_rad.sin_cos();
        let (sin, cos) = self.latitude_rad.sin_cos();
        cos * z - sin * (cos_lon * x + sin_lon * y)
    }

    /// The place that lies `[east, north]` of here along this plane, m, not farther than some 100 km.
    #[must_use]
    pub fn at_m(self, [east_m, north_m]: [f64; 2]) -> Self {
        let cos = self.latitude_rad.cos().max(1e-6);
        let mut at = self;
        for _ in 0..STEPS {
            let missing_m = [east_m - self.to_east_m(at), north_m - self.to_north_m(at)];
            at.longitude_rad += missing_m[0] / (EARTH_RADIUS_M * cos);
            at.latitude_rad += missing_m[1] / EARTH_RADIUS_M;
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_plane_come_back() {
        for (latitude_deg, longitude_deg) in
            [(52.0, -1.0), (-33.9, 151.2), (0.0, 0.0), (69.6, 18.9)]
        {
            let here = GeographicPlace::from_degrees(latitude_deg, longitude_deg).unwrap();
            for way_m in [[0.0, 0.0], [12.5, -40.0], [-900.0, 700.0], [5000.0, 8000.0]] {
                let there = here.at_m(way_m);
                let back_m = [here.to_east_m(there), here.to_north_m(there)];
                let off_m = (back_m[0] - way_m[0]).hypot(back_m[1] - way_m[1]);
                assert!(off_m < 1e-6, "{latitude_deg}, {longitude_deg}: {way_m:?} is {back_m:?}");
            }
        }
        assert_eq!(GeographicPlace::from_degrees(91.0, 0.0), None);
        assert_eq!(GeographicPlace::from_degrees(0.0, f64::NAN), None);
    }
}

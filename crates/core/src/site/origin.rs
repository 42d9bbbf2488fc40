//! Where a site lies in survey coordinates.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use crate::data::GeographicPlace;

/// The origin and the direction of the axes of a site in a national grid or another system with an
/// easting and a northing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteOrigin {
    /// Easting and northing of the origin of the site, m.
    pub survey_m: [f64; 2],
    /// Direction of X, clockwise from grid north, rad; a quarter turn is east.
    pub x_axis_azimuth_rad: f64,
}

impl Default for SiteOrigin {
    /// Site and survey have the same axes: X is easting, Y is northing.
    fn default() -> Self {
        Self { survey_m: [0.0; 2], x_axis_azimuth_rad: FRAC_PI_2 }
    }
}

impl SiteOrigin {
    /// A place of the survey in the axes of the site, m. The origin is subtracted first, in double
    /// precision: what is 10⁷ m away keeps its position to 2 nm.
    ///
    /// ```text
    /// X =  ΔE sin α + ΔN cos α        α: azimuth of X
    /// Y = −ΔE cos α + ΔN sin α
    /// ```
    pub fn site_from_survey(&self, [easting_m, northing_m]: [f64; 2]) -> [f64; 2] {
        self.turned([easting_m - self.survey_m[0], northing_m - self.survey_m[1]])
    }

    /// A direction of the survey in the axes of the site.
    pub fn turned(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.sin_cos();
        [east * sin + north * cos, north * sin - east * cos]
    }

    /// A place of the site in survey coordinates, easting and northing, m.
    pub fn survey_from_site(&self, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.sin_cos();
        [self.survey_m[0] + x_m * sin - y_m * cos, self.survey_m[1] + x_m * cos + y_m * sin]
    }

    /// Sine and cosine of the azimuth; exact where X points east, so that nothing is turned by rounding.
    fn sin_cos(&self) -> (f64, f64) {
        if self.x_axis_azimuth_rad == FRAC_PI_2 {
            return (1.0, 0.0);
        }
        self.x_axis_azimuth_rad.sin_cos()
    }
}

/// Where a site lies on the earth, if that is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeographicFrame {
    /// The origin of the site.
    pub place: GeographicPlace,
    /// Direction of X, clockwise from true north, rad.
    pub x_axis_azimuth_rad: f64,
}

impl GeographicFrame {
    /// Longitude and latitude of a place of the site, degrees, in the order of KML and GeoJSON.
    pub fn longitude_latitude_deg(&self, at_m: [f64; 2]) -> [f64; 2] {
        let x_axis_azimuth_rad = self.x_axis_azimuth_rad;
        let origin = SiteOrigin { survey_m: [0.0; 2], x_axis_azimuth_rad };
        let [latitude_deg, longitude_deg] =
            self.place.at_m(origin.survey_from_site(at_m)).degrees();
        [longitude_deg, latitude_deg]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_turned_clockwise_from_north_and_come_back() {
        let far = [3_512_345.678, 5_400_123.456];
        for (azimuth_deg, x, y) in [
            (90.0, [1.0, 0.0], [0.0, 1.0]),
            (0.0, [0.0, 1.0], [-1.0, 0.0]),
            (180.0, [0.0, -1.0], [1.0, 0.0]),
        ] {
            let x_axis_azimuth_rad = f64::to_radians(azimuth_deg);
            let origin = SiteOrigin { survey_m: far, x_axis_azimuth_rad };
            for (along, expected) in [(x, [1.0, 0.0]), (y, [0.0, 1.0])] {
                let seen = origin.site_from_survey([far[0] + along[0], far[1] + along[1]]);
                let off = (seen[0] - expected[0]).hypot(seen[1] - expected[1]);
                assert!(off < 1e-8, "{azimuth_deg} deg: {along:?} is {seen:?}");
            }
        }
        let origin = SiteOrigin { survey_m: far, x_axis_azimuth_rad: 0.7 };
        let back = origin.site_from_survey(origin.survey_from_site([41.25, -7.5]));
        assert!((back[0] - 41.25).hypot(back[1] + 7.5) < 1e-8, "{back:?}");
        assert_eq!(SiteOrigin::default().site_from_survey([3.0, 4.0]), [3.0, 4.0]);
    }
}

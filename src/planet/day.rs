//! The position of the star over a rotating planet, by hour and season.

use super::Star;
use crate::sphere::LatLon;

impl Star {
    /// The location where the star is overhead, `time_secs` seconds after time zero.
    pub fn place(&self, time_secs: f64) -> LatLon {
        LatLon::from_degrees(self.latitude_deg, wrapped_deg(self.longitude_deg - self.turned_deg(time_secs)))
    }

    /// Places the star over a location at a time, rounded to a hundredth of a degree to keep the file short.
    pub fn set_place(&mut self, lat_deg: f64, lon_deg: f64, time_secs: f64) {
        let tidy = |degrees: f64| (degrees * 100.0).round() / 100.0;
        self.latitude_deg = tidy(lat_deg).clamp(-90.0, 90.0);
        self.longitude_deg = tidy(wrapped_deg(lon_deg + self.turned_deg(time_secs))).clamp(-180.0, 180.0);
    }

    /// The solar hour, 0 to 24, at a longitude; 12 is noon.
    pub fn hour(&self, lon_deg: f64, time_secs: f64) -> f64 {
        let (_, star_lon_deg) = self.place(time_secs).to_degrees();
        ((lon_deg - star_lon_deg) / 15.0 + 12.0).rem_euclid(24.0)
    }

    /// Sets the solar hour at a longitude.
    pub fn set_hour(&mut self, hour: f64, lon_deg: f64, time_secs: f64) {
        self.set_place(self.latitude_deg, lon_deg - (hour - 12.0) * 15.0, time_secs);
    }

    /// The season as an angle since the northern spring, in degrees: at 90 the star is as far north as the axial tilt
    /// allows. Of the two seasons with equal latitude, the one in which northern days get longer.
    pub fn season_deg(&self) -> f64 {
        let (latitude, tilt) = (self.latitude_deg.to_radians(), self.tilt_deg.to_radians());
        let share = libm::sin(latitude) / libm::sin(tilt).max(1e-9);
        libm::asin(share.clamp(-1.0, 1.0)).to_degrees()
    }

    /// Sets the season.
    pub fn set_season(&mut self, season_deg: f64) {
        let sine = libm::sin(self.tilt_deg.to_radians()) * libm::sin(season_deg.to_radians());
        self.latitude_deg = (libm::asin(sine.clamp(-1.0, 1.0)).to_degrees() * 100.0).round() / 100.0;
    }

    /// The rotation of the planet since time zero.
    fn turned_deg(&self, time_secs: f64) -> f64 {
        if self.day_hours > 0.0 { (time_secs / (self.day_hours * 3600.0)).fract() * 360.0 } else { 0.0 }
    }
}

/// A longitude, wrapped to -180 to 180.
fn wrapped_deg(degrees: f64) -> f64 {
    if (-180.0..=180.0).contains(&degrees) { degrees } else { (degrees + 180.0).rem_euclid(360.0) - 180.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_goes_westward_and_ends_where_it_began() {
        let star = Star { longitude_deg: 170.0, latitude_deg: 12.0, day_hours: 10.0, ..Star::default() };
        let lon_deg = |hours: f64| star.place(hours * 3600.0).to_degrees().1;
        assert!((lon_deg(0.0) - 170.0).abs() < 1e-9);
        assert!((lon_deg(2.5) - 80.0).abs() < 1e-9);
        assert!((lon_deg(-2.5) + 100.0).abs() < 1e-9, "{}", lon_deg(-2.5));
        assert!((lon_deg(10.0) - 170.0).abs() < 1e-6);
        let still = Star { day_hours: 0.0, ..star };
        assert_eq!(still.place(1e5).to_degrees().1, still.place(0.0).to_degrees().1);
    }

    #[test]
    fn hours_and_seasons_are_set_as_they_are_told() {
        let mut star = Star { day_hours: 30.0, tilt_deg: 25.0, ..Star::default() };
        for (hour, lon_deg, time_secs) in [(6.0, 20.0, 0.0), (18.5, -170.0, 5e4), (0.0, 100.0, -7e4)] {
            star.set_hour(hour, lon_deg, time_secs);
            // Midnight is 0 and 24.
            let off = (star.hour(lon_deg, time_secs) - hour + 12.0).rem_euclid(24.0) - 12.0;
            assert!(off.abs() < 0.001, "{hour}: {off}");
        }
        for season_deg in [-90.0, -30.0, 0.0, 45.0, 90.0] {
            star.set_season(season_deg);
            assert!((star.season_deg() - season_deg).abs() < 2.0, "{season_deg}: {}", star.season_deg());
            assert!(star.latitude_deg.abs() <= 25.0);
        }
        star.set_season(135.0);
        assert!((star.season_deg() - 45.0).abs() < 0.1);
    }
}

//! The sun: where it stands, and how much of its light comes through clear air.

use core::f64::consts::PI;
use kirkas_geometry::DVec3;
use kirkas_geometry::elementary::{acos, asin, atan2, cos, exp, pow, sin};

/// Mean angular radius as seen from Earth, degrees.
pub const RADIUS: f64 = 0.2666;

/// A place and a moment.
#[derive(Clone, Copy, Debug)]
pub struct When {
    /// Degrees, north positive.
    pub latitude: f64,
    /// Degrees, east positive.
    pub longitude: f64,
    /// Year, month and day of the Gregorian calendar.
    pub date: (i32, u32, u32),
    /// Universal time, hours.
    pub time: f64,
}

/// Elevation above the horizon and azimuth from north towards east, radians: the Astronomical Almanac's formulas for low
/// precision (0.01 degrees from 1950 to 2050) as given by Michalsky 1988, "The Astronomical Almanac's Algorithm for
/// Approximate Solar Position". Refraction is left out.
pub fn position(w: &When) -> (f64, f64) {
    let n = days_since_2000(w.date) + (w.time - 12.0) / 24.0;
    let degrees = |x: f64| x.rem_euclid(360.0).to_radians();
    let mean_longitude = 280.460 + 0.985_647_4 * n;
    let anomaly = degrees(357.528 + 0.985_600_3 * n);
    let longitude = degrees(mean_longitude + 1.915 * sin(anomaly) + 0.020 * sin(2.0 * anomaly));
    let obliquity = (23.439 - 0.000_000_4 * n).to_radians();
    let ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
    let declination = asin(sin(obliquity) * sin(longitude));
    let greenwich = 6.697_375 + 0.065_709_824_2 * n + w.time;
    let hour_angle = degrees(15.0 * greenwich + w.longitude) - ascension;
    let latitude = w.latitude.to_radians();
    let sine = sin(declination) * sin(latitude) + cos(declination) * cos(latitude) * cos(hour_angle);
    let east = -cos(declination) * sin(hour_angle);
    let north = sin(declination) * cos(latitude) - cos(declination) * sin(latitude) * cos(hour_angle);
    (asin(sine.clamp(-1.0, 1.0)), atan2(east, north))
}

/// From noon of 1 January 2000 to noon of the date (Fliegel & Van Flandern 1968).
fn days_since_2000((year, month, day): (i32, u32, u32)) -> f64 {
    let (y, m, d) = (i64::from(year), i64::from(month), i64::from(day));
    let a = (m - 14) / 12;
    let julian =
        (1461 * (y + 4800 + a)) / 4 + (367 * (m - 2 - 12 * a)) / 12 - (3 * ((y + 4900 + a) / 100)) / 4 + d - 32_075;
    (julian - 2_451_545) as f64
}

/// The date in `YYYY-MM-DD`.
pub fn read_date(text: &str) -> Option<(i32, u32, u32)> {
    let mut parts = text.split('-');
    let (y, m, d) = (parts.next()?, parts.next()?, parts.next()?);
    let all_digits = [y, m, d].iter().all(|p| !p.is_empty() && p.bytes().all(|b| b.is_ascii_digit()));
    let (year, month, day): (i32, u32, u32) = (y.parse().ok()?, m.parse().ok()?, d.parse().ok()?);
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let last = *days.get((month as usize).checked_sub(1)?)?;
    (all_digits && parts.next().is_none() && (1..=9999).contains(&year) && (1..=last).contains(&day))
        .then_some((year, month, day))
}

/// Irradiance on a surface that faces the sun at this elevation (radians), linear Rec.709, W/m2 (683 lux count as 1):
/// a black body of 5900 K that sends 133.3 klux (Darula, Kittler & Gueymard 2005), weakened by molecules, haze and ozone as in Preetham, Shirley & Smits 1999, "A Practical Analytic
/// Model for Daylight", appendix A.1 (after Iqbal 1983). Gases and water that absorb beyond 690 nm are left out.
pub fn irradiance(turbidity: f64, elevation: f64) -> [f64; 3] {
    if elevation <= 0.0 {
        return [0.0; 3];
    }
    let zenith = 90.0 - elevation.to_degrees();
    let air_mass = 1.0 / (cos(zenith.to_radians()) + 0.15 * pow(93.885 - zenith, -1.253));
    let haze = (0.046_08 * turbidity - 0.045_86).max(0.0);
    const STEP: f64 = 5.0;
    let mut xyz = DVec3::ZERO;
    for i in 0..80 {
        let nm = 382.5 + STEP * f64::from(i);
        let um = nm / 1000.0;
        let depth = 0.008_735 * pow(um, -4.08) + haze * pow(um, -1.3) + 0.35 * ozone(nm);
        xyz += color_matching(nm) * (black_body(nm) * exp(-air_mass * depth) * STEP);
    }
    let solid_angle = 2.0 * PI * (1.0 - cos(RADIUS.to_radians()));
    let [x, y, z] = (xyz * solid_angle).to_array();
    // IEC 61966-2-1.
    [
        (3.240_97 * x - 1.537_383 * y - 0.498_611 * z).max(0.0),
        (-0.969_244 * x + 1.875_968 * y + 0.041_555 * z).max(0.0),
        (0.055_63 * x - 0.203_977 * y + 1.056_972 * z).max(0.0),
    ]
}

/// The sun without air, W/(m2 sr nm): Planck's law at its colour temperature, scaled to its illuminance.
fn black_body(nm: f64) -> f64 {
    const KELVIN: f64 = 5900.0;
    const SCALE: f64 = 0.9628;
    let m = nm * 1e-9;
    // 2 h c^2 and h c / k.
    SCALE * 1.191_042_972e-16 / (m * m * m * m * m) / (exp(1.438_776_877e-2 / (m * KELVIN)) - 1.0) * 1e-9
}

/// Absorption by ozone, 1/cm, from 450 nm in steps of 10 nm (Leckner 1978, in Iqbal 1983).
const OZONE: [f64; 35] = [
    0.003, 0.006, 0.009, 0.014, 0.021, 0.030, 0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125,
    0.120, 0.105, 0.090, 0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009, 0.007,
    0.004, 0.0, 0.0,
];

fn ozone(nm: f64) -> f64 {
    let x = (nm - 450.0) / 10.0;
    if x < 0.0 {
        return 0.0;
    }
    let i = (x as usize).min(OZONE.len() - 2);
    OZONE[i] + (OZONE[i + 1] - OZONE[i]) * (x - i as f64).min(1.0)
}

/// The CIE 1931 observer (Wyman, Sloan & Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching
/// Functions", table 1).
fn color_matching(nm: f64) -> DVec3 {
    let lobe = |peak: f64, below: f64, above: f64| {
        let t = (nm - peak) / if nm < peak { below } else { above };
        exp(-0.5 * t * t)
    };
    DVec3::new(
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    )
}

/// How bright the disc is at a share `r` of its radius, beside its mean: linear limb darkening with the coefficient 0.6
/// (visible light; Cox 2000, "Allen's Astrophysical Quantities").
pub fn limb_darkening(r: f64) -> f64 {
    const U: f64 = 0.6;
    let mu = (1.0 - r * r).max(0.0).sqrt();
    (1.0 - U * (1.0 - mu)) / (1.0 - U / 3.0)
}

/// The angle between unit vectors, and its cosine.
pub fn angle_between(a: DVec3, b: DVec3) -> (f64, f64) {
    let cosine = a.dot(b).clamp(-1.0, 1.0);
    // Where the cosine says little, the chord says it.
    let chord = (a - b).length();
    (if chord < 0.5 { 2.0 * asin(0.5 * chord) } else { acos(cosine) }, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(latitude: f64, longitude: f64, date: &str, time: f64, elevation: f64, azimuth: f64) {
        let when = When { latitude, longitude, date: read_date(date).unwrap(), time };
        let (e, a) = position(&when);
        let a = a.to_degrees().rem_euclid(360.0);
        assert!((e.to_degrees() - elevation).abs() < 0.05, "elevation {}", e.to_degrees());
        assert!((a - azimuth).abs() < 0.1, "azimuth {a}");
    }

    #[test]
    fn the_sun_stands_where_the_almanac_has_it() {
        // Reda & Andreas 2004, table A5.1 (17 October 2003, 12:30:30 in zone -7, Golden): zenith 50.111, azimuth 194.340.
        check(39.742_476, -105.178_6, "2003-10-17", 19.0 + 30.5 / 60.0, 90.0 - 50.12, 194.34);
        // At the June solstice it culminates over the tropic of Cancer; noon at Greenwich comes 1.9 minutes late.
        let when = |time| When { latitude: 23.44, longitude: 0.0, date: (2000, 6, 21), time };
        assert!(position(&when(12.031)).0.to_degrees() > 89.9);
        // On an equinox it rises in the east.
        let when = When { latitude: 0.0, longitude: 0.0, date: (2024, 3, 20), time: 6.0 + 7.5 / 60.0 };
        let (e, a) = position(&when);
        assert!(e.to_degrees().abs() < 0.2 && (a.to_degrees() - 90.0).abs() < 0.2, "{e} {a}");
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(read_date("2024-02-29"), Some((2024, 2, 29)));
        for wrong in ["2023-02-29", "2024-13-01", "2024-00-10", "2024-1", "24.12.2024", "2024-06-31", "", "2024-06-+1"]
        {
            assert_eq!(read_date(wrong), None, "{wrong}");
        }
        assert_eq!(days_since_2000((2000, 1, 1)), 0.0);
        assert_eq!(days_since_2000((2026, 6, 21)), 9668.0);
    }

    fn lux(turbidity: f64, degrees: f64) -> f64 {
        let [r, g, b] = irradiance(turbidity, f64::to_radians(degrees));
        683.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b)
    }

    #[test]
    fn the_sun_gives_as_many_lux_as_it_does() {
        // Outside the air 133.3 klux (Darula, Kittler & Gueymard 2005); on the ground in clear air 85 to 110 klux.
        let outside: f64 =
            (0..800).map(|i| 380.0 + f64::from(i) * 0.5).map(|nm| color_matching(nm).y * black_body(nm) * 0.5).sum();
        let outside = outside * 683.0 * 2.0 * PI * (1.0 - cos(RADIUS.to_radians()));
        assert!((outside - 133.3e3).abs() < 100.0, "{outside}");
        assert!((85e3..110e3).contains(&lux(2.5, 60.0)), "{}", lux(2.5, 60.0));
        assert!(lux(3.0, 5.0) < 0.4 * lux(3.0, 30.0) && lux(6.0, 30.0) < 0.8 * lux(2.0, 30.0));
        assert_eq!(lux(3.0, -1.0), 0.0);
    }

    #[test]
    fn a_low_sun_is_red_and_a_high_one_nearly_white() {
        let [r, _, b] = irradiance(3.0, f64::to_radians(4.0));
        assert!(r > 4.0 * b);
        let [r, g, b] = irradiance(2.0, f64::to_radians(70.0));
        assert!(r < 1.6 * b && (g / r - 0.85).abs() < 0.1, "{r} {g} {b}");
    }

    #[test]
    fn limb_darkening_keeps_the_mean() {
        let n = 10_000;
        let mean: f64 =
            (0..n).map(|i| limb_darkening(((f64::from(i) + 0.5) / f64::from(n)).sqrt())).sum::<f64>() / f64::from(n);
        assert!((mean - 1.0).abs() < 1e-4, "{mean}");
    }
}

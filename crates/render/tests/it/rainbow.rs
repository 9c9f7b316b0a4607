//! The primary bow, measured in a picture: a shower under a sun that is a point, by wavelength.
//!
//! By geometric optics the light of one wavelength rises as 1 / sqrt(distance) towards the bow's outer edge (the caustic, where
//! drops turn light the least) and breaks off there. So the angle of the bow is that of the brightest column, and it must lie
//! within a column or two of the edge, where light has fallen to half of that.

use crate::support::{expose, pixel, prepared};
use kirkas_render::Film;

/// Columns of 0.02 degrees, along the great circle through the point opposite the sun.
const COLUMNS: u32 = 120;
/// Rows; 8 of them up or down an angle of 42 degrees is off by 2e-4 degrees.
const ROWS: u32 = 16;
const FIELD: f64 = 2.4;
const SAMPLES: u32 = 1024;
/// The middle of the picture, from the antisolar point, degrees.
const AIM: f64 = 41.8;

/// Bins of 1 nm around whole wavelengths from 400 to 709 nm.
fn shower() -> Film {
    let (sine, cosine) = AIM.to_radians().sin_cos();
    let toml = format!(
        "[film]\nwidth = {COLUMNS}\nheight = {ROWS}\nfilter = \"box\"\ncolor = \"spectral\"\n\
         spectral_bins = 310\nspectral_range = [399.5, 709.5]\n[integrator]\ntype = \"path\"\nmax_depth = 1\n\
         [cameras.eye]\ntype = \"perspective\"\nlook_at = [{sine:?}, 0, {:?}]\nposition = [0, 0, 0]\nfov = {FIELD}\n\
         fov_axis = \"horizontal\"\n[lights.sun]\ntype = \"directional\"\ndirection = [0, 0, -1]\n\
         [phases.drops]\ntype = \"droplet\"\n[media.shower]\ntype = \"homogeneous\"\nscattering = 0.004\nphase = \"drops\"\n\
         [materials.shower]\ntype = \"hull\"\ninterior = \"shower\"\n\
         [objects.shower]\ntype = \"box\"\nmin = [-900, -900, -300]\nmax = [900, 900, -100]\nmaterial = \"shower\"\n",
        -cosine
    );
    expose(&prepared(&toml), 0..SAMPLES).0
}

/// The angle of a place across the picture, in columns from the left.
fn angle(column: f64) -> f64 {
    let across = 2.0 * column / f64::from(COLUMNS) - 1.0;
    AIM + (across * (0.5 * FIELD).to_radians().tan()).atan().to_degrees()
}

/// Means over the rows.
fn columns(value: impl Fn(u32, u32) -> f64) -> Vec<f64> {
    (0..COLUMNS).map(|x| (0..ROWS).map(|y| value(x, y)).sum::<f64>() / f64::from(ROWS)).collect()
}

fn brightest(columns: &[f64]) -> usize {
    (0..columns.len()).max_by(|a, b| columns[*a].total_cmp(&columns[*b])).expect("columns")
}

/// The angles of the brightest column and of the edge, where light has fallen to half of it.
fn bow(columns: &[f64]) -> (f64, f64) {
    let peak = brightest(columns);
    let half = 0.5 * columns[peak];
    let last = (peak..columns.len()).rev().find(|i| columns[*i] >= half).expect("the peak itself");
    let next = columns.get(last + 1).copied().unwrap_or(0.0);
    let edge = last as f64 + 0.5 + (columns[last] - half) / (columns[last] - next);
    (angle(peak as f64 + 0.5), angle(edge))
}

#[test]
fn the_rendered_bow_stands_at_its_angle_for_each_wavelength_red_outside_and_blue_inside() {
    let film = shower();
    let of_wavelength = |nm: u32| {
        let values = film.spectral_bin(nm - 400);
        columns(|x, y| f64::from(values[(y * COLUMNS + x) as usize]))
    };
    // analytic.json, "rainbow_in_air".
    let mut last = 0.0;
    for (nm, truth) in
        [(450, 41.1803234), (500, 41.5829126), (550, 41.8876117), (589, 42.08107), (600, 42.1284103), (650, 42.3261531)]
    {
        let light = of_wavelength(nm);
        let (peak, edge) = bow(&light);
        println!("{nm} nm: brightest at {peak:.3}, edge at {edge:.3} degrees, {truth:.3} expected");
        assert!((peak - truth).abs() < 0.1 && (edge - truth).abs() < 0.04, "{nm} nm: {peak} and {edge}, not {truth}");
        assert!(peak > last, "{nm} nm lies within a shorter wavelength");
        last = peak;
    }
    // At 589 nm, 42.08 degrees; outside, in Alexander's dark band, there is next to nothing.
    let light = of_wavelength(589);
    let peak = brightest(&light);
    assert!((bow(&light).0 - 42.08).abs() < 0.1);
    let outside = &light[peak + 10..];
    assert!(outside.iter().sum::<f64>() < 0.1 * light[peak] * outside.len() as f64);

    // In colours: red outside, blue inside.
    let [red, green, blue] = [0, 1, 2].map(|c| bow(&columns(|x, y| pixel(&film, x, y)[c])).0);
    println!("red {red:.2}, green {green:.2}, blue {blue:.2} degrees");
    assert!(red > green + 0.1 && green > blue + 0.1, "{red} {green} {blue}");
}

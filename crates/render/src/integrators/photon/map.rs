//! Where photons landed, found by place: they are sorted into the cells of a grid, by the hash of the cell, so that memory follows
//! their number and not the size of the scene. Buckets keep the order of the photons: sums over them are the same every time.
//!
//! # References
//! Teschner et al. 2003, "Optimized Spatial Hashing for Collision Detection of Deformable Objects"; Epanechnikov 1969,
//! "Non-Parametric Estimation of a Multivariate Probability Density" (the kernel).

use core::f32::consts::PI;
use kirkas_geometry::Vec3;
use kirkas_geometry::hash::mix64;
use kirkas_optics::Light;

/// A bit of light that reached a surface.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    /// Where.
    pub position: Vec3,
    /// Unit, back to where it came from.
    pub wi: Vec3,
    /// Unit geometric normal of the surface, on the side of `wi`.
    pub normal: Vec3,
    /// What it brings, W per lane.
    pub power: Light,
    /// Light group.
    pub group: u32,
    /// Surfaces that scattered it before.
    pub bounces: u32,
    /// Only one of its lanes was left.
    pub is_alone: bool,
}

/// The photons of one pass.
pub struct PhotonMap {
    photons: Vec<Photon>,
    /// Bucket b holds the photons `starts[b]..starts[b + 1]`.
    starts: Vec<u32>,
    radius: f32,
}

/// Buckets at most.
const MOST_BUCKETS: usize = 1 << 22;

impl PhotonMap {
    /// Sorted for searches within `radius`, scene units.
    pub fn new(photons: &[Photon], radius: f32) -> Self {
        let mut map = PhotonMap { photons: Vec::new(), starts: Vec::new(), radius };
        let count = photons.len().next_power_of_two().min(MOST_BUCKETS);
        let bucket_of = |p: &Photon| bucket(map.cell(p.position), count);
        let buckets: Vec<u32> = photons.iter().map(bucket_of).collect();

        // Count, sum up, and put each photon into its place.
        let mut starts = vec![0_u32; count + 1];
        buckets.iter().for_each(|&b| starts[b as usize + 1] += 1);
        (0..count).for_each(|b| starts[b + 1] += starts[b]);
        let mut next = starts.clone();
        let mut order = vec![0_u32; photons.len()];
        for (i, &b) in buckets.iter().enumerate() {
            order[next[b as usize] as usize] = i as u32;
            next[b as usize] += 1;
        }
        map.photons = order.iter().map(|&i| photons[i as usize]).collect();
        map.starts = starts;
        map
    }

    /// Hands out every photon within the radius of `at`, with the density (1 / scene unit squared) that its power counts with: a
    /// kernel that falls off to the rim, `2 (1 - d^2 / r^2) / (pi r^2)`.
    pub fn gather(&self, at: Vec3, mut take: impl FnMut(&Photon, f32)) {
        if self.photons.is_empty() {
            return;
        }
        let r2 = self.radius * self.radius;
        let peak = 2.0 / (PI * r2);
        // A ball is at most as wide as a cell: it touches two along each axis.
        let least = self.cell(at - Vec3::splat(self.radius));
        let mut seen = [u32::MAX; 8];
        for corner in 0..8 {
            let cell = std::array::from_fn(|axis| least[axis].saturating_add((corner >> axis & 1) as i32));
            let b = bucket(cell, self.starts.len() - 1);
            if seen[..corner].contains(&b) {
                continue;
            }
            seen[corner] = b;
            let range = self.starts[b as usize] as usize..self.starts[b as usize + 1] as usize;
            for p in &self.photons[range] {
                let d2 = (p.position - at).length_squared();
                if d2 < r2 {
                    take(p, peak * (1.0 - d2 / r2));
                }
            }
        }
    }

    fn cell(&self, at: Vec3) -> [i32; 3] {
        let width = 2.0 * self.radius;
        [at.x, at.y, at.z].map(|x| (x / width).floor() as i32)
    }
}

fn bucket(cell: [i32; 3], count: usize) -> u32 {
    let [x, y, z] = cell.map(|c| u64::from(c as u32));
    (mix64(mix64(x << 32 | y) ^ z) & (count as u64 - 1)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_testkit::Random;

    fn strewn(count: usize) -> Vec<Photon> {
        let mut random = Random::new(5);
        let mut number = |scale: f32| (random.number() - 0.5) * scale;
        (0..count)
            .map(|i| Photon {
                position: Vec3::new(number(4.0), number(1.0), number(4.0)),
                wi: Vec3::Y,
                normal: Vec3::Y,
                power: Light::splat(1.0),
                group: i as u32,
                bounces: 1,
                is_alone: false,
            })
            .collect()
    }

    #[test]
    fn every_photon_within_the_radius_is_found_once_and_no_other() {
        let photons = strewn(3000);
        for radius in [0.02_f32, 0.3, 1.7, 90.0] {
            let map = PhotonMap::new(&photons, radius);
            for at in photons.iter().step_by(61).map(|p| p.position + Vec3::splat(0.01)) {
                let mut found = Vec::new();
                map.gather(at, |p, _| found.push(p.group));
                found.sort_unstable();
                let near = |p: &&Photon| (p.position - at).length_squared() < radius * radius;
                let truth: Vec<u32> = photons.iter().filter(near).map(|p| p.group).collect();
                assert_eq!(found, truth, "{radius}");
            }
        }
        PhotonMap::new(&[], 1.0).gather(Vec3::ZERO, |_, _| panic!("found what is not there"));
    }

    #[test]
    fn the_kernel_counts_every_photon_once_over_a_plane() {
        let photon = Photon { position: Vec3::new(0.3, 0.0, -0.2), ..strewn(1)[0] };
        let map = PhotonMap::new(&[photon], 0.5);
        let (n, mut sum) = (400, 0.0);
        for i in 0..n * n {
            let place = |k: usize| (k as f32 + 0.5) / n as f32 * 2.0 - 1.0;
            map.gather(Vec3::new(place(i % n), 0.0, place(i / n)), |_, density| sum += f64::from(density));
        }
        assert!((sum * 4.0 / (n * n) as f64 - 1.0).abs() < 1e-3);
    }
}

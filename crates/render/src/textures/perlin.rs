//! Gradient noise, the base of the solid textures.
//!
//! K. Perlin: "Improving Noise", 2002, <https://doi.org/10.1145/566654.566636>: the reference implementation's numbers,
//! bit for bit. [`noise`] is 0 at all integer points, smooth to the second derivative, between -1 and 1, and repeats
//! after 256 units.

use kirkas_geometry::DVec3;

/// Improved noise at a point; 0 where the point is not finite.
pub fn noise(p: DVec3) -> f64 {
    if !p.is_finite() {
        return 0.0;
    }
    let cell = p.floor();
    let [x, y, z] = (p - cell).to_array();
    let [i, j, k] = cell.to_array().map(|c| c.rem_euclid(256.0) as usize);
    let corner = |di: usize, dj: usize, dk: usize| {
        let hash = permute(permute(permute(i + di) + j + dj) + k + dk);
        gradient(hash, x - di as f64, y - dj as f64, z - dk as f64)
    };
    let (u, v, w) = (fade(x), fade(y), fade(z));
    let face = |dk| {
        let near = lerp(u, corner(0, 0, dk), corner(1, 0, dk));
        let far = lerp(u, corner(0, 1, dk), corner(1, 1, dk));
        lerp(v, near, far)
    };
    lerp(w, face(0), face(1))
}

/// Octaves of noise, each twice as fine and half as strong: `noise(p) + noise(2 p) / 2 + noise(4 p) / 4 + ...`
pub fn turbulence(p: DVec3, octaves: u32) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    for _ in 0..octaves {
        sum += noise(p * factor) / factor;
        factor *= 2.0;
    }
    sum
}

fn permute(i: usize) -> usize {
    usize::from(PERMUTATION[i % 256])
}

/// `6 t^5 - 15 t^4 + 10 t^3`.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn lerp(t: f64, a: f64, b: f64) -> f64 {
    a + t * (b - a)
}

/// The dot product with one of 12 directions to the middles of a cube's edges (four of them twice).
fn gradient(hash: usize, x: f64, y: f64, z: f64) -> f64 {
    let h = hash % 16;
    let u = if h < 8 { x } else { y };
    let v = match h {
        0..=3 => y,
        12 | 14 => x,
        _ => z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17,
    182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129,
    22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238,
    210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184,
    84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180,
];

//! Orthonormal frames.

use crate::Vec3;

/// A right-handed orthonormal frame; `z` is the normal of the surfaces it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// Normal.
    pub z: Vec3,
}

impl Frame {
    /// Any frame around the unit vector `z` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1.0_f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Frame {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// The frame around unit `z` whose `x` leans as near to `tangent` as it can; any frame if they are parallel.
    pub fn from_z_and_tangent(z: Vec3, tangent: Vec3) -> Self {
        let x = tangent - z * z.dot(tangent);
        let length = x.length();
        if !(length > 1e-12 * tangent.length()) || !length.is_finite() {
            return Self::from_z(z);
        }
        let x = x / length;
        Frame { x, y: z.cross(x), z }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for z in [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::new(0.3, -0.5, 0.1).normalize()] {
            for f in [Frame::from_z(z), Frame::from_z_and_tangent(z, Vec3::Y)] {
                assert!(f.x.dot(f.y).abs() < 1e-6 && f.x.dot(f.z).abs() < 1e-6);
                assert!((f.x.cross(f.y) - f.z).length() < 1e-6);
                let v = Vec3::new(0.2, -3.0, 1.5);
                assert!((f.to_world(f.to_local(v)) - v).length() < 1e-5);
            }
        }
    }
}

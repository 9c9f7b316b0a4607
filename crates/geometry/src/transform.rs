//! Affine maps in f64: built from steps, decomposed, inverted, and applied to normals.

use crate::elementary::{cos, sin};
use crate::{DAffine3, DMat3, DVec3};

/// A turn of `degrees` about `axis` (any length but 0), counter-clockwise seen from its tip.
pub fn rotation(axis: DVec3, degrees: f64) -> DMat3 {
    let a = axis / axis.length();
    let radians = degrees.to_radians();
    let (s, c) = match degrees.rem_euclid(360.0) {
        // Quarter turns are exact.
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => (sin(radians), cos(radians)),
    };
    let t = 1.0 - c;
    DMat3::from_cols(
        DVec3::new(t * a.x * a.x + c, t * a.x * a.y + s * a.z, t * a.x * a.z - s * a.y),
        DVec3::new(t * a.x * a.y - s * a.z, t * a.y * a.y + c, t * a.y * a.z + s * a.x),
        DVec3::new(t * a.x * a.z + s * a.y, t * a.y * a.z - s * a.x, t * a.z * a.z + c),
    )
}

/// The map that puts a camera or lamp at `from`, its -z axis towards `to`, its y axis as near `up` as it can be.
/// `None` when `from` equals `to`.
pub fn look_at(from: DVec3, to: DVec3, up: DVec3) -> Option<DAffine3> {
    let z = (from - to).try_normalize()?;
    let x = match up.cross(z).try_normalize() {
        Some(x) if up.cross(z).length() > 1e-9 * up.length() => x,
        _ => z.any_orthonormal_vector(),
    };
    let y = z.cross(x);
    Some(DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: from })
}

/// A surface normal under an affine map given by its *inverse*: the inverse transpose, normalised by the caller.
pub fn transform_normal(object_from_world: &DAffine3, normal: DVec3) -> DVec3 {
    object_from_world.matrix3.transpose() * normal
}

/// True when the map can be inverted and holds no infinity or NaN.
pub fn is_invertible(m: &DAffine3) -> bool {
    let a = &m.matrix3;
    let scale = a.x_axis.length() * a.y_axis.length() * a.z_axis.length();
    m.is_finite() && scale > 0.0 && a.determinant().abs() > 1e-14 * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        assert_eq!(rotation(DVec3::Z, 90.0) * DVec3::X, DVec3::Y);
        let r = rotation(DVec3::new(1.0, 2.0, 3.0), 37.0);
        assert!((r.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn looking_along_minus_z_is_the_identity() {
        let m = look_at(DVec3::ZERO, -DVec3::Z, DVec3::Y).unwrap();
        assert_eq!(m.matrix3, DMat3::IDENTITY);
        assert!(look_at(DVec3::X, DVec3::X, DVec3::Y).is_none());
    }
}

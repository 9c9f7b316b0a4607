//! The box test of a node's two children.

use crate::build::binary::Node;
use crate::prepared_ray::PreparedRay;
use kirkas_geometry::bounds::pad_far;

/// What the box test of both children needs of a ray.
#[derive(Clone, Copy)]
pub(crate) struct NodeRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// 1 where the direction is negative: the high plane is met first.
    first: [usize; 3],
    t_min: f32,
}

impl NodeRay {
    pub fn new(ray: &PreparedRay) -> Self {
        let inverse = ray.inverse().to_array();
        NodeRay {
            origin: ray.clipped.origin.to_array(),
            inverse,
            first: inverse.map(|i| usize::from(i.is_sign_negative())),
            t_min: ray.clipped.t_min,
        }
    }
}

impl Node {
    /// `Bounds3::intersect` for both children at once: when the ray enters, and whether it does before `limit`.
    #[inline(always)]
    pub fn intersect(&self, ray: &NodeRay, limit: f32) -> ([f32; 2], [bool; 2]) {
        let mut near = [ray.t_min; 2];
        let mut far = [f32::INFINITY; 2];
        for k in 0..3 {
            let side = ray.first[k] & 1;
            let (enter, leave) = (self.planes[k][side], self.planes[k][side ^ 1]);
            for c in 0..2 {
                let e = (enter[c] - ray.origin[k]) * ray.inverse[k];
                let l = (leave[c] - ray.origin[k]) * ray.inverse[k];
                // NaN, a ray within a face, loses both comparisons.
                near[c] = if e > near[c] { e } else { near[c] };
                far[c] = if l < far[c] { l } else { far[c] };
            }
        }
        let far = far.map(pad_far).map(|f| if limit < f { limit } else { f });
        (near, [near[0] <= far[0], near[1] <= far[1]])
    }
}

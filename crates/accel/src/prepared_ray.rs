//! A ray with what every test against it needs, computed once.

use core::mem::MaybeUninit;
use kirkas_geometry::{Ray, Vec3, Vec4};

/// A ray ready to be tested. Rays inside an instance carry two intervals: the world ray's own, and that of the instance's
/// bounds, into which `t` is clamped.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    /// The ray, its `t` limited to the bounds of its instance: what boxes are tested with.
    pub(crate) clipped: Ray,
    /// Hits lie after this.
    pub(crate) t_min: f32,
    /// Hits lie before this.
    pub(crate) t_max: f32,
    /// One over the direction; the last lane is idle.
    pub(crate) inverse: [f32; 4],
    /// 1 where the direction is negative, so that the high plane of a box is met first.
    pub(crate) is_negative: [u32; 3],
    /// The axes, the one along which the ray runs fastest last (each below 3).
    pub(crate) axes: [u32; 3],
    /// The origin along these axes.
    pub(crate) sheared_origin: [f32; 3],
    /// How far the ray moves along the first two axes for each step along the last.
    pub(crate) shear: [f32; 2],
}

impl PreparedRay {
    /// `None` for a ray that can hit nothing: NaN or infinity in origin or direction, no direction, or NaN in `t`.
    #[inline]
    pub fn new(ray: &Ray) -> Option<Self> {
        Self::clipped(*ray, (ray.t_min, ray.t_max))
    }

    /// A ray whose hits lie within the open interval `t`, clamped into the interval that `clipped` carries.
    #[inline]
    pub(crate) fn clipped(clipped: Ray, t: (f32, f32)) -> Option<Self> {
        let mut place = MaybeUninit::uninit();
        // SAFETY: written when that says so.
        Self::prepare(&mut place, &clipped, t).then(|| unsafe { place.assume_init() })
    }

    /// [`PreparedRay::clipped`] where it is to stay; false when nothing was written. Copying what was just written would wait for it.
    #[inline(always)]
    pub(crate) fn prepare(place: &mut MaybeUninit<Self>, clipped: &Ray, t: (f32, f32)) -> bool {
        let (o, d) = (clipped.origin.extend(0.0), clipped.direction.extend(0.0));
        let (size, endless) = (d.abs(), Vec4::INFINITY);
        let is_finite = (o.abs().cmplt(endless) & size.cmplt(endless)).all();
        if !(is_finite & d.cmpne(Vec4::ZERO).any() & (t.0 < t.1)) {
            return false;
        }
        // Without branches, since nothing is known of the next ray: y or z, and then x if it beats that.
        let last = if size.y > size.z { 1 } else { 2 };
        let last = if (size.x > size.y) & (size.x > size.z) { 0 } else { last };
        let axes: [u32; 3] = AXES[last];
        let [u, v, w] = axes.map(|k| k as usize & 3);
        let inverse = (Vec4::ONE / d).to_array();
        let (o, d) = (o.to_array(), d.to_array());
        let p = place.as_mut_ptr();
        // SAFETY: every field is written.
        unsafe {
            (&raw mut (*p).clipped).write(*clipped);
            (&raw mut (*p).t_min).write(t.0);
            (&raw mut (*p).t_max).write(t.1);
            (&raw mut (*p).inverse).write(inverse);
            (&raw mut (*p).is_negative).write([inverse[0], inverse[1], inverse[2]].map(|i| i.to_bits() >> 31));
            (&raw mut (*p).axes).write(axes);
            (&raw mut (*p).sheared_origin).write([o[u], o[v], o[w]]);
            (&raw mut (*p).shear).write([d[u] / d[w], d[v] / d[w]]);
        }
        true
    }

    /// One over the direction.
    #[inline]
    pub(crate) fn inverse(&self) -> Vec3 {
        Vec3::new(self.inverse[0], self.inverse[1], self.inverse[2])
    }

    /// A crossing, clamped into what `Bounds3::intersect` gave for its bounds, if it may be a hit.
    #[inline]
    pub(crate) fn accept(&self, t: f64, inside: (f32, f32)) -> Option<f32> {
        // NaN is not accepted.
        if !(t > f64::from(self.t_min) && t < f64::from(self.t_max)) {
            return None;
        }
        let t = clamp(t as f32, inside);
        self.admits(t).then_some(t)
    }

    /// True when `t` may be a hit.
    #[inline]
    pub(crate) fn admits(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }
}

/// The axes in cyclic order, by the last of them.
const AXES: [[u32; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// `t` moved into `[near, far]`; NaN stays. A zero comes out positive: whether the greater of 0 and -0 is one or the other differs from
/// compiler to compiler.
#[inline]
pub(crate) fn clamp(t: f32, (near, far): (f32, f32)) -> f32 {
    let inside = if t < near {
        near
    } else if t > far {
        far
    } else {
        t
    };
    inside + 0.0
}

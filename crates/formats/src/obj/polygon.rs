//! Polygons into triangles. Triangles and convex polygons become a fan about their first corner, a concave quad one about
//! its inner corner; other concave polygons lose ears (Meisters 1975) up to [`MOST_CORNERS`], beyond that they are taken as
//! convex.

use kirkas_geometry::{DVec2, DVec3, Vec3};

/// Concave polygons with more corners than this are cut as if they were convex: ear clipping costs up to n^3.
pub const MOST_CORNERS: usize = 100;

/// Cut a polygon of `n` corners; `emit` gets the corners' numbers, turning as the polygon does.
pub fn triangulate(n: usize, point: impl Fn(usize) -> Vec3, mut emit: impl FnMut([usize; 3])) {
    if n <= 3 {
        if n == 3 {
            emit([0, 1, 2]);
        }
        return;
    }
    if n <= MOST_CORNERS {
        let flat = flatten(n, &point);
        match (0..n).find(|&i| turn(&flat, (i + n - 1) % n, i, (i + 1) % n) < 0.0) {
            None => {}
            Some(inner) if n == 4 => return fan(n, inner, emit),
            Some(_) => return clip_ears(&flat, emit),
        }
    }
    fan(n, 0, &mut emit);
}

fn fan(n: usize, first: usize, mut emit: impl FnMut([usize; 3])) {
    for i in 1..n - 1 {
        emit([first, (first + i) % n, (first + i + 1) % n]);
    }
}

/// The polygon seen along its mean normal (Newell), so that it turns left.
fn flatten(n: usize, point: impl Fn(usize) -> Vec3) -> Vec<DVec2> {
    let p: Vec<DVec3> = (0..n).map(|i| point(i).as_dvec3()).collect();
    let mut normal = DVec3::ZERO;
    for i in 0..n {
        let (a, b) = (p[i] - p[0], p[(i + 1) % n] - p[0]);
        normal += a.cross(b);
    }
    let size = normal.abs();
    p.iter()
        .map(|&v| {
            let v = v - p[0];
            if size.x >= size.y && size.x >= size.z {
                DVec2::new(v.y * normal.x.signum(), v.z)
            } else if size.y >= size.z {
                DVec2::new(v.z * normal.y.signum(), v.x)
            } else {
                DVec2::new(v.x * normal.z.signum(), v.y)
            }
        })
        .collect()
}

/// Twice the signed area of a triangle.
fn turn(p: &[DVec2], a: usize, b: usize, c: usize) -> f64 {
    (p[b] - p[a]).perp_dot(p[c] - p[b])
}

fn clip_ears(p: &[DVec2], mut emit: impl FnMut([usize; 3])) {
    let mut left: Vec<usize> = (0..p.len()).collect();
    while left.len() > 3 {
        let n = left.len();
        let corners = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let is_ear = |i: &usize| {
            let [a, b, c] = corners(*i);
            let inside = |&q: &usize| {
                q != a
                    && q != b
                    && q != c
                    && turn(p, a, b, q) >= 0.0
                    && turn(p, b, c, q) >= 0.0
                    && turn(p, c, a, q) >= 0.0
            };
            turn(p, a, b, c) > 0.0 && !left.iter().any(inside)
        };
        // A polygon that crosses itself may have no ear: cut anywhere.
        let ear = (0..n).find(is_ear).unwrap_or(1);
        emit(corners(ear));
        left.remove(ear);
    }
    emit([left[0], left[1], left[2]]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[[f32; 2]]) -> (usize, f64) {
        let p: Vec<DVec2> = points.iter().map(|q| DVec2::new(q[0].into(), q[1].into())).collect();
        let (mut count, mut sum) = (0, 0.0);
        triangulate(
            p.len(),
            |i| Vec3::new(points[i][0], points[i][1], 0.0),
            |[a, b, c]| {
                let t = turn(&p, a, b, c);
                assert!(t >= 0.0, "a triangle turns the wrong way");
                count += 1;
                sum += t / 2.0;
            },
        );
        (count, sum)
    }

    #[test]
    fn convex_and_concave_polygons_keep_their_area() {
        assert_eq!(area(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), (2, 1.0));
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        assert_eq!(area(&arrow), (2, 1.0));
        let comb = [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 3.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        assert_eq!(area(&comb), (6, 9.0));
    }

    #[test]
    fn a_polygon_that_crosses_itself_still_ends() {
        let mut count = 0;
        let star = [[0.0, 1.0], [0.6, -0.8], [-1.0, 0.3], [1.0, 0.3], [-0.6, -0.8]];
        triangulate(5, |i| Vec3::new(star[i][0], star[i][1], 0.0), |_| count += 1);
        assert_eq!(count, 3);
        triangulate(5, |_| Vec3::NAN, |_| count += 1);
        assert_eq!(count, 6);
    }
}

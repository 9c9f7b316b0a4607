//! Cameras against closed forms.

use kirkas_geometry::{DVec3, Vec3};
use kirkas_render::camera::{CAMERAS, COMMON, Camera, CameraSample};
use kirkas_scene::{Catalog, Diagnostic, Entity, Kind, Map, Node, Params, SourceId, Span};

const SIZE: (u32, u32) = (640, 480);

fn compile_entity(entity: &Entity) -> Result<Camera, Diagnostic> {
    let catalog = Catalog { types: CAMERAS.to_vec(), common: vec![(Kind::Camera, COMMON)] };
    Camera::compile(&Params::new(entity, Kind::Camera, &catalog).expect("a listed type"))
}

fn camera(type_name: &str, params: Map) -> Camera {
    compile_entity(&Entity::new("main", type_name, params)).expect("a sound camera")
}

fn at(x: f64, y: f64) -> CameraSample {
    CameraSample { film: (x, y), lens: (0.5, 0.5), time: 0.0 }
}

fn key(time: f64, step: &str, value: impl Into<kirkas_scene::Value>) -> Node {
    let steps = vec![Node::new(Map::default().with(step, value))];
    Node::new(Map::default().with("time", time).with("transform", steps))
}

fn assert_near(a: Vec3, b: [f32; 3]) {
    assert!((a - Vec3::from_array(b)).length() < 2e-6, "{a} is not {b:?}");
}

#[test]
fn the_middle_of_the_film_looks_at_the_point_named() {
    for type_name in ["perspective", "orthographic", "thin_lens"] {
        let c = camera(type_name, Map::default().with("position", [1.0, 2.0, 3.0]).with("look_at", [1.0, 2.0, -3.0]));
        let ray = c.ray(&at(320.0, 240.0), SIZE);
        assert_near(ray.origin, [1.0, 2.0, 3.0]);
        assert_near(ray.direction, [0.0, 0.0, -1.0]);
    }
}

#[test]
fn the_edge_of_the_picture_is_half_the_field_of_view_from_the_axis() {
    let half = |c: &Camera, x: f64, y: f64, size: (u32, u32)| {
        f64::from(c.ray(&at(x, y), size).direction.dot(Vec3::NEG_Z)).acos().to_degrees()
    };
    let with = |axis: &str| camera("perspective", Map::default().with("fov", 60.0).with("fov_axis", axis));
    let near_30 = |angle: f64| assert!((angle - 30.0).abs() < 1e-5, "{angle}");
    near_30(half(&with("vertical"), 320.0, 0.0, SIZE));
    near_30(half(&with("vertical"), 320.0, 480.0, SIZE));
    near_30(half(&with("horizontal"), 0.0, 240.0, SIZE));
    near_30(half(&with("smaller"), 320.0, 0.0, SIZE));
    near_30(half(&with("smaller"), 0.0, 320.0, (480, 640)));
    // The corner of a square picture: tan = sqrt(2) tan(30 degrees).
    let corner = half(&with("vertical"), 0.0, 0.0, (100, 100));
    assert!((corner - (2.0_f64.sqrt() * 30.0_f64.to_radians().tan()).atan().to_degrees()).abs() < 1e-5);
}

#[test]
fn x_runs_right_and_y_runs_down() {
    let c = camera("perspective", Map::default().with("fov", 90.0));
    assert_near(c.ray(&at(640.0, 240.0), (640, 480)).direction, [0.8, 0.0, -0.6]);
    assert_near(c.ray(&at(320.0, 0.0), (640, 480)).direction, [0.0, 0.5_f32.sqrt(), -(0.5_f32.sqrt())]);
    let turned = camera("perspective", Map::default().with("fov", 90.0).with("up", [1.0, 0.0, 0.0]));
    assert_near(turned.ray(&at(320.0, 0.0), (640, 480)).direction, [0.5_f32.sqrt(), 0.0, -(0.5_f32.sqrt())]);
}

#[test]
fn orthographic_rays_are_parallel_and_cover_the_height() {
    let c = camera("orthographic", Map::default().with("height", 3.0));
    for (x, y, origin) in
        [(0.0, 0.0, [-2.0, 1.5, 5.0]), (640.0, 480.0, [2.0, -1.5, 5.0]), (480.0, 240.0, [1.0, 0.0, 5.0])]
    {
        let ray = c.ray(&at(x, y), SIZE);
        assert_near(ray.origin, origin);
        assert_eq!(ray.direction, Vec3::NEG_Z);
    }
}

#[test]
fn points_in_focus_are_seen_through_the_whole_lens_at_one_place() {
    for blades in [0_i64, 3, 7] {
        let c = camera(
            "thin_lens",
            Map::default()
                .with("position", [1.0, 2.0, 7.0])
                .with("look_at", [0.0, 1.0, 0.0])
                .with("aperture_radius", 0.8)
                .with("focus_distance", 4.0)
                .with("blades", blades),
        );
        let pinhole =
            camera("perspective", Map::default().with("position", [1.0, 2.0, 7.0]).with("look_at", [0.0, 1.0, 0.0]));
        let axis = DVec3::new(-1.0, -1.0, -7.0).normalize();
        for (x, y) in [(320.0, 240.0), (10.0, 20.0), (600.0, 300.0)] {
            let central = pinhole.ray(&at(x, y), SIZE);
            let direction = central.direction.as_dvec3();
            let in_focus = central.origin.as_dvec3() + direction * (4.0 / direction.dot(axis));
            for i in 0..64 {
                let lens = ((i % 8) as f32 / 8.0 + 0.06, (i / 8) as f32 / 8.0 + 0.06);
                let ray = c.ray(&CameraSample { film: (x, y), lens, time: 0.0 }, SIZE);
                let to = in_focus - ray.origin.as_dvec3();
                let miss = to.cross(ray.direction.as_dvec3()).length();
                assert!(miss < 3e-6, "misses by {miss}");
                // The lens lies in the plane through the camera's place, across the axis.
                assert!((ray.origin.as_dvec3() - central.origin.as_dvec3()).dot(axis).abs() < 1e-6);
            }
            let seen = c.project(in_focus, 0.0, SIZE).expect("before the camera");
            assert!((seen.0 - x).abs() < 1e-3 && (seen.1 - y).abs() < 1e-3, "{seen:?}");
        }
    }
}

#[test]
fn out_of_focus_points_blur_to_the_size_that_similar_triangles_give() {
    // At twice the focus distance the circle of confusion, carried to the plane of focus, has half the aperture's radius.
    let c = camera("thin_lens", Map::default().with("aperture_radius", 0.5).with("focus_distance", 3.0));
    let far = |lens| c.ray(&CameraSample { film: (320.0, 240.0), lens, time: 0.0 }, SIZE);
    let ray = far((1.0, 0.5));
    assert_near(ray.origin, [0.5, 0.0, 5.0]);
    assert_near(ray.at((6.0 / -ray.direction.z).abs()), [-0.5, 0.0, -1.0]);
}

#[test]
fn an_aperture_of_blades_fills_its_polygon_and_nothing_else() {
    let params = Map::default().with("aperture_radius", 1.0).with("blades", 4_i64).with("blade_rotation", 45.0);
    let c = camera("thin_lens", params.with("position", [0.0, 0.0, 0.0]).with("look_at", [0.0, 0.0, -1.0]));
    // Turned by 45 degrees, the square of circumradius 1 has its sides at 1 / sqrt(2).
    let side = 0.5_f32.sqrt();
    let mut quadrants = [0; 4];
    let (mut widest, mut n) = (0.0_f32, 0);
    for i in 0..40 {
        for j in 0..40 {
            let lens = ((i as f32 + 0.5) / 40.0, (j as f32 + 0.5) / 40.0);
            let p = c.ray(&CameraSample { film: (320.0, 240.0), lens, time: 0.0 }, SIZE).origin;
            assert!(p.x.abs() < side + 1e-6 && p.y.abs() < side + 1e-6 && p.z == 0.0);
            widest = widest.max(p.x.abs());
            quadrants[usize::from(p.x > 0.0) + 2 * usize::from(p.y > 0.0)] += 1;
            n += 1;
        }
    }
    assert!(widest > 0.97 * side);
    assert!(quadrants.iter().all(|&q: &i32| (q - n / 4).abs() <= n / 50), "{quadrants:?}");
}

#[test]
fn a_moving_camera_is_halfway_at_half_time() {
    let motion = vec![key(0.0, "translate", [0.0, 0.0, 0.0]), key(1.0, "translate", [4.0, 0.0, 0.0])];
    let c = camera("perspective", Map::default().with("motion", motion).with("shutter", [0.25, 0.75]));
    assert_eq!(c.shutter(), (0.25, 0.75));
    let ray = c.ray(&CameraSample { film: (320.0, 240.0), lens: (0.0, 0.0), time: 0.5 }, SIZE);
    assert_near(ray.origin, [2.0, 0.0, 5.0]);
    assert_near(ray.direction, [0.0, 0.0, -1.0]);
    assert_eq!(ray.time, 0.5);

    // A quarter turn about y carries the camera, halfway, to 45 degrees: it keeps looking at the origin.
    let turn = vec![key(0.0, "rotate", [0.0, 1.0, 0.0, 0.0]), key(1.0, "rotate", [0.0, 1.0, 0.0, 90.0])];
    let c = camera("perspective", Map::default().with("motion", turn));
    let ray = c.ray(&CameraSample { film: (320.0, 240.0), lens: (0.0, 0.0), time: 0.5 }, SIZE);
    let s = 0.5_f32.sqrt();
    assert_near(ray.origin, [5.0 * s, 0.0, 5.0 * s]);
    assert_near(ray.direction, [-s, 0.0, -s]);
}

#[test]
fn a_transform_moves_the_placed_camera_and_motion_moves_that() {
    let turn = vec![Node::new(Map::default().with("rotate", [0.0, 1.0, 0.0, 90.0]))];
    let still = vec![key(0.0, "translate", [0.0, 0.0, 1.0])];
    let c = camera("perspective", Map::default().with("transform", turn).with("motion", still));
    // A quarter turn about y takes (0, 0, 5) to (5, 0, 0); then it moves by 1 along z.
    let ray = c.ray(&at(320.0, 240.0), SIZE);
    assert_near(ray.origin, [5.0, 0.0, 1.0]);
    assert_near(ray.direction, [-1.0, 0.0, 0.0]);
}

#[test]
fn projecting_a_point_on_a_ray_gives_the_place_on_the_film() {
    for type_name in ["perspective", "orthographic"] {
        let c = camera(type_name, Map::default().with("position", [3.0, -2.0, 1.0]).with("look_at", [0.0, 1.0, 0.5]));
        for (x, y) in [(0.5, 0.5), (320.0, 17.0), (639.0, 479.5)] {
            let ray = c.ray(&at(x, y), SIZE);
            let point = ray.origin.as_dvec3() + ray.direction.as_dvec3() * 7.0;
            let (px, py) = c.project(point, 0.0, SIZE).expect("before the camera");
            assert!((px - x).abs() < 1e-3 && (py - y).abs() < 1e-3, "{px} {py}");
        }
    }
    let c = camera("perspective", Map::default());
    assert_eq!(c.project(DVec3::new(0.0, 0.0, 6.0), 0.0, SIZE), None);
}

#[test]
fn directions_are_unit_under_any_transform() {
    let stretch = vec![Node::new(Map::default().with("scale", [3.0, 0.2, 1.0]))];
    for type_name in ["perspective", "orthographic", "thin_lens"] {
        let c = camera(type_name, Map::default().with("transform", stretch.clone()));
        for i in 0..100 {
            let lens = (i as f32 / 100.0, 0.3);
            let sample = CameraSample { film: (f64::from(i) * 6.4, f64::from(i) * 4.8), lens, time: 0.0 };
            assert!((c.ray(&sample, SIZE).direction.length() - 1.0).abs() < 2e-7);
        }
    }
}

#[test]
fn looking_straight_down_needs_no_up() {
    let c = camera("perspective", Map::default().with("position", [0.0, 5.0, 0.0]).with("fov", 90.0));
    assert_near(c.ray(&at(320.0, 0.0), SIZE).direction, [0.0, -(0.5_f32.sqrt()), -(0.5_f32.sqrt())]);
    assert_near(c.ray(&at(640.0, 240.0), SIZE).direction, [0.8, -0.6, 0.0]);
}

#[test]
fn impossible_cameras_say_why_and_where_and_how_to_mend_them() {
    let place = |start: usize| Span::new(SourceId(0), start, start + 3);
    let spanned = |pairs: &[(&str, [f64; 3])]| {
        let mut map = Map::default();
        for (i, (name, value)) in pairs.iter().enumerate() {
            map.set(kirkas_scene::Name::new(*name), Node::spanned(*value, place(10 * i)));
        }
        map
    };
    let fails = |type_name: &str, params: Map| {
        let error = compile_entity(&Entity::new("main", type_name, params)).expect_err("an impossible camera");
        assert!(error.help.is_some(), "no cure: {error}");
        error
    };
    let same = fails("perspective", spanned(&[("position", [1.0; 3]), ("look_at", [1.0; 3])]));
    assert_eq!(same.message, "the camera stands at the point it looks at");
    assert_eq!(same.labels.iter().map(|l| l.0.start).collect::<Vec<_>>(), [0, 10]);
    let roll = fails("orthographic", spanned(&[("up", [0.0, 0.0, 2.0])]));
    assert_eq!(roll.message, "`up` points along the line of sight and so leaves the camera free to roll");
    assert_eq!(roll.labels[0].0, place(0));
    assert_eq!(fails("perspective", spanned(&[("up", [0.0; 3])])).message, "`up` is zero and so gives no direction");
    let shutter = fails("perspective", Map::default().with("shutter", [1.0, 0.5]));
    assert_eq!(shutter.message, "the shutter closes at 0.5 s, before it opens at 1 s");
    let blades = fails("thin_lens", Map::default().with("blades", 2_i64));
    assert_eq!(blades.message, "an aperture of 2 sides has no area");
    let flat = vec![Node::new(Map::default().with("scale", 0.0))];
    assert_eq!(fails("perspective", Map::default().with("transform", flat)).code, "singular-transform");
}

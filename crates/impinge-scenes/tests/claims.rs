//! Checks the numbers in the doc comments of the scenes, by counting overlaps, motions and sizes.

use impinge_scenes::{
    Placement, Scene, SceneQuery, SceneShape, SolidKind, aligned_pile, asteroids, crowd,
    few_asteroids_moving, few_moving, mixed_shapes, mixed_sizes, pile, plates, rain, room, sensors,
    shaken, solids, solids_on_plain, sparse_drift, spawn_and_despawn, ten_moving, terrain_field,
    terrain_mesh, tower, trembling_vehicles_field, trembling_vehicles_mesh, turned_pile,
    vehicles_field, vehicles_mesh,
};

/// Returns the pairs of living objects whose boxes overlap, by a sweep along the first axis.
fn box_pairs<const D: usize>(scene: &Scene<D>, step: u32) -> Vec<(usize, usize)> {
    let alive = (0..scene.objects.len()).filter(|&n| scene.is_alive(n, step));
    let mut boxes: Vec<_> =
        alive.filter_map(|n| scene.aabb(n, step).map(|(low, high)| (low, high, n))).collect();
    boxes.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let mut pairs = Vec::new();
    for (k, (low1, high1, n1)) in boxes.iter().enumerate() {
        let near = boxes[k + 1..].iter().take_while(|(low2, ..)| low2[0] <= high1[0]);
        let meets = |low2: &[f64; D], high2: &[f64; D]| {
            (0..D).all(|i| low1[i] <= high2[i] && low2[i] <= high1[i])
        };
        let found = near.filter(|(low2, high2, _)| meets(low2, high2));
        pairs.extend(found.map(|(.., n2)| (*n1.min(n2), *n1.max(n2))));
    }
    pairs
}

fn mean_neighbours<const D: usize>(scene: &Scene<D>, step: u32) -> f64 {
    let alive = (0..scene.objects.len()).filter(|&n| scene.is_alive(n, step)).count();
    2.0 * box_pairs(scene, step).len() as f64 / alive as f64
}

/// Transforms a point from the world to the local frame of a placement: the negated tangent inverts
/// the rotation.
fn local<const D: usize>(placement: &Placement<D>, world: &[f64; D]) -> [f64; D] {
    let back = Placement { tangent: -placement.tangent, ..*placement };
    back.turned(&std::array::from_fn(|i| world[i] - placement.translation[i]))
}

fn holds<const D: usize>(scene: &Scene<D>, object: usize, step: u32, world: &[f64; D]) -> bool {
    let SceneShape::Cuboid { half_extents } = &scene.objects[object].shape else {
        panic!("a pile is of boxes")
    };
    let point = local(&scene.placement(object, step), world);
    (0..D).all(|i| point[i].abs() <= half_extents[i])
}

/// Asserts the number of pairs of overlapping boxes, and that both boxes of a pair contain the
/// point halfway between their centres, so that they touch.
fn check_pile<const D: usize>(count: usize, expected_pairs: usize) {
    let scene: Scene<D> = pile(count);
    assert_eq!(scene.objects.len(), count, "size");
    for step in [0, 1, 17, 99] {
        let pairs = box_pairs(&scene, step);
        assert_eq!(pairs.len(), expected_pairs, "pairs of neighbours at step {step}");
        for (one, two) in pairs {
            let (a, b) = (scene.placement(one, step), scene.placement(two, step));
            let middle = std::array::from_fn(|i| 0.5 * (a.translation[i] + b.translation[i]));
            assert!(holds(&scene, one, step, &middle), "{one} {two} at step {step}");
            assert!(holds(&scene, two, step, &middle), "{two} {one} at step {step}");
        }
    }
}

#[test]
fn every_box_of_a_pile_touches_its_neighbours() {
    // A grid of side s has ((3 s − 2)^D − s^D) / 2 pairs of neighbours, the diagonal ones included.
    check_pile::<2>(400, (58 * 58 - 400) / 2);
    check_pile::<3>(1000, (28 * 28 * 28 - 1000) / 2);
}

#[test]
fn a_large_pile_has_as_many_pairs_as_it_says() {
    let pairs = box_pairs(&pile::<3>(10_000), 3).len();
    assert!((112_000..122_000).contains(&pairs), "{pairs} pairs");
}

#[test]
fn a_box_of_the_sparse_drift_has_about_three_neighbours() {
    for step in [0, 50] {
        let counts = [
            mean_neighbours(&sparse_drift::<2>(1000), step),
            mean_neighbours(&sparse_drift::<2>(10_000), step),
            mean_neighbours(&sparse_drift::<3>(1000), step),
            mean_neighbours(&sparse_drift::<3>(10_000), step),
        ];
        let fits = counts.iter().all(|mean| (2.5..=3.5).contains(mean));
        assert!(fits, "step {step}: {counts:?}");
    }
}

#[test]
fn mixed_sizes_span_four_orders_of_magnitude() {
    fn check<const D: usize>() {
        let scene = mixed_sizes::<D>(2000);
        let sizes = scene.objects.iter().map(|object| match &object.shape {
            SceneShape::Cuboid { half_extents } => half_extents[0],
            _ => panic!("boxes only"),
        });
        let (least, greatest) =
            sizes.fold((f64::MAX, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        assert!(least < 0.001 && greatest > 10.0 * 0.9, "{least} to {greatest}");
        let mean = mean_neighbours(&scene, 10);
        assert!((1.0..10.0).contains(&mean), "{mean} neighbours in {D} dimensions");
    }
    check::<2>();
    check::<3>();
}

#[test]
fn one_in_a_hundred_moves() {
    let scene = few_moving::<3>(1000);
    let moves = |n: &usize| scene.placement(*n, 0) != scene.placement(*n, 1);
    assert_eq!((0..1000).filter(moves).count(), 10);
    assert_eq!((0..1000).filter(|&n| scene.placement(n, 0) != scene.placement(n, 90)).count(), 10);
}

#[test]
fn ten_boxes_and_one_rock_in_a_hundred_move() {
    fn moving<const D: usize>(scene: &Scene<D>) -> usize {
        let moves = |n: &usize| scene.placement(*n, 0) != scene.placement(*n, 1);
        (0..scene.objects.len()).filter(moves).count()
    }
    assert_eq!([moving(&ten_moving::<2>(3000)), moving(&ten_moving::<3>(3000))], [10; 2], "boxes");
    assert_eq!(moving(&few_asteroids_moving::<3>(3000)), 30, "rocks");
}

/// Returns the distance between the positions of an object at two steps.
fn distance<const D: usize>(scene: &Scene<D>, object: usize, steps: [u32; 2]) -> f64 {
    let [a, b] = steps.map(|step| scene.placement(object, step).translation);
    (0..D).map(|i| (b[i] - a[i]) * (b[i] - a[i])).sum::<f64>().sqrt()
}

#[test]
fn a_shaken_object_hops_about_its_start() {
    fn check<const D: usize>() {
        let (rest, scene) = (tower::<D>(50), shaken(tower::<D>(50), 0.001));
        assert_eq!(scene.objects[0].motion, rest.objects[0].motion, "the plane stays");
        let (mut sum, mut turns) = (0.0, Vec::new());
        for (n, step) in (1..=50).flat_map(|n| (0..40).map(move |step| (n, step))) {
            let [home, at] = [&rest, &scene].map(|scene| scene.placement(n, step));
            let is_near = |i: usize| (home.translation[i] - at.translation[i]).abs() <= 0.001_01;
            assert!((0..D).all(is_near) && at.tangent.abs() <= 0.000_501, "{n} at step {step}");
            sum += distance(&scene, n, [step, step + 1]);
            turns.push(at.tangent);
        }
        // Two independent points in a square of width 0.002 are 0.001 apart on average, in a cube
        // 0.0013.
        let mean = sum / 2000.0;
        assert!((0.001..0.0018).contains(&mean), "a step has {mean} in the mean");
        turns.sort_by(f64::total_cmp);
        assert!(turns[500] < -0.000_2 && turns[1500] > 0.000_2, "turns are spread evenly");
    }
    check::<2>();
    check::<3>();
}

#[test]
fn piles_are_aligned_or_turned_by_any_angle() {
    fn check<const D: usize>() {
        let (aligned, turned) = (aligned_pile::<D>(1000), turned_pile::<D>(1000));
        assert!((0..1000).all(|n| aligned.placement(n, 7).tangent == 0.0), "aligned");
        let far = (0..1000).filter(|n| turned.placement(*n, 7).tangent.abs() > 0.5).count();
        assert!((400..600).contains(&far), "{far} of 1000 are turned by more than 53 degrees");
        let [few, many] = [&aligned, &turned].map(|scene| mean_neighbours(scene, 7));
        assert!(many >= few, "boxes around turned boxes are wider: {few}, {many}");
    }
    check::<2>();
    check::<3>();
}

#[test]
fn births_and_deaths_balance_at_every_step() {
    let scene = spawn_and_despawn::<2>(500);
    for step in 0..scene.steps {
        let alive = (0..scene.objects.len()).filter(|&n| scene.is_alive(n, step)).count();
        assert_eq!(alive, 500, "step {step}");
        let born = (0..scene.objects.len()).filter(|&n| scene.objects[n].alive.start == step);
        assert!(step == 0 || born.count() == 5, "step {step}");
    }
}

#[test]
fn a_tower_rests_on_its_plane() {
    fn check<const D: usize>() {
        let scene = tower::<D>(25);
        assert_eq!(scene.objects.len(), 26, "a plane and boxes");
        let pairs = box_pairs(&scene, 7);
        assert_eq!(pairs.len(), 9 + 9 + 4, "each touches the one above");
        for (one, two) in pairs {
            let (low, high) =
                (scene.aabb(two, 0).expect("a box").0, scene.aabb(one, 0).expect("a box").1);
            assert_eq!(low[1], high[1], "{two} stands on {one} exactly");
        }
        assert_eq!(scene.aabb(1, 0).expect("a box").0[1], 0.0, "the first stands on the plane");
    }
    check::<2>();
    check::<3>();
}

#[test]
fn all_kinds_of_shapes_are_there_with_both_queries() {
    fn check<const D: usize>(kinds: usize) {
        let scene = mixed_shapes::<D>(kinds * 70);
        let mut seen = std::collections::BTreeMap::new();
        for object in &scene.objects {
            let name = format!("{:?}", object.shape);
            let name = name.split_whitespace().next().expect("a name").to_owned();
            let contacts = matches!(object.query, SceneQuery::Contacts { .. });
            *seen.entry((name, contacts)).or_insert(0) += 1;
        }
        assert_eq!(seen.len(), 2 * kinds + 1, "the plane asks for contacts only: {seen:?}");
        let mean = mean_neighbours(&scene, 5);
        assert!((1.0..4.0).contains(&mean), "{mean} neighbours");
    }
    check::<2>(6);
    check::<3>(8);
}

/// Returns the height of a field at the vertex nearest to a point, and the number of parts of the
/// field.
fn ground<const D: usize>(shape: &SceneShape<D>, at: &[f64; D]) -> (f64, usize) {
    let SceneShape::HeightField { counts: [rows, columns], heights, extents } = shape else {
        panic!("the ground is a field")
    };
    let nearest = |axis: usize, count: usize| {
        let x = (at[axis] / extents[axis] + 0.5) * (count - 1) as f64;
        (0..count).find(|n| *n as f64 + 0.5 >= x).unwrap_or(count - 1)
    };
    let row = if D < 3 { 0 } else { nearest(2, *rows) };
    let cells = if D < 3 { columns - 1 } else { 2 * (rows - 1) * (columns - 1) };
    (heights[row * columns + nearest(0, *columns)], cells)
}

#[test]
fn solids_stay_on_the_ground() {
    fn check<const D: usize>(parts: std::ops::Range<usize>) {
        let scene = terrain_field::<D>(200);
        let shape = &scene.objects[0].shape;
        for n in 1..=200 {
            for step in [0, 40, 80] {
                let at = scene.placement(n, step).translation;
                let (height, count) = ground(shape, &at);
                assert!(parts.contains(&count), "{count} parts");
                let low = scene.aabb(n, step).expect("bounded").0[1];
                assert!(at[1] > height, "the centre of {n} is above the ground at step {step}");
                assert!((low - height).abs() < 0.35, "{n} is near the ground: {low}, {height}");
            }
        }
    }
    check::<2>(2000..2001);
    check::<3>(20_000..20_500);
}

/// Asserts that the mesh and the height field are equal surfaces.
#[test]
fn both_grounds_are_one() {
    let (mesh, field) = (terrain_mesh::<3>(3), terrain_field::<3>(3));
    let SceneShape::TriMesh { vertices, triangles } = &mesh.objects[0].shape else {
        panic!("a mesh")
    };
    for corners in triangles {
        let [a, b, c] = corners.map(|n| vertices[n as usize]);
        let up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
        assert_eq!(up, 0.25, "seen from above, counter-clockwise: half a cell, twice");
    }
    for vertex in vertices {
        assert_eq!(ground(&field.objects[0].shape, vertex).0, vertex[1], "at {vertex:?}");
    }
    assert_eq!(mesh.objects[1..].len(), field.objects[1..].len());
    let line = terrain_mesh::<2>(3);
    assert!(
        matches!(&line.objects[0].shape, SceneShape::Polyline { vertices } if vertices.len() == 31)
    );
}

/// Returns two averages over the box vehicles: the number of terrain vertices within the lower
/// third of the box, and the number of those below, within or above the box.
fn vertices_under_boxes<const D: usize>(scene: &Scene<D>, step: u32) -> [f64; 2] {
    let (SceneShape::TriMesh { vertices, .. } | SceneShape::Polyline { vertices }) =
        &scene.objects[0].shape
    else {
        panic!("a mesh")
    };
    let (mut held, mut covered, mut boxes) = (0, 0, 0);
    for (n, object) in scene.objects.iter().enumerate() {
        let SceneShape::Cuboid { half_extents } = &object.shape else { continue };
        boxes += 1;
        for vertex in vertices {
            let at = local(&scene.placement(n, step), vertex);
            let is_below = (0..D).all(|i| i == 1 || at[i].abs() <= half_extents[i]);
            covered += usize::from(is_below);
            held += usize::from(is_below && (-0.75..-0.25).contains(&at[1]));
        }
    }
    [held, covered].map(|count| count as f64 / f64::from(boxes))
}

#[test]
fn vehicles_lie_along_the_ground() {
    for step in [0, 50, 100] {
        let [held, covered] = vertices_under_boxes(&vehicles_mesh::<3>(60), step);
        assert!((30.0..35.0).contains(&covered), "32 cells: {covered} vertices at step {step}");
        assert!((0.4..0.9).contains(&(held / covered)), "{held} of {covered} at step {step}");
        let [held, covered] = vertices_under_boxes(&vehicles_mesh::<2>(60), step);
        assert!((0.4..=1.0).contains(&(held / covered)), "{held} of {covered} at step {step}");
    }
    let moves = |scene: &Scene<3>| distance(scene, 7, [0, 1]);
    assert!((0.009..0.035).contains(&moves(&vehicles_field(60))), "slowly");
    assert!((1e-5..1e-3).contains(&moves(&trembling_vehicles_field(60))), "in place");
}

/// Returns the vertices of a height field.
fn vertices<const D: usize>(shape: &SceneShape<D>) -> Vec<[f64; D]> {
    let SceneShape::HeightField { counts: [rows, columns], heights, extents } = shape else {
        panic!("the ground is a field")
    };
    let along = |n: usize, count: usize, axis: usize| {
        if count < 2 { 0.0 } else { (n as f64 / (count - 1) as f64 - 0.5) * extents[axis] }
    };
    let places = (0..*rows).flat_map(|row| (0..*columns).map(move |column| [row, column]));
    let vertices = places.zip(heights).map(|([row, column], height)| {
        std::array::from_fn(|axis| match axis {
            0 => along(column, *columns, 0),
            1 => height * extents[1],
            _ => along(row, *rows, axis),
        })
    });
    vertices.collect()
}

/// Checks that plates do not overlap, that they cover the expected number of vertices, and that a
/// quarter to three quarters of these vertices are above the undersides.
fn check_plates<const D: usize>(half: f64) {
    let scene = plates::<D>(20, half);
    let ground = vertices(&scene.objects[0].shape);
    for step in [0, 13, 77] {
        let pairs = box_pairs(&scene, step);
        assert!(
            pairs.len() == 20 && pairs.iter().all(|pair| pair.0 == 0),
            "each on the ground alone"
        );
        let (mut held, mut covered) = (0, 0);
        for (n, vertex) in (1..=20).flat_map(|n| ground.iter().map(move |vertex| (n, vertex))) {
            let at = local(&scene.placement(n, step), vertex);
            let is_below = (0..D).all(|i| i == 1 || at[i].abs() <= half);
            covered += usize::from(is_below);
            held += usize::from(is_below && at[1] >= -0.25);
        }
        let (mean, expected) = (covered as f64 / 20.0, (1..D).map(|_| 2.0 * half).product::<f64>());
        assert!((mean / expected - 1.0).abs() < 0.35, "{mean} vertices for {expected}");
        let share = held as f64 / covered as f64;
        assert!((0.25..0.75).contains(&share), "{share} of the vertices are above the underside");
    }
}

#[test]
fn plates_lie_on_a_rough_plain() {
    for half in [0.5, 1.0, 2.0, 4.0, 8.0] {
        check_plates::<2>(half);
        check_plates::<3>(half);
    }
}

#[test]
fn solids_on_the_plain_slide_by_a_tenth() {
    fn check<const D: usize>() {
        for kind in SolidKind::all::<D>() {
            let scene = solids_on_plain::<D>(30, *kind);
            // A solid that reverses within a step moves less far.
            let far = (1..=30).filter(|n| (0.099..0.101).contains(&distance(&scene, *n, [4, 5])));
            assert!(far.count() > 20, "{kind:?} in {D} dimensions");
            let pairs = box_pairs(&scene, 4);
            assert!(
                pairs.len() == 30 && pairs.iter().all(|pair| pair.0 == 0),
                "{kind:?}: {pairs:?}"
            );
            // The box of a cylinder is larger than needed, so its lower face does not show whether
            // the cylinder lies on the ground.
            let exact = (1..=30).filter(|_| *kind != SolidKind::Cylinder);
            let lows: Vec<_> = exact.map(|n| scene.aabb(n, 4).expect("bounded").0[1]).collect();
            assert!(
                lows.iter().all(|low| low.abs() < 0.006),
                "{kind:?} lies on the ground: {lows:?}"
            );
        }
    }
    check::<2>();
    check::<3>();
}

#[test]
fn densities_of_the_scenes_for_comparison() {
    let step = 20;
    let rocks = mean_neighbours(&asteroids::<3>(2000), step);
    assert!((0.1..0.8).contains(&rocks), "{rocks} rocks near a rock");
    let people = mean_neighbours(&crowd(2000), step);
    assert!((1.0..3.0).contains(&people), "{people} people near one");
    let sensed = mean_neighbours(&sensors::<3>(2000), step);
    assert!((4.0..15.0).contains(&sensed), "{sensed} neighbours with sensors");
    let [dense, loose] = [1.0, 2.0]
        .map(|spacing| mean_neighbours(&solids::<3>(2000, SolidKind::all::<3>(), spacing), step));
    assert!((4.0..8.0).contains(&dense) && (0.4..1.0).contains(&loose), "solids: {dense}, {loose}");
    let scene = rain::<3>(2000);
    let solids = Scene { objects: scene.objects[1..].to_vec(), ..scene };
    let drops = mean_neighbours(&solids, step);
    assert!((0.02..1.0).contains(&drops), "{drops} drops near a drop");
}

#[test]
fn the_room_has_walls_and_areas() {
    let (plane, space) = (room::<2>(), room::<3>());
    assert_eq!((plane.scene.objects.len(), space.scene.objects.len()), (9, 11));
    for area in plane.areas {
        let center = plane.scene.placement(area.object, 0).translation;
        let expected = match area.name {
            "purple" => [-5.0, 5.0],
            "blue" => [5.0, 5.0],
            "green" => [5.0, -5.0],
            _ => [-5.0, -5.0],
        };
        assert_eq!(center, expected, "{}", area.name);
    }
    let is_plane = |n: &usize| matches!(space.scene.objects[*n].shape, SceneShape::Plane { .. });
    for n in (0..11).filter(is_plane) {
        let SceneShape::Plane { normal } = &space.scene.objects[n].shape else { unreachable!() };
        let at = space.scene.placement(n, 0).translation;
        let height: f64 = (0..3).map(|i| normal[i] * at[i]).sum();
        assert_eq!(height, -10.0, "plane {n} faces the middle of the room");
    }
}

/// Checks that a scene is equal when made again, that its translations are exact in `f32`, and that
/// motions stay within their bounds.
fn check_motion<const D: usize>(make: impl Fn() -> Scene<D>) {
    let (scene, again) = (make(), make());
    for step in [0, 1, 33, 99, 1_000_000] {
        for n in 0..scene.objects.len() {
            let placement = scene.placement(n, step);
            assert_eq!(placement, again.placement(n, step), "{}: pure", scene.name);
            for (i, &x) in placement.translation.iter().enumerate() {
                let wave = &scene.objects[n].motion.place[i];
                assert!((wave.low..=wave.high).contains(&x), "{}: bounded", scene.name);
                assert_eq!(x.to_bits() << 35, 0, "{}: {x} is an f32", scene.name);
            }
            let axis: f64 = placement.axis.iter().map(|x| x * x).sum();
            assert!((axis - 1.0).abs() < 1e-15, "{}: the axis is a unit vector", scene.name);
        }
    }
}

#[test]
fn motion_is_pure_and_bounded() {
    fn check<const D: usize>() {
        check_motion(|| pile::<D>(100));
        check_motion(|| sparse_drift::<D>(100));
        check_motion(|| few_moving::<D>(100));
        check_motion(|| mixed_sizes::<D>(100));
        check_motion(|| mixed_shapes::<D>(100));
        check_motion(|| spawn_and_despawn::<D>(100));
        check_motion(|| tower::<D>(100));
        check_motion(|| room::<D>().scene);
        check_motion(|| terrain_mesh::<D>(100));
        check_motion(|| terrain_field::<D>(100));
        check_motion(|| asteroids::<D>(100));
        check_motion(|| rain::<D>(100));
        check_motion(|| sensors::<D>(100));
        check_motion(|| vehicles_mesh::<D>(50));
        check_motion(|| vehicles_field::<D>(50));
        check_motion(|| trembling_vehicles_mesh::<D>(50));
        check_motion(|| trembling_vehicles_field::<D>(50));
        check_motion(|| aligned_pile::<D>(100));
        check_motion(|| turned_pile::<D>(100));
        check_motion(|| shaken(turned_pile::<D>(100), 0.001));
        check_motion(|| few_asteroids_moving::<D>(100));
        check_motion(|| ten_moving::<D>(100));
        check_motion(|| plates::<D>(20, 2.0));
        check_motion(|| solids::<D>(100, SolidKind::all::<D>(), 1.3));
        check_motion(|| solids_on_plain::<D>(20, SolidKind::Capsule));
    }
    check::<2>();
    check::<3>();
    check_motion(|| crowd(100));
}

//! Tests which normals a surface in 3D admits at edges and corners.

use impinge::math::{Real, Vector};
use impinge::shape::{CompositeShape, EdgeNeighbor, FeatureId, TriMesh};
use impinge_reference::random::Random;

use super::{corner_at, grid, mesh, points, soup, sphere, surface, unit, vector};

fn up<N: Real>() -> Vector<N, 3> {
    vector([0.0, 0.0, 1.0])
}

/// Iterates over all features of `parts` triangles: three vertices, three edges and two faces of
/// each.
fn features(parts: u32) -> impl Iterator<Item = (u32, FeatureId)> {
    let of_part = |part| {
        let sides = (0..3).flat_map(|at| [FeatureId::Vertex(at), FeatureId::Edge(at)]);
        sides.chain([FeatureId::Face(0), FeatureId::Face(1)]).map(move |feature| (part, feature))
    };
    (0..parts).flat_map(of_part)
}

/// Iterates over the parts of a floor that are not at its border.
fn middle(side: u32) -> impl Iterator<Item = u32> {
    let inner = 1..side - 1;
    let squares = inner.clone().flat_map(move |j| inner.clone().map(move |i| i + side * j));
    squares.flat_map(|square| [2 * square, 2 * square + 1])
}

fn check_flat<N: Real>(floor: &TriMesh<N, 3>, parts: &[u32]) {
    let whole = surface(floor);
    for (part, feature) in features(floor.num_parts()).filter(|(part, _)| parts.contains(part)) {
        assert!(whole.admits(part, feature, &up()), "{part} {feature:?}: up");
        assert_eq!(whole.admits(part, feature, &-up()), !floor.is_one_sided(), "down");
        for lean in
            [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [1.0, 0.0, 1.0], [0.0, 1e-3, 1.0], [-2.0, 1.0, -3.0]]
        {
            let normal = unit(lean);
            assert!(!whole.admits(part, feature, &normal), "{part} {feature:?}: {lean:?}");
            let own = if floor.is_one_sided() || lean[2] >= 0.0 { up() } else { -up::<N>() };
            assert_eq!(whole.snapped(part, &normal), Some(own), "{part} {feature:?}: {lean:?}");
        }
    }
}

#[test]
fn a_flat_floor_has_its_normal_only() {
    let parts: Vec<u32> = middle(4).collect();
    let (vertices, triangles) = grid(4, |x, y| [x, y, 0.0]);
    let floor = mesh::<f32, 3>(&vertices, &triangles);
    check_flat(&floor, &parts);
    check_flat(&soup(&floor), &parts);
    check_flat(&floor.clone().one_sided(), &parts);
    for (scale, away) in [(1e-18, 0.0), (1e17, 0.0), (1.0, 1e6)] {
        let (vertices, triangles) = grid(4, |x, y| [scale * x + away, scale * y - away, away]);
        check_flat(&mesh::<f64, 3>(&vertices, &triangles), &parts);
    }
    let (vertices, triangles) = grid(4, |x, y| [8.0 * x + 1e6, 8.0 * y - 1e6, -1e6]);
    check_flat(&mesh::<f32, 3>(&vertices, &triangles), &parts);
}

/// Tests a square with a vertex at the midpoint of a side, which a triangle without area connects
/// to the ends of the side. At the sides and corners along this filler no direction but the normal
/// of the floor is admitted.
#[test]
fn a_filler_without_area_is_no_seam() {
    let vertices = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, -2.0, 0.0],
        [0.0, -2.0, 0.0],
        [2.0, -2.0, 0.0],
    ];
    let filler = [0, 4, 1];
    let triangles = [[0, 1, 2], [0, 2, 3], filler, [0, 5, 4], [0, 6, 5], [4, 5, 7], [4, 7, 1]];
    let floor = mesh::<f64, 3>(&vertices, &triangles);
    let whole = surface(&floor);
    let middle = (3..7).filter(|part| floor.triangles()[*part as usize].contains(&4));
    let mut seams = vec![(0, FeatureId::Edge(0)), (3, FeatureId::Edge(2)), (6, FeatureId::Edge(2))];
    seams.extend(middle.map(|part| (part, corner_at(&floor, part, [1.0, 0.0, 0.0]))));
    assert_eq!(seams.len(), 6, "three sides and three corners");
    for (part, feature) in seams {
        assert!(whole.admits(part, feature, &up()), "{part} {feature:?}");
        for lean in [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]] {
            assert!(!whole.admits(part, feature, &unit(lean)), "{part} {feature:?} {lean:?}");
        }
    }
    assert_eq!(whole.snapped(2, &unit([0.0, 1.0, 1.0])), None, "the filler has no face");
}

/// Returns two squares that meet along the x axis; the square at negative y slopes down by
/// `degrees`.
fn roof<N: Real>(degrees: f64) -> TriMesh<N, 3> {
    let (sine, cosine) = degrees.to_radians().sine_cosine();
    let vertices = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -cosine, -sine],
        [1.0, -cosine, -sine],
    ];
    mesh(&vertices, &[[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 1]])
}

/// Returns the upward normal tilted by `degrees` toward negative y.
fn leaning<N: Real>(degrees: f64) -> Vector<N, 3> {
    let (sine, cosine) = degrees.to_radians().sine_cosine();
    vector([0.0, -sine, cosine])
}

#[test]
fn a_ridge_has_the_arc_between_its_faces() {
    let (roof, edges) = (roof::<f64>(40.0), [(0, FeatureId::Edge(0)), (3, FeatureId::Edge(2))]);
    for roof in [roof.clone(), roof.clone().one_sided(), soup(&roof)] {
        for (part, edge) in edges {
            let whole = surface(&roof);
            for degrees in [0.0, 1.0, 20.0, 39.0, 40.0] {
                assert!(whole.admits(part, edge, &leaning(degrees)), "{part}: {degrees}");
            }
            for degrees in [-90.0, -1.0, 41.0, 90.0, 180.0 + 20.0, 180.0 + 1.0] {
                assert!(!whole.admits(part, edge, &leaning(degrees)), "{part}: {degrees}");
            }
            let own = if part == 0 { 180.0 } else { 180.0 + 40.0 };
            let has_back = whole.admits(part, edge, &leaning(own));
            assert_eq!(has_back, !roof.is_one_sided(), "{part}: its own on the back");
        }
    }
}

#[test]
fn a_valley_has_only_the_normals_of_its_faces() {
    let valley = roof::<f64>(-40.0);
    let whole = surface(&valley);
    for degrees in [-90.0, -60.0, -20.0, -1.0, 1.0, 30.0] {
        for edge in [(0, FeatureId::Edge(0)), (3, FeatureId::Edge(2))] {
            assert!(!whole.admits(edge.0, edge.1, &leaning(degrees)), "{edge:?} {degrees}");
        }
    }
    assert!(whole.admits(0, FeatureId::Edge(0), &up()), "its own");
    assert!(whole.admits(3, FeatureId::Edge(2), &leaning(-40.0)), "its own");
    assert!(!whole.admits(0, FeatureId::Edge(0), &leaning(-40.0)), "only the neighbour's");
    assert!(whole.admits(0, FeatureId::Edge(0), &leaning(180.0 - 20.0)), "a ridge from below");
    let one_sided = valley.one_sided();
    let below = surface(&one_sided).admits(0, FeatureId::Edge(0), &leaning(180.0 - 20.0));
    assert!(!below, "nothing is below");
}

#[test]
fn the_tolerance_of_flatness_is_the_documented_angle() {
    for (degrees, is_flat) in [(0.56, true), (-0.56, true), (0.58, false)] {
        let bent = roof::<f32>(degrees);
        let between = surface(&bent).admits(0, FeatureId::Edge(0), &leaning(degrees / 2.0));
        assert_eq!(between, !is_flat, "{degrees}");
        assert!(surface(&bent).admits(0, FeatureId::Edge(0), &up()), "its own");
    }
}

#[test]
fn borders_have_what_points_out_of_the_face() {
    let roof = roof::<f64>(40.0);
    // Side 0 of triangle 1 is shared, side 1 is the border at y = 1.
    for degrees in [-179.0, -120.0, -90.0, -45.0, -1.0, 0.0] {
        assert!(surface(&roof).admits(1, FeatureId::Edge(1), &leaning(degrees)), "{degrees}");
    }
    assert!(!surface(&roof).admits(1, FeatureId::Edge(1), &leaning(1.0)), "over the face");
    let roof = roof.one_sided();
    assert!(surface(&roof).admits(1, FeatureId::Edge(1), &leaning(-89.0)), "a little up");
    assert!(!surface(&roof).admits(1, FeatureId::Edge(1), &leaning(-91.0)), "from below");
}

/// Returns a pyramid without a base, with its apex at the origin.
fn pyramid<N: Real>(depth: f64, sides: u32) -> TriMesh<N, 3> {
    let around = |i: u32| {
        let (sine, cosine) =
            (f64::from(i) * std::f64::consts::TAU / f64::from(sides)).sine_cosine();
        [cosine, sine, -depth]
    };
    let vertices: Vec<_> = std::iter::once([0.0; 3]).chain((0..sides).map(around)).collect();
    let triangles: Vec<_> = (0..sides).map(|i| [0, i + 1, (i + 1) % sides + 1]).collect();
    mesh(&vertices, &triangles)
}

#[test]
fn a_corner_has_the_cone_over_the_normals_around_it() {
    for (depth, sides) in [(0.2, 4), (1.0, 5), (30.0, 3)] {
        let (tip, pit) = (pyramid::<f64>(depth, sides), pyramid::<f64>(-depth, sides));
        let corner = FeatureId::Vertex(0);
        let [tip_front, pit_front] = [tip.clone(), pit.clone()].map(TriMesh::one_sided);
        for part in 0..sides {
            let admits = |mesh: &TriMesh<f64, 3>, normal: Vector<f64, 3>| {
                surface(mesh).admits(part, corner, &normal)
            };
            let own = tip.normal(part).expect("an area");
            for share in [0.0, 0.3, 0.9, 0.999, 1.0] {
                let inside = (up::<f64>() * (1.0 - share) + own * share).normalize();
                assert!(admits(&tip, inside) && admits(&tip_front, inside), "{depth}: {share}");
                assert!(admits(&pit, -pit_mirror(&inside)), "the back of a pit: {share}");
                let is_own = share == 1.0;
                assert!(!admits(&pit_front, -pit_mirror(&inside)), "{is_own}: no back");
                assert_eq!(admits(&tip, -inside), is_own, "inside a tip: {share}");
                assert!(!admits(&tip_front, -inside), "behind a tip: {share}");
            }
            let beyond = (own * 1.1 - up::<f64>() * 0.1).normalize();
            assert!(!admits(&tip, beyond), "{depth}: below the face");
        }
    }
}

/// Rotates a normal by half a turn about the axis of the pyramid. Negated, the result is a normal
/// of the back of the pit.
fn pit_mirror(v: &Vector<f64, 3>) -> Vector<f64, 3> {
    vector([-v.x, -v.y, v.z])
}

#[test]
fn edges_of_a_sphere_have_its_normals_and_no_others() {
    let mesh = soup(&sphere::<f32>(16)).one_sided();
    let normal = |part| mesh.normal(part).expect("an area");
    for (part, edge) in (0..mesh.num_parts()).flat_map(|part| (0..3).map(move |e| (part, e))) {
        let [a, b] = [edge, (edge + 1) % 3].map(|at| mesh.triangle(part).corners()[at as usize]);
        let outward = (a.coords + b.coords).normalize();
        let admits = |normal| surface(&mesh).admits(part, FeatureId::Edge(edge), &normal);
        let EdgeNeighbor::Triangle { index, is_flipped: false } = mesh.neighbor(part, edge) else {
            panic!("{part} has a neighbour at {edge}")
        };
        // An edge within a square, where its two triangles meet, is flat.
        let is_flat = normal(part).dot(&normal(index)) > 0.999_99;
        assert_eq!(admits(outward), !is_flat, "{part} {edge}: away from the middle");
        assert!(admits(normal(part)), "{part} {edge}: its own");
        assert!(!admits(-outward), "{part} {edge}: inwards");
        let corner = FeatureId::Vertex(edge);
        assert!(surface(&mesh).admits(part, corner, &a.coords.normalize()), "{part} {edge}");
        assert!(!surface(&mesh).admits(part, corner, &b.coords.normalize()), "{part} {edge}");
    }
}

/// Returns `true` if the vertex or edge is higher, along the normal, than all other corners of the
/// triangles that share it. `None` if the highest of these is within 1e-3 of it.
fn is_highest(mesh: &TriMesh<f64, 3>, ends: &[usize], normal: &Vector<f64, 3>) -> Option<bool> {
    let at = mesh.vertices()[ends[0]].coords.dot(normal);
    let around = mesh.triangles().iter().filter(|t| ends.iter().all(|&e| t.contains(&number(e))));
    let others = around.flatten().filter(|&&v| !ends.contains(&(v as usize)));
    let rises = others.map(|&v| mesh.vertices()[v as usize].coords.dot(normal) - at);
    let highest = rises.fold(f64::NEG_INFINITY, f64::max);
    (highest.abs() > 1e-3).then_some(highest < 0.0)
}

fn number(vertex: usize) -> u32 {
    u32::try_from(vertex).expect("few")
}

#[test]
fn rough_ground_against_looking_at_all_corners() {
    let mut random = Random::new(11);
    let (mut admitted, mut refused) = (0, 0);
    for _ in 0..4 {
        let (mut vertices, triangles) = grid(5, |x, y| [x, y, 0.0]);
        vertices.iter_mut().for_each(|v| v[2] = random.range(-1.5, 1.5));
        let ground = TriMesh::new(points::<f64, 3>(&vertices), triangles);
        for _ in 0..4000 {
            let part = random.below(ground.num_triangles());
            let corners = ground.triangles()[part].map(|v| v as usize);
            let at = random.below(3);
            let normal = vector::<f64, 3>(random.unit_vector());
            let ends = [corners[at], corners[(at + 1) % 3]];
            let side = ground.vertices()[ends[1]] - ground.vertices()[ends[0]];
            let across = normal - side * (side.dot(&normal) / side.norm_squared());
            let corner = FeatureId::Vertex(number(at));
            let cases = [
                (FeatureId::Edge(number(at)), across.normalize(), &ends[..]),
                (corner, normal, &ends[..1]),
            ];
            for (feature, normal, ends) in cases {
                let Some(expected) = is_highest(&ground, ends, &normal) else { continue };
                let found = surface(&ground).admits(number(part), feature, &normal);
                assert_eq!(found, expected, "{part} {feature:?} {normal:?}");
                *(if found { &mut admitted } else { &mut refused }) += 1;
            }
        }
    }
    assert!(admitted > 2000 && refused > 2000, "{admitted} and {refused}");
}

#[test]
fn fronts_are_seen_from_the_front() {
    let roof = roof::<f32>(40.0);
    let (above, below) = ([0.5, 0.5, 0.1], [0.5, 0.5, -0.1]);
    let faces = |mesh: &TriMesh<f32, 3>, at| surface(mesh).faces(0, &points(&[at])[0]);
    assert!(faces(&roof, above) && faces(&roof, below), "two sides");
    let roof = roof.one_sided();
    assert!(faces(&roof, above) && !faces(&roof, below), "one side");
    assert!(faces(&roof, [3.0, 3.0, 0.0]), "its plane counts as the front");
}

#[test]
fn internal_edges_may_be_kept() {
    let (vertices, triangles) = grid(4, |x, y| [x, y, 0.0]);
    let floor = mesh::<f32, 3>(&vertices, &triangles).with_internal_edges_kept();
    assert!(floor.surface().is_none(), "triangles on their own");
    let floor = floor.one_sided();
    let whole = surface(&floor);
    assert!(whole.admits(9, FeatureId::Edge(0), &unit([1.0, 0.0, 1.0])), "an edge like any");
    assert!(!whole.admits(9, FeatureId::Edge(0), &unit([1.0, 0.0, -1.0])), "from behind");
    assert!(!whole.faces(9, &vector([0.0, 0.0, -1.0]).into()), "still one side");
}

/// Tests the normals that are admitted at the edge where a wall stands on a floor, which three
/// triangles share.
#[test]
fn a_wall_on_a_floor() {
    let vertices =
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let wall = mesh::<f64, 3>(&vertices, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let admits = |part, normal| surface(&wall).admits(part, FeatureId::Edge(0), &unit(normal));
    assert!(!admits(0, [0.0, 1.0, 1.0]) && !admits(0, [0.0, -1.0, 1.0]), "hollow");
    assert!(!admits(0, [0.0, 0.1, -1.0]) && !admits(2, [0.0, -0.1, -1.0]), "flat below");
    assert!(admits(0, [0.0, 0.0, 1.0]) && admits(0, [0.0, 0.0, -1.0]), "its own");
    assert!(admits(2, [0.0, 0.0, -1.0]), "under the wall is the floor's own");
}

//! Tests the number of points in the manifolds of the corpus's boxes, and the area that the points
//! of two faces span, relative to the overlap of the faces. If there are more than four points, the
//! library keeps four.

use crate::support::query_support;
use crate::support::samples::samples;

use std::f64::consts::TAU;

use impinge::math::na::{Quaternion, Translation, UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::ContactManifold;
use impinge::shape::{
    CompositeShape, ConvexHull, Cuboid, HeightField, ShapeHandle, TriMesh, Triangle,
};
use impinge::world::{CollisionGroups, CollisionWorld};
use query_support::Placed;
use query_support::corpus::{placed2, placed3, regression, vector};
use query_support::random::Random;
use serde_json::Value;

/// Returns the manifolds of two boxes in a world to which they are added in the order of `names`.
fn manifolds<N, R, const D: usize>(
    case: &Value,
    place: fn(&Value, &Value) -> Option<Placed<N, R, D>>,
    names: [[&str; 2]; 2],
) -> Vec<ContactManifold<N, D>>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.01));
    let handles = names.map(|[shape, pose]| {
        let placed = place(&case[shape], &case[pose]).expect("a box");
        let half: Vector<N, D> = vector(&case[shape]["half_extents"]);
        let cuboid = ShapeHandle::new(Cuboid::new(half));
        let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
        world.add(placed.pose, cuboid, CollisionGroups::new(), contacts, ())
    });
    world.update();
    let mut found = Vec::new();
    let pair = world.contact_pair(handles[0], handles[1]);
    pair.expect("the boxes overlap").contacts(&mut found);
    found.into_iter().cloned().collect()
}

fn counts<N, R, const D: usize>(
    case: &Value,
    place: fn(&Value, &Value) -> Option<Placed<N, R, D>>,
) -> [usize; 2]
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let [one, two] = [["shape1", "pose1"], ["shape2", "pose2"]];
    [[one, two], [two, one]].map(|names| {
        let found = manifolds(case, place, names);
        found.iter().map(|manifold| manifold.contacts().len()).sum()
    })
}

#[test]
fn manifold_points_of_the_corpus() {
    let (mut checked, mut wrong) = (0, Vec::new());
    for case in regression() {
        let Some(given) = case["expected"]["manifold_points"].as_u64() else { continue };
        let expected = usize::try_from(given).expect("few").min(4);
        let found = if case["dim"] == 2 {
            [counts(&case, placed2::<f32>), counts(&case, placed2::<f64>)]
        } else {
            [counts(&case, placed3::<f32>), counts(&case, placed3::<f64>)]
        };
        if found != [[expected; 2]; 2] {
            wrong.push(format!("{}: {found:?} points, not {given}", case["id"]));
        }
        checked += 1;
    }
    assert_eq!(checked, 13, "all that say how many");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A convex polygon in the plane of contact, counter-clockwise.
type Outline = Vec<[f64; 2]>;

/// Returns twice the signed area of a triangle, positive if it is counter-clockwise.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn area(outline: &[[f64; 2]]) -> f64 {
    let first = outline.first().copied().unwrap_or_default();
    outline.windows(2).map(|side| turn(first, side[0], side[1])).sum::<f64>() / 2.0
}

/// Returns the intersection of two outlines (I. E. Sutherland and G. W. Hodgman, 1974). Consecutive
/// corners that coincide are merged; the last corner may still coincide with the first.
fn overlap(one: &[[f64; 2]], other: &[[f64; 2]]) -> Outline {
    let mut rest = one.to_vec();
    for (at, &from) in other.iter().enumerate() {
        let to = other[(at + 1) % other.len()];
        let mut inside = Outline::new();
        for (at, &a) in rest.iter().enumerate() {
            let b = rest[(at + 1) % rest.len()];
            let [here, there] = [turn(from, to, a), turn(from, to, b)];
            if here >= 0.0 {
                inside.push(a);
            }
            if here.min(there) < 0.0 && here.max(there) > 0.0 {
                let part = here / (here - there);
                inside.push([a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part]);
            }
        }
        rest = inside;
    }
    rest.dedup_by(|a, b| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9);
    rest
}

/// Returns the largest area of a quadrilateral with four corners of an outline; the area of the
/// outline if it has fewer. With `given`, the four must include that corner.
fn best_four(outline: &[[f64; 2]], given: Option<usize>) -> f64 {
    let count = outline.len();
    if count < 4 {
        return area(outline);
    }
    // Visits all choices of four indices in ascending order.
    let mut four = [0, 1, 2, 3];
    let mut best: f64 = 0.0;
    loop {
        if given.is_none_or(|given| four.contains(&given)) {
            best = best.max(area(&four.map(|at| outline[at])));
        }
        let Some(place) = (0..4).rev().find(|&place| four[place] < count - 4 + place) else {
            return best;
        };
        let first = four[place] + 1;
        for (number, at) in four[place..].iter_mut().enumerate() {
            *at = first + number;
        }
    }
}

/// Returns the area of the polygon whose corners are the points, given in any order.
fn spanned(mut points: Outline) -> f64 {
    let sum = points.iter().fold([0.0; 2], |sum, point| [sum[0] + point[0], sum[1] + point[1]]);
    let middle = sum.map(|x| x / points.len() as f64);
    points.sort_by(|a, b| {
        let [a, b] = [a, b].map(|point| (point[1] - middle[1]).atan2(point[0] - middle[0]));
        a.total_cmp(&b)
    });
    area(&points)
}

fn turned(outline: &[[f64; 2]], angle: f64, at: [f64; 2]) -> Outline {
    let (sine, cosine) = (angle.sin(), angle.cos());
    let place = |[x, y]: [f64; 2]| [at[0] + cosine * x - sine * y, at[1] + sine * x + cosine * y];
    outline.iter().map(|&corner| place(corner)).collect()
}

/// A solid that extends from `-0.5 scale` to `0.5 scale` in height, and the outline of its flat
/// ends seen from above, in coordinates x and z.
struct Flat<N: Space<3>> {
    shape: ShapeHandle<N, 3>,
    outline: Outline,
}

fn rectangle([x, z]: [f64; 2]) -> Outline {
    vec![[-x, -z], [x, -z], [x, z], [-x, z]]
}

fn cuboid<N: Space<3>>(random: &mut Random, scale: f64) -> Flat<N> {
    let half = [random.within(0.2, 1.5), random.within(0.2, 1.5)].map(|x| x * scale);
    let shape =
        Cuboid::new(Vector::<N, 3>::new(N::lit(half[0]), N::lit(0.5 * scale), N::lit(half[1])));
    Flat { shape: ShapeHandle::new(shape), outline: rectangle(half) }
}

/// Returns a random prism with 3 to 20 sides.
fn prism<N: Space<3>>(random: &mut Random, scale: f64) -> Flat<N> {
    let count = [3, 5, 6, 8, 12, 20][usize::try_from(random.bits() % 6).expect("few")];
    let radii = [random.within(0.4, 1.5), random.within(0.4, 1.5)].map(|x| x * scale);
    let angles = (0..count).map(|at| f64::from(at) * TAU / f64::from(count));
    let outline: Outline = angles.map(|a| [radii[0] * a.cos(), radii[1] * a.sin()]).collect();
    let ends = outline.iter().flat_map(|&[x, z]| [-0.5, 0.5].map(|y| [x, y * scale, z]));
    let points: Vec<_> = ends.map(|p| Point::from(Vector::<f64, 3>::from(p).map(N::lit))).collect();
    Flat { shape: ShapeHandle::new(ConvexHull::from_points(&points)), outline }
}

/// Returns a square of nine cells at the height `0.5 scale`, as a height field or a mesh.
fn floor<N: Space<3>>(random: &mut Random, scale: f64) -> Flat<N> {
    let side = 3.0 * scale;
    let outline = rectangle([0.5 * side; 2]);
    let heights = vec![N::HALF; 16];
    let extents = Vector::<N, 3>::new(N::lit(side), N::lit(scale), N::lit(side));
    let field = HeightField::<N, 3>::new(4, 4, heights, extents);
    if random.bits() & 1 == 0 {
        return Flat { shape: ShapeHandle::new(field), outline };
    }
    let part = |part: u32| field.part(part).solid.as_shape().as_shape::<Triangle<N, 3>>().copied();
    let corners = (0..field.num_parts()).filter_map(part).flat_map(|part| *part.corners());
    let points: Vec<_> = corners.collect();
    let count = u32::try_from(points.len()).expect("few");
    let triangles: Vec<[u32; 3]> =
        (0_u32..count / 3_u32).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
    Flat { shape: ShapeHandle::new(TriMesh::new(points, triangles)), outline }
}

type Make<N> = fn(&mut Random, f64) -> Flat<N>;

/// Two solids, one resting on the other. `overlap` is the overlap of their touching ends seen from
/// above; `deepest` is the index of its deepest corner, `None` if several are equally deep.
struct Rest<N: Space<3>> {
    solids: [(ShapeHandle<N, 3>, N::Isometry); 2],
    overlap: Outline,
    deepest: Option<usize>,
}

fn turn_about<N: Real>(axis: [f64; 3], angle: f64) -> UnitQuaternion<N> {
    let (sine, cosine) = ((0.5 * angle).sin(), (0.5 * angle).cos());
    let [x, y, z] = axis.map(|x| N::lit(x * sine));
    UnitQuaternion::new_unchecked(Quaternion::new(N::lit(cosine), x, y, z))
}

impl<N: Space<3, Isometry = Isometry<N, UnitQuaternion<N>, 3>>> Rest<N> {
    /// Draws a random pose that overlaps by `0.01 scale`; `None` if the ends overlap little, or if
    /// the lowest corner of the tilted solid lies beside the lower solid.
    fn draw(makes: [Make<N>; 2], tilt: f64, scale: f64, random: &mut Random) -> Option<Self> {
        let [low, high] = makes.map(|make| make(random, scale));
        let (at, angle) = ([0.0; 2].map(|_| 1.5 * scale * random.signed()), TAU * random.signed());
        let axis = TAU * random.signed();
        let (sine, cosine) = (axis.sin(), axis.cos());
        // The touching end is `0.5 scale` below the axis of the tilt, so the tilt shifts that end
        // sideways.
        let slide = 0.5 * scale * tilt.sin();
        let upper = turned(&high.outline, angle, [at[0] + slide * sine, at[1] - slide * cosine]);
        let overlap = overlap(&upper, &low.outline);
        // A rotation about (cosine, 0, sine) lowers the points on one side of this axis.
        let rise = |&[x, z]: &[f64; 2]| tilt.tan() * ((x - at[0]) * sine - (z - at[1]) * cosine);
        let lowest = |outline: &[[f64; 2]]| outline.iter().map(rise).fold(f64::INFINITY, f64::min);
        let [lowest, lowest_of_all] = [lowest(&overlap), lowest(&upper)];
        if overlap.len() < 3
            || area(&overlap) < 0.02 * scale * scale
            || lowest > lowest_of_all + 1e-9 * scale
        {
            return None;
        }
        let deepest = overlap.iter().position(|corner| rise(corner) <= lowest + 1e-9 * scale);
        let height = 0.5 * scale + 0.5 * scale * tilt.cos() - 0.01 * scale - lowest;
        let rotation = turn_about([cosine, 0.0, sine], tilt) * turn_about([0.0, 1.0, 0.0], -angle);
        let place = Vector::<N, 3>::new(N::lit(at[0]), N::lit(height), N::lit(at[1]));
        let pose = Isometry::from_parts(Translation::from(place), rotation);
        let solids = [(low.shape, Isometry::identity()), (high.shape, pose)];
        Some(Self { solids, overlap, deepest: deepest.filter(|_| tilt > 0.0) })
    }
}

/// Returns two lists with a fraction for each of `rests`: the area that its contact points span,
/// relative to the best area of four corners that include the deepest one, and relative to the best
/// area of any four corners.
fn shares<N: Space<3, Isometry = Isometry<N, UnitQuaternion<N>, 3>>>(
    rests: &[Rest<N>],
    scale: f64,
) -> [Vec<f64>; 2] {
    let mut world = CollisionWorld::<N, 3, usize>::new(N::lit(0.01 * scale));
    let contacts = GeometricQueryType::Contacts(N::lit(0.2 * scale), N::ZERO);
    for (at, rest) in rests.iter().enumerate() {
        let aside = [at % 32, at / 32].map(|at| N::lit(8.0 * scale * at as f64));
        let aside = Translation::from(Vector::<N, 3>::new(aside[0], N::ZERO, aside[1]));
        for (shape, pose) in &rest.solids {
            world.add(aside * *pose, shape.clone(), CollisionGroups::new(), contacts, at);
        }
    }
    world.update();
    let mut points = vec![Outline::new(); rests.len()];
    for (one, _, manifold) in world.contact_manifolds() {
        for tracked in manifold.contacts() {
            let point = tracked.contact.world1.coords;
            points[*one.data()].push([point.x.as_f64(), point.z.as_f64()]);
        }
    }
    let mut shares = [Vec::new(), Vec::new()];
    for (rest, points) in rests.iter().zip(points) {
        assert!((3..=4).contains(&points.len()), "{} points: {:?}", points.len(), rest.overlap);
        let spanned = spanned(points);
        shares[0].push(spanned / best_four(&rest.overlap, rest.deepest));
        shares[1].push(spanned / best_four(&rest.overlap, None));
    }
    shares
}

fn points_span_the_overlap<N: Space<3, Isometry = Isometry<N, UnitQuaternion<N>, 3>>>() {
    let pairs: [(&str, [Make<N>; 2], usize); 5] = [
        ("boxes", [cuboid, cuboid], 666),
        ("hulls", [prism, prism], 100),
        ("a hull on a box", [cuboid, prism], 100),
        ("a box on a surface", [floor, cuboid], 100),
        ("a hull on a surface", [floor, prism], 100),
    ];
    let random = &mut Random(7, false);
    for (what, makes, count) in pairs {
        for tilt in [0.0, 1e-3, 0.02] {
            for scale in [1.0, 1.0 / 1024.0, 1024.0] {
                let mut rests = Vec::new();
                while rests.len() < samples(count) / 10 {
                    rests.extend(Rest::<N>::draw(makes, tilt, scale, random));
                }
                let limit = if tilt > 0.0 { 0.6 } else { 0.9 };
                // So many fit into a world near its origin.
                for rests in rests.chunks(1024) {
                    let [with_deepest, of_all] = shares(rests, scale);
                    let least = |list: &[f64]| list.iter().fold(f64::INFINITY, |a, &b| a.min(b));
                    let (few, count) =
                        (with_deepest.iter().filter(|&&x| x < 0.9).count(), rests.len());
                    let least = [least(&with_deepest), least(&of_all)];
                    let case = format!("{what}, tilt {tilt}, scale {scale}");
                    assert_eq!(few, 0, "{case}: {few} of {count} below 90 %, {least:?}");
                    assert!(least[1] >= limit, "{case}: {least:?}");
                }
            }
        }
    }
}

/// Asserts that the points span at least 90 % of the area of the best four corners. If a single
/// corner is the deepest, only choices of four that include it count.
#[test]
fn four_points_span_the_overlap_of_two_faces() {
    points_span_the_overlap::<f32>();
    points_span_the_overlap::<f64>();
}

/// Asserts that in 2D the contact points are the two ends of the overlap interval of two sides.
#[test]
fn two_points_span_the_overlap_of_two_sides() {
    let random = &mut Random(8, false);
    for _ in 0..500 {
        let half = [random.within(0.2, 1.5), random.within(0.2, 1.5)];
        let at = 0.99 * random.signed() * (half[0] + half[1]);
        let ends = [(at - half[1]).max(-half[0]), (at + half[1]).min(half[0])];
        let mut world = CollisionWorld::<f64, 2, ()>::new(0.01);
        for (half, x, y) in [(half[0], 0.0, 0.0), (half[1], at, 0.99)] {
            let shape = ShapeHandle::new(Cuboid::new(Vector::<f64, 2>::new(half, 0.5)));
            let contacts = GeometricQueryType::Contacts(0.1, 0.0);
            let pose = Isometry::from_parts(
                Translation::from(Vector::<f64, 2>::new(x, y)),
                UnitComplex::identity(),
            );
            world.add(pose, shape, CollisionGroups::new(), contacts, ());
        }
        world.update();
        let (_, _, manifold) = world.contact_manifolds().next().expect("they overlap");
        let mut found: Vec<f64> =
            manifold.contacts().iter().map(|tracked| tracked.contact.world1.x).collect();
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2, "{ends:?}: {found:?}");
        let off = (found[0] - ends[0]).abs().max((found[1] - ends[1]).abs());
        assert!(off < 1e-12, "{ends:?}: {found:?}");
    }
}

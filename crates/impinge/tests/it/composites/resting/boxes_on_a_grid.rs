//! Boxes with parallel axes at exact distances, as solids, hulls and solid meshes or lines: apart,
//! touching, flush with each other, corner on corner and overlapping. The gap along each axis gives
//! the distance, the depth and the normal of every pair.

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{Proximity, contact, distance, proximity};
use impinge::shape::{ConvexHull, ConvexPolygon, Cuboid, Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

use crate::support::samples::stride;

/// The overlaps and gaps along an axis, beside the middle and a quarter beside it.
const SMALL: f64 = 1.0 / 64.0;

/// Two boxes with parallel axes; the second one lies at `offset`.
struct Boxes<const D: usize> {
    halves: [[f64; D]; 2],
    offset: [f64; D],
}

impl<const D: usize> Boxes<D> {
    /// Returns the gap along each axis; negative for an overlap.
    fn gaps(&self) -> [f64; D] {
        let [half1, half2] = self.halves;
        std::array::from_fn(|axis| self.offset[axis].abs() - half1[axis] - half2[axis])
    }

    /// Returns the largest gap: minus the depth of boxes that overlap.
    fn gap(&self) -> f64 {
        self.gaps().into_iter().fold(f64::MIN, f64::max)
    }
}

/// Calls `visit` with each pair of boxes; the halves are multiples of a quarter.
fn each_pair<const D: usize>(mut visit: impl FnMut(&Boxes<D>)) {
    let sizes: [[f64; 3]; 4] =
        [[1.0, 1.0, 1.0], [0.5, 0.5, 0.5], [1.0, 0.5, 1.5], [0.25, 1.0, 0.5]];
    let halves = sizes.map(|size| std::array::from_fn(|axis| size[axis]));
    let choices = 7_usize.pow(u32::try_from(D).expect("few axes"));
    let pairs = halves.iter().flat_map(|one| halves.iter().map(move |other| [*one, *other]));
    for (number, (halves, choice)) in
        pairs.flat_map(|halves| (0..choices).map(move |choice| (halves, choice))).enumerate()
    {
        if number % stride(23) != 0 {
            continue;
        }
        let offset = std::array::from_fn(|axis| {
            let sum: f64 = halves[0][axis] + halves[1][axis];
            let flush = halves[0][axis] - halves[1][axis];
            let place = choice / 7_usize.pow(u32::try_from(axis).expect("few axes")) % 7;
            [0.0, 0.25, flush, sum - SMALL, sum, -sum, sum + SMALL][place]
        });
        visit(&Boxes { halves, offset });
    }
}

/// Returns the depth of the deepest contact in a world, with its normal.
fn deepest_in_world<N: Space<D>, R, const D: usize>(
    shapes: [&ShapeHandle<N, D>; 2],
    poses: [&Isometry<N, R, D>; 2],
) -> Option<(N, Vector<N, D>)>
where
    R: AbstractRotation<N, D> + Copy,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let query = GeometricQueryType::Contacts(N::lit(SMALL / 4.0), N::ZERO);
    let (mut world, groups) = (CollisionWorld::new(N::lit(0.02)), CollisionGroups::new());
    for (shape, pose) in shapes.into_iter().zip(poses) {
        world.add((*pose).into(), shape.clone(), groups, query, ());
    }
    world.update();
    let contacts = world.contact_manifolds().flat_map(|(_, _, manifold)| {
        manifold.contacts().iter().map(|tracked| tracked.contact).collect::<Vec<_>>()
    });
    let all = contacts.map(|contact| (contact.depth, contact.normal.into_inner()));
    all.reduce(|best, next| if next.0 > best.0 { next } else { best })
}

/// Asserts the distance, the contact and the contacts in a world of two boxes.
fn check<N: Space<D>, R, const D: usize>(
    boxes: &Boxes<D>,
    shapes: [&ShapeHandle<N, D>; 2],
    are_convex: bool,
) where
    R: AbstractRotation<N, D> + Copy + std::fmt::Debug,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let [shape1, shape2] = shapes;
    let at = Vector::<N, D>::from(boxes.offset.map(N::lit));
    let (m1, m2) =
        (Isometry::<N, R, D>::identity(), Isometry::from_parts(at.into(), R::identity()));
    let name = || format!("{:?} at {:?}: {shape1:?} and {shape2:?}", boxes.halves, boxes.offset);
    let noise = N::lit(64.0) * N::EPSILON;
    let apart = boxes.gaps().map(|gap| gap.max(0.0));
    let expected = apart.iter().map(|gap| gap * gap).sum::<f64>().sqrt();
    let (gap, found) = (boxes.gap(), distance(&m1, &**shape1, &m2, &**shape2));
    assert!((found - N::lit(expected)).abs() <= noise, "distance {found} of {}", name());
    assert_eq!(found == N::ZERO, gap <= 0.0, "distance {found} of {}", name());
    let near = proximity(&m1, &**shape1, &m2, &**shape2, N::ZERO);
    assert_eq!(near == Proximity::Intersecting, gap <= 0.0, "{near:?} of {}", name());
    let touch = contact(&m1, &**shape1, &m2, &**shape2, N::ZERO);
    let touch = touch.map(|touch| (touch.depth, touch.normal.into_inner()));
    assert_eq!(touch.is_some(), gap <= 0.0, "contact of {}", name());
    let in_world = deepest_in_world(shapes, [&m1, &m2]);
    if gap <= 0.0 {
        assert!(in_world.is_some(), "no contact in a world of {}", name());
    }
    // A solid mesh that is deep in another may have contacts with faces farther away.
    if gap < -SMALL && !are_convex {
        return;
    }
    for (depth, normal) in [touch, in_world].into_iter().flatten() {
        if gap <= 0.0 {
            assert!((depth + N::lit(gap)).abs() <= noise, "{depth} deep: {}", name());
        }
        // The normal is along an axis with the largest gap, away from the first box.
        let gaps = boxes.gaps();
        let is_along = |axis: usize| {
            let sign = N::lit(if boxes.offset[axis] < 0.0 { -1.0 } else { 1.0 });
            gaps[axis] == gap && (normal[axis] * sign > N::lit(0.999) || boxes.offset[axis] == 0.0)
        };
        if gap < 0.0 {
            assert!((0..D).any(is_along), "{normal:?} for {}", name());
        }
    }
}

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let shapes = |half: [f64; 2]| {
        let [x, y] = half.map(N::lit);
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(Point::<N, 2>::from);
        [
            ShapeHandle::new(Cuboid::new(Vector::<N, 2>::new(x, y))),
            ShapeHandle::new(ConvexPolygon::new(&corners)),
            ShapeHandle::new(Polyline::closed(corners.to_vec()).solid()),
        ]
    };
    each_pair::<2>(|boxes| each_kind(boxes, boxes.halves.map(shapes)));
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let shapes = |half: [f64; 3]| {
        let cuboid = Cuboid::new(Vector::<N, 3>::from(half.map(N::lit)));
        let surface = impinge::procedural::space::cuboid(&cuboid);
        [
            ShapeHandle::new(cuboid),
            ShapeHandle::new(ConvexHull::from_points(&surface.vertices)),
            ShapeHandle::new(TriMesh::new(surface.vertices, surface.triangles).solid()),
        ]
    };
    each_pair::<3>(|boxes| each_kind(boxes, boxes.halves.map(shapes)));
}

/// Checks each pair of the forms of two boxes: a box, a hull, and a solid mesh or line.
fn each_kind<N, R, const D: usize>(boxes: &Boxes<D>, shapes: [[ShapeHandle<N, D>; 3]; 2])
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy + std::fmt::Debug,
{
    for (first, one) in shapes[0].iter().enumerate() {
        for (second, other) in shapes[1].iter().enumerate() {
            check::<N, R, D>(boxes, [one, other], first < 2 && second < 2);
        }
    }
}

#[test]
fn boxes_in_the_plane() {
    in_plane::<f64>();
    in_plane::<f32>();
}

#[test]
fn boxes_in_space() {
    in_space::<f64>();
    in_space::<f32>();
}

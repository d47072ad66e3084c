//! Random positions, shapes and groups with numbers on a grid, for the world and for the reference.

use impinge::math::na::{
    Complex, Isometry2, Isometry3, Quaternion, Translation2, Translation3, UnitComplex,
    UnitQuaternion,
};
use impinge::math::{Point, Real};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::procedural::space as surfaces;
use impinge::shape::{
    Ball, Capsule, ConvexHull, Cuboid, Diagonals, HeightField, Polyline, ShapeHandle, Tetrahedron,
    TriMesh,
};
use impinge::world::Registry;
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge::{dim2, dim3};
use impinge_reference::geometry::{Pose, Solid};
use impinge_reference::random::Random;
use impinge_reference::world::{Groups, QueryType};

use crate::support::shape_table::{self, Shapes};
use crate::support::world_stage::{Stage, half_space, vector};

/// Objects lie within this distance of the origin, except for a few far away.
const ROOM: u32 = 3;

/// A scalar and dimension with rotations that do not round.
pub(crate) trait Grid<const D: usize>: Stage<D> {
    /// Returns a pose with a random rotation that permutes the axes, for the world and for the
    /// reference.
    fn posed(coordinates: [f64; D], random: &mut Random) -> (Self::Isometry, Pose<D>);

    /// Registers a filter that refuses pairs whose indices add up to a multiple of `number`.
    fn register(world: &mut CollisionWorld<Self, D, u64>, name: &str, number: usize);

    /// Adds to a registry the name of the filter that [`Self::register`] registers.
    fn name(registry: Registry<Self, D, u64>, name: &str, number: usize) -> Registry<Self, D, u64>;

    /// Returns shapes of all kinds, a few times `size` large.
    fn all_shapes(size: f64) -> Shapes<Self, D>;
}

/// A filter that accepts pairs whose sum of indices is not a multiple of the number.
struct NotMultipleOf(usize);

impl NotMultipleOf {
    fn allows(&self, first: CollisionObjectHandle, second: CollisionObjectHandle) -> bool {
        assert!(first < second, "in order");
        !(first.uid() + second.uid()).is_multiple_of(self.0)
    }
}

impl<N: Real> dim2::world::BroadPhasePairFilter<N, u64> for NotMultipleOf {
    fn is_pair_valid(
        &self,
        co1: &dim2::world::CollisionObject<N, u64>,
        co2: &dim2::world::CollisionObject<N, u64>,
    ) -> bool {
        self.allows(co1.handle(), co2.handle())
    }
}

impl<N: Real> dim3::world::BroadPhasePairFilter<N, u64> for NotMultipleOf {
    fn is_pair_valid(
        &self,
        co1: &dim3::world::CollisionObject<N, u64>,
        co2: &dim3::world::CollisionObject<N, u64>,
    ) -> bool {
        self.allows(co1.handle(), co2.handle())
    }
}

impl<N: Real> Grid<2> for N {
    fn posed(coordinates: [f64; 2], random: &mut Random) -> (Isometry2<N>, Pose<2>) {
        let turn = *random.pick(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]);
        let [x, y, re, im] = [coordinates[0], coordinates[1], turn[0], turn[1]].map(N::lit);
        let rotation = UnitComplex::new_unchecked(Complex::new(re, im));
        let isometry = Isometry2::from_parts(Translation2::new(x, y), rotation);
        (isometry, Pose::from_complex(coordinates, turn))
    }

    fn register(world: &mut CollisionWorld<N, 2, u64>, name: &str, number: usize) {
        world.register_broad_phase_pair_filter(name, NotMultipleOf(number));
    }

    fn name(registry: Registry<N, 2, u64>, name: &str, number: usize) -> Registry<N, 2, u64> {
        registry.with_filter(name, NotMultipleOf(number))
    }

    fn all_shapes(size: f64) -> Shapes<N, 2> {
        let mut shapes = shape_table::plane(N::lit(size));
        let corner = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x * size), N::lit(y * size));
        let square =
            vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let line = Polyline::closed(square);
        shapes.push(("one-sided line", ShapeHandle::new(line.clone().one_sided())));
        shapes.push(("kept edges", ShapeHandle::new(line.clone().with_internal_edges_kept())));
        shapes.push(("solid line", ShapeHandle::new(line.solid())));
        shapes
    }
}

impl<N: Real> Grid<3> for N {
    fn posed(coordinates: [f64; 3], random: &mut Random) -> (Isometry3<N>, Pose<3>) {
        let mut sign = || if random.chance(0.5) { 0.5 } else { -0.5 };
        let third = [sign(), sign(), sign(), 0.5];
        let halves = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
        let turn = if random.chance(0.5) { third } else { *random.pick(&halves) };
        let [i, j, k, w] = turn.map(N::lit);
        let [x, y, z] = coordinates.map(N::lit);
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        let isometry = Isometry3::from_parts(Translation3::new(x, y, z), rotation);
        (isometry, Pose::from_quaternion(coordinates, turn))
    }

    fn register(world: &mut CollisionWorld<N, 3, u64>, name: &str, number: usize) {
        world.register_broad_phase_pair_filter(name, NotMultipleOf(number));
    }

    fn name(registry: Registry<N, 3, u64>, name: &str, number: usize) -> Registry<N, 3, u64> {
        registry.with_filter(name, NotMultipleOf(number))
    }

    fn all_shapes(size: f64) -> Shapes<N, 3> {
        let mut shapes = shape_table::space(N::lit(size));
        let corner = |at: [f64; 3]| Point::from(vector(at.map(|x| x * size)));
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.25, 0.0, 1.0]];
        let tetrahedron = Tetrahedron::<N>::new(corners.map(corner));
        shapes.push(("tetrahedron", ShapeHandle::new(tetrahedron)));
        let surface = surfaces::cuboid(&Cuboid::new(vector([size; 3])));
        let mesh = TriMesh::new(surface.vertices, surface.triangles);
        shapes.push(("one-sided mesh", ShapeHandle::new(mesh.clone().one_sided())));
        shapes.push(("kept edges", ShapeHandle::new(mesh.clone().with_internal_edges_kept())));
        let (own, ghosts) = mesh.triangles().split_at(8);
        let open = TriMesh::new(mesh.vertices().to_vec(), own.to_vec()).with_ghosts(ghosts);
        shapes.push(("mesh with ghosts", ShapeHandle::new(open)));
        shapes.push(("solid mesh", ShapeHandle::new(mesh.solid())));
        let heights = (0..20_u8).map(|n| N::lit(0.1 * f64::from(n * 7 % 5))).collect();
        let field = HeightField::<N, 3>::new(4, 5, heights, vector([2.0 * size, size, size]));
        shapes.push(("ghost border", ShapeHandle::new(field.clone().with_ghost_border())));
        let field = field.with_diagonals(Diagonals::Zigzag).with_holes(|row, _| row == 1);
        shapes.push(("zigzag field", ShapeHandle::new(field.one_sided())));
        let random = &mut Random::new(7);
        let mut point = |_| corner([0; 3].map(|_: u8| random.range(-1.0, 1.0)));
        let points: Vec<_> = (0..40).map(&mut point).collect();
        shapes.push(("random hull", ShapeHandle::new(ConvexHull::from_points(&points))));
        shapes
    }
}

/// Returns a random pose in the room, sometimes far outside.
pub(crate) fn pose<N: Grid<D>, const D: usize>(random: &mut Random) -> (N::Isometry, Pose<D>) {
    let room = if random.chance(0.05) { 40 } else { ROOM };
    N::posed(std::array::from_fn(|_| random.grid(room, 3)), random)
}

/// Returns a random pose up to half a unit from `from` along each axis, on the grid of 1/8.
pub(crate) fn pose_near<N: Grid<D>, const D: usize>(
    from: &Pose<D>,
    random: &mut Random,
) -> (N::Isometry, Pose<D>) {
    let moved = std::array::from_fn(|axis| from.translation[axis] + random.grid(1, 3) * 0.5);
    N::posed(moved.map(|x| (x * 8.0).round() / 8.0), random)
}

/// Returns a random size, sometimes zero.
fn size(random: &mut Random) -> f64 {
    if random.chance(0.1) { 0.0 } else { 0.125 * (1 + random.below(8)) as f64 }
}

pub(crate) fn shape<N: Grid<D>, const D: usize>(
    random: &mut Random,
) -> (ShapeHandle<N, D>, Solid<D>) {
    match random.below(20) {
        0..7 => {
            let radius = size(random);
            (ShapeHandle::new(Ball::new(N::lit(radius))), Solid::ball(radius))
        }
        7..14 => {
            let half: [f64; D] = std::array::from_fn(|_| size(random));
            (ShapeHandle::new(Cuboid::new(vector(half))), Solid::cuboid(half))
        }
        14..19 => {
            let (half_height, radius) = (size(random), size(random));
            let mut end = [0.0; D];
            end[1] = half_height;
            let solid = Solid::capsule(end.map(|x| -x), end, radius);
            (ShapeHandle::new(Capsule::new(N::lit(half_height), N::lit(radius))), solid)
        }
        _ => {
            let (axis, sign) = (random.below(D), *random.pick(&[1.0, -1.0]));
            let mut normal = [0.0; D];
            normal[axis] = sign;
            (half_space(axis, sign), Solid::half_space(normal))
        }
    }
}

/// Returns random groups with which most objects interact with most other objects.
pub(crate) fn groups(random: &mut Random) -> (CollisionGroups, Groups) {
    let mut groups = CollisionGroups::new();
    if random.chance(0.5) {
        return (groups, Groups::new());
    }
    let mut list = |most: f64| (0..4).filter(|_| random.chance(most)).collect::<Vec<usize>>();
    let (membership, whitelist, blacklist) = (list(0.6), list(0.7), list(0.1));
    groups.set_membership(&membership);
    groups.set_whitelist(&whitelist);
    groups.set_blacklist(&blacklist);
    let numbers = |list: &[usize]| {
        list.iter().map(|&group| u32::try_from(group).expect("small")).collect::<Vec<u32>>()
    };
    let mask = (numbers(&membership), numbers(&whitelist), numbers(&blacklist));
    (groups, Groups::of(&mask.0, &mask.1, &mask.2))
}

pub(crate) fn query_type<N: Real>(random: &mut Random) -> (GeometricQueryType<N>, QueryType) {
    let limit = *random.pick(&[0.0, 0.0, 0.125, 0.25, 0.5]);
    if random.chance(0.6) {
        let angular = if random.chance(0.5) { N::ZERO } else { N::lit(0.09) };
        (GeometricQueryType::Contacts(N::lit(limit), angular), QueryType::Contacts(limit))
    } else {
        (GeometricQueryType::Proximity(N::lit(limit)), QueryType::Proximity(limit))
    }
}

/// Returns a random point on the grid, in the room.
pub(crate) fn point<const D: usize>(random: &mut Random) -> [f64; D] {
    std::array::from_fn(|_| random.grid(ROOM, 3))
}

/// Returns a random direction that is not aligned with an axis.
pub(crate) fn direction<const D: usize>(random: &mut Random) -> [f64; D] {
    std::array::from_fn(|_| random.single(-1.0, 1.0))
}

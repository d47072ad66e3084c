//! Signed distance of two placed solids.

use super::features::Features;
use super::point::PointMeter;
use super::polytope;
use super::pose::Pose;
use super::solid::Solid;
use super::sphere_search::{TOLERANCE, maximise};
use super::vector::{negate, norm, perpendicular, sub};

/// The result of [`signed_distance`]: a bracket of the true value, and a normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<const D: usize> {
    /// A lower bound of the signed distance: the separation along `normal`.
    pub lower: f64,
    /// An upper bound of the signed distance.
    pub upper: f64,
    /// The unit normal in the world frame, from the first solid to the second. If several normals
    /// give the same distance, one of them; [`separation_along`] measures any other normal. `None`
    /// only for half-spaces that overlap without bound.
    pub normal: Option<[f64; D]>,
}

impl<const D: usize> Reference<D> {
    fn exact(distance: f64, normal: [f64; D]) -> Self {
        Self { lower: distance, upper: distance, normal: Some(normal) }
    }

    /// Returns the length by which `distance` lies outside of `[lower, upper]`; zero within this
    /// interval.
    #[must_use]
    pub fn error_of(&self, distance: f64) -> f64 {
        (self.lower - distance).max(distance - self.upper).max(0.0)
    }
}

/// Computes the signed distance of two solids: positive if they are disjoint, otherwise minus the
/// length of the shortest translation that separates their interiors.
///
/// - Rounded solids (balls, capsules, polytopes, …), half-spaces, and a ball against anything:
///   exact up to about 1e-15 times the size of the solids, with `lower == upper`.
/// - A cylinder or cone against any other solid: a proven bracket. `upper - lower` is at most about
///   1e-11 times the size of the pair (the bounding radii plus the distance of the origins). If
///   many directions are nearly equally good, as for coaxial solids that interpenetrate, it is up
///   to about 1e-4 of the size, typically 1e-6. Longer searches of such pairs showed that `lower`
///   was within 1e-7 of the true value. Such a pair takes tens of milliseconds, any other pair
///   about 0.1 ms.
/// - Two half-spaces: infinite overlap (`-inf`) unless they are antiparallel to within 1e-12.
///
/// The solids are measured relative to the origin of the first, so that a large distance from the
/// world origin costs no accuracy.
///
/// # Panics
/// For a cylinder or cone in 2D.
#[must_use]
pub fn signed_distance<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
) -> Reference<D> {
    use Solid::{HalfSpace, Rounded};
    let near1 = Pose { rotation: pose1.rotation, translation: [0.0; D] };
    let near2 = pose2.moved(&negate(&pose1.translation));
    match (solid1, solid2) {
        (HalfSpace { normal }, _) => along(solid1, &near1, solid2, &near2, &near1.rotate(normal)),
        (_, HalfSpace { normal }) => {
            along(solid1, &near1, solid2, &near2, &negate(&near2.rotate(normal)))
        }
        (
            Rounded { vertices: vertices1, radius: radius1 },
            Rounded { vertices: vertices2, radius: radius2 },
        ) => {
            let features1 = Features::new(vertices1).placed(&near1);
            let features2 = Features::new(vertices2).placed(&near2);
            let (distance, normal) = polytope::distance(&features1, &features2);
            Reference::exact(distance - radius1 - radius2, normal)
        }
        (Rounded { vertices, radius }, _) if vertices.len() == 1 => {
            let (distance, normal) = from_point(solid2, &near2, &near1.apply(&vertices[0]));
            Reference::exact(distance - radius, negate(&normal))
        }
        (_, Rounded { vertices, radius }) if vertices.len() == 1 => {
            let (distance, normal) = from_point(solid1, &near1, &near2.apply(&vertices[0]));
            Reference::exact(distance - radius, normal)
        }
        _ => curved(solid1, &near1, solid2, &near2),
    }
}

/// Returns the least of `normal · b` over the second solid minus the greatest of `normal · a` over
/// the first, in the world frame. For every unit normal this is a lower bound of the signed
/// distance, and for the best normal it is equal to it.
///
/// A library that returns distance `d` and normal `n` loses `d - separation_along(n)` by its
/// normal. The result is minus infinity if the first solid is a half-space and `normal` differs
/// from its outward normal by more than 1e-12. For the second solid the same limit holds for
/// `-normal`.
#[must_use]
pub fn separation_along<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
    normal: &[f64; D],
) -> f64 {
    let near1 = Pose { rotation: pose1.rotation, translation: [0.0; D] };
    let near2 = pose2.moved(&negate(&pose1.translation));
    -solid2.extent(&near2, &negate(normal)) - solid1.extent(&near1, normal)
}

/// Returns the separation along `normal`, the world normal of a half-space, which leads from the
/// first solid to the second. In all other directions the separation is minus infinity. The normal
/// of the result is `None` if the distance is infinite.
fn along<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
    normal: &[f64; D],
) -> Reference<D> {
    let distance = separation_along(solid1, pose1, solid2, pose2, normal);
    let normal = distance.is_finite().then_some(*normal);
    Reference { lower: distance, upper: distance, normal }
}

/// Returns the signed distance of a world point from a solid, and the unit direction of
/// [`PointMeter::measure`] in the world frame.
fn from_point<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    point: &[f64; D],
) -> (f64, [f64; D]) {
    let (distance, normal) = PointMeter::new(solid).measure(&pose.inverse_apply(point));
    (distance, pose.rotate(&normal))
}

/// Computes the signed distance by a search over the sphere of directions, in 3D. Neither solid may
/// be a half-space. [`signed_distance`] needs it for a cylinder or cone; tests also call it for
/// polytopes.
fn curved<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
) -> Reference<D> {
    assert_eq!(D, 3, "cylinders and cones exist in space only");
    let support = |solid: &Solid<D>, pose: &Pose<D>, direction: &[f64; D]| {
        pose.apply(&solid.core_support(&pose.inverse_rotate(direction)))
    };
    let lowest = |normal: &[f64; 3]| {
        let normal: [f64; D] = convert(normal);
        let point2 = support(solid2, pose2, &negate(&normal));
        convert(&sub(&point2, &support(solid1, pose1, &normal)))
    };
    let between = sub(&pose2.translation, &pose1.translation);
    let size = solid1.bounding_radius() + solid2.bounding_radius() + norm(&between);
    let mut seeds: Vec<[f64; 3]> = vec![convert(&between)];
    let (normals1, lines1) = guesses(solid1, pose1);
    let (normals2, lines2) = guesses(solid2, pose2);
    seeds.extend(normals1.iter().chain(&normals2).map(convert));
    for line1 in &lines1 {
        seeds.extend(lines2.iter().map(|line2| convert(&perpendicular(&[*line1, *line2]))));
    }
    let found = maximise(&lowest, &seeds, size, TOLERANCE);
    let rounding = solid1.radius() + solid2.radius();
    Reference {
        lower: found.lower - rounding,
        upper: found.upper - rounding,
        normal: Some(convert(&found.normal)),
    }
}

/// Returns face normals and edge directions in the world frame, as start values of the search. The
/// axis of a cylinder or cone counts as both.
fn guesses<const D: usize>(solid: &Solid<D>, pose: &Pose<D>) -> (Vec<[f64; D]>, Vec<[f64; D]>) {
    match solid {
        Solid::Rounded { vertices, .. } => {
            let features = Features::new(vertices).placed(pose);
            (features.normals, features.directions)
        }
        _ => {
            let axis = pose.rotate(&super::vector::axis(1));
            (vec![axis], vec![axis])
        }
    }
}

/// Converts a vector between two array types that both have length three. The compiler does not
/// know that `D` is 3 here.
fn convert<const FROM: usize, const TO: usize>(v: &[f64; FROM]) -> [f64; TO] {
    std::array::from_fn(|i| v[i])
}

#[cfg(test)]
mod tests {
    use super::super::vector::{add, scale, unit};
    use super::*;
    use crate::random::Random;

    fn exact<const D: usize>(
        one: &Solid<D>,
        at1: [f64; D],
        two: &Solid<D>,
        at2: [f64; D],
    ) -> (f64, [f64; D]) {
        let found = signed_distance(one, &Pose::at(at1), two, &Pose::at(at2));
        assert_eq!(found.lower, found.upper, "this pair is exact");
        (found.lower, found.normal.expect("bounded"))
    }

    #[test]
    fn boxes_face_edge_and_corner() {
        let (one, two) = (Solid::cuboid([1.0, 1.0, 1.0]), Solid::cuboid([2.0, 2.0, 2.0]));
        let far = [1e9, -1e9, 1e9];
        let answer = |offset: [f64; 3]| exact(&one, far, &two, add(&far, &offset));
        assert_eq!(answer([5.0, 1.0, 0.0]), (2.0, [1.0, 0.0, 0.0]));
        assert_eq!(answer([6.0, 7.0, 0.0]), (5.0, [0.6, 0.8, 0.0]));
        let (distance, normal) = answer([4.0, 5.0, 5.0]);
        assert!((distance - 3.0).abs() < 1e-14, "1, 2 and 2 make 3: {distance}");
        assert!(norm(&sub(&normal, &[1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0])) < 1e-15, "{normal:?}");
        assert_eq!(answer([0.0, 0.0, -2.5]), (-0.5, [0.0, 0.0, -1.0]));
        assert_eq!(answer([0.25, 0.5, 0.0]), (-2.5, [0.0, 1.0, 0.0]));
        assert_eq!(answer([3.0, 0.0, 0.0]).0, 0.0);
    }

    #[test]
    fn edge_across_edge() {
        // Two cubes, rotated by 45 degrees about x and about y, so that an edge of one crosses an
        // edge of the other at a right angle.
        let cube = Solid::cuboid([1.0, 1.0, 1.0]);
        let (s, c) = (std::f64::consts::FRAC_PI_8.sin(), std::f64::consts::FRAC_PI_8.cos());
        let about_x = Pose::from_quaternion([0.0; 3], [s, 0.0, 0.0, c]);
        let about_y = Pose::from_quaternion([0.0, 0.0, 3.0], [0.0, s, 0.0, c]);
        let found = signed_distance(&cube, &about_x, &cube, &about_y);
        assert!((found.lower - (3.0 - 2.0 * 2f64.sqrt())).abs() < 1e-15, "{found:?}");
        let deeper = about_y.moved(&[0.0, 0.0, -0.5]);
        let found = signed_distance(&cube, &about_x, &cube, &deeper);
        assert!((found.lower - (2.5 - 2.0 * 2f64.sqrt())).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn crossing_capsules() {
        let lying = Solid::capsule([-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], 0.5);
        let deep = Solid::capsule([0.0, -2.0, 0.0], [0.0, 2.0, 0.0], 0.25);
        // The axes first cross at a distance of 0.3, then intersect, and then lie on one line.
        assert_eq!(exact(&lying, [0.0; 3], &deep, [0.0, 0.0, 0.3]), (0.3 - 0.75, [0.0, 0.0, 1.0]));
        assert_eq!(exact(&lying, [0.0; 3], &deep, [0.0; 3]).0, -0.75);
        let (depth, normal) = exact(&lying, [0.0; 3], &lying, [1.0, 0.0, 0.0]);
        assert_eq!((depth, normal[0]), (-1.0, 0.0));
        assert_eq!(exact(&lying, [0.0; 3], &lying, [8.0, 0.0, 0.0]), (1.0, [1.0, 0.0, 0.0]));
    }

    #[test]
    fn crossing_axes_in_the_plane_have_depth() {
        // In 2D the Minkowski difference of two crossing segments is a solid parallelogram.
        let lying = Solid::capsule([-3.0, 0.0], [3.0, 0.0], 0.5);
        let standing = Solid::capsule([0.0, -2.0], [0.0, 2.0], 0.25);
        assert_eq!(exact(&lying, [0.0; 2], &standing, [0.0, 0.5]), (-1.5 - 0.75, [0.0, 1.0]));
    }

    #[test]
    fn ball_centre_on_a_corner() {
        let (ball, cuboid) = (Solid::ball(1.0), Solid::cuboid([1.0, 1.0]));
        let (depth, normal) = exact(&ball, [1.0, 1.0], &cuboid, [0.0, 0.0]);
        assert_eq!(depth, -1.0);
        assert!(normal[0] <= 0.0 && normal[1] <= 0.0, "from the ball to the box: {normal:?}");
        let poses = (Pose::at([1.0, 1.0]), Pose::at([0.0, 0.0]));
        let outside = separation_along(&ball, &poses.0, &cuboid, &poses.1, &[1.0, 0.0]);
        assert_eq!(outside, -3.0, "out of the wrong side of the box");
    }

    #[test]
    fn flat_in_one_plane_touches() {
        let triangle = Solid::triangle([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]);
        let (depth, normal) = exact(&triangle, [0.0; 3], &triangle, [1.0, 1.0, 0.0]);
        assert_eq!((depth, normal[2].abs()), (0.0, 1.0));
        let (distance, normal) = exact(&triangle, [0.0; 3], &triangle, [7.0, 0.0, 0.0]);
        assert_eq!((distance, normal), (3.0, [1.0, 0.0, 0.0]));
        let point = Solid::ball(0.0);
        assert_eq!(exact(&point, [1.0; 3], &point, [1.0; 3]).0, 0.0);
    }

    #[test]
    fn half_spaces() {
        let (up, down) = (Solid::half_space([0.0, 1.0]), Solid::half_space([0.0, -1.0]));
        assert_eq!(exact(&up, [0.0; 2], &down, [7.0, 2.0]), (2.0, [0.0, 1.0]));
        assert_eq!(exact(&up, [0.0; 2], &down, [7.0, -2.0]), (-2.0, [0.0, 1.0]));
        let tilted = Solid::half_space([1.0, 1.0]);
        let found = signed_distance(&up, &Pose::identity(), &tilted, &Pose::identity());
        assert_eq!((found.lower, found.normal), (f64::NEG_INFINITY, None));
        assert_eq!(exact(&up, [0.0; 2], &Solid::ball(0.5), [3.0, 2.0]), (1.5, [0.0, 1.0]));
        assert_eq!(exact(&Solid::ball(0.5), [3.0, 2.0], &up, [0.0; 2]), (1.5, [0.0, -1.0]));
    }

    fn certified(one: &Solid<3>, two: &Solid<3>, offset: [f64; 3], expected: f64) {
        let found = signed_distance(one, &Pose::identity(), two, &Pose::at(offset));
        assert!(found.error_of(expected) < 1e-14, "{found:?}, not {expected}");
        assert!((found.lower - expected).abs() < 1e-9, "{found:?}, not {expected}");
        assert!(found.upper - found.lower < 1e-4, "{found:?} is wide");
    }

    #[test]
    fn curved_by_hand() {
        let cylinder = Solid::Cylinder { half_height: 2.0, radius: 1.0 };
        let cone = Solid::Cone { half_height: 2.0, radius: 3.0 };
        certified(&cylinder, &cylinder, [0.0, 5.0, 0.0], 1.0);
        certified(&cylinder, &cylinder, [3.0, 1.0, 4.0], 3.0);
        certified(&cylinder, &cylinder, [0.9, 3.0, 1.2], -0.5);
        certified(&cylinder, &cylinder, [0.0, 0.25, 0.0], -2.0);
        certified(&cylinder, &cylinder, [5.0, 8.0, 0.0], 5.0);
        // The apex of the cone is 0.25 below the bottom face of the box.
        certified(&cone, &Solid::cuboid([0.5, 0.5, 0.5]), [0.0, 2.75, 0.0], 0.25);
        certified(&cone, &cylinder, [0.0, 3.5, 0.0], -0.5);
        certified(
            &cone,
            &Solid::capsule([0.0, -9.0, 0.0], [0.0, 9.0, 0.0], 0.5),
            [4.0, 0.0, 0.0],
            0.5,
        );
    }

    /// Asserts that the search over the sphere agrees with the enumeration of features for random
    /// hulls. The search uses the features only as start directions.
    #[test]
    fn search_agrees_with_enumeration() {
        let mut random = Random::new(7);
        let mut hits = 0;
        for _ in 0..60 {
            let mut hull = || -> Vec<[f64; 3]> {
                (0..8).map(|_| std::array::from_fn(|_| random.range(-1.0, 1.0))).collect()
            };
            let (points1, points2) = (hull(), hull());
            let offset = scale(&random.unit_vector::<3>(), random.range(0.0, 2.5));
            let (one, two) = (Solid::polytope(points1), Solid::polytope(points2));
            let (pose1, pose2) = (Pose::identity(), Pose::at(offset));
            let exact = signed_distance(&one, &pose1, &two, &pose2);
            let searched = curved(&one, &pose1, &two, &pose2);
            assert!(searched.error_of(exact.lower) < 1e-14, "{exact:?} {searched:?}");
            assert!(searched.upper - searched.lower < 1e-10, "{exact:?} {searched:?}");
            hits += u32::from(exact.lower < 0.0);
        }
        assert!((15..=45).contains(&hits), "hits {hits}");
    }

    /// Asserts that the search over the sphere agrees with the enumeration of features for needles,
    /// plates, flat boxes, nearly parallel edges, and contact up to rounding.
    #[test]
    fn search_agrees_on_degenerate_boxes() {
        let mut random = Random::new(13);
        let extents = [0.0, 1e-6, 1e-3, 1.0, 1.0];
        let mut hits = 0;
        for _ in 0..100 {
            let mut cuboid = || Solid::cuboid(std::array::from_fn(|_| *random.pick(&extents)));
            let (one, two) = (cuboid(), cuboid());
            let tilt = random.magnitude(1e-9, 30);
            let axis = random.vector::<3>(tilt);
            let pose1 = Pose::from_quaternion([0.0; 3], [axis[0], axis[1], axis[2], 1.0]);
            let pose2 = Pose::at(std::array::from_fn(|_| random.grid(1, 1)));
            let exact = signed_distance(&one, &pose1, &two, &pose2);
            let searched = curved(&one, &pose1, &two, &pose2);
            assert!(searched.error_of(exact.lower) < 1e-14, "{exact:?} {searched:?}");
            hits += u32::from(exact.lower <= 0.0);
        }
        assert!((20..=80).contains(&hits), "hits {hits}");
    }

    /// Asserts that no random direction has a separation above the upper bound. The directions lie
    /// near the returned normal and everywhere else.
    #[test]
    fn random_directions_never_beat_the_answer() {
        let mut random = Random::new(11);
        let cone = Solid::Cone { half_height: 0.7, radius: 1.1 };
        let cylinder = Solid::Cylinder { half_height: 1.0, radius: 0.4 };
        for _ in 0..20 {
            let pose1 = random.pose::<3>(1.0);
            let pose2 = random.pose::<3>(1.0);
            let found = signed_distance(&cone, &pose1, &cylinder, &pose2);
            let normal = found.normal.expect("bounded");
            let along = separation_along(&cone, &pose1, &cylinder, &pose2, &normal);
            assert!((along - found.lower).abs() < 1e-14, "{found:?} {along}");
            for _ in 0..300 {
                let nearby =
                    add(&normal, &scale(&random.unit_vector(), random.magnitude(1e-4, 16)));
                let nearby = unit(&nearby).expect("not zero");
                let other = separation_along(&cone, &pose1, &cylinder, &pose2, &nearby);
                assert!(other <= found.upper, "{other} along {nearby:?} beats {found:?}");
            }
        }
    }
}

//! Tests that compare predicted contacts with the contacts of a new query.

use super::ContactKinematic;
use crate::collide::manifold::tests::scene::{
    Random, Scene, describe, fact, for_all_pairs, manifold, request,
};
use crate::collide::{Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Isometry3, Point, Pose, Real, Unit, Vector};
use crate::query::Placement;
use crate::query::manifold::materialise;
use crate::shape::{Ball, Capsule, Cuboid, Cylinder, FeatureId, Plane, Segment, Shape};

fn reproduces<N: Scene<D>, const D: usize>(accuracy: f64) {
    let mut checked = 0;
    for_all_pairs::<N, D>(40, 1.0, |pair| {
        let (_, raw) = manifold(pair, &request(0.05, 0.05));
        for point in &raw.points {
            let kinematic = ContactKinematic::new(pair, &raw.normal, point);
            let found = kinematic.predicted(&pair.pose12);
            let error = (found.point1 - point.point1).norm()
                + (found.distance - point.distance).abs()
                + (found.normal - raw.normal).norm();
            assert!(
                error <= N::lit(accuracy),
                "{error}: {} {point:?} {found:?} {kinematic:?}",
                describe(pair)
            );
            let pose21 = pair.pose12.inverse();
            let back = kinematic.flipped().predicted(&pose21).flipped(&pose21);
            let error = (back.point1 - found.point1).norm() + (back.normal - found.normal).norm();
            assert!(error <= N::lit(accuracy), "flipped: {error} {}", describe(pair));
            checked += 1;
        }
    });
    assert!(checked > 300, "{checked} contacts");
}

#[test]
fn unmoved_solids_give_the_contact_itself() {
    reproduces::<f32, 2>(5e-4);
    reproduces::<f64, 2>(1e-12);
    reproduces::<f32, 3>(5e-4);
    reproduces::<f64, 3>(1e-12);
}

/// Two solids, the pose of the second in the frame of the first, and the features whose contact is
/// followed.
struct Case<'a, const D: usize> {
    solids: [&'a dyn Shape<f64, D>; 2],
    pose12: Pose<f64, D>,
    followed: [FeatureId; 2],
    /// The weight of position errors, relative to errors of distance and normal.
    position_weight: f64,
}

impl<const D: usize> Case<'_, D>
where
    f64: Scene<D>,
{
    fn pair(&self, pose12: Pose<f64, D>) -> Pair<'_, f64, D> {
        Pair { first: self.solids[0].geometry().0, second: self.solids[1].geometry().0, pose12 }
    }

    fn followed(&self, raw: &RawManifold<f64, D>) -> usize {
        let is_it =
            |p: &crate::collide::RawPoint<f64, D>| [p.feature1, p.feature2] == self.followed;
        raw.points
            .iter()
            .position(is_it)
            .unwrap_or_else(|| panic!("{:?} in {raw:?}", self.followed))
    }

    /// Returns the error of the prediction after a motion of size `step`.
    fn error(&self, kinematic: &ContactKinematic<f64, D>, motion: &Motion<D>, step: f64) -> f64 {
        let turn = motion.turn.map(|angle| angle * step);
        let moved = f64::pose(motion.shift * step, turn).compose(&self.pose12);
        let (_, raw) = manifold(&self.pair(moved), &request(0.1, 0.0));
        let (predicted, point) = (kinematic.predicted(&moved), &raw.points[self.followed(&raw)]);
        (predicted.point1 - point.point1).norm() * self.position_weight
            + (predicted.distance - point.distance).abs()
            + (predicted.normal - raw.normal).norm()
    }

    /// Checks that halving small motions divides the error by at least three, until only rounding
    /// is left.
    fn check(&self) {
        let pair = self.pair(self.pose12);
        let (_, raw) = manifold(&pair, &request(0.1, 0.0));
        let point = &raw.points[self.followed(&raw)];
        let kinematic = ContactKinematic::new(&pair, &raw.normal, point);
        for seed in 0..20 {
            let mut random = Random(seed);
            let motion = Motion { shift: random.vector(0.3), turn: random.turn().map(|x| 0.1 * x) };
            let errors = [0.02, 0.01, 0.005].map(|step| self.error(&kinematic, &motion, step));
            let is_small = |a: f64, b: f64| b * 3.0 <= a || b < 1e-9;
            let fine = is_small(errors[0], errors[1]) && is_small(errors[1], errors[2]);
            assert!(fine, "{:?}: {errors:?} {kinematic:?}", self.followed);
        }
    }
}

struct Motion<const D: usize> {
    shift: Vector<f64, D>,
    turn: [f64; 3],
}

fn at(x: f64, y: f64, z: f64, turn: [f64; 3]) -> Pose<f64, 3> {
    f64::pose(Vector::<f64, 3>::new(x, y, z), turn)
}

/// Returns the features of the first contact for which `is_it` is true.
fn first_features<const D: usize>(
    solids: [&dyn Shape<f64, D>; 2],
    pose12: Pose<f64, D>,
    is_it: impl Fn(FeatureId, FeatureId) -> bool,
) -> [FeatureId; 2]
where
    f64: Scene<D>,
{
    let pair = Pair { first: solids[0].geometry().0, second: solids[1].geometry().0, pose12 };
    let (_, raw) = manifold(&pair, &request(0.1, 0.0));
    let found = raw.points.iter().find(|p| is_it(p.feature1, p.feature2));
    found.map_or_else(|| panic!("no such contact: {raw:?}"), |p| [p.feature1, p.feature2])
}

/// Checks the prediction of the first contact whose features satisfy `is_it`.
fn follow<const D: usize>(
    solids: [&dyn Shape<f64, D>; 2],
    pose12: Pose<f64, D>,
    is_it: impl Fn(FeatureId, FeatureId) -> bool,
) where
    f64: Scene<D>,
{
    let followed = first_features(solids, pose12, is_it);
    Case { solids, pose12, followed, position_weight: 1.0 }.check();
}

#[test]
fn corners_and_faces() {
    use FeatureId::{Face, Vertex};
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let square = Cuboid::new(Vector::<f64, 2>::new(0.5, 0.5));
    let (low, high) = (at(0.1, 0.95, 0.1, [0.3, 0.2, 0.25]), at(0.4, 1.05, 0.3, [0.01, 0.3, 0.02]));
    for pose12 in [at(0.1, 1.3, 0.1, [0.6, 0.2, 0.6]), high, low] {
        follow([&cuboid, &cuboid], pose12, |a, b| matches!((a, b), (Face(_), Vertex(_))));
    }
    follow([&cuboid, &cuboid], high, |a, b| matches!((a, b), (Vertex(_), Face(_))));
    let pose12 = f64::pose(Vector::<f64, 2>::new(0.2, 1.0), [0.0, 0.0, 0.1]);
    follow([&square, &square], pose12, |a, b| matches!((a, b), (Face(_), Vertex(_))));
    follow([&square, &square], pose12, |a, b| matches!((a, b), (Vertex(_), Face(_))));
    let plane = Plane::new(Unit::new_normalize(Vector::<f64, 3>::new(0.0, 1.0, 0.0)));
    let below = at(0.0, -0.55, 0.0, [0.05, 0.0, 0.05]);
    follow([&cuboid, &plane], below, |a, b| matches!((a, b), (Vertex(_), Face(_))));
}

#[test]
fn crossing_edges() {
    use FeatureId::Edge;
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let (roof, flat) =
        ([std::f64::consts::FRAC_PI_4, 0.0, 0.0], at(0.3, 1.02, 0.2, [0.01, 0.7, 0.02]));
    let first = at(0.0, 0.0, 0.0, [0.0, 0.0, std::f64::consts::FRAC_PI_4]);
    for height in [1.35, 1.45] {
        let crossed = Pose::relative(&first, &at(0.1, height, 0.05, roof));
        follow([&cuboid, &cuboid], crossed, |a, b| matches!((a, b), (Edge(_), Edge(_))));
    }
    follow([&cuboid, &cuboid], flat, |a, b| matches!((a, b), (Edge(_), Edge(_))));
}

#[test]
fn balls() {
    use FeatureId::{Edge, Face, Vertex};
    let ball = Ball::new(0.5_f64);
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let capsule = Capsule::<f64, 3>::new(0.5, 0.25);
    let turn = [0.1, 0.2, 0.3];
    follow([&ball, &cuboid], at(0.1, 0.98, 0.1, [0.0; 3]), |_, b| matches!(b, Face(_)));
    follow([&ball, &cuboid], at(0.75, 0.75, 0.75, [0.0; 3]), |_, b| matches!(b, Vertex(_)));
    follow([&ball, &cuboid], at(0.83, 0.85, 0.1, [0.0; 3]), |_, b| matches!(b, Edge(_)));
    follow([&ball, &capsule], at(0.7, 0.1, 0.0, turn), |_, b| matches!(b, Edge(_)));
    follow([&ball, &capsule], at(0.1, -1.2, 0.0, turn), |_, b| matches!(b, Vertex(_)));
    for distance in [0.9, 1.0, 1.05] {
        follow::<3>([&ball, &ball], at(0.6 * distance, 0.8 * distance, 0.0, turn), |_, _| true);
        let pose12 = f64::pose(Vector::<f64, 2>::new(0.6 * distance, 0.8 * distance), turn);
        follow::<2>([&ball, &ball], pose12, |_, _| true);
    }
}

#[test]
fn capsules_segments_and_cylinders() {
    use FeatureId::{Edge, Face, Vertex};
    let capsule = Capsule::<f64, 3>::new(0.5, 0.25);
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let segment =
        Segment::new(Point::<f64, 3>::new(-1.0, 0.0, 0.0), Point::<f64, 3>::new(1.0, 0.1, 0.0));
    let crossing = at(0.1, 0.05, 0.27, [0.0, 0.0, 1.0]);
    follow([&capsule, &capsule], at(0.1, 0.05, 0.52, [0.0, 0.1, 1.0]), |a, b| {
        matches!((a, b), (Edge(_), Edge(_)))
    });
    follow([&segment, &capsule], crossing, |a, b| matches!((a, b), (Edge(_), Edge(_))));
    // The box edge along y is in front of the capsule, which is tilted across it.
    let corner = at(0.9, 0.0, 0.0, [0.0, std::f64::consts::FRAC_PI_4, 0.0]);
    let tilted = at(0.0, 0.0, 0.0, [0.7, 0.0, 0.0]);
    follow([&capsule, &cuboid], Pose::relative(&tilted, &corner), |a, b| {
        matches!((a, b), (Edge(_), Edge(_)))
    });
    let lying = at(0.0, 0.74, 0.0, [0.0, 0.0, std::f64::consts::FRAC_PI_2]);
    let floor = Cuboid::new(Vector::<f64, 3>::new(2.0, 0.5, 2.0));
    let below = Pose::relative(&lying, &at(0.2, 0.0, 0.2, [0.0; 3]));
    follow([&capsule, &floor], below, |a, b| matches!((a, b), (Vertex(_), Face(_))));
    let cylinder = Cylinder::new(0.3_f64, 0.25);
    // The rim is round, so the position on it has an error of first order.
    let (solids, pose12) = ([&floor as &dyn Shape<f64, 3>, &cylinder], below.inverse());
    let followed = first_features(solids, pose12, |a, _| matches!(a, Face(_)));
    assert!(matches!(followed[1], Edge(_)), "a rim: {followed:?}");
    Case { solids, pose12, followed, position_weight: 0.0 }.check();
}

/// After a common motion of both solids, the contact has moved with them.
#[test]
fn common_motion_carries_the_contact_along() {
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let m1 =
        Isometry3::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0), Vector::<f64, 3>::new(0.3, 0.1, 0.2));
    let m2 = m1 * Isometry3::translation(0.3, 0.98, 0.2);
    let common =
        Isometry3::new(Vector::<f64, 3>::new(-5.0, 1.0, 0.5), Vector::<f64, 3>::new(1.0, 0.5, 2.0));
    let (pose1, pose2) = (Pose::from_isometry(&m1), Pose::from_isometry(&m2));
    let pose12 = Pose::relative(&pose1, &pose2);
    let pair = Pair { first: cuboid.geometry().0, second: cuboid.geometry().0, pose12 };
    let (_, raw) = manifold(&pair, &request(0.0, 0.0));
    let placed = Placement { pose1: &pose1, pair: 7, is_swapped: false };
    let straight = materialise(&pair, &raw, &placed, crate::query::ContactManifold::default());
    let swapped =
        materialise(&pair, &raw, &Placement { is_swapped: true, ..placed }, straight.clone());
    assert_eq!((straight.len(), swapped.len()), (4, 4), "{straight:?}");
    for (tracked, other) in straight.contacts().iter().zip(swapped.contacts()) {
        let moved = tracked.kinematic.contact(&(common * m1), &(common * m2));
        let error = (moved.world1 - common * tracked.contact.world1).norm();
        assert!(error < 1e-12, "carried along: {error}");
        assert!((moved.depth - tracked.contact.depth).abs() < 1e-12, "as deep as before");
        assert_eq!(other.contact, tracked.contact.flipped(), "swapped");
        assert_eq!(other.id, tracked.id, "one contact, one id");
        let back = other.kinematic.contact(&(common * m2), &(common * m1)).flipped();
        assert!((back.world1 - moved.world1).norm() < 1e-12, "swapped and moved");
        assert_eq!(other.kinematic.feature1(), tracked.kinematic.feature2(), "swapped features");
    }
    let deepest = straight.deepest_contact().expect("four contacts").contact.depth;
    assert!((deepest - 0.02).abs() < 1e-12, "{deepest}");
    assert_eq!(straight.contacts()[straight.deepest_contact_id()].contact.depth, deepest, "same");
}

/// If two points coincide, their connection has no direction: the old normal moves with the solids.
#[test]
fn a_vanishing_connection_keeps_the_normal() {
    let ball = Ball::new(0.0_f64);
    let pose12 = at(0.0, 0.25, 0.0, [0.0; 3]);
    let pair =
        Pair { first: Shape::<f64, 3>::geometry(&ball).0, second: ball.geometry().0, pose12 };
    let separation: Separation<f64, 3> = fact(&pair);
    let (_, raw) = manifold(&pair, &request(0.5, 0.0));
    let kinematic = ContactKinematic::new(&pair, &raw.normal, &raw.points[0]);
    let met = kinematic.predicted(&at(0.0, 0.0, 0.0, [0.0; 3]));
    assert_eq!(met.normal, separation.normal, "the old one");
    assert_eq!(met.distance.as_f64(), 0.0, "they touch");
}

//! Explains why two objects touch or do not.

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Real, Space, Unit, Vector, max, min};
use impinge::narrow_phase::{ContactPair, GeometricQueryType};
use impinge::query::{
    ClosestPoints, Contact, ContactPoint, Proximity, closest_points, contact, distance, proximity,
};
use impinge::world::{CollisionObject, CollisionWorld};

use crate::answer::{ManifoldPoint, PairAnswer, ShownContact, ShownManifold, Test, Why};
use crate::ask::feature_text;
use crate::groups::{self, Named};
use crate::space::{coordinates, isometry};

/// Two objects of a world, in the order of the request.
#[derive(Debug)]
pub(crate) struct Two<'a, N: Space<D>, const D: usize, T> {
    pub(crate) world: &'a CollisionWorld<N, D, T>,
    pub(crate) one: &'a CollisionObject<N, D, T>,
    pub(crate) two: &'a CollisionObject<N, D, T>,
    /// The names of the pair filters that stand-ins replace, since they are code of the recorded
    /// program. A stand-in accepts all pairs.
    pub(crate) stand_ins: &'a [String],
}

/// The query type of a pair in a world, and the distance up to which it has a result.
#[derive(Clone, Copy, Debug)]
enum Limit<N> {
    /// The pair has contacts up to this distance: the sum of the predictions and skins of both
    /// objects.
    Prediction(N),
    /// The pair has the proximity `WithinMargin` up to this distance: the sum of the margins of its
    /// proximity queries.
    Margin(N),
}

impl<N: Real> Limit<N> {
    /// Returns the limit of a pair; `skins` is the sum of both skins. If at least one object has a
    /// proximity query, the pair has a proximity, and predictions and skins are ignored.
    fn of(one: GeometricQueryType<N>, two: GeometricQueryType<N>, skins: N) -> Self {
        use GeometricQueryType::{Contacts, Proximity};
        match (one, two) {
            (Contacts(first, _), Contacts(second, _)) => Self::Prediction(first + second + skins),
            (Proximity(first), Proximity(second)) => Self::Margin(first + second),
            (Proximity(margin), Contacts(..)) | (Contacts(..), Proximity(margin)) => {
                Self::Margin(margin)
            }
        }
    }

    const fn length(self) -> N {
        match self {
            Self::Prediction(length) | Self::Margin(length) => length,
        }
    }
}

/// The geometry of two objects at their current positions, which may differ from their positions at
/// the last update.
struct Measures<N: Real, const D: usize> {
    distance: N,
    points: ClosestPoints<N, D>,
    contact: Option<Contact<N, D>>,
    proximity: Proximity,
}

/// Returns a proximity as a word.
pub(crate) const fn proximity_text(proximity: Proximity) -> &'static str {
    match proximity {
        Proximity::Intersecting => "intersecting",
        Proximity::WithinMargin => "within margin",
        Proximity::Disjoint => "disjoint",
    }
}

impl<N: Space<D>, const D: usize, T> Two<'_, N, D, T> {
    /// Returns the description of the pair. Costs four queries on the two shapes.
    pub(crate) fn answer(&self) -> PairAnswer {
        let skin = |object: &CollisionObject<N, D, T>| self.world.skin(object.handle());
        let skins = skin(self.one).zip(skin(self.two)).map_or(N::ZERO, |(one, two)| one + two);
        let limit = Limit::of(self.one.query_type(), self.two.query_type(), skins);
        let measures = self.measures(limit.length());
        let points = match measures.points {
            ClosestPoints::WithinMargin(point1, point2) => {
                Some([point1, point2].map(|point| coordinates(&point.coords)))
            }
            _ => None,
        };
        PairAnswer {
            a: self.one.handle().uid(),
            b: self.two.handle().uid(),
            distance: measures.distance.as_f64(),
            points,
            contact: measures.contact.as_ref().map(shown_contact),
            proximity: proximity_text(measures.proximity),
            manifolds: self.manifolds(),
            why: self.why(limit, &measures),
        }
    }

    fn measures(&self, limit: N) -> Measures<N, D> {
        let [pose1, pose2] =
            [self.one, self.two].map(|object| isometry(&N::pose(object.position())));
        let (shape1, shape2) = (&**self.one.shape(), &**self.two.shape());
        Measures {
            distance: distance(&pose1, shape1, &pose2, shape2),
            points: closest_points(&pose1, shape1, &pose2, shape2, N::INFINITY),
            contact: contact(&pose1, shape1, &pose2, shape2, limit),
            proximity: proximity(&pose1, shape1, &pose2, shape2, limit),
        }
    }

    /// Returns the manifolds of the pair, as of the last update. The world orders the objects of a
    /// pair by their handles; if the request has the other order, the points are flipped.
    fn manifolds(&self) -> Vec<ShownManifold> {
        let (one, two) = (self.one.handle(), self.two.handle());
        let views = self.world.contact_pair(one, two).into_iter().flat_map(ContactPair::views);
        let point = |point: ContactPoint<N, D>| {
            self.manifold_point(&if two < one { point.flipped() } else { point })
        };
        views.map(|view| ShownManifold { contacts: view.contacts().map(point).collect() }).collect()
    }

    fn manifold_point(&self, point: &ContactPoint<N, D>) -> ManifoldPoint {
        let [feature1, feature2] = [
            feature_text(point.feature1, point.part1, &**self.one.shape()),
            feature_text(point.feature2, point.part2, &**self.two.shape()),
        ];
        let contact = shown_contact(&point.contact);
        ManifoldPoint { contact, features: format!("{feature1}, {feature2}") }
    }

    /// Explains why the two objects touch or do not touch, as of the last update. All conditions
    /// but the boxes are tested with the current state of the world. So they may contradict the
    /// update if the world has changed since. They may also contradict it for a one-sided surface,
    /// since no condition tests the side.
    fn why(&self, limit: Limit<N>, measures: &Measures<N, D>) -> Why {
        let tests =
            vec![self.groups(), self.filters(), self.boxes(), distance_test(limit, measures)];
        let (touch, found) = self.found();
        let refusal = tests.iter().find(|test| !test.passes);
        let text = match (touch, refusal) {
            (true, None) => format!("They touch: {found}."),
            (true, Some(test)) => {
                format!("They touched at the last update; since then: {}.", test.text)
            }
            (false, Some(test)) => format!("They do not touch: {}.", test.text),
            (false, None) => format!("They do not touch: {found}."),
        };
        Why { touch, text, tests }
    }

    /// Returns whether the pair touches as of the last update, and a phrase that describes its
    /// contacts or its proximity. A pair touches if it intersects or has contacts, predicted ones
    /// included.
    fn found(&self) -> (bool, String) {
        let (one, two) = (self.one.handle(), self.two.handle());
        if let Some(pair) = self.world.proximity_pair(one, two) {
            let proximity = pair.proximity();
            let text = format!("the last update found them {}", proximity_text(proximity));
            return (proximity == Proximity::Intersecting, text);
        }
        let Some(pair) = self.world.contact_pair(one, two) else {
            return (false, "the last update found no pair of them".to_owned());
        };
        // A pair exists while the fat AABBs overlap, with or without manifolds.
        let depth = pair.views().map(|view| view.deepest_contact().contact.depth).reduce(max);
        match depth {
            Some(depth) => {
                let (count, deepest) = (pair.num_contacts(), short(depth.as_f64()));
                let points = if count == 1 { "contact point" } else { "contact points" };
                (true, format!("{count} {points}, the deepest of depth {deepest}"))
            }
            None => (
                false,
                "the last update found no contact; surfaces have none from behind".to_owned(),
            ),
        }
    }

    /// Tests whether the groups of both objects allow the pair. Two fixed objects fail the test,
    /// whatever their groups are.
    fn groups(&self) -> Test {
        if self.one.is_fixed() && self.two.is_fixed() {
            let text =
                "both are fixed, and fixed objects have no pairs among each other".to_owned();
            return Test { name: "groups", passes: false, text };
        }
        let [one, two] = [self.one, self.two].map(|object| Named {
            object: object.handle().uid(),
            groups: object.collision_groups(),
        });
        let passes = one.groups.can_interact_with_groups(two.groups);
        Test { name: "groups", passes, text: groups::text(one, two) }
    }

    /// Tests whether all pair filters of the world accept the pair. The text mentions stand-ins,
    /// which accept all pairs.
    fn filters(&self) -> Test {
        let refusing = self.world.refusing_pair_filters(self.one.handle(), self.two.handle());
        let names: Vec<&str> = self.world.broad_phase_pair_filter_names().collect();
        let mut text = match (names.as_slice(), refusing.as_slice()) {
            ([], _) => "no filter is registered".to_owned(),
            ([name], []) => format!("the filter {name} allows the pair"),
            (names, []) => format!("the filters {} allow the pair", names.join(", ")),
            (_, [name]) => format!("the filter {name} refuses the pair"),
            (_, names) => format!("the filters {} refuse the pair", names.join(", ")),
        };
        if names.iter().any(|name| self.stand_ins.iter().any(|own| own == name)) {
            text.push_str("; what is code of another program lets all pairs through here");
        }
        Test { name: "filter", passes: refusing.is_empty(), text }
    }

    /// Tests whether the fat AABBs of both objects overlap, as of the last update.
    fn boxes(&self) -> Test {
        let boxes = [self.one, self.two].map(|object| self.world.loosened_aabb(object.handle()));
        let [Some(box1), Some(box2)] = boxes else {
            let text = "the broad phase has no box of one of them yet".to_owned();
            return Test { name: "boxes", passes: false, text };
        };
        let passes = box1.intersects(&box2);
        let text = if passes {
            // The overlap of the boxes of two half-spaces may be unbounded.
            let overlap = overlap(&box1, &box2).as_f64();
            let is_finite = overlap.is_finite();
            let by = if is_finite { format!(" by {}", short(overlap)) } else { String::new() };
            format!("the loosened boxes overlap{by}")
        } else {
            let distance = box1.distance_to_aabb(&box2).as_f64();
            format!("the loosened boxes are {} apart", short(distance))
        };
        Test { name: "boxes", passes, text }
    }
}

/// Returns the least extent of the intersection of two boxes that intersect.
fn overlap<N: Real, const D: usize>(box1: &Aabb<N, D>, box2: &Aabb<N, D>) -> N {
    let on_axis = |axis: usize| {
        let low = max(box1.mins()[axis], box2.mins()[axis]);
        min(box1.maxs()[axis], box2.maxs()[axis]) - low
    };
    (0..D).map(on_axis).fold(N::INFINITY, min)
}

/// Tests whether the distance of the shapes is at most the limit. The text has the distance, or the
/// depth if the shapes overlap, and the limit.
fn distance_test<N: Real, const D: usize>(limit: Limit<N>, measures: &Measures<N, D>) -> Test {
    let (length, apart) = (short(limit.length().as_f64()), short(measures.distance.as_f64()));
    let passes = measures.distance <= limit.length();
    let depth = measures.contact.as_ref().map(|contact| contact.depth.as_f64());
    // The distance is tested before the depth: shapes that are apart, but within the prediction,
    // have a contact of negative depth.
    let state = match depth {
        _ if measures.distance > N::ZERO => format!("{apart} apart"),
        Some(depth) if depth > 0.0 => format!("they overlap, {} deep", short(depth)),
        _ => "they touch".to_owned(),
    };
    let kept = match limit {
        Limit::Prediction(_) => format!("contacts are kept up to {length}"),
        Limit::Margin(_) => format!("they are near up to {length}"),
    };
    Test { name: "distance", passes, text: format!("{state}; {kept}") }
}

/// Converts a contact; all vectors are in the world frame.
pub(crate) fn shown_contact<N: Real, const D: usize>(contact: &Contact<N, D>) -> ShownContact {
    let normal: &Unit<Vector<N, D>> = &contact.normal;
    ShownContact {
        a: coordinates(&contact.world1.coords),
        b: coordinates(&contact.world2.coords),
        normal: coordinates(&normal.into_inner()),
        depth: contact.depth.as_f64(),
    }
}

/// Formats a number with four significant digits and without trailing zeros. Magnitudes below 0.001
/// and magnitudes of at least a million have an exponent.
pub(crate) fn short(number: f64) -> String {
    // Parsing the rounded number drops trailing zeros; adding zero turns -0 into 0.
    let rounded = format!("{number:.3e}").parse().unwrap_or(number) + 0.0;
    let is_plain = rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs());
    if is_plain { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (0.02, "0.02"),
            (0.012_345_67, "0.01235"),
            (0.123_456, "0.1235"),
            (1.0, "1"),
            (12.3456, "12.35"),
            (1234.56, "1235"),
            (123_456.0, "123500"),
            (-0.5, "-0.5"),
            (-0.0, "0"),
            (1.5e-7, "1.5e-7"),
            (f64::INFINITY, "inf"),
        ];
        for (number, text) in cases {
            assert_eq!(short(number), text, "{number}");
        }
    }
}

//! Queries of the page that search all objects of a world: picking, rays, nearest objects.

use core::cmp::Reverse;

use impinge::bounding_volume::Ray;
use impinge::math::{Real, Space};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::ClosestPoints;
use impinge::shape::FeatureId;
use impinge::world::{CollisionObject, CollisionWorld, QueryFilter};

use crate::answer::{NearObject, NearestAnswer, Picked, RayAnswer, RayHit};
use crate::request::{NearestRequest, PickRequest, RayRequest};
use crate::space::{coordinates, point, vector};

/// Returns `true` if an object has a proximity query; such objects are drawn transparent.
pub(crate) fn is_sensor<N: Space<D>, const D: usize, T>(object: &CollisionObject<N, D, T>) -> bool {
    matches!(object.query_type(), GeometricQueryType::Proximity(_))
}

/// Returns the first opaque object that a ray hits; if there is none, the first transparent object.
/// A ray that begins inside an object hits its far side, which a camera at that position shows.
pub(crate) fn pick_by_ray<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    at: &PickRequest,
) -> Picked {
    let ray = Ray::new(point(at.from), vector(at.direction));
    let is_opaque = |object: &CollisionObject<N, D, T>| !is_sensor(object);
    let filters = [QueryFilter::new().predicate(&is_opaque), QueryFilter::new()];
    // The iterator is lazy: the second cast is made only if the first one hits nothing.
    let mut hits =
        filters.iter().filter_map(|filter| world.first_ray_hit(&ray, N::INFINITY, false, filter));
    hits.next().map_or_else(Picked::default, |(object, hit)| Picked {
        object: Some(object.handle().uid()),
        point: coordinates(&ray.point_at(hit.toi).coords),
        normal: coordinates(&hit.normal),
        time: hit.toi.as_f64(),
    })
}

/// Returns the object that contains a point; if there is none, the nearest object within `reach`.
/// If several objects have the same distance, or contain the point, opaque objects precede
/// transparent ones, then bounded objects precede unbounded ones, then the largest handle is
/// selected, since objects are drawn in the order of their handles.
pub(crate) fn pick_by_point<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    at: &PickRequest,
) -> Picked {
    let from = point::<N, D>(at.from);
    let near = world.nearest_to_point(&from, usize::MAX, N::lit(at.reach), &QueryFilter::new());
    let best = near.into_iter().min_by(|one, two| {
        let rank = |object: &CollisionObject<N, D, T>| {
            let is_endless = !object.shape().local_aabb().is_bounded();
            (is_sensor(object), is_endless, Reverse(object.handle()))
        };
        // All objects that contain the point are at a distance of 0.
        let order = one.distance.as_f64().total_cmp(&two.distance.as_f64());
        order.then_with(|| rank(one.object).cmp(&rank(two.object)))
    });
    best.map_or_else(Picked::default, |near| {
        let at = nearest_point(&near.points).unwrap_or(at.from);
        Picked { object: Some(near.object.handle().uid()), point: at, ..Picked::default() }
    })
}

/// Returns the point of an object nearest to the point of the query; `None` if the object contains
/// that point.
fn nearest_point<N: Real, const D: usize>(points: &ClosestPoints<N, D>) -> Option<[f64; 3]> {
    match points {
        ClosestPoints::WithinMargin(_, on_object) => Some(coordinates(&on_object.coords)),
        _ => None,
    }
}

/// Returns all objects that a ray hits up to its maximum time, in order of time.
pub(crate) fn ray<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    asked: &RayRequest,
) -> RayAnswer {
    let ray = Ray::new(point(asked.from), vector(asked.direction));
    let longest = asked.longest.map_or(N::INFINITY, N::lit);
    let hits = world.ray_hits(&ray, longest, true, &QueryFilter::new());
    let hits = hits.into_iter().map(|(object, hit)| RayHit {
        object: object.handle().uid(),
        point: coordinates(&ray.point_at(hit.toi).coords),
        normal: coordinates(&hit.normal),
        time: hit.toi.as_f64(),
        feature: feature_text(hit.feature, hit.part, &**object.shape()),
    });
    RayAnswer { hits: hits.collect() }
}

/// Returns at most `count` objects nearest to a point, in order of distance.
pub(crate) fn nearest<N: Space<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    asked: &NearestRequest,
) -> NearestAnswer {
    let from = point::<N, D>(asked.point);
    let count = usize::try_from(asked.count).unwrap_or(usize::MAX);
    let near = world.nearest_to_point(&from, count, N::INFINITY, &QueryFilter::new());
    let nearest = near.into_iter().map(|near| NearObject {
        object: near.object.handle().uid(),
        distance: near.distance.as_f64(),
        point: nearest_point(&near.points).unwrap_or(asked.point),
    });
    NearestAnswer { nearest: nearest.collect() }
}

/// Returns a feature as text. For a composite the text includes the part, since features are
/// numbered within their parts.
pub(crate) fn feature_text<N: Real, const D: usize>(
    feature: FeatureId,
    part: u32,
    shape: &dyn impinge::shape::Shape<N, D>,
) -> String {
    let text = match feature {
        FeatureId::Vertex(index) => format!("vertex {index}"),
        FeatureId::Edge(index) => format!("edge {index}"),
        FeatureId::Face(index) => format!("face {index}"),
    };
    let is_composite = shape.geometry().as_composite().is_some();
    if is_composite { format!("{text} of part {part}") } else { text }
}

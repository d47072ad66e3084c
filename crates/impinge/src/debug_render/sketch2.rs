//! Adds the outlines of 2D solids, and the triangles that fill them, to a mesh under construction.

use super::sketch::Sketch;
use crate::math::{Point, Real, Vector, cross2, perp, unit};
use crate::procedural::plane;
use crate::shape::{Ball, Kind, Rounded, SupportMap};

/// Adds the outline of a convex solid in 2D and the triangles that fill it.
pub(crate) fn sketch2<N: Real>(solid: Kind<'_, N, 2>, sketch: &mut Sketch<N, 2>) {
    let outline = outline(solid, sketch.parts_of_turn());
    sketch.ring(&outline);
    sketch.fan(&outline);
}

/// Returns the corners around a convex solid, counter-clockwise: two for a segment, none for a
/// half-space or a composite.
fn outline<N: Real>(solid: Kind<'_, N, 2>, parts: u32) -> Vec<Point<N, 2>> {
    match solid {
        Kind::Ball(ball) => plane::ball(ball, parts).points,
        Kind::Segment(segment) => vec![*segment.a(), *segment.b()],
        Kind::Capsule(capsule) => plane::capsule(capsule, parts).points,
        Kind::Triangle(triangle) => plane::triangle(triangle).points,
        Kind::Cuboid(cuboid) => plane::cuboid(cuboid).points,
        Kind::Polytope(polygon) => polygon.vertices().to_vec(),
        Kind::Ellipsoid(ellipse) => plane::ellipse(ellipse, parts).points,
        Kind::TaperedCapsule(capsule) => plane::tapered_capsule(capsule, parts).points,
        Kind::Rounded(solid) => rounded(solid, parts),
        Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => sampled(map, parts),
        Kind::Plane(_) | Kind::Composite(_) => Vec::new(),
    }
}

/// Returns unit directions around a circle, counter-clockwise from the x axis.
fn directions<N: Real>(parts: u32) -> Vec<Vector<N, 2>> {
    let unit = Ball::new(N::ONE);
    plane::ball(&unit, parts).points.into_iter().map(|point| point.coords).collect()
}

/// Returns the support points of a solid in the directions around a circle.
fn sampled<N: Real>(map: &dyn SupportMap<N, 2>, parts: u32) -> Vec<Point<N, 2>> {
    directions(parts).iter().map(|direction| map.support_point(direction)).collect()
}

/// Returns the outline of a rounded solid: exact sides for a polygon, support points for other
/// solids.
fn rounded<N: Real>(solid: &Rounded<N, 2>, parts: u32) -> Vec<Point<N, 2>> {
    let inner = solid.inner().0;
    match inner {
        Kind::Segment(_) | Kind::Triangle(_) | Kind::Cuboid(_) | Kind::Polytope(_) => {
            let mut corners = outline(inner, parts);
            corners.dedup();
            if corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            inflated(&corners, solid.radius(), parts)
        }
        _ => sampled(solid, parts),
    }
}

/// Returns the outline of a convex polygon inflated by `radius`. The polygon is counter-clockwise,
/// without sides of length zero. The outline consists of the sides, moved outwards, and an arc
/// around each corner.
fn inflated<N: Real>(corners: &[Point<N, 2>], radius: N, parts: u32) -> Vec<Point<N, 2>> {
    let around = directions::<N>(parts);
    if let [corner] = corners {
        return around.iter().map(|toward| corner + toward * radius).collect();
    }
    let normal = |(a, b): (&Point<N, 2>, &Point<N, 2>)| {
        unit(&(b - a)).map_or_else(Vector::<N, 2>::zeros, |(along, _)| -perp(&along))
    };
    // For each side, the unit normal to its right, which points outwards.
    let next = corners.iter().cycle().skip(1);
    let normals: Vec<_> = corners.iter().zip(next).map(normal).collect();
    let before = normals.iter().cycle().skip(normals.len().saturating_sub(1));
    let arcs = before.zip(&normals).map(|(before, after)| arc(&around, [before, after]));
    let of_corner = |(corner, arc): (&Point<N, 2>, Vec<Vector<N, 2>>)| {
        let corner = *corner;
        arc.into_iter().map(move |toward| corner + toward * radius)
    };
    corners.iter().zip(arcs).flat_map(of_corner).collect()
}

/// Returns two unit vectors and the directions of `around` between them, counter-clockwise over at
/// most 180°.
fn arc<N: Real>(around: &[Vector<N, 2>], [first, last]: [&Vector<N, 2>; 2]) -> Vec<Vector<N, 2>> {
    let is_between = |v: &Vector<N, 2>| cross2(first, v) > N::ZERO && cross2(v, last) > N::ZERO;
    let before = around.iter().cycle().skip(around.len().saturating_sub(1));
    // The directions between are consecutive, but may wrap around the end of the list.
    let start = before.zip(around).position(|(before, v)| is_between(v) && !is_between(before));
    let row = around.iter().cycle().skip(start.unwrap_or(0)).take(around.len());
    let mut arc = vec![*first];
    arc.extend(row.take_while(|&v| is_between(v)));
    arc.push(*last);
    arc
}

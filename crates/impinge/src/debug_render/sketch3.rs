//! Adds the triangles and lines of 3D solids to a mesh under construction.

use super::rounded3::inflated;
use super::sketch::Sketch;
use crate::math::{Point, Real, Vector, orthonormal_basis, unit_or};
use crate::procedural::{TriangleSurface, plane, space};
use crate::shape::{
    Ball, Cone, ConvexPolyhedron, Cuboid, Cylinder, Feature, FeatureId, Kind, Rounded, SupportMap,
    TaperedCapsule,
};

/// Adds the surface of a convex solid in 3D and the lines that are usual in drawings of it.
pub(crate) fn sketch3<N: Real>(solid: Kind<'_, N, 3>, sketch: &mut Sketch<N, 3>) {
    let parts = sketch.parts_of_turn();
    match solid {
        Kind::Ball(ball) => {
            surface(sketch, &space::ball(ball, parts));
            great_circles(sketch, |direction| Point::from(direction * ball.radius()));
        }
        Kind::Ellipsoid(solid) => {
            surface(sketch, &space::ellipsoid(solid, parts));
            let at = |v: &Vector<N, 3>| Point::from(v.component_mul(solid.half_axes()));
            great_circles(sketch, at);
        }
        Kind::Segment(segment) => sketch.line([segment.a(), segment.b()]),
        Kind::Capsule(capsule) => {
            surface(sketch, &space::capsule(capsule, parts));
            let (ends, radius) = (capsule.segment(), capsule.radius());
            let tapered = TaperedCapsule::try_from_ends(*ends.a(), *ends.b(), [radius; 2]);
            tapered.iter().for_each(|tapered| round_ends(sketch, tapered));
        }
        Kind::TaperedCapsule(capsule) => {
            surface(sketch, &space::tapered_capsule(capsule, parts));
            round_ends(sketch, capsule);
        }
        Kind::Triangle(triangle) => {
            sketch.ring(triangle.corners());
            sketch.fan(triangle.corners());
        }
        Kind::Cuboid(solid) => cuboid(sketch, solid),
        Kind::Polytope(hull) => {
            // The lines are the edges of the hull, so faces with many corners have no diagonals.
            let ends = hull.edges().iter().map(|edge| edge.vertices);
            for [a, b] in ends.map(|ends| ends.map(|end| &hull.vertices()[end as usize])) {
                sketch.line([a, b]);
            }
            faces(hull, hull.faces().len()).iter().for_each(|face| sketch.fan(&face.vertices));
        }
        Kind::Cylinder(solid, _) => cylinder(sketch, solid),
        Kind::Cone(solid, _) => cone(sketch, solid),
        Kind::Rounded(solid) => rounded(sketch, solid),
        Kind::SupportMap(map) => {
            sampled(sketch, map);
            great_circles(sketch, |direction| map.support_point(direction));
        }
        Kind::Plane(_) | Kind::Composite(_) => {}
    }
}

/// Adds the triangles of a surface, without lines.
fn surface<N: Real>(sketch: &mut Sketch<N, 3>, surface: &TriangleSurface<N>) {
    for [a, b, c] in surface.corners() {
        sketch.triangle([&a, &b, &c]);
    }
}

/// Returns `parts` points of the circle (or ellipse) around `center` with the half axes `axes`,
/// from the first axis towards the second.
fn circle<N: Real>(center: &Point<N, 3>, axes: [Vector<N, 3>; 2], parts: u32) -> Vec<Point<N, 3>> {
    let around = plane::ball(&Ball::new(N::ONE), parts).points;
    around.iter().map(|toward| center + axes[0] * toward.x + axes[1] * toward.y).collect()
}

/// Adds three closed lines: the images, under the map `at`, of the unit circles in the three
/// coordinate planes.
fn great_circles<N: Real>(sketch: &mut Sketch<N, 3>, at: impl Fn(&Vector<N, 3>) -> Point<N, 3>) {
    let axes = [Vector::<N, 3>::x(), Vector::<N, 3>::y(), Vector::<N, 3>::z()];
    for axis in 0..3 {
        let pair = [axes[axis], axes[(axis + 1) % 3]];
        let directions = circle(&Point::origin(), pair, sketch.parts_of_turn());
        let points: Vec<_> = directions.iter().map(|direction| at(&direction.coords)).collect();
        sketch.ring(&points);
    }
}

/// Adds the outlines of a tapered capsule in two planes through its axis, and the circles where its
/// side touches the balls at its ends. If one ball contains the other, adds a great circle of the
/// larger ball instead.
fn round_ends<N: Real>(sketch: &mut Sketch<N, 3>, capsule: &TaperedCapsule<N, 3>) {
    let (parts, center) = (sketch.parts_of_turn(), capsule.segment().center());
    let axis = unit_or(&(capsule.segment().b() - capsule.segment().a()), Vector::<N, 3>::y());
    let (u, v) = orthonormal_basis(&axis);
    let [radius1, radius2] = capsule.radii();
    // The 2D capsule that generates the solid by revolution. If it cannot be constructed because
    // numbers overflow, there are no outlines.
    let flat = TaperedCapsule::<N, 2>::try_new(capsule.half_height(), radius1, radius2);
    for (flat, across) in flat.iter().flat_map(|flat| [(flat, u), (flat, v)]) {
        let outline = plane::tapered_capsule(flat, parts).points;
        let placed = outline.iter().map(|corner| center + across * corner.x + axis * corner.y);
        sketch.ring(&placed.collect::<Vec<_>>());
    }
    let Some(taper) = capsule.taper() else {
        let (end, radius) = (capsule.larger_end(), capsule.radii()[capsule.larger_end()]);
        return sketch.ring(&circle(capsule.end(end), [u, v].map(|side| side * radius), parts));
    };
    for (end, radius) in capsule.radii().into_iter().enumerate() {
        let center = capsule.end(end) + axis * (taper.sine * radius);
        let axes = [u, v].map(|side| side * (taper.cosine * radius));
        sketch.ring(&circle(&center, axes, parts));
    }
}

/// Adds a box. Corner `i` has the positive half extent on the axes whose bits are set in `i`, else
/// the negative one.
fn cuboid<N: Real>(sketch: &mut Sketch<N, 3>, cuboid: &Cuboid<N, 3>) {
    let corner = |index| cuboid.vertex(FeatureId::Vertex(index));
    for axis in [1, 2, 4] {
        for start in (0..8).filter(|start| start & axis == 0) {
            sketch.line([&corner(start), &corner(start | axis)]);
        }
    }
    surface(sketch, &space::cuboid(cuboid));
}

/// Adds the surface of a cylinder, its rims, and four lines between them.
fn cylinder<N: Real>(sketch: &mut Sketch<N, 3>, solid: &Cylinder<N>) {
    let parts = sketch.parts_of_turn();
    let (radius, up) = (solid.radius(), Vector::<N, 3>::y() * solid.half_height());
    let rim = |center: Vector<N, 3>, parts| {
        let axes = [Vector::<N, 3>::x() * radius, Vector::<N, 3>::z() * radius];
        circle(&Point::from(center), axes, parts)
    };
    surface(sketch, &space::cylinder(solid, parts));
    sketch.ring(&rim(up, parts));
    sketch.ring(&rim(-up, parts));
    for (above, below) in rim(up, 4).iter().zip(&rim(-up, 4)) {
        sketch.line([above, below]);
    }
}

/// Adds the surface of a cone, its rim, and four lines from the rim to the apex.
fn cone<N: Real>(sketch: &mut Sketch<N, 3>, solid: &Cone<N>) {
    let parts = sketch.parts_of_turn();
    let apex = Point::from(Vector::<N, 3>::y() * solid.half_height());
    let base = Point::from(-apex.coords);
    let axes = [Vector::<N, 3>::x(), Vector::<N, 3>::z()].map(|axis| axis * solid.radius());
    surface(sketch, &space::cone(solid, parts));
    sketch.ring(&circle(&base, axes, parts));
    for side in &circle(&base, axes, 4) {
        sketch.line([&apex, side]);
    }
}

/// Returns the first `count` faces of a solid, with their normals.
fn faces<N: Real>(solid: &dyn ConvexPolyhedron<N, 3>, count: usize) -> Vec<Feature<N, 3>> {
    let face = |index| {
        let mut face = Feature::default();
        solid.face(FeatureId::Face(index), &mut face);
        face.normal = Some(solid.feature_normal(FeatureId::Face(index)));
        face
    };
    (0..).map(face).take(count).collect()
}

/// Adds a rounded solid, with exact faces and patches if the inner shape is a box, a triangle or a
/// hull. Other shapes, and shapes that [`inflated`] rejects, are sampled by support points.
fn rounded<N: Real>(sketch: &mut Sketch<N, 3>, solid: &Rounded<N, 3>) {
    let faces = match solid.inner().0 {
        Kind::Cuboid(cuboid) => faces(cuboid, 6),
        Kind::Triangle(triangle) => faces(triangle, 2),
        Kind::Polytope(hull) => faces(hull, hull.faces().len()),
        _ => Vec::new(),
    };
    if !inflated(sketch, &faces, solid.radius()) {
        sampled(sketch, solid);
        great_circles(sketch, |direction| solid.support_point(direction));
    }
}

/// Adds the surface of a ball in which each direction is replaced by the support point in that
/// direction.
fn sampled<N: Real>(sketch: &mut Sketch<N, 3>, map: &dyn SupportMap<N, 3>) {
    let mut directions = space::ball(&Ball::new(N::ONE), sketch.parts_of_turn());
    for vertex in &mut directions.vertices {
        *vertex = map.support_point(&vertex.coords);
    }
    surface(sketch, &directions);
}

//! Describes shapes as text: the kind, and sizes such as radii, lengths or numbers of parts.
//! Lengths have four significant digits.

use impinge::math::{Point, Real, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, Ellipsoid, Plane, Polyline, Rounded, Segment, Shape,
    ShapeKind, TaperedCapsule, TriMesh, Triangle,
};
use impinge_record::{Recordable, ShapeData};

use crate::answer::ShapeText;
use crate::explain::short;

/// Returns the kind and the sizes of a shape. For a shape type that is not of the library, the text
/// has no sizes.
pub(crate) fn shape_text<N: Recordable<D>, const D: usize>(shape: &dyn Shape<N, D>) -> ShapeText {
    let kind = kind_text(shape.geometry().kind());
    let sizes = solid_sizes(shape).or_else(|| composite_sizes(shape)).or_else(|| own_sizes(shape));
    let text = match sizes {
        Some(sizes) => format!("{}, {}", sizes.kind, sizes.text),
        None => format!("{kind} of the program's own"),
    };
    ShapeText { kind, text }
}

const fn kind_text(kind: ShapeKind) -> &'static str {
    match kind {
        ShapeKind::Ball => "ball",
        ShapeKind::Segment => "segment",
        ShapeKind::Capsule => "capsule",
        ShapeKind::Triangle => "triangle",
        ShapeKind::Cuboid => "cuboid",
        ShapeKind::Polytope => "convex polytope",
        ShapeKind::Cylinder => "cylinder",
        ShapeKind::Cone => "cone",
        ShapeKind::Ellipsoid => "ellipsoid",
        ShapeKind::TaperedCapsule => "tapered capsule",
        ShapeKind::Rounded => "rounded shape",
        ShapeKind::Plane => "half-space",
        ShapeKind::Composite => "composite",
        _ => "support map",
    }
}

/// Returns the description of a shape of known type; `text` contains the sizes.
fn sizes(kind: &'static str, text: String) -> Option<ShapeText> {
    Some(ShapeText { kind, text })
}

fn length<N: Real>(number: N) -> String {
    short(number.as_f64())
}

/// Formats extents as `1 × 2 × 3`.
fn extents<N: Real, const D: usize>(vector: &Vector<N, D>) -> String {
    let lengths: Vec<String> = vector.iter().map(|x| length(*x)).collect();
    lengths.join(" × ")
}

fn distance<N: Real, const D: usize>(from: &Point<N, D>, to: &Point<N, D>) -> String {
    length((to - from).norm())
}

/// Describes the convex shapes that exist in both dimensions, and the half-space; `None` for other
/// shapes.
fn solid_sizes<N: Recordable<D>, const D: usize>(shape: &dyn Shape<N, D>) -> Option<ShapeText> {
    if let Some(ball) = shape.as_shape::<Ball<N>>() {
        return sizes("ball", format!("radius {}", length(ball.radius())));
    }
    if let Some(cuboid) = shape.as_shape::<Cuboid<N, D>>() {
        return sizes("cuboid", format!("half extents {}", extents(cuboid.half_extents())));
    }
    if let Some(segment) = shape.as_shape::<Segment<N, D>>() {
        return sizes("segment", format!("length {}", distance(segment.a(), segment.b())));
    }
    if let Some(capsule) = shape.as_shape::<Capsule<N, D>>() {
        let axis = distance(capsule.segment().a(), capsule.segment().b());
        let text = format!("axis {axis} long, radius {}", length(capsule.radius()));
        return sizes("capsule", text);
    }
    if let Some(capsule) = shape.as_shape::<TaperedCapsule<N, D>>() {
        let axis = distance(capsule.segment().a(), capsule.segment().b());
        let [radius1, radius2] = capsule.radii().map(length);
        return sizes(
            "tapered capsule",
            format!("axis {axis} long, radii {radius1} and {radius2}"),
        );
    }
    if let Some(triangle) = shape.as_shape::<Triangle<N, D>>() {
        let [a, b, c] = triangle.corners();
        let sides = [distance(a, b), distance(b, c), distance(c, a)].join(", ");
        return sizes("triangle", format!("sides {sides}"));
    }
    if let Some(ellipsoid) = shape.as_shape::<Ellipsoid<N, D>>() {
        return sizes("ellipsoid", format!("half axes {}", extents(ellipsoid.half_axes())));
    }
    if let Some(rounded) = shape.as_shape::<Rounded<N, D>>() {
        let inner = shape_text(&**rounded.shape()).text;
        return sizes("rounded", format!("radius {} around {inner}", length(rounded.radius())));
    }
    let plane = shape.as_shape::<Plane<N, D>>()?;
    let normal: Vec<String> = plane.normal().iter().map(|x| length(*x)).collect();
    sizes("half-space", format!("normal {}", normal.join(", ")))
}

/// Describes polylines, meshes and compounds; `None` for other shapes.
fn composite_sizes<N: Recordable<D>, const D: usize>(shape: &dyn Shape<N, D>) -> Option<ShapeText> {
    // Two-sided is the default, so it is not mentioned.
    let sides = |is_solid: bool, is_one_sided: bool| match (is_solid, is_one_sided) {
        (true, _) => ", solid",
        (false, true) => ", one-sided",
        (false, false) => "",
    };
    if let Some(line) = shape.as_shape::<Polyline<N, D>>() {
        let sides = sides(line.is_solid(), line.is_one_sided());
        let text = format!("{} segments{sides}", line.num_segments());
        return sizes("polyline", text);
    }
    if let Some(mesh) = shape.as_shape::<TriMesh<N, D>>() {
        let sides = sides(mesh.is_solid(), mesh.is_one_sided());
        let text = format!("{} triangles{sides}", mesh.num_triangles());
        return sizes("mesh", text);
    }
    let compound = shape.as_shape::<Compound<N, D>>()?;
    sizes("compound", format!("{} shapes", compound.num_children()))
}

/// Describes the shapes that exist only in 2D or only in 3D, and height fields; `None` for other
/// shapes. Generic code cannot name their types, so the sizes come from the data with which they
/// are recorded.
fn own_sizes<N: Recordable<D>, const D: usize>(shape: &dyn Shape<N, D>) -> Option<ShapeText> {
    let [kind, height, radius] = ["cylinder", "half height", "radius"];
    match N::own_data(shape)? {
        ShapeData::Outline(points) => sizes("convex polygon", format!("{} vertices", points.len())),
        ShapeData::Hull { points, .. } => {
            sizes("convex hull", format!("{} vertices", points.len()))
        }
        ShapeData::Cylinder([h, r]) => {
            sizes(kind, format!("{height} {}, {radius} {}", length(h), length(r)))
        }
        ShapeData::Cone([h, r]) => {
            sizes("cone", format!("{height} {}, {radius} {}", length(h), length(r)))
        }
        ShapeData::Tetrahedron([a, b, c, d]) => {
            // The six edges connect each corner with all corners after it.
            let edges = [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]];
            let edges = edges.map(|[from, to]| distance(&from, &to)).join(", ");
            sizes("tetrahedron", format!("edges {edges}"))
        }
        ShapeData::HeightField(field) => {
            // A height field in 2D has a single row.
            let rows = field.heights.len() / field.columns.max(1);
            let grid = if rows > 1 {
                format!("{rows} × {}", field.columns)
            } else {
                field.columns.to_string()
            };
            sizes("height field", format!("{grid} heights"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use impinge::dim2::shape::ConvexPolygon;
    use impinge::dim3::math::Vector;
    use impinge::dim3::shape::{Cylinder, ShapeHandle};

    use super::*;

    #[test]
    fn sizes_are_those_of_the_constructors() {
        let cuboid = Cuboid::new(Vector::new(1.0_f32, 2.0, 0.25));
        let rounded = Rounded::new(cuboid, 0.5);
        let polygon = ConvexPolygon::new(&[[0.0_f64, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Into::into));
        assert_eq!(shape_text(&cuboid).text, "cuboid, half extents 1 × 2 × 0.25");
        assert_eq!(
            shape_text(&rounded).text,
            "rounded, radius 0.5 around cuboid, half extents 1 × 2 × 0.25"
        );
        assert_eq!(shape_text(&polygon).text, "convex polygon, 3 vertices");
        let cylinder = ShapeHandle::new(Cylinder::new(2.0_f64, 0.125));
        assert_eq!(shape_text(&*cylinder).text, "cylinder, half height 2, radius 0.125");
        assert_eq!(shape_text(&*cylinder).kind, "cylinder");
    }
}

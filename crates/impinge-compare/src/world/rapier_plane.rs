// The conversions for 2D; included by `rapier.rs`.

/// The number of dimensions.
pub const DIM: usize = 2;

/// Converts a shape of a scene.
pub fn builder(shape: &SceneShape<2>) -> ColliderBuilder {
    match shape {
        SceneShape::Ball { radius } => ColliderBuilder::ball(*radius as f32),
        SceneShape::Cuboid { half_extents: [x, y] } => {
            ColliderBuilder::cuboid(*x as f32, *y as f32)
        }
        SceneShape::Capsule { half_height, radius } => {
            ColliderBuilder::capsule_y(*half_height as f32, *radius as f32)
        }
        SceneShape::Plane { normal } => {
            ColliderBuilder::new(SharedShape::halfspace(vector(normal)))
        }
        SceneShape::Segment { ends: [a, b] } => ColliderBuilder::segment(vector(a), vector(b)),
        SceneShape::Triangle { corners } => {
            let [a, b, c] = counter_clockwise(*corners);
            ColliderBuilder::triangle(vector(&a), vector(&b), vector(&c))
        }
        SceneShape::Convex { points } => {
            let points: Vec<_> = points.iter().map(vector).collect();
            ColliderBuilder::convex_hull(&points).expect("the points span all dimensions")
        }
        SceneShape::Polyline { vertices } => {
            ColliderBuilder::polyline(vertices.iter().map(vector).collect(), None)
        }
        SceneShape::HeightField { heights, extents, .. } => {
            let heights = heights.iter().map(|height| *height as f32).collect();
            ColliderBuilder::heightfield(heights, vector(extents))
        }
        SceneShape::Cylinder { .. } | SceneShape::Cone { .. } | SceneShape::TriMesh { .. } => {
            unreachable!("not of the plane")
        }
    }
}

/// Returns the corners in counter-clockwise order: rapier misses contacts of a clockwise triangle.
fn counter_clockwise([a, b, c]: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if turn < 0.0 { [a, c, b] } else { [a, b, c] }
}

fn vector(v: &[f64; 2]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

/// Converts a placement of a scene.
pub fn pose(placement: &Placement<2>) -> Pose {
    let [x, y] = placement.translation.map(|x| x as f32);
    let [cosine, sine] = placement.complex().map(|x| x as f32);
    Pose::from_parts(Vector::new(x, y), Rotation::from_cos_sin_unchecked(cosine, sine))
}

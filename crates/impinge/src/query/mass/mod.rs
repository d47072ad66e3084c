//! Mass, centre of mass and inertia of shapes.
//!
//! Shapes of either scalar type are integrated in doubles, about their centre and in units of their
//! size ([`integrals`]). Closed forms are used where they exist; [`round_ellipsoid`], [`support2`]
//! and [`support3`] integrate the other shapes numerically.

mod by_dimension;
mod enclosed;
mod integrals;
mod outline;
mod plate;
mod polyhedron;
mod revolution;
mod round_ellipsoid;
mod solids;
mod support2;
mod support3;

pub(crate) use by_dimension::MassByDimension;

use crate::math::{Pose, Real, Space, Vector};
use crate::shape::{
    CompositeShape, Compound, Geometry, Kind, MassError, MassProperties, Moments, PartPath, Shape,
    amount,
};

/// Returns the mass, centre of mass and inertia of a shape of uniform density, in the frame of the
/// shape.
///
/// | shape | its mass |
/// |---|---|
/// | ball, cuboid, ellipsoid, capsule, tapered capsule, cylinder, cone, convex polygon and hull, tetrahedron, triangle in 2D | density × area in 2D, × volume in 3D |
/// | any of them [`Rounded`](crate::shape::Rounded), and a rounded segment or triangle | density × area in 2D, × volume in 3D |
/// | segment; triangle in 3D | density × length; density × area |
/// | closed triangle mesh in 3D, closed polyline in 2D | density × the enclosed volume or area |
/// | triangle mesh in 2D | density × the areas of its triangles |
/// | compound; user's composite that is no surface | the sum of its children; of its parts |
/// | half-space; open mesh, other polylines, height field | an error |
/// | user's convex shape | [`Shape::unit_mass_properties`], else by its support points |
///
/// Overlaps of children, parts or triangles count twice. A region inside a mesh or polyline counts
/// once per turn that the mesh winds around it: inner surfaces with reversed orientation are
/// cavities. The orientation of the whole mesh does not matter. A shape of size zero has no mass;
/// neither has a rounded segment or flat triangle with a radius of zero.
///
/// # Accuracy
///
/// Closed forms are accurate to the rounding of the scalar; in `f32` the result is usually the
/// nearest number. The distance from the origin does not affect the accuracy. Quadrature is used
/// for rounded ellipsoids and ellipses, accurate to about 1e-8, and for a user's convex shape,
/// accurate to about 1e-8 in 2D and 1e-4 in 3D. A rounded flat tetrahedron is also accurate to
/// about 1e-4. For a closed mesh whose surfaces are close together, the relative error grows with
/// the ratio of its size to their gap. Scaling a shape by a power of two scales the result exactly.
///
/// # Errors
/// If the density is negative or not finite; if the shape, or a part of a compound, is a
/// half-space, a surface that is not closed, or a polyline in 3D; or if the mass or a moment
/// exceeds the range of the scalar.
///
/// # Cost
/// O(1) for simple shapes, O(n) for n vertices, triangles or children. In 3D a user's convex shape
/// takes some milliseconds, a rounded ellipsoid about one millisecond. So compute the properties
/// once for each shape.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::query::mass_properties;
/// use impinge::dim3::shape::{Compound, Cuboid, Rounded, ShapeHandle};
///
/// let brick = mass_properties(&Cuboid::new(Vector::new(1.0_f64, 2.0, 3.0)), 0.5)?;
/// assert_eq!(brick.mass(), 24.0, "2 × 4 × 6, half as dense as water");
/// assert_eq!(brick.inertia().diagonal(), Vector::new(104.0, 80.0, 40.0), "m (h² + d²) / 12, …");
///
/// // A die: the box, a slab on each face, a quarter of a cylinder on each edge, and a ball at the corners.
/// let die = mass_properties(&Rounded::new(Cuboid::new(Vector::repeat(1.0_f64)), 0.5), 1.0)?;
/// let pi = std::f64::consts::PI;
/// assert!((die.mass() - (8.0 + 12.0 + 1.5 * pi + pi / 6.0)).abs() < 1e-13);
///
/// // Two stacked bricks equal one brick of twice the height.
/// let brick = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 2.0, 3.0)));
/// let at = |y: f64| Isometry::translation(0.0, y, 0.0);
/// let tower = Compound::new(vec![(at(-2.0), brick.clone()), (at(2.0), brick)]);
/// let (tower, whole) = (mass_properties(&tower, 0.5)?, Cuboid::new(Vector::new(1.0, 4.0, 3.0)));
/// let whole = mass_properties(&whole, 0.5)?;
/// assert!((tower.inertia() - whole.inertia()).norm() < 1e-12);
/// # Ok::<(), impinge::query::MassError>(())
/// ```
pub fn mass_properties<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    density: N,
) -> Result<MassProperties<N, D>, MassError> {
    mass_properties_with(shape, &mut |_| density)
}

/// Runs [`mass_properties`] for a compound whose children have different densities.
///
/// `density` is called once for each child, in order, with the child's path: the index of the
/// child, then in a nested compound the index of that compound's child, and so on, as in
/// [`PartPath`]. A mesh is one child, as is any shape other than a compound; for a user's composite
/// `density` is called for each part. A shape that is not a compound has the empty path.
///
/// # Errors
/// If a density is negative or not finite; if the shape, or a part of a compound, is a half-space,
/// a surface that is not closed, or a polyline in 3D; or if the mass or a moment exceeds the range
/// of the scalar.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::mass_properties_with;
/// use impinge::dim2::shape::{Ball, Compound, Cuboid, ShapeHandle};
///
/// let (handle, head) = (Cuboid::new(Vector::new(4.0_f64, 0.5)), Cuboid::new(Vector::new(0.5, 1.0)));
/// let hammer = Compound::new(vec![
///     (Isometry::identity(), ShapeHandle::new(handle)),
///     (Isometry::translation(4.5, 0.0), ShapeHandle::new(head)),
/// ]);
/// let materials = [1.0, 10.0];
/// let found = mass_properties_with(&hammer, &mut |path| materials[path[0] as usize])?;
/// assert_eq!(found.mass(), 8.0 + 20.0);
/// assert!((found.center_of_mass().x - 4.5 * 20.0 / 28.0).abs() < 1e-15);
/// # Ok::<(), impinge::query::MassError>(())
/// ```
pub fn mass_properties_with<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    density: &mut dyn FnMut(&[u32]) -> N,
) -> Result<MassProperties<N, D>, MassError> {
    let mut weighing = Weighing { density, path: PartPath::new(), first: 0 };
    MassProperties::try_of_moments(&weighing.of_shape(shape)?)
}

/// The traversal of a shape and its children.
struct Weighing<'d, N> {
    density: &'d mut dyn FnMut(&[u32]) -> N,
    path: PartPath,
    /// The index, in the whole shape, of the first part of the current child.
    first: u32,
}

impl<N: Real> Weighing<'_, N> {
    /// Returns the moments of a shape, with the density that belongs to its path; an error if that
    /// density is invalid, or if the shape has no finite mass.
    fn of_shape<const D: usize>(&mut self, shape: &dyn Shape<N, D>) -> Result<Moments<D>, MassError>
    where
        N: Space<D>,
    {
        let geometry = shape.geometry();
        match (shape.unit_mass_properties(), geometry.as_composite()) {
            (None, Some(composite)) => self.of_composite(composite),
            (Some(known), _) => Ok(known.moments().of_density(self.density()?)),
            (None, None) => {
                let found = of_solid(geometry).map_err(|error| self.placed(error))?;
                Ok(found.of_density(self.density()?))
            }
        }
    }

    fn of_composite<const D: usize>(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
    ) -> Result<Moments<D>, MassError>
    where
        N: Space<D>,
    {
        let Some(shape) = composite.built_in() else { return self.of_parts(composite) };
        if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
            return self.of_children(compound);
        }
        let found = <N::Algorithms>::enclosed(shape).map_err(|error| self.placed(error))?;
        Ok(found.of_density(self.density()?))
    }

    /// Returns the sum of the moments of a compound's children, in the compound's frame; the error
    /// of the first child that has one.
    fn of_children<const D: usize>(
        &mut self,
        compound: &Compound<N, D>,
    ) -> Result<Moments<D>, MassError>
    where
        N: Space<D>,
    {
        let (start, mut all) = (self.first, None);
        for (index, (position, shape)) in (0_u32..).zip(compound.children()) {
            self.first = start + compound.first_part(index);
            self.path.push(index);
            let found = self.of_shape(&**shape)?;
            self.path.pop();
            add_placed(&mut all, &N::pose(position), &found);
        }
        self.first = start;
        Ok(all.unwrap_or_else(|| Moments::massless(Vector::<f64, D>::zeros())))
    }

    /// Returns the sum of the moments of the parts of a user's composite.
    ///
    /// # Errors
    /// If the composite is a surface.
    fn of_parts<const D: usize>(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
    ) -> Result<Moments<D>, MassError>
    where
        N: Space<D>,
    {
        if composite.surface().is_some() {
            return Err(MassError::NotClosed { part: self.first });
        }
        let (start, mut all) = (self.first, None);
        for index in 0..composite.num_parts() {
            let part = composite.part(index);
            self.first = start + index;
            self.path.push(index);
            let found = self.of_shape(part.solid.as_shape())?;
            self.path.pop();
            add_placed(&mut all, &part.pose, &found);
        }
        self.first = start;
        Ok(all.unwrap_or_else(|| Moments::massless(Vector::<f64, D>::zeros())))
    }

    /// Calls the user's function for the density of the current child.
    ///
    /// # Errors
    /// If the density is negative or not finite.
    fn density(&mut self) -> Result<f64, MassError> {
        amount("the density", (self.density)(&self.path).as_f64())
    }

    /// Converts the part index in an error about a child to the index in the whole shape.
    fn placed(&self, error: MassError) -> MassError {
        match error {
            MassError::Unbounded { part } => MassError::Unbounded { part: self.first + part },
            MassError::NotClosed { part } => MassError::NotClosed { part: self.first + part },
            other => other,
        }
    }
}

/// Adds a body placed at `pose` to the sum `all`; `None` is an empty sum.
fn add_placed<N: Real, const D: usize>(
    all: &mut Option<Moments<D>>,
    pose: &Pose<N, D>,
    found: &Moments<D>,
) {
    let placed = found.placed(&pose.rotation.map(N::as_f64), &pose.translation.map(N::as_f64));
    *all = Some(all.map_or(placed, |all| all.plus(&placed)));
}

/// Returns the moments of a solid at density 1: per volume, or per length or area for a segment or
/// flat triangle. An error for a half-space, and for a user's solid with a support point that is
/// not finite.
fn of_solid<N: Space<D>, const D: usize>(
    solid: Geometry<'_, N, D>,
) -> Result<Moments<D>, MassError> {
    match solid.0 {
        Kind::Segment(segment) => return Ok(solids::simplex(&[*segment.a(), *segment.b()])),
        Kind::Triangle(triangle) => return Ok(solids::simplex(triangle.corners())),
        _ => {}
    }
    let (mut core, mut radius) = (solid, N::ZERO);
    while let Kind::Rounded(outer) = core.0 {
        (core, radius) = (outer.inner(), radius + outer.radius());
    }
    match (core.0, solid.as_support_map()) {
        (Kind::SupportMap(_), Some(whole)) => <N::Algorithms>::by_support(whole),
        (Kind::Plane(_), _) => Err(MassError::Unbounded { part: 0 }),
        _ => Ok(rounded(core, radius)),
    }
}

/// Returns the moments of the set of points within `radius` of a built-in convex solid other than a
/// [`Kind::Rounded`].
fn rounded<N: Space<D>, const D: usize>(core: Geometry<'_, N, D>, radius: N) -> Moments<D> {
    match core.0 {
        Kind::Ball(ball) => solids::round_box(&Vector::<N, D>::zeros(), ball.radius() + radius),
        Kind::Cuboid(cuboid) => solids::round_box(cuboid.half_extents(), radius),
        Kind::Segment(segment) => revolution::two_balls([segment.a(), segment.b()], [radius; 2]),
        Kind::Capsule(capsule) => {
            let (segment, radius) = (capsule.segment(), capsule.radius() + radius);
            revolution::two_balls([segment.a(), segment.b()], [radius; 2])
        }
        Kind::TaperedCapsule(capsule) => {
            let (segment, radii) = (capsule.segment(), capsule.radii().map(|own| own + radius));
            revolution::two_balls([segment.a(), segment.b()], radii)
        }
        Kind::Cylinder(cylinder, _) => {
            revolution::round_cylinder([cylinder.half_height(), cylinder.radius()], radius)
        }
        Kind::Cone(cone, _) => revolution::round_cone([cone.half_height(), cone.radius()], radius),
        Kind::Triangle(triangle) => <N::Algorithms>::round_triangle(triangle.corners(), radius),
        Kind::Polytope(polytope) => <N::Algorithms>::round_polytope(polytope, radius),
        Kind::Ellipsoid(ellipsoid) if radius > N::ZERO => {
            <N::Algorithms>::round_ellipsoid(ellipsoid.half_axes(), radius)
        }
        Kind::Ellipsoid(ellipsoid) => solids::ellipsoid(ellipsoid.half_axes()),
        Kind::Rounded(_) | Kind::SupportMap(_) | Kind::Plane(_) | Kind::Composite(_) => {
            unreachable!("the caller has a formula for the core")
        }
    }
}

//! Compares the mass properties of every kind of solid with a count of the sample points in it.

use crate::support::composite_support::{Piece, Pieces};
use crate::support::shape_table::{self, Shapes};
use crate::support::solids::{self, Rng};

use impinge::math::{Isometry, Isometry2, Isometry3, Matrix, Point, Pose, Vector};
use impinge::query::{PointQuery, mass_properties};
use impinge::shape::{
    Ball, Compound, Cone, ConvexHull, Cuboid, Cylinder, Ellipsoid, Rounded, Shape, ShapeHandle,
    TaperedCapsule, Tetrahedron,
};
use impinge_reference::mass::{Mass, counted};
use impinge_reference::random::Random;

use super::{Found, Inertia, assert_alike, p3, unit};

/// Returns the number of cells of the sampling grid along each axis in `D` dimensions.
fn cells<const D: usize>() -> usize {
    [0, 0, 300, 44][D]
}

/// Converts counted mass properties to the form of [`Inertia`].
fn found<const D: usize>(mass: &Mass<D>) -> Found<D> {
    let tensor = Matrix::<f64, D>::from_fn(|row, column| mass.inertia()[row][column]);
    let tensor = if D == 2 {
        Matrix::<f64, D>::from_fn(
            |row, column| if row + column == 0 { tensor.trace() } else { 0.0 },
        )
    } else {
        tensor
    };
    (mass.measure, Vector::<f64, D>::from(mass.center), tensor)
}

/// Returns mass properties from a count of the sample points, one in each cell of the box of a
/// solid, that are inside the solid.
fn count<const D: usize>(
    shape: &dyn Shape<f64, D>,
    is_inside: impl FnMut(&[f64; D]) -> bool,
) -> Found<D> {
    let aabb = shape.local_aabb();
    let [low, high] = [aabb.mins(), aabb.maxs()].map(|corner| corner.coords.into());
    found(&counted(&low, &high, cells::<D>(), &mut Random::new(7), is_inside))
}

fn check<const D: usize>(
    name: &str,
    shape: &dyn Shape<f64, D>,
    is_inside: impl FnMut(&[f64; D]) -> bool,
) where
    f64: Inertia<D>,
{
    assert_alike(&unit(shape), &count(shape, is_inside), 1.2e-2, name);
}

/// Compares mass properties with counts of points for which the level functions of [`solids`] are
/// negative.
fn by_levels<const D: usize>(make: fn(&mut Rng) -> Vec<solids::Solid<f64, D>>)
where
    f64: Inertia<D>,
{
    let mut tried = 0;
    for seed in 0..3 {
        for solid in make(&mut Rng::new(seed)) {
            if mass_properties(&*solid.shape, 1.0).is_err() {
                assert_eq!(solid.name, "plane", "seed {seed}");
                continue;
            }
            tried += 1;
            let is_inside = |point: &[f64; D]| solid.at(&Vector::<f64, D>::from(*point)) < 0.0;
            check(solid.name, &*solid.shape, is_inside);
        }
    }
    assert!(tried >= 30, "{tried} solids");
}

#[test]
fn solids_of_random_sizes() {
    by_levels::<2>(solids::plane_solids);
    by_levels::<3>(solids::space_solids);
}

/// Compares mass properties with counts of points that the library's own point queries place inside
/// the shape.
fn by_points<R, const D: usize>(shapes: &Shapes<f64, D>, origin: &Isometry<f64, R, D>)
where
    f64: Inertia<D>,
    R: impinge::math::AbstractRotation<f64, D>,
{
    for (name, shape) in shapes {
        check(name, &**shape, |point| shape.contains_point(origin, &Point::from(*point)));
    }
}

/// Returns the bounded convex shapes of the table that have an area in 2D, or a volume in 3D.
fn solids_of<const D: usize>(mut shapes: Shapes<f64, D>) -> Shapes<f64, D> {
    let others = [
        "segment",
        "plane",
        "polyline",
        "mesh",
        "pieces",
        "height field",
        "closed mesh",
        "compound",
    ];
    let flat = [&others[..], &["triangle"]].concat();
    shapes.retain(|(name, _)| !(if D == 3 { &flat[..] } else { &others[..] }).contains(name));
    shapes
}

#[test]
fn solids_of_the_plane() {
    let mut shapes = solids_of(shape_table::plane(1.0));
    let half = Vector::<f64, 2>::new(0.25, 1.5);
    shapes.push(("rounded ellipse", ShapeHandle::new(Rounded::new(Ellipsoid::new(half), 0.5))));
    let club = TaperedCapsule::<f64, 2>::new(1.0, 0.25, 0.75);
    shapes.push(("rounded club", ShapeHandle::new(Rounded::new(club, 0.5))));
    by_points(&shapes, &Isometry2::identity());
}

#[test]
fn solids_of_space() {
    let mut shapes = solids_of(shape_table::space(1.0));
    let corners = [p3(-1.0, -1.0, -1.0), p3(2.0, -1.0, 0.0), p3(-1.0, 1.5, 0.0), p3(0.0, 0.0, 1.0)];
    let spike = Tetrahedron::new(corners);
    let half = Vector::<f64, 3>::new(0.25, 0.5, 1.5);
    let twice = Rounded::new(Rounded::new(Cone::new(1.0, 0.5), 0.25), 0.25);
    let more: [(&str, ShapeHandle<f64, 3>); 7] = [
        ("tetrahedron", ShapeHandle::new(spike.clone())),
        ("rounded tetrahedron", ShapeHandle::new(Rounded::new(spike, 0.5))),
        ("rounded ellipsoid", ShapeHandle::new(Rounded::new(Ellipsoid::new(half), 0.5))),
        ("rounded ball", ShapeHandle::new(Rounded::new(Ball::new(0.5), 0.5))),
        ("rounded disk", ShapeHandle::new(Rounded::new(Cylinder::new(0.0, 1.0), 0.5))),
        ("cone rounded twice", ShapeHandle::new(twice)),
        ("rounded hull", ShapeHandle::new(Rounded::new(ConvexHull::from_points(&corners), 1.0))),
    ];
    shapes.extend(more);
    by_points(&shapes, &Isometry3::identity());
}

/// Compares the mass properties of a nested compound, whose children do not overlap, with a count
/// of the points inside the whole compound.
#[test]
fn compounds_with_densities() {
    use impinge::dim3::math::Isometry;
    let box_ = ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::new(1.0, 0.5, 0.25)));
    let ball = ShapeHandle::new(Ball::new(0.5));
    let tilt = Vector::<f64, 3>::new(0.3, 0.5, -0.4);
    let at =
        |x: f64, y: f64, turn: f64| Isometry::new(Vector::<f64, 3>::new(x, y, 0.0), tilt * turn);
    let pair =
        Compound::new(vec![(at(0.0, 0.0, 1.0), box_.clone()), (at(0.0, 1.5, 0.0), ball.clone())]);
    let nested = Compound::new(vec![
        (at(-2.0, 0.0, 2.0), ShapeHandle::new(pair)),
        (at(1.0, 0.0, -1.0), box_),
    ]);
    let densities = |path: &[u32]| if path == [0, 1] { 3.0 } else { 1.0 };
    let body = impinge::query::mass_properties_with(&nested, &mut |path| densities(path));
    let one = count(&nested, |p| nested.contains_point(&Isometry::identity(), &Point::from(*p)));
    // Adds the ball twice more, since it has three times the density.
    let (center, mass) = (
        at(-2.0, 0.0, 2.0) * at(0.0, 1.5, 0.0) * Point::origin(),
        unit::<f64, 3>(&Ball::new(0.5)).0,
    );
    let whole = impinge::query::MassProperties::<f64, 3>::new(one.1.into(), one.0, &one.2);
    let heavy = impinge::query::MassProperties::<f64, 3>::new(
        center,
        2.0 * mass,
        &(unit::<f64, 3>(&Ball::new(0.5)).2 * 2.0),
    );
    let found = super::wide(&body.expect("solids"));
    assert_alike(&found, &super::wide(&(whole + heavy)), 1e-2, "nested");
    // A custom composite of such a box and such a ball.
    let parts = vec![
        (
            Pose::from(at(-2.0, 0.0, 2.0)),
            Piece::of(Cuboid::new(Vector::<f64, 3>::new(1.0, 0.5, 0.25))),
        ),
        (Pose::from(at(1.0, 0.0, -1.0)), Piece::Shape(ball)),
    ];
    let pieces = Pieces::new(parts);
    check("pieces", &pieces, |p| pieces.contains_point(&Isometry::identity(), &Point::from(*p)));
}

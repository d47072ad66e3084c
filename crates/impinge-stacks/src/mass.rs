//! Mass properties of the solids of scenes, in closed form, at density 1.

use core::f64::consts::PI;

use impinge::dim2::transformation as plane;
use impinge::dim3::transformation as space;
use impinge::math::{Matrix, Point, Vector};
use impinge_scenes::{Placement, SceneShape};

use crate::{Mass, Solid};

/// Solids with known mass properties.
pub trait Weighed<const D: usize> {
    /// Returns mass, centre and inertia.
    ///
    /// # Panics
    /// If the solid has no volume, such as a mesh.
    fn mass(&self) -> Mass<D>;
}

impl Weighed<2> for Solid<2> {
    fn mass(&self) -> Mass<2> {
        sum(self, of_plane, |placement| {
            let turn = |v: [f64; 2]| placement.turned(&v);
            let ([a, b], [c, d]) = (turn([1.0, 0.0]), turn([0.0, 1.0]));
            Matrix::<f64, 3>::new(a, c, 0.0, b, d, 0.0, 0.0, 0.0, 1.0)
        })
    }
}

impl Weighed<3> for Solid<3> {
    fn mass(&self) -> Mass<3> {
        sum(self, of_space, |placement| {
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            Matrix::<f64, 3>::from_columns(&axes.map(|axis| placement.turned(&axis).into()))
        })
    }
}

/// Returns the sum of the mass properties of the parts, by Steiner's theorem.
fn sum<const D: usize>(
    solid: &Solid<D>,
    mass: fn(&SceneShape<D>) -> Mass<D>,
    rotation: fn(&Placement<D>) -> Matrix<f64, 3>,
) -> Mass<D> {
    let parts = match solid {
        Solid::One(shape) => return mass(shape),
        Solid::Compound(parts) => parts,
    };
    let placed = parts.iter().map(|(placement, shape)| {
        let own = mass(shape);
        let turn = rotation(placement);
        let inertia = turn * matrix(&own.inertia) * turn.transpose();
        (own.mass, lifted(&placement.point(&own.center)), inertia)
    });
    let placed: Vec<_> = placed.collect();
    let total: f64 = placed.iter().map(|part| part.0).sum();
    let weighted = placed.iter().fold(Vector::<f64, 3>::zeros(), |sum, part| sum + part.1 * part.0);
    let center = weighted / total;
    let inertia = placed.iter().fold(Matrix::<f64, 3>::zeros(), |sum, (mass, at, own)| {
        sum + own + steiner(&(at - center)) * *mass
    });
    finished(total, center, &inertia)
}

fn of_plane(shape: &SceneShape<2>) -> Mass<2> {
    match shape {
        SceneShape::Ball { radius } => {
            let mass = PI * radius * radius;
            about_origin(mass, [0.0, 0.0, mass * radius * radius / 2.0])
        }
        SceneShape::Cuboid { half_extents: [a, b] } => {
            let mass = 4.0 * a * b;
            about_origin(mass, [0.0, 0.0, mass * (a * a + b * b) / 3.0])
        }
        SceneShape::Capsule { half_height: h, radius: r } => {
            let (rest, ends) = (4.0 * h * r, PI * r * r);
            let of_ends = r * r / 2.0 + h * h + 8.0 * h * r / (3.0 * PI);
            let inertia = rest * (h * h + r * r) / 3.0 + ends * of_ends;
            about_origin(rest + ends, [0.0, 0.0, inertia])
        }
        SceneShape::Convex { points } => polygon(points),
        other => unreachable!("{other:?} has no mass in 2D"),
    }
}

/// Returns the mass properties of a convex polygon: the sum over the signed triangles from the
/// origin to each side.
fn polygon(points: &[[f64; 2]]) -> Mass<2> {
    let hull = plane::convex_hull(&rounded(points)).expect("the points span the plane");
    let corner = |n: usize| Vector::<f64, 2>::from(points[hull[n % hull.len()]]);
    let (mut area, mut first, mut second) = (0.0, Vector::<f64, 2>::zeros(), 0.0);
    for n in 0..hull.len() {
        let (a, b) = (corner(n), corner(n + 1));
        let twice = a.perp(&b);
        area += twice / 2.0;
        first += (a + b) * (twice / 6.0);
        second += (a.dot(&a) + a.dot(&b) + b.dot(&b)) * twice / 12.0;
    }
    let center = first / area;
    let inertia = second - area * center.dot(&center);
    let tensor = Matrix::<f64, 3>::from_diagonal(&Vector::<f64, 3>::new(0.0, 0.0, inertia));
    finished(area, Vector::<f64, 3>::new(center.x, center.y, 0.0), &tensor)
}

fn of_space(shape: &SceneShape<3>) -> Mass<3> {
    match shape {
        SceneShape::Ball { radius } => {
            let mass = 4.0 / 3.0 * PI * radius.powi(3);
            about_origin(mass, [0.4 * mass * radius * radius; 3])
        }
        SceneShape::Cuboid { half_extents } => {
            let mass = 8.0 * half_extents.iter().product::<f64>();
            let [a, b, c] = half_extents.map(|x| x * x * mass / 3.0);
            about_origin(mass, [b + c, a + c, a + b])
        }
        SceneShape::Cylinder { half_height: h, radius: r } => {
            let mass = 2.0 * PI * r * r * h;
            let (along, across) = (r * r / 2.0, r * r / 4.0 + h * h / 3.0);
            about_origin(mass, [across, along, across].map(|x| x * mass))
        }
        SceneShape::Cone { half_height: h, radius: r } => {
            let mass = 2.0 / 3.0 * PI * r * r * h;
            let (along, across) = (0.3 * r * r, 0.15 * (r * r + h * h));
            let made: Mass<3> = about_origin(mass, [across, along, across].map(|x| x * mass));
            Mass { center: [0.0, -h / 2.0, 0.0], ..made }
        }
        SceneShape::Capsule { half_height: h, radius: r } => {
            let (rest, ends) = (2.0 * PI * r * r * h, 4.0 / 3.0 * PI * r.powi(3));
            let along = rest * r * r / 2.0 + ends * 0.4 * r * r;
            let of_ends = 0.4 * r * r + h * h + 0.75 * h * r;
            let across = rest * (r * r / 4.0 + h * h / 3.0) + ends * of_ends;
            about_origin(rest + ends, [across, along, across])
        }
        SceneShape::Convex { points } => hull(points),
        other => unreachable!("{other:?} has no mass in 3D"),
    }
}

/// Returns the mass properties of a convex hull: the sum over the signed tetrahedra from the origin
/// to each triangle of each face, with the covariance of each in closed form. See Jonathan Blow and
/// Atman Binstock, "How to find the inertia tensor of a 3D solid body" (2004).
fn hull(points: &[[f64; 3]]) -> Mass<3> {
    let hull = space::convex_hull(&rounded(points)).expect("the points span space");
    let (mut volume, mut first) = (0.0, Vector::<f64, 3>::zeros());
    let mut second = Matrix::<f64, 3>::zeros();
    for face in &hull.faces {
        for n in 1..face.len() - 1 {
            let [a, b, c] =
                [face[0], face[n], face[n + 1]].map(|n| Vector::<f64, 3>::from(points[n]));
            let (six, sum) = (a.dot(&b.cross(&c)), a + b + c);
            volume += six / 6.0;
            first += sum * (six / 24.0);
            let squares = [a, b, c, sum].map(|v| v * v.transpose());
            second += squares.iter().sum::<Matrix<f64, 3>>() * (six / 120.0);
        }
    }
    let center = first / volume;
    let inertia = Matrix::<f64, 3>::identity() * second.trace() - second;
    finished(volume, center, &(inertia - steiner(&center) * volume))
}

fn about_origin<const D: usize>(mass: f64, diagonal: [f64; 3]) -> Mass<D> {
    finished(mass, Vector::<f64, 3>::zeros(), &Matrix::<f64, 3>::from_diagonal(&diagonal.into()))
}

fn finished<const D: usize>(
    mass: f64,
    center: Vector<f64, 3>,
    inertia: &Matrix<f64, 3>,
) -> Mass<D> {
    Mass { mass, center: core::array::from_fn(|n| center[n]), inertia: (*inertia).into() }
}

/// Returns the inertia tensor of a unit mass at a point.
fn steiner(at: &Vector<f64, 3>) -> Matrix<f64, 3> {
    Matrix::<f64, 3>::identity() * at.dot(at) - at * at.transpose()
}

/// Rounds points to `f32`, the scalar with which the library is always compiled.
#[expect(clippy::cast_possible_truncation, reason = "rounds to nearest")]
fn rounded<const D: usize>(points: &[[f64; D]]) -> Vec<Point<f32, D>> {
    points.iter().map(|point| Point::from(point.map(|x| x as f32))).collect()
}

fn matrix(rows: &[[f64; 3]; 3]) -> Matrix<f64, 3> {
    (*rows).into()
}

fn lifted<const D: usize>(point: &[f64; D]) -> Vector<f64, 3> {
    Vector::<f64, 3>::from_fn(|n, _| point.get(n).copied().unwrap_or(0.0))
}

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "sums that are compared within a bound")]
mod tests {
    use super::*;

    fn close<const D: usize>(a: &Mass<D>, b: &Mass<D>, share: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= share * a.abs().max(b.abs()) + 1e-6;
        let inertias = a.inertia.iter().flatten().zip(b.inertia.iter().flatten());
        near(a.mass, b.mass)
            && a.center.iter().zip(&b.center).all(|(a, b)| near(*a, *b))
            && inertias.into_iter().all(|(a, b)| near(*a, *b))
    }

    fn corners(half: [f64; 3]) -> Vec<[f64; 3]> {
        let sign = |n: usize, axis: usize| if n >> axis & 1 == 0 { -1.0 } else { 1.0 };
        (0..8).map(|n| core::array::from_fn(|axis| sign(n, axis) * half[axis])).collect()
    }

    /// Returns the corners of a regular polygon with many corners, at a height.
    fn ring(radius: f64, height: f64) -> impl Iterator<Item = [f64; 3]> {
        (0..400).map(move |n| {
            let (sine, cosine) = (f64::from(n) * PI / 200.0).sin_cos();
            [radius * cosine, height, radius * sine]
        })
    }

    #[test]
    fn a_box_by_hand_as_a_hull_and_as_two_halves() {
        let half = [0.5, 1.0, 1.5];
        let whole = Solid::One(SceneShape::Cuboid { half_extents: half }).mass();
        assert_eq!((whole.mass, whole.center), (6.0, [0.0; 3]));
        assert_eq!(whole.inertia[0][0], 6.0 / 12.0 * (4.0 + 9.0), "m/12 (height² + depth²)");
        let hull = Solid::One(SceneShape::Convex { points: corners(half) }).mass();
        assert!(close(&whole, &hull, 1e-6), "{hull:?}");
        let part = SceneShape::Cuboid { half_extents: [0.5, 0.5, 1.5] };
        // The lower half is rotated by half a turn, which does not change its shape.
        let turned =
            Placement { axis: [0.0, 1.0, 0.0], tangent: 1e9, ..Placement::at([0.0, -0.5, 0.0]) };
        let halves = vec![(Placement::at([0.0, 0.5, 0.0]), part.clone()), (turned, part)];
        assert!(close(&whole, &Solid::Compound(halves).mass(), 1e-6));
    }

    #[test]
    fn round_solids_as_hulls_of_many_corners() {
        let (half_height, radius) = (0.7, 0.5);
        let cylinder = Solid::One(SceneShape::Cylinder { half_height, radius }).mass();
        let points = ring(radius, -half_height).chain(ring(radius, half_height)).collect();
        assert!(close(&cylinder, &Solid::One(SceneShape::Convex { points }).mass(), 1e-3));
        let cone = Solid::One(SceneShape::Cone { half_height, radius }).mass();
        let points = ring(radius, -half_height).chain([[0.0, half_height, 0.0]]).collect();
        assert!(close(&cone, &Solid::One(SceneShape::Convex { points }).mass(), 1e-3));
        let capsule = Solid::One(SceneShape::Capsule { half_height, radius }).mass();
        let caps = (0..=40).flat_map(|n| {
            let (sine, cosine) = (f64::from(n) * PI / 80.0).sin_cos();
            let ring = move |sign: f64| ring(radius * cosine, sign * (half_height + radius * sine));
            ring(-1.0).chain(ring(1.0)).step_by(4)
        });
        let points = caps.collect();
        assert!(close(&capsule, &Solid::One(SceneShape::Convex { points }).mass(), 5e-3));
    }

    #[test]
    fn solids_of_the_plane_as_polygons() {
        let square = Solid::One(SceneShape::Cuboid { half_extents: [0.5, 1.0] }).mass();
        let points = vec![[-0.5, -1.0], [0.5, -1.0], [0.5, 1.0], [-0.5, 1.0]];
        assert!(close(&square, &Solid::One(SceneShape::Convex { points }).mass(), 1e-6));
        let expected = 2.0 / 12.0 * (1.0 + 4.0);
        assert!((square.inertia[2][2] - expected).abs() < 1e-15, "m/12 (width² + height²)");
        let (half_height, radius) = (0.7, 0.5);
        let capsule = Solid::One(SceneShape::Capsule { half_height, radius }).mass();
        let points = (0..2000).map(|n| {
            let (sine, cosine) = (f64::from(n) * PI / 1000.0).sin_cos();
            [radius * cosine, radius * sine + half_height.copysign(sine)]
        });
        let polygon = Solid::One(SceneShape::Convex { points: points.collect() }).mass();
        assert!(close(&capsule, &polygon, 1e-4), "{capsule:?} {polygon:?}");
    }
}

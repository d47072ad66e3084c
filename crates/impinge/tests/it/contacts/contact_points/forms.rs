//! Random solids of all kinds. Each has a function for the distance of a point from its surface,
//! computed in `f64` by `impinge_reference::geometry` or by a formula of this file. Convex solids
//! also have a description for `impinge_reference::precise`.
#![allow(dead_code, reason = "each test binary uses a part")]

use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid,
    HeightField, Plane, Polyline, Rounded, Segment, Shape, ShapeHandle, TaperedCapsule, TriMesh,
    Triangle,
};
use impinge_reference::geometry::vector::{add, dot, norm, scale, sub};
use impinge_reference::geometry::{PointMeter, Solid};
use impinge_reference::precise;
use impinge_reference::random::Random;

use super::query_support::solids::RoundHull;

/// Distance of a local point from the surface of a solid, or of one part of a composite.
type Off<const D: usize> = Box<dyn Fn(&[f64; D]) -> f64>;

/// A shape under test, with what the tests know about it.
pub(crate) struct Form<N: Real, const D: usize> {
    pub(crate) shape: ShapeHandle<N, D>,
    /// Description of the solid, for messages.
    pub(crate) text: String,
    /// The solid for `impinge_reference::precise`; `None` for composites.
    pub(crate) precise: Option<precise::Solid<D>>,
    offs: Vec<Off<D>>,
    /// Greatest distance of a point of the solid from the local origin; zero for a half-space.
    pub(crate) reach: f64,
    /// Error allowed for contact points other than the deepest, as a length. The library treats a
    /// tilted face of a rounded solid as flat up to its edges, so points near the edges are off the
    /// rounded surface.
    pub(crate) beside: f64,
}

/// Allowed error per unit of radius: `1 / cos(a) - 1` for a face tilted by `a = atan(1 / 2)`.
const LEANING: f64 = 0.1181;

impl<N: Real, const D: usize> Form<N, D> {
    fn new<S: Shape<N, D>>(shape: S, text: String, reach: f64, offs: Vec<Off<D>>) -> Self {
        Self { shape: ShapeHandle::new(shape), text, precise: None, offs, reach, beside: 0.0 }
    }

    /// Adds the description for `impinge_reference::precise`.
    fn with(self, precise: precise::Solid<D>) -> Self {
        Self { precise: Some(precise), ..self }
    }

    /// Creates the form of a shape that equals `solid`, a solid of `impinge_reference::geometry`,
    /// inflated by the radius `inflation`.
    fn known<S: Shape<N, D>>(shape: S, solid: &Solid<D>, inflation: f64) -> Self {
        let reach = solid.bounding_radius();
        let reach = if reach.is_finite() { reach + inflation } else { 0.0 };
        let text = format!("{solid:?} inflated by {inflation}");
        Self {
            beside: LEANING * inflation,
            precise: with_all_digits(solid).map(|solid| solid.inflated(inflation)),
            ..Self::new(shape, text, reach, vec![metered(solid, inflation)])
        }
    }

    /// Creates the form of a composite whose parts equal `parts`, solids of
    /// `impinge_reference::geometry`.
    fn composite<S: Shape<N, D>>(shape: S, parts: &[Solid<D>]) -> Self {
        let reach = parts.iter().map(Solid::bounding_radius).fold(0.0, f64::max);
        let offs = parts.iter().map(|part| metered(part, 0.0)).collect();
        Self::new(shape, format!("{parts:?}"), reach, offs)
    }

    /// Returns the distance of a local point from the surface; for a composite, from the surface of
    /// its nearest part.
    pub(crate) fn off(&self, point: &[f64; D]) -> f64 {
        self.offs.iter().map(|off| off(point).abs()).fold(f64::INFINITY, f64::min)
    }
}

/// Returns the solid for `impinge_reference::precise`; `None` for cylinders and cones, which exist
/// in 3D only.
fn with_all_digits<const D: usize>(solid: &Solid<D>) -> Option<precise::Solid<D>> {
    match solid {
        Solid::Rounded { vertices, radius } => {
            Some(precise::Solid::round_polytope(vertices.clone(), *radius))
        }
        Solid::HalfSpace { normal } => Some(precise::Solid::half_space(*normal)),
        Solid::Cylinder { .. } | Solid::Cone { .. } => None,
    }
}

fn metered<const D: usize>(solid: &Solid<D>, inflation: f64) -> Off<D> {
    let meter = PointMeter::new(solid);
    Box::new(move |point| meter.measure(point).0 - inflation)
}

/// Range of the lengths of random solids, and whether some of them are zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    /// Lengths lie between `least` and `16 * least`.
    pub(crate) least: f64,
    /// Whether half of the lengths are zero, and corners lie on a line or coincide. Polygons and
    /// hulls are exempt.
    pub(crate) zeros: bool,
}

/// Draws sizes and points that the scalar represents exactly.
struct Draw<'a> {
    random: &'a mut Random,
    sizes: Sizes,
}

impl Draw<'_> {
    fn size<N: Real>(&mut self) -> f64 {
        if self.sizes.zeros && self.random.chance(0.5) {
            return 0.0;
        }
        self.length::<N>()
    }

    /// Returns a random length that is not zero.
    fn length<N: Real>(&mut self) -> f64 {
        N::lit(self.random.magnitude(self.sizes.least, 4)).as_f64()
    }

    fn sizes<N: Real, const D: usize>(&mut self) -> [f64; D] {
        std::array::from_fn(|_| self.size::<N>())
    }

    /// Returns the corners of a segment, triangle or tetrahedron that is not thin. With `zeros`,
    /// all corners lie on a line.
    fn corners<N: Real, const D: usize, const K: usize>(&mut self) -> [[f64; D]; K] {
        if self.sizes.zeros {
            return self.corners_of_line::<N, D, K>();
        }
        loop {
            let limit = self.length::<N>();
            let corners: [[f64; D]; K] =
                std::array::from_fn(|_| self.random.vector::<D>(limit).map(|x| N::lit(x).as_f64()));
            let side = |corner: usize| sub(&corners[corner], &corners[0]);
            let apart = |a: [f64; D], b: [f64; D]| dot(&a, &b).abs() < 0.8 * norm(&a) * norm(&b);
            let is_wide = (1..K).all(|corner| norm(&side(corner)) > 0.3 * limit)
                && (2..K).all(|corner| apart(side(corner), side(corner - 1)));
            // Triangles in 2D must be counter-clockwise.
            let is_left = D != 2 || K < 3 || side(1)[0] * side(2)[1] > side(1)[1] * side(2)[0];
            if is_wide && is_left {
                return corners;
            }
        }
    }
}

impl Draw<'_> {
    /// Returns corners on a line through the origin, some of which may coincide.
    fn corners_of_line<N: Real, const D: usize, const K: usize>(&mut self) -> [[f64; D]; K] {
        let limit = self.length::<N>();
        let end = self.random.vector::<D>(limit).map(|x| N::lit(x).as_f64());
        std::array::from_fn(|_| scale(&end, *self.random.pick(&[0.0, 1.0, -1.0, 0.5])))
    }
}

fn point<N: Real, const D: usize>(p: &[f64; D]) -> Point<N, D> {
    Point::from(p.map(N::lit))
}

fn vector<N: Real, const D: usize>(v: &[f64; D]) -> Vector<N, D> {
    Vector::from(v.map(N::lit))
}

fn up<const D: usize>(length: f64) -> [f64; D] {
    std::array::from_fn(|axis| if axis == 1 { length } else { 0.0 })
}

const COMMON: usize = 12;

/// Returns a random solid of kind `kind`, of the kinds that exist in both dimensions.
fn common<N: Space<D>, const D: usize>(kind: usize, draw: &mut Draw<'_>) -> Form<N, D> {
    let (half, radius, sizes) = (draw.size::<N>(), draw.size::<N>(), draw.sizes::<N, D>());
    let cuboid = || Cuboid::new(vector::<N, D>(&sizes));
    match kind {
        0 => Form::known(Ball::new(N::lit(radius)), &Solid::ball(radius), 0.0),
        1 => {
            let [a, b] = draw.corners::<N, D, 2>();
            Form::known(Segment::new(point(&a), point(&b)), &Solid::segment(a, b), 0.0)
        }
        2 => {
            let capsule = Capsule::<N, D>::new(N::lit(half), N::lit(radius));
            Form::known(capsule, &Solid::segment(up(-half), up(half)), radius)
        }
        3 => {
            let [a, b, c] = draw.corners::<N, D, 3>();
            let triangle = Triangle::<N, D>::new(point(&a), point(&b), point(&c));
            Form::known(triangle, &Solid::triangle(a, b, c), 0.0)
        }
        4 => Form::known(cuboid(), &Solid::cuboid(sizes), 0.0),
        5 => {
            let (shape, text) =
                (Ellipsoid::new(vector::<N, D>(&sizes)), format!("ellipsoid of {sizes:?}"));
            let most = sizes.iter().copied().fold(0.0, f64::max);
            let form = Form::new(shape, text, most, vec![off_ellipsoid(sizes)]);
            form.with(precise::Solid::ellipsoid(sizes))
        }
        6 => tapered(half, [radius, draw.size::<N>()]),
        7 => Form::known(Rounded::new(cuboid(), N::lit(radius)), &Solid::cuboid(sizes), radius),
        8 => {
            let [a, b, c] = draw.corners::<N, D, 3>();
            let triangle = Triangle::<N, D>::new(point(&a), point(&b), point(&c));
            let rounded = Rounded::new(triangle, N::lit(radius));
            Form::known(rounded, &Solid::triangle(a, b, c), radius)
        }
        9 => {
            let corners = draw.corners::<N, D, 3>();
            let points = corners.iter().map(point).collect();
            let hull = RoundHull { points, rounding: N::lit(radius) };
            Form::known(hull, &Solid::polytope(corners.to_vec()), radius)
        }
        10 => {
            let normal = Unit::new_unchecked(vector::<N, D>(&up(1.0)));
            Form::known(Plane::<N, D>::new(normal), &Solid::half_space(up(1.0)), 0.0)
        }
        _ => {
            let [a, b, c] = draw.corners::<N, D, 3>();
            let line = Polyline::open([a, b, c].iter().map(point).collect());
            Form::composite(line, &[Solid::segment(a, b), Solid::segment(b, c)])
        }
    }
}

/// Returns a function for the signed distance of a point from the surface of an ellipsoid, accurate
/// to first order in that distance. For a flat ellipsoid the function uses the precise reference.
fn off_ellipsoid<const D: usize>(half_axes: [f64; D]) -> Off<D> {
    if half_axes.contains(&0.0) {
        // A flat ellipsoid consists of its surface.
        let solid = precise::Solid::ellipsoid(half_axes);
        return Box::new(move |point| off_precise(&solid, point));
    }
    Box::new(move |point| {
        let once: [f64; D] = std::array::from_fn(|axis| point[axis] / half_axes[axis]);
        let twice: [f64; D] = std::array::from_fn(|axis| once[axis] / half_axes[axis]);
        if norm(&twice) == 0.0 {
            return -half_axes.iter().copied().fold(f64::INFINITY, f64::min);
        }
        norm(&once) * (norm(&once) - 1.0) / norm(&twice)
    })
}

/// Returns the distance of a local point from the surface of a solid, by
/// `impinge_reference::precise`, which is slow.
fn off_precise<const D: usize>(solid: &precise::Solid<D>, point: &[f64; D]) -> f64 {
    let (place, origin) = (precise::Pose::at(*point), precise::Pose::at([0.0; D]));
    let dot = precise::Solid::ball(0.0);
    precise::signed_distance(&dot, &place, solid, &origin).distance.to_f64()
}

/// Creates a tapered capsule along the y axis, with the radius `radii[0]` at `-half` and `radii[1]`
/// at `half`.
fn tapered<N: Space<D>, const D: usize>(half: f64, radii: [f64; 2]) -> Form<N, D> {
    let [low, high] = radii.map(N::lit);
    let shape = TaperedCapsule::<N, D>::new(N::lit(half), low, high);
    let off = move |point: &[f64; D]| {
        let (length, growth) = (2.0 * half, radii[1] - radii[0]);
        let (along, axis) = (point[1] + half, up::<D>(point[1]));
        let aside = norm(&sub(point, &axis));
        let ball =
            |share: f64| norm(&sub(point, &up(share * length - half))) - radii[0] - growth * share;
        let lean = length * length - growth * growth;
        if lean <= 0.0 {
            return ball(0.0).min(ball(1.0));
        }
        ball(((along + aside * growth / lean.sqrt()) / length).clamp(0.0, 1.0))
    };
    let text = format!("tapered capsule of {half} and {radii:?}");
    let most = radii[0].max(radii[1]);
    let form = Form::new(shape, text, half + most, vec![Box::new(off)]);
    let [low, high] = radii;
    let precise = precise::Solid::tapered_capsule(up(-half), low, up(half), high);
    Form { beside: LEANING * most, ..form.with(precise) }
}

pub(crate) const PLANE: [&str; COMMON + 4] = [
    "ball",
    "segment",
    "capsule",
    "triangle",
    "cuboid",
    "ellipsoid",
    "tapered capsule",
    "rounded cuboid",
    "rounded triangle",
    "support map",
    "half-space",
    "polyline",
    "polygon",
    "rounded polygon",
    "height field",
    "compound",
];

pub(crate) fn plane<N: Real>(kind: usize, sizes: Sizes, random: &mut Random) -> Form<N, 2> {
    let mut draw = Draw { random, sizes };
    if kind < COMMON {
        return common(kind, &mut draw);
    }
    let (half, radius) = (draw.length::<N>(), draw.length::<N>());
    let sizes = [draw.length::<N>(), draw.length::<N>()];
    let corners = [[1.0, 0.0], [0.75, 0.75], [0.0, 1.0], [-1.0, 0.5], [-0.5, -1.0], [0.5, -0.75]]
        .map(|[x, y]| [x * sizes[0], y * sizes[1]].map(|x| N::lit(x).as_f64()));
    let points: Vec<_> = corners.iter().map(point).collect();
    let solid = Solid::polytope(corners.to_vec());
    match kind - COMMON {
        0 => Form::known(ConvexPolygon::<N>::from_points(&points), &solid, 0.0),
        1 => {
            let polygon = ConvexPolygon::<N>::from_points(&points);
            Form::known(Rounded::new(polygon, N::lit(radius)), &solid, radius)
        }
        2 => {
            let heights = (0..5).map(|_| N::lit(draw.random.single(-0.5, 0.5))).collect();
            let field = HeightField::<N, 2>::new(heights, vector(&[half * 8.0, radius]));
            let cells = (0..4).filter_map(|cell| field.segment(cell));
            let ends =
                |segment: Segment<N, 2>| Solid::segment(wide(segment.a()), wide(segment.b()));
            let parts: Vec<_> = cells.map(ends).collect();
            Form::composite(field, &parts)
        }
        _ => {
            let at = [half, radius].map(N::lit);
            let cuboid = ShapeHandle::new(Cuboid::new(vector::<N, 2>(&sizes)));
            let children = vec![
                (Isometry2::translation(at[0], at[1]), ShapeHandle::new(Ball::new(N::lit(radius)))),
                (Isometry2::identity(), cuboid),
            ];
            let ball = Solid::capsule([half, radius], [half, radius], radius);
            Form::composite(Compound::new(children), &[ball, Solid::cuboid(sizes)])
        }
    }
}

pub(crate) const SPACE: [&str; COMMON + 11] = [
    "ball",
    "segment",
    "capsule",
    "triangle",
    "cuboid",
    "ellipsoid",
    "tapered capsule",
    "rounded cuboid",
    "rounded triangle",
    "support map",
    "half-space",
    "polyline",
    "cylinder",
    "cone",
    "rounded cylinder",
    "rounded cone",
    "hull",
    "rounded hull",
    "thin box",
    "mesh",
    "closed mesh",
    "height field",
    "compound",
];

pub(crate) fn space<N: Real>(kind: usize, sizes: Sizes, random: &mut Random) -> Form<N, 3> {
    let mut draw = Draw { random, sizes };
    if kind < COMMON {
        return common(kind, &mut draw);
    }
    let (half, radius, inflation) = (draw.size::<N>(), draw.size::<N>(), draw.size::<N>());
    let [h, r, s] = [half, radius, inflation].map(N::lit);
    let cylinder = Solid::Cylinder { half_height: half, radius };
    let cone = Solid::Cone { half_height: half, radius };
    let exact = [precise::Solid::cylinder(half, radius), precise::Solid::cone(half, radius)];
    let [exact_cylinder, exact_cone] = exact;
    match kind - COMMON {
        0 => Form::known(Cylinder::new(h, r), &cylinder, 0.0).with(exact_cylinder),
        1 => Form::known(Cone::new(h, r), &cone, 0.0).with(exact_cone),
        2 => Form::known(Rounded::new(Cylinder::new(h, r), s), &cylinder, inflation)
            .with(exact_cylinder.inflated(inflation)),
        3 => Form::known(Rounded::new(Cone::new(h, r), s), &cone, inflation)
            .with(exact_cone.inflated(inflation)),
        4 => hull(&mut draw, 0.0),
        5 => hull(&mut draw, inflation),
        6 => {
            let sizes = [half * 4.0, N::lit(radius / 256.0).as_f64(), inflation * 4.0];
            Form::known(Cuboid::new(vector::<N, 3>(&sizes)), &Solid::cuboid(sizes), 0.0)
        }
        7 => floor(half * 8.0, |_| 0.0),
        8 => {
            let corners = draw.corners::<N, 3, 4>();
            let volume = dot(&cross(&corners), &sub(&corners[3], &corners[0]));
            let faces: [[u32; 3]; 4] = if volume < 0.0 {
                [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
            } else {
                [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
            };
            meshed(&corners, faces.to_vec())
        }
        9 => {
            let heights = (0..9).map(|_| N::lit(draw.random.single(-0.5, 0.5))).collect();
            let size = vector(&[half * 8.0, inflation, radius * 8.0]);
            let field = HeightField::<N, 3>::new(3, 3, heights, size);
            let cells =
                [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(row, column)| field.triangles(row, column));
            let triangles = cells.into_iter().flatten().flatten().map(|triangle| {
                let [a, b, c] = triangle.corners().each_ref().map(wide);
                Solid::triangle(a, b, c)
            });
            let parts: Vec<_> = triangles.collect();
            Form::composite(field, &parts)
        }
        _ => {
            let children = vec![
                (Isometry3::translation(r, s, h), ShapeHandle::new(Ball::new(r))),
                (Isometry3::identity(), ShapeHandle::new(Cone::new(h, s))),
            ];
            let ball = Solid::capsule([radius, inflation, half], [radius, inflation, half], radius);
            let cone = Solid::Cone { half_height: half, radius: inflation };
            Form::composite(Compound::new(children), &[ball, cone])
        }
    }
}

fn wide<N: Real, const D: usize>(point: &Point<N, D>) -> [f64; D] {
    point.coords.map(N::as_f64).into()
}

fn cross([a, b, c, _]: &[[f64; 3]; 4]) -> [f64; 3] {
    let (e, f) = (sub(b, a), sub(c, a));
    [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
}

/// Returns a hull of ten random points around the origin.
fn hull<N: Real>(draw: &mut Draw<'_>, inflation: f64) -> Form<N, 3> {
    let sizes: [f64; 3] = std::array::from_fn(|_| draw.length::<N>());
    let corners: Vec<[f64; 3]> = (0..10)
        .map(|_| {
            let direction: [f64; 3] = draw.random.unit_vector();
            std::array::from_fn(|axis| N::lit(direction[axis] * sizes[axis]).as_f64())
        })
        .collect();
    let hull = ConvexHull::<N>::from_points(&corners.iter().map(point).collect::<Vec<_>>());
    let solid = Solid::polytope(hull.vertices().iter().map(wide).collect());
    if inflation > 0.0 {
        return Form::known(Rounded::new(hull, N::lit(inflation)), &solid, inflation);
    }
    Form::known(hull, &solid, 0.0)
}

/// Returns a mesh of eight triangles over a square of four cells; `height` maps the index of each
/// of the nine vertices to its height.
fn floor<N: Real>(half: f64, height: impl Fn(usize) -> f64) -> Form<N, 3> {
    let corner = |index: usize| {
        let at = |step: usize| half * [-1.0, 0.0, 1.0][step];
        add(&scale(&[1.0, 0.0, 0.0], at(index / 3)), &[0.0, height(index), at(index % 3)])
    };
    let corners: Vec<_> = (0..9).map(corner).collect();
    let triangles = [0, 1, 3, 4].map(|low: u32| [[low, low + 1, low + 4], [low, low + 4, low + 3]]);
    meshed(&corners, triangles.into_iter().flatten().collect())
}

fn meshed<N: Real>(corners: &[[f64; 3]], triangles: Vec<[u32; 3]>) -> Form<N, 3> {
    let mesh = TriMesh::<N, 3>::new(corners.iter().map(point).collect(), triangles.clone());
    let solid = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
        Solid::triangle(a, b, c)
    };
    let parts: Vec<_> = triangles.iter().map(solid).collect();
    Form::composite(mesh, &parts)
}

/// Returns a world point in the frame of the solid at `pose`, by the matrix of `pose`.
pub(crate) fn local<N: Real, const D: usize>(pose: &Pose<N, D>, point: &Point<N, D>) -> [f64; D] {
    let away = point.coords.map(N::as_f64) - pose.translation.map(N::as_f64);
    pose.rotation.map(N::as_f64).tr_mul(&away).into()
}

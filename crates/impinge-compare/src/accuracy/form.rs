//! Solids and placements as plain numbers: the common input of all contenders and of the reference.

use impinge_reference::geometry::vector::{dot, norm, scale, sub};
use impinge_reference::precise::{Quad, Solid};
use impinge_reference::random::Random;

/// The scalar type with which the contenders compute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scalar {
    F32,
    F64,
}

impl Scalar {
    pub const ALL: [Self; 2] = [Self::F32, Self::F64];

    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// Rounds `x` to the nearest number that the scalar can represent.
    pub fn rounded(self, x: f64) -> f64 {
        match self {
            Self::F32 => f64::from(x as f32),
            Self::F64 => x,
        }
    }

    pub fn vector<const D: usize>(self, v: &[f64; D]) -> [f64; D] {
        v.map(|x| self.rounded(x))
    }

    pub fn epsilon(self) -> f64 {
        match self {
            Self::F32 => f64::from(f32::EPSILON),
            Self::F64 => f64::EPSILON,
        }
    }

    /// Returns the first vector of `draw` that, rounded to the scalar, has a squared length within
    /// epsilon / 64 of 1. Panics after 100,000 draws.
    pub fn unit<const D: usize>(self, mut draw: impl FnMut() -> [f64; D]) -> [f64; D] {
        const TRIES: usize = 100_000;
        for _ in 0..TRIES {
            let v = self.vector(&draw());
            let square = v.iter().fold(Quad::ZERO, |sum, &x| sum + Quad::new(x) * Quad::new(x));
            if (square - Quad::ONE).abs().to_f64() <= self.epsilon() / 64.0 {
                return v;
            }
        }
        panic!("no unit vector among {TRIES}")
    }
}

/// The kinds of solids that are compared; `PLANE` and `SPACE` list those of each dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Ball,
    Cuboid,
    Capsule,
    Segment,
    Triangle,
    Convex,
    Cylinder,
    Cone,
    Ellipsoid,
    Tapered,
    RoundCuboid,
    HalfSpace,
}

impl Kind {
    pub const PLANE: &[Self] = &[
        Self::Ball,
        Self::Cuboid,
        Self::Capsule,
        Self::Segment,
        Self::Triangle,
        Self::Convex,
        Self::Ellipsoid,
        Self::Tapered,
        Self::RoundCuboid,
        Self::HalfSpace,
    ];
    pub const SPACE: &[Self] = &[
        Self::Ball,
        Self::Cuboid,
        Self::Capsule,
        Self::Segment,
        Self::Triangle,
        Self::Convex,
        Self::Cylinder,
        Self::Cone,
        Self::Ellipsoid,
        Self::Tapered,
        Self::RoundCuboid,
        Self::HalfSpace,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Cuboid => "cuboid",
            Self::Capsule => "capsule",
            Self::Segment => "segment",
            Self::Triangle => "triangle",
            Self::Convex => "convex",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Ellipsoid => "ellipsoid",
            Self::Tapered => "tapered capsule",
            Self::RoundCuboid => "round cuboid",
            Self::HalfSpace => "half-space",
        }
    }

    /// Returns a random solid of this kind; its lengths are mostly between 0.1 and 1.6.
    pub fn draw<const D: usize>(self, random: &mut Random, scalar: Scalar) -> Form<D> {
        let mut size = || scalar.rounded(random.magnitude(0.1, 4));
        let (half_height, radius) = (size(), size());
        match self {
            Self::Ball => Form::Ball { radius },
            Self::Cuboid => Form::Cuboid { half_extents: std::array::from_fn(|_| size()) },
            Self::Capsule => Form::Capsule { half_height, radius },
            Self::Segment => Form::Segment(apart(random, scalar)),
            Self::Triangle => Form::Triangle(wide(random, scalar)),
            Self::Convex => Form::Convex(around(random, scalar)),
            Self::Cylinder => Form::Cylinder { half_height, radius },
            Self::Cone => Form::Cone { half_height, radius },
            Self::Ellipsoid => Form::Ellipsoid { half_axes: std::array::from_fn(|_| size()) },
            Self::Tapered => Form::Tapered { half_height, radii: [radius, size()] },
            Self::RoundCuboid => {
                Form::RoundCuboid { half_extents: std::array::from_fn(|_| size()), radius }
            }
            Self::HalfSpace => Form::HalfSpace { normal: scalar.unit(|| random.unit_vector()) },
        }
    }
}

/// Returns the ends of a segment longer than 0.1.
fn apart<const D: usize>(random: &mut Random, scalar: Scalar) -> [[f64; D]; 2] {
    loop {
        let limit = random.magnitude(0.1, 4);
        let ends = [(); 2].map(|()| scalar.vector(&random.vector(limit)));
        if norm(&sub(&ends[0], &ends[1])) > 0.1 {
            return ends;
        }
    }
}

/// Returns the corners of a triangle, counter-clockwise in 2D. It is not degenerate: at the first
/// corner the cosine of the angle is less than 0.95 in magnitude, and both edges are longer than
/// 0.05.
fn wide<const D: usize>(random: &mut Random, scalar: Scalar) -> [[f64; D]; 3] {
    loop {
        let limit = random.magnitude(0.1, 4);
        let [a, b, c] = [(); 3].map(|()| scalar.vector(&random.vector::<D>(limit)));
        let (e, f) = (sub(&b, &a), sub(&c, &a));
        let cosine = dot(&e, &f) / (norm(&e) * norm(&f));
        let is_left = D != 2 || e[0] * f[1] > e[1] * f[0];
        if is_left && cosine.abs() < 0.95 && norm(&e).min(norm(&f)) > 0.05 {
            return [a, b, c];
        }
    }
}

/// Returns points on a random ellipsoid, rounded to the scalar. No two are nearer than 0.3 on the
/// unit ball before it is stretched, so that all are vertices of their convex hull.
fn around<const D: usize>(random: &mut Random, scalar: Scalar) -> Vec<[f64; D]> {
    let axes: [f64; D] = std::array::from_fn(|_| random.magnitude(0.2, 3));
    let count = if D == 2 { 3 + random.below(6) } else { 4 + random.below(9) };
    let mut points: Vec<[f64; D]> = Vec::new();
    while points.len() < count {
        let direction: [f64; D] = random.unit_vector();
        let is_free = points.iter().all(|p| norm(&sub(p, &direction)) > 0.3);
        if is_free {
            points.push(direction);
        }
    }
    let stretched = |p: &[f64; D]| scalar.vector(&std::array::from_fn(|i| p[i] * axes[i]));
    points.iter().map(stretched).collect()
}

/// A solid in its own frame.
#[derive(Clone, Debug)]
pub enum Form<const D: usize> {
    Ball {
        radius: f64,
    },
    Cuboid {
        half_extents: [f64; D],
    },
    Capsule {
        half_height: f64,
        radius: f64,
    },
    Segment([[f64; D]; 2]),
    Triangle([[f64; D]; 3]),
    Convex(Vec<[f64; D]>),
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    Cone {
        half_height: f64,
        radius: f64,
    },
    Ellipsoid {
        half_axes: [f64; D],
    },
    /// The convex hull of two balls with centres at `-half_height` and `half_height` on the second
    /// axis. `radii` are those of the lower and the upper ball.
    Tapered {
        half_height: f64,
        radii: [f64; 2],
    },
    RoundCuboid {
        half_extents: [f64; D],
        radius: f64,
    },
    HalfSpace {
        normal: [f64; D],
    },
}

impl<const D: usize> Form<D> {
    /// Returns the solid for the reference; `None` for cylinders and cones, which exist in 3D only.
    pub fn solid(&self) -> Option<Solid<D>> {
        Some(match self {
            Self::Ball { radius } => Solid::ball(*radius),
            Self::Cuboid { half_extents } => Solid::round_cuboid(*half_extents, 0.0),
            Self::Capsule { half_height, radius } => {
                let up = up(*half_height);
                Solid::capsule(scale(&up, -1.0), up, *radius)
            }
            Self::Ellipsoid { half_axes } => Solid::ellipsoid(*half_axes),
            Self::Tapered { half_height, radii: [low, high] } => {
                let up = up(*half_height);
                Solid::tapered_capsule(scale(&up, -1.0), *low, up, *high)
            }
            Self::RoundCuboid { half_extents, radius } => {
                Solid::round_cuboid(*half_extents, *radius)
            }
            Self::Segment([a, b]) => Solid::capsule(*a, *b, 0.0),
            Self::Triangle(corners) => Solid::polytope(corners.to_vec()),
            Self::Convex(points) => Solid::polytope(points.clone()),
            Self::HalfSpace { normal } => Solid::half_space(*normal),
            Self::Cylinder { .. } | Self::Cone { .. } => return None,
        })
    }
}

fn up<const D: usize>(length: f64) -> [f64; D] {
    std::array::from_fn(|i| if i == 1 { length } else { 0.0 })
}

/// The pose of a solid.
#[derive(Clone, Copy, Debug)]
pub struct Placement<const D: usize> {
    pub translation: [f64; D],
    /// The quaternion `[x, y, z, w]` in 3D; `[cosine, sine, 0, 0]` in 2D.
    pub rotation: [f64; 4],
}

/// Two placed solids.
#[derive(Clone, Debug)]
pub struct Sample<const D: usize> {
    pub forms: [Form<D>; 2],
    pub placements: [Placement<D>; 2],
}

/// The result of a contender for a sample.
#[derive(Clone, Copy, Debug)]
pub enum Outcome<const D: usize> {
    /// The contender has no algorithm for the pair.
    Unsupported,
    /// The contender has an algorithm, but reports no contact within the prediction.
    Nothing {
        /// The distance that the contender returns.
        distance: f64,
    },
    /// The contender reports a distance and a contact.
    Found {
        /// The distance; zero if the solids overlap.
        distance: f64,
        /// The signed distance of the contact; negative if the solids overlap.
        signed: f64,
        /// The normal, from the first solid to the second.
        normal: [f64; D],
    },
}

/// A contender's queries for one sample: the distance, and the contact. The second argument is the
/// prediction of the contact.
pub type Ask<const D: usize> = fn(&Sample<D>, f64) -> Outcome<D>;

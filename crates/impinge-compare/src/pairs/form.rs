//! The solids of the suite as plain data. Each is about 1 in size and lies around the origin of its
//! frame.

use impinge_reference::geometry::vector::{dot, norm, perpendicular, scale, sub};
use impinge_reference::random::Random;

/// A solid in its local frame. Heights and axes are along the second coordinate.
#[derive(Clone, Debug)]
pub enum Form<const D: usize> {
    Ball(f64),
    Cuboid([f64; D]),
    RoundCuboid { half_extents: [f64; D], radius: f64 },
    Capsule { half_height: f64, radius: f64 },
    Cylinder { half_height: f64, radius: f64 },
    Cone { half_height: f64, radius: f64 },
    Segment([[f64; D]; 2]),
    Triangle([[f64; D]; 3]),
    Convex(Vec<[f64; D]>),
    HalfSpace,
    Mesh(Terrain),
    HeightField(Terrain),
    Polyline(Terrain),
}

/// A terrain around the origin: hills over a square of cells in 3D, over a row of cells in 2D.
#[derive(Clone, Copy, Debug)]
pub struct Terrain {
    /// The number of cells along each horizontal axis.
    pub cells: u32,
    /// The side length of a cell.
    pub side: f64,
    /// The greatest height above zero, and the greatest depth below zero.
    pub height: f64,
}

/// A solid with its name.
#[derive(Clone, Debug)]
pub struct Solid<const D: usize> {
    pub name: &'static str,
    pub form: Form<D>,
    /// Directions in the local frame along which the solid has a face or a straight side: outward
    /// normals of faces, or directions perpendicular to an axis.
    pub flats: Vec<[f64; D]>,
    /// For a terrain, a smaller version about 1 across, which is used as the second solid of a pair
    /// of two terrains; otherwise `None`.
    pub patch: Option<Form<D>>,
}

impl<const D: usize> Solid<D> {
    fn new(name: &'static str, form: Form<D>, flats: Vec<[f64; D]>) -> Self {
        Self { name, form, flats, patch: None }
    }

    /// Returns `true` for a half-space or a terrain. Such a solid is the fixed first solid of all
    /// pairs of a case.
    pub fn is_ground(&self) -> bool {
        matches!(self.form, Form::HalfSpace) || self.patch.is_some()
    }

    fn ground(name: &'static str, form: fn(Terrain) -> Form<D>, cells: u32) -> Self {
        let wide = Terrain { cells, side: 1.0, height: 0.3 };
        let patch = Terrain { cells: 8, side: 0.15, height: 0.05 };
        Self { name, form: form(wide), flats: vec![up()], patch: Some(form(patch)) }
    }
}

impl Terrain {
    /// Returns the distance from one border to the opposite one.
    pub fn extent(&self) -> f64 {
        f64::from(self.cells) * self.side
    }

    /// Returns the height of the vertex with these indices: a sum of waves with several periods,
    /// without trigonometry.
    pub fn height(&self, [x, z]: [u32; 2]) -> f64 {
        self.height * (wave(x, 11) + wave(z, 13) + wave(x + 2 * z, 17)) / 3.0
    }

    /// Returns the height of the vertex nearest to a horizontal position.
    pub fn height_at(&self, [x, z]: [f64; 2]) -> f64 {
        let number = |x: f64| ((x + self.extent() / 2.0) / self.side).round() as u32;
        self.height([number(x), number(z)])
    }

    fn along(&self, number: u32) -> f64 {
        f64::from(number) * self.side - self.extent() / 2.0
    }

    /// Returns the vertices, row by row: x grows within a row, z from row to row.
    pub fn vertices(&self) -> Vec<[f64; 3]> {
        let vertex = |[x, z]: [u32; 2]| [self.along(x), self.height([x, z]), self.along(z)];
        self.numbers().map(vertex).collect()
    }

    /// Returns the heights of the vertices, row by row.
    pub fn heights(&self) -> Vec<f64> {
        self.numbers().map(|at| self.height(at)).collect()
    }

    fn numbers(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let count = self.cells + 1;
        (0..count).flat_map(move |z| (0..count).map(move |x| [x, z]))
    }

    /// Returns two triangles for each cell, counter-clockwise when seen from above.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let (cells, row) = (self.cells, self.cells + 1);
        let corners = (0..cells).flat_map(|z| (0..cells).map(move |x| z * row + x));
        corners.flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]]).collect()
    }

    /// Returns the vertices of a polyline in 2D, from right to left, so that its front side is
    /// above.
    pub fn line(&self) -> Vec<[f64; 2]> {
        let vertex = |x: u32| [self.along(x), self.height([x, 0])];
        (0..=self.cells).rev().map(vertex).collect()
    }
}

/// Returns a periodic wave at `n`, from −1 to 1, made of alternating parabolas.
fn wave(n: u32, period: u32) -> f64 {
    let phase = f64::from(n % period) / f64::from(period) * 2.0;
    let (sign, share) = if phase < 1.0 { (1.0, phase) } else { (-1.0, phase - 1.0) };
    sign * 4.0 * share * (1.0 - share)
}

/// Returns the unit vector along the second axis.
pub fn up<const D: usize>() -> [f64; D] {
    axis(1, 1.0)
}

fn axis<const D: usize>(which: usize, sign: f64) -> [f64; D] {
    std::array::from_fn(|i| if i == which { sign } else { 0.0 })
}

/// Returns both directions of each of these coordinate axes.
fn axes<const D: usize>(which: &[usize]) -> Vec<[f64; D]> {
    which.iter().flat_map(|&i| [axis(i, 1.0), axis(i, -1.0)]).collect()
}

/// Returns the 2D solids, terrain last.
pub fn plane() -> Vec<Solid<2>> {
    let octagon = around_origin(8, 0.55, 0.35);
    let triangle = [[-0.5, -0.35], [0.5, -0.3], [0.0, 0.65]];
    let segment = [[-0.5, -0.1], [0.5, 0.1]];
    vec![
        Solid::new("ball", Form::Ball(0.5), axes(&[0, 1])),
        Solid::new("cuboid", Form::Cuboid([0.5, 0.4]), axes(&[0, 1])),
        Solid::new("capsule", Form::Capsule { half_height: 0.4, radius: 0.3 }, axes(&[0])),
        Solid::new("segment", Form::Segment(segment), across_segment(&segment)),
        Solid::new("triangle", Form::Triangle(triangle), face_normals(&triangle)),
        Solid::new("8-gon", Form::Convex(octagon.clone()), face_normals(&octagon)),
        Solid::ground("polyline", Form::Polyline, 1024),
    ]
}

/// Returns the 3D solids, half-space and terrains last.
pub fn space() -> Vec<Solid<3>> {
    let segment = [[-0.5, -0.1, -0.2], [0.5, 0.1, 0.2]];
    let triangle = [[-0.5, -0.1, -0.35], [0.5, 0.1, -0.3], [0.0, 0.0, 0.65]];
    let [few, many] = [(12, 0.55), (32, 0.3)].map(|(n, apart)| around_origin(n, 0.6, apart));
    let round = Form::RoundCuboid { half_extents: [0.4, 0.3, 0.5], radius: 0.1 };
    vec![
        Solid::new("ball", Form::Ball(0.5), axes(&[0, 1, 2])),
        Solid::new("cuboid", Form::Cuboid([0.5, 0.4, 0.6]), axes(&[0, 1, 2])),
        Solid::new("capsule", Form::Capsule { half_height: 0.4, radius: 0.3 }, axes(&[0, 2])),
        Solid::new("segment", Form::Segment(segment), across_segment(&segment)),
        Solid::new("triangle", Form::Triangle(triangle), face_normals(&triangle)),
        Solid::new("cylinder", Form::Cylinder { half_height: 0.5, radius: 0.4 }, axes(&[1])),
        Solid::new("cone", Form::Cone { half_height: 0.5, radius: 0.5 }, vec![axis(1, -1.0)]),
        Solid::new("12-hull", Form::Convex(few.clone()), face_normals(&few)),
        Solid::new("32-hull", Form::Convex(many.clone()), face_normals(&many)),
        Solid::new("round cuboid", round, axes(&[0, 1, 2])),
        Solid::new("half-space", Form::HalfSpace, vec![up()]),
        Solid::ground("mesh", Form::Mesh, 64),
        Solid::ground("height field", Form::HeightField, 64),
    ]
}

/// Returns random points on a sphere of `radius`. Any two are more than `apart * radius` from each
/// other. All of them are vertices of their convex hull.
fn around_origin<const D: usize>(count: usize, radius: f64, apart: f64) -> Vec<[f64; D]> {
    let mut random = Random::new(count as u64);
    let mut points: Vec<[f64; D]> = Vec::new();
    while points.len() < count {
        let point = scale(&random.unit_vector(), radius);
        if points.iter().all(|other| norm(&sub(other, &point)) > apart * radius) {
            points.push(point);
        }
    }
    points
}

/// Returns two opposite directions perpendicular to a segment, in the plane of the segment and the
/// second axis.
fn across_segment<const D: usize>([a, b]: &[[f64; D]; 2]) -> Vec<[f64; D]> {
    let along = scale(&sub(b, a), 1.0 / norm(&sub(b, a)));
    let across = sub(&up(), &scale(&along, dot(&along, &up())));
    let across = scale(&across, 1.0 / norm(&across));
    vec![across, scale(&across, -1.0)]
}

/// Returns the outward normals of the convex hull of a few points, by testing every D points: all
/// others must be behind their line or plane.
fn face_normals<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    let mut normals = Vec::new();
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points.iter().enumerate().skip(i + 1) {
            let thirds = if D == 2 { &points[j..=j] } else { &points[j + 1..] };
            for c in thirds {
                normals.extend(outward(points, a, &normal_of(a, b, c)));
            }
        }
    }
    normals
}

/// Returns a unit normal of the line through `a` and `b` in 2D, of the plane through all three
/// points in 3D.
fn normal_of<const D: usize>(a: &[f64; D], b: &[f64; D], c: &[f64; D]) -> [f64; D] {
    let normal = perpendicular(&[sub(b, a), sub(c, a)][..D - 1]);
    scale(&normal, 1.0 / norm(&normal))
}

/// Returns those of the directions `normal` and `-normal` in which no point lies beyond `on`.
fn outward<const D: usize>(points: &[[f64; D]], on: &[f64; D], normal: &[f64; D]) -> Vec<[f64; D]> {
    let is_behind = |side: &[f64; D]| points.iter().all(|p| dot(&sub(p, on), side) < 1e-9);
    [*normal, scale(normal, -1.0)].into_iter().filter(is_behind).collect()
}

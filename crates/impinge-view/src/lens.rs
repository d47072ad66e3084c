//! Projects points of the world to points of the picture.

use crate::camera::Camera;
use impinge::dim3::math::{Point, Vector};

/// A camera that is placed so that it sees the framed content, and the bounds of this content in
/// the image plane.
#[derive(Clone, Debug)]
pub(crate) struct Lens {
    axes: [Vector<f64>; 3],
    is_perspective: bool,
    /// The position of the viewer in the camera's frame; zero for an orthographic camera.
    eye: Vector<f64>,
    /// The distance of the near plane from the viewer. Points nearer than this plane are not drawn.
    near: f64,
    low: [f64; 2],
    high: [f64; 2],
}

/// A [`Lens`], and the scale and the centre of the framed content in the picture.
#[derive(Clone, Debug)]
pub(crate) struct View {
    lens: Lens,
    /// The number of pixels per unit of length in the image plane.
    scale: f64,
    center: [f64; 2],
}

/// A point of the picture in pixels, with y downwards. The depth grows away from the viewer. Along
/// the image of a line, the depth is linear in x and y, even in perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OnScreen {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) depth: f64,
}

/// A rectangle of the picture in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub(crate) low: [f64; 2],
    pub(crate) size: [f64; 2],
}

impl Lens {
    /// Returns the lens of a camera that frames `points`, or the box of [`Camera::fit`] if one is
    /// set. Without points it frames the origin.
    pub(crate) fn new(camera: &Camera, points: &[Point<f64>]) -> Self {
        let framed = camera.framed();
        let points = framed.as_deref().unwrap_or(points);
        let points = if points.is_empty() { &[Point::origin()] } else { points };
        let mut lens = Self {
            axes: [camera.right(), camera.up(), camera.back()],
            is_perspective: camera.tangent() > 0.0,
            eye: Vector::zeros(),
            near: f64::NEG_INFINITY,
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        if lens.is_perspective {
            lens.place_eye(camera.tangent(), points);
        }
        for point in points {
            lens.include(point);
        }
        lens
    }

    /// Moves the eye to the smallest distance at which all points are inside the angle of view.
    ///
    /// With the tangent `t` and the eye `e`, a point is inside the right side if
    /// `x - e.x <= t (e.z - z)`. So `e.x + t e.z` must be at least the maximum of `x + t z`. The
    /// other sides are analogous. The eye stays in front of all points.
    fn place_eye(&mut self, tangent: f64, points: &[Point<f64>]) {
        let mut sides = [f64::NEG_INFINITY; 4];
        let mut z = [f64::INFINITY, f64::NEG_INFINITY];
        for point in points {
            let p = self.local(point);
            let reaches = [p.x, -p.x, p.y, -p.y].map(|along| along + tangent * p.z);
            for (side, reach) in sides.iter_mut().zip(reaches) {
                *side = larger(*side, reach);
            }
            z = [-larger(-z[0], -p.z), larger(z[1], p.z)];
        }
        let [right, left, top, bottom] = sides;
        let distance = larger(right + left, top + bottom) / (2.0 * tangent);
        let extent = larger(z[1] - z[0], distance - z[1]);
        let extent = if extent > 0.0 { extent } else { 1.0 };
        let distance = larger(distance, z[1] + 0.1 * extent);
        self.eye = Vector::new((right - left) * 0.5, (top - bottom) * 0.5, distance);
        self.near = (distance - z[1]) * 0.01;
    }

    fn include(&mut self, point: &Point<f64>) {
        let image = self.image(&self.local(point));
        for (axis, along) in image.into_iter().enumerate() {
            self.low[axis] = -larger(-self.low[axis], -along);
            self.high[axis] = larger(self.high[axis], along);
        }
    }

    /// Returns the width and the height of the framed content, in the image plane.
    pub(crate) fn size(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    /// Returns the view in which the framed content fills the window as far as its aspect ratio
    /// allows, in the centre of the window.
    pub(crate) fn within(self, window: &Window) -> View {
        let [width, height] = self.size();
        let fit = |extent: f64, pixels: f64| {
            if extent > 0.0 { pixels / extent } else { f64::INFINITY }
        };
        let scale = -larger(-fit(width, window.size[0]), -fit(height, window.size[1]));
        let least = -larger(-window.size[0], -window.size[1]);
        let center = [0, 1].map(|axis| window.low[axis] + window.size[axis] * 0.5);
        View { lens: self, scale: if scale.is_finite() { scale } else { least }, center }
    }

    /// Transforms a point to the camera's frame: x to the right, y up, z towards the viewer.
    fn local(&self, point: &Point<f64>) -> Vector<f64> {
        self.turned(&point.coords)
    }

    /// Rotates a direction to the camera's frame.
    pub(crate) fn turned(&self, v: &Vector<f64>) -> Vector<f64> {
        Vector::new(self.axes[0].dot(v), self.axes[1].dot(v), self.axes[2].dot(v))
    }

    /// Returns the distance of a point from the viewer along the direction of view. An orthographic
    /// camera has no viewer; its distances are from the plane z = 0 of the camera's frame.
    fn distance(&self, local: &Vector<f64>) -> f64 {
        self.eye.z - local.z
    }

    fn image(&self, local: &Vector<f64>) -> [f64; 2] {
        let across = local - self.eye;
        if self.is_perspective {
            let distance = self.distance(local);
            [across.x / distance, across.y / distance]
        } else {
            [across.x, across.y]
        }
    }

    /// Returns `true` if the viewer is on the front side of the plane through `on` with this
    /// normal.
    pub(crate) fn faces(&self, normal: &Vector<f64>, on: &Point<f64>) -> bool {
        let normal = self.turned(normal);
        if self.is_perspective {
            normal.dot(&(self.eye - self.local(on))) > 0.0
        } else {
            normal.z > 0.0
        }
    }
}

impl View {
    /// Converts a length at the point `at` to pixels.
    pub(crate) fn pixels(&self, length: f64, at: &Point<f64>) -> f64 {
        let distance = self.lens.distance(&self.lens.local(at));
        if self.lens.is_perspective {
            length * self.scale / larger(distance, self.lens.near)
        } else {
            length * self.scale
        }
    }

    /// Projects a point. Its depth is that of the point moved towards the viewer by `bias` pixels.
    /// `None` if the point is nearer than the near plane.
    pub(crate) fn point(&self, at: &Point<f64>, bias: f64) -> Option<OnScreen> {
        let local = self.lens.local(at);
        (self.lens.distance(&local) >= self.lens.near).then(|| self.project(&local, bias))
    }

    /// Projects the part of a line segment beyond the near plane; `None` if no part remains. For
    /// `bias` see [`Self::point`].
    pub(crate) fn line(&self, ends: &[Point<f64>; 2], bias: f64) -> Option<[OnScreen; 2]> {
        let cut = self.cut(ends);
        let [start, end] = cut[..] else { return None };
        Some([self.project(&start, bias), self.project(&end, bias)])
    }

    /// Projects the part of a triangle beyond the near plane. Returns the 3 or 4 corners in order
    /// around the clipped polygon; an empty list if nothing remains.
    pub(crate) fn triangle(&self, corners: &[Point<f64>; 3], bias: f64) -> Vec<OnScreen> {
        self.cut(corners).iter().map(|local| self.project(local, bias)).collect()
    }

    /// Clips a polygon, or a line segment, by the near plane (Sutherland and Hodgman, 1974).
    /// Returns the corners in the camera's frame; an empty list if nothing remains.
    fn cut(&self, corners: &[Point<f64>]) -> Vec<Vector<f64>> {
        let local: Vec<_> = corners.iter().map(|corner| self.lens.local(corner)).collect();
        let beyond = |p: &Vector<f64>| self.lens.distance(p) - self.lens.near;
        let mut kept = Vec::with_capacity(local.len() + 1);
        let sides = if local.len() > 2 { local.len() } else { 1 };
        for (index, a) in local.iter().enumerate() {
            if beyond(a) >= 0.0 {
                kept.push(*a);
            }
            let b = &local[(index + 1) % local.len()];
            let crosses = (beyond(a) >= 0.0) != (beyond(b) >= 0.0);
            if crosses && index < sides {
                kept.push(a + (b - a) * (beyond(a) / (beyond(a) - beyond(b))));
            }
        }
        kept
    }

    fn project(&self, local: &Vector<f64>, bias: f64) -> OnScreen {
        let [x, y] = self.lens.image(local);
        let middle = [0, 1].map(|axis| (self.lens.low[axis] + self.lens.high[axis]) * 0.5);
        let distance = self.lens.distance(local);
        let depth = if self.lens.is_perspective {
            -1.0 / (distance * larger(1.0 - bias / self.scale, 0.5))
        } else {
            distance - bias / self.scale
        };
        OnScreen {
            x: self.center[0] + (x - middle[0]) * self.scale,
            y: self.center[1] - (y - middle[1]) * self.scale,
            depth,
        }
    }
}

/// Returns the larger number; `a` if one of the numbers is NaN.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window() -> Window {
        Window { low: [10.0, 10.0], size: [80.0, 80.0] }
    }

    #[test]
    fn an_orthographic_view_is_to_scale_with_y_upwards() {
        let points = [Point::new(-1.0, 0.0, 0.0), Point::new(3.0, 2.0, 5.0)];
        let view = Lens::new(&Camera::plane(), &points).within(&window());
        let low = view.point(&points[0], 0.0).expect("in front");
        let high = view.point(&points[1], 0.0).expect("in front");
        assert_eq!((low.x, low.y), (10.0, 70.0), "left and down; 20 pixels for 1");
        assert_eq!((high.x, high.y), (90.0, 30.0), "right and up");
        assert!(high.depth < low.depth, "the second is nearer");
    }

    #[test]
    fn a_perspective_view_touches_the_sides_and_cuts_what_is_behind() {
        let camera = Camera::plane()
            .perspective(1.0)
            .fit([Point::new(-1.0, -1.0, -1.0), Point::new(1.0, 1.0, 1.0)]);
        let view = Lens::new(&camera, &[]).within(&window());
        let near = view.point(&Point::new(1.0, 1.0, 1.0), 0.0).expect("in front");
        assert!((near.x - 90.0).abs() < 1e-9 && (near.y - 10.0).abs() < 1e-9, "{near:?}");
        assert!(view.point(&Point::new(0.0, 0.0, 1e3), 0.0).is_none(), "behind the viewer");
        let behind = [Point::new(0.0, 0.0, 0.0), Point::new(0.5, 0.0, 1e3)];
        let [start, end] = view.line(&behind, 0.0).expect("its beginning is in front");
        assert_eq!((start.x, start.y), (50.0, 50.0), "the middle");
        assert!(end.depth < start.depth && end.x.is_finite(), "cut at the near plane");
        let corners = [behind[0], behind[1], Point::new(0.0, 1.0, 0.0)];
        assert_eq!(view.triangle(&corners, 0.0).len(), 4, "one corner is cut off");
    }

    #[test]
    fn one_point_and_no_point_have_a_view() {
        for points in [&[][..], &[Point::new(5.0, 5.0, 5.0)]] {
            for camera in [Camera::plane(), Camera::plane().perspective(0.5)] {
                let view = Lens::new(&camera, points).within(&window());
                let at = points.first().copied().unwrap_or(Point::origin());
                let found = view.point(&at, 0.0).expect("in front");
                assert_eq!((found.x, found.y), (50.0, 50.0), "the middle");
            }
        }
    }
}

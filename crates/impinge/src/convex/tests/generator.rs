//! Pseudo-random pairs of solids, equal in every run.

use serde_json::{Value, json};

use super::super::{Simplicial, separation};
use super::solids::{Own, Solid, solid};
use crate::math::{Pose, Real, Vector, unit_or};

/// `SplitMix64`: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators"
/// (2014).
pub(super) struct Generator(pub(super) u64);

impl Generator {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number in `low..high` that `f32` represents exactly.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        let bits = u32::try_from(self.next() >> 40).expect("24 bits are left");
        f64::from((low + (high - low) * f64::from(bits) / 16_777_216.0).as_f32())
    }

    pub(super) fn vector<const D: usize>(&mut self, size: f64) -> Vector<f64, D> {
        Vector::from_fn(|_, _| self.between(-size, size))
    }

    /// Returns a random unit vector, almost uniformly distributed.
    pub(super) fn direction<const D: usize>(&mut self) -> Vector<f64, D> {
        let axis = Vector::<f64, D>::from_fn(|row, _| f64::from(u8::from(row == 0)));
        loop {
            let v = self.vector::<D>(1.0);
            if v.norm_squared() < 1.0 {
                return unit_or(&v, axis);
            }
        }
    }

    fn list<const D: usize>(&mut self, size: f64) -> Value {
        json!(self.vector::<D>(size).iter().copied().collect::<Vec<_>>())
    }

    /// Returns a random solid of a kind, with sizes of about `size`. If `thin`, the radius of a
    /// ball, capsule, cylinder or cone is 200 times smaller, and so are the last half extent and
    /// the radius of a box; other kinds ignore `thin`.
    pub(super) fn shape<const D: usize>(&mut self, kind: &str, size: f64, thin: bool) -> Value {
        let slim = if thin { size / 200.0 } else { size };
        let mut length = |scale: f64| self.between(0.5, 2.0) * scale;
        match kind {
            "ball" => json!({ "type": kind, "r": length(slim) }),
            "capsule_y" | "cylinder_y" | "cone_y" => {
                json!({ "type": kind, "half_height": length(size), "r": length(slim) })
            }
            "cuboid" | "round_cuboid" => {
                let mut half_extents: Vec<_> = (1..D).map(|_| length(size)).collect();
                half_extents.push(length(slim));
                json!({ "type": kind, "half_extents": half_extents, "r": length(slim) * 0.25 })
            }
            "segment" => {
                json!({ "type": kind, "a": self.list::<D>(size), "b": self.list::<D>(size) })
            }
            "triangle" => {
                let [a, b, c] = [0; 3].map(|_| self.list::<D>(size));
                json!({ "type": kind, "a": a, "b": b, "c": c })
            }
            _ => {
                let points: Vec<_> = (0..12).map(|_| self.list::<D>(size)).collect();
                json!({ "type": kind, "points": points })
            }
        }
    }

    /// Returns a random rotation, as a pose at the origin.
    pub(super) fn rotation<const D: usize>(&mut self) -> Pose<f64, D>
    where
        f64: Own<D>,
    {
        let q: Vec<_> = self.direction::<4>().iter().copied().collect();
        let origin = vec![0.0; D];
        f64::pose(&json!({ "rotation_xyzw": q, "angle": self.between(-3.0, 3.0), "t": origin }))
    }
}

/// A pair of solids at a relative pose, for use with any scalar.
pub(super) struct Sample<const D: usize> {
    pub(super) shapes: [Value; 2],
    pub(super) pose12: Pose<f64, D>,
    /// Length that tolerances are relative to: the sum of the bounding radii of the cores, their
    /// rounding radii and the distance of the origins.
    pub(super) scale: f64,
}

impl<const D: usize> Sample<D>
where
    f64: Simplicial<D> + Own<D>,
{
    /// Draws a rotation, then moves the second solid in 12 steps until the distance is about
    /// `target`. Each step is along one fixed random direction, or along the normal if the angle
    /// between the two has a cosine of at most 0.1.
    pub(super) fn new(shapes: [Value; 2], target: f64, generator: &mut Generator) -> Self {
        let mut sample = Self { shapes, pose12: generator.rotation(), scale: 0.0 };
        let [a, b] = sample.solids::<f64>();
        let away = generator.direction::<D>();
        sample.pose12.translation = a.center().coords + away * 0.1 * (a.reach() + b.reach());
        for _ in 0..12 {
            let found = separation(&*a, &*b, &sample.pose12, f64::INFINITY).expect("no limit");
            let slope = found.normal.dot(&away);
            let step = if slope > 0.1 { away } else { found.normal };
            sample.pose12.translation += step * (target - found.distance);
        }
        let rounding = a.rounding() + b.rounding();
        sample.scale = a.reach() + b.reach() + rounding + sample.pose12.translation.norm();
        sample
    }

    /// Rounds the pose to `N`; its rotation is then orthonormal only up to rounding.
    pub(super) fn representable<N: Real>(mut self) -> Self {
        self.pose12.translation.apply(|x| *x = N::lit(*x).as_f64());
        self.pose12.rotation.apply(|x| *x = N::lit(*x).as_f64());
        self
    }

    pub(super) fn solids<N: Own<D>>(&self) -> [Solid<N, D>; 2] {
        [0, 1].map(|index| solid(&self.shapes[index]).expect("a convex solid"))
    }

    pub(super) fn pose<N: Real>(&self) -> Pose<N, D> {
        Pose {
            rotation: self.pose12.rotation.map(|x| N::lit(x)),
            translation: self.pose12.translation.map(|x| N::lit(x)),
        }
    }
}

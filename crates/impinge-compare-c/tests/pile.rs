//! Tests that at every step every engine finds as many touching pairs as the grid of a pile has
//! pairs of neighbours.

#![cfg(any(feature = "box2d", feature = "box3d", feature = "jolt"))]

use impinge_compare_c::Digest;
use impinge_scenes::{Placement, Scene, pile};

/// An engine, and its methods: the engines have the same methods, but no common trait.
struct Engine<'a, E, const D: usize> {
    engine: E,
    prepare: fn(&mut E, &[(usize, Placement<D>)]),
    step: fn(&mut E),
    read: fn(&E) -> Digest,
    touching: &'a dyn Fn(&E) -> Vec<(usize, usize)>,
}

impl<E, const D: usize> Engine<'_, E, D> {
    fn check(mut self, scene: &Scene<D>, pairs: usize) {
        for step in 0..30 {
            let moved: Vec<_> =
                (0..scene.objects.len()).map(|n| (n, scene.placement(n, step))).collect();
            (self.prepare)(&mut self.engine, &moved);
            (self.step)(&mut self.engine);
            assert_eq!((self.touching)(&self.engine).len(), pairs, "step {step}");
            let digest = (self.read)(&self.engine);
            assert!(digest.points >= pairs, "{digest:?} at step {step}");
            let mean = digest.depth / digest.points as f64;
            assert!((0.0..0.2).contains(&mean), "boxes overlap by 0.1: {digest:?}");
        }
    }
}

#[cfg(feature = "box2d")]
#[test]
fn box2d() {
    use impinge_compare_c::{Box2d, Recycling};
    let scene = pile::<2>(9);
    for recycling in [Recycling::Off, Recycling::On] {
        Engine {
            engine: Box2d::new(&scene, recycling).expect("there are boxes"),
            prepare: Box2d::prepare,
            step: Box2d::step,
            read: Box2d::read,
            touching: &|world| world.touching(0.0),
        }
        .check(&scene, 20);
    }
}

#[cfg(feature = "box3d")]
#[test]
fn box3d() {
    use impinge_compare_c::{Box3d, Recycling};
    let scene = pile::<3>(8);
    for recycling in [Recycling::Off, Recycling::On] {
        Engine {
            engine: Box3d::new(&scene, recycling).expect("there are boxes"),
            prepare: Box3d::prepare,
            step: Box3d::step,
            read: Box3d::read,
            touching: &|world| world.touching(0.0),
        }
        .check(&scene, 28);
    }
}

#[cfg(feature = "jolt")]
#[test]
fn jolt() {
    use impinge_compare_c::Jolt;
    let scene = pile::<3>(8);
    for radius in [0.0, Jolt::CONVEX_RADIUS] {
        Engine {
            engine: Jolt::new(&scene, 0.002, radius).expect("there are boxes"),
            prepare: Jolt::prepare,
            step: Jolt::step,
            read: Jolt::read,
            touching: &|world| world.touching(0.0),
        }
        .check(&scene, 28);
    }
}

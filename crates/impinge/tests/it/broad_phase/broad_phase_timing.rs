//! Prints the times of a step; asserts nothing. Run with
//! `cargo test --release -p impinge --test it broad_phase_timing -- --ignored --nocapture`.

use std::time::Instant;

use impinge::bounding_volume::{Aabb, Ray};
use impinge::broad_phase::{BroadPhase, DBVTBroadPhase, ProxyHandle};
use impinge::math::{Point, Space, Vector};

struct Random(u64);

impl Random {
    /// Returns a random number from 0 to 1.
    fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 33).expect("31 bits")) / f64::from(1_u32 << 31)
    }
}

/// Boxes of half extents 0.35 to 0.65, each of which overlaps about three others. They move in
/// straight lines and are reflected at the walls of a room of width `side`.
struct Scene<N: Space<D>, const D: usize> {
    centers: Vec<Vector<f64, D>>,
    velocities: Vec<Vector<f64, D>>,
    half: Vec<f64>,
    side: f64,
    handles: Vec<ProxyHandle>,
    broad_phase: DBVTBroadPhase<N, Aabb<N, D>, u32>,
}

impl<N: Space<D>, const D: usize> Scene<N, D> {
    fn new(count: u32, step: f64) -> Self {
        let mut random = Random(5);
        // A box overlaps another of its size if the centre of the other lies in a concentric box of
        // 2^D times the volume. The side of the room is chosen so that on average three centres do.
        let per_neighbour = 2_f64.powi(i32::try_from(D).expect("2 or 3")) / 3.0;
        let side = (f64::from(count) * per_neighbour).powf(1.0 / if D > 2 { 3.0 } else { 2.0 });
        let mut scene = Self {
            centers: Vec::new(),
            velocities: Vec::new(),
            half: Vec::new(),
            side,
            handles: Vec::new(),
            broad_phase: DBVTBroadPhase::new(N::lit(0.05)),
        };
        for data in 0..count {
            let center = Vector::<f64, D>::from_fn(|_, _| random.unit() * side);
            let direction = Vector::<f64, D>::from_fn(|_, _| random.unit() - 0.5);
            let speed = step * (0.2 + 1.6 * random.unit()) / direction.norm();
            scene.velocities.push(direction * speed);
            scene.centers.push(center);
            scene.half.push(0.35 + 0.3 * random.unit());
            let aabb = scene.aabb(data as usize);
            scene.handles.push(scene.broad_phase.create_proxy(aabb, data));
        }
        scene
    }

    fn aabb(&self, index: usize) -> Aabb<N, D> {
        let (center, half) = (self.centers[index], self.half[index]);
        let corner = |reach: f64| Point::from(center.map(|x| N::lit(x + reach)));
        Aabb::new(corner(-half), corner(half))
    }

    /// Moves every `stride`-th box and updates. Returns the milliseconds for both, and the number
    /// of events.
    fn step(&mut self, stride: usize) -> (f64, usize) {
        let mut boxes = Vec::new();
        for index in (0..self.handles.len()).step_by(stride) {
            for axis in 0..D {
                let x = self.centers[index][axis] + self.velocities[index][axis];
                if x < 0.0 || x > self.side {
                    self.velocities[index][axis] = -self.velocities[index][axis];
                }
                self.centers[index][axis] += self.velocities[index][axis];
            }
            boxes.push((self.handles[index], self.aabb(index)));
        }
        let (start, mut events) = (Instant::now(), 0);
        for (handle, aabb) in boxes {
            self.broad_phase.deferred_set_bounding_volume(handle, aabb);
        }
        self.broad_phase.update(&mut |_, _| true, &mut |_, _, _| events += 1);
        (start.elapsed().as_secs_f64() * 1e3, events)
    }
}

#[expect(clippy::print_stdout, reason = "printing is its purpose")]
fn measure<N: Space<D>, const D: usize>(name: &str, count: u32, step: f64, stride: usize) {
    let mut scene = Scene::<N, D>::new(count, step);
    let start = Instant::now();
    scene.broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
    let build = start.elapsed().as_secs_f64() * 1e3;
    (0..20).for_each(|_| _ = scene.step(stride));
    let steps: Vec<(f64, usize)> = (0..100).map(|_| scene.step(stride)).collect();
    let events: usize = steps.iter().map(|step| step.1).sum();
    let mut times: Vec<f64> = steps.iter().map(|step| step.0).collect();
    times.sort_by(f64::total_cmp);
    let mean = times.iter().sum::<f64>() / 100.0;
    println!(
        "{name} n {count} step {step} 1/{stride}: build {build:.2}, min {:.3} median {:.3} mean \
         {mean:.3} p90 {:.3} max {:.3} ms, {} pairs, {} events/step",
        times[0],
        times[50],
        times[90],
        times[99],
        scene.broad_phase.num_interferences(),
        events / 100
    );
}

#[expect(clippy::print_stdout, reason = "printing is its purpose")]
fn measure_rays(count: u32) {
    let mut scene = Scene::<f32, 3>::new(count, 0.05);
    scene.broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
    let mut random = Random(8);
    let rays: Vec<Ray<f32, 3>> = (0..20_000)
        .map(|_| {
            let origin = Vector::<f64, 3>::from_fn(|_, _| random.unit() * scene.side);
            let dir = Vector::<f64, 3>::from_fn(|_, _| random.unit() - 0.5);
            let small = |v: Vector<f64, 3>| v.map(<f32 as impinge::math::Real>::lit);
            Ray::new(Point::from(small(origin)), small(dir))
        })
        .collect();
    let (start, mut visited) = (Instant::now(), 0);
    for ray in &rays {
        scene.broad_phase.visit_ray(ray, f32::INFINITY, &mut |_| {
            visited += 1;
            -1.0
        });
    }
    let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / 20_000.0;
    println!("rays into {count}: {nanoseconds:.0} ns, {visited} of 20000 hit");
}

#[test]
#[ignore = "prints times"]
fn times() {
    for count in [1000, 10_000, 100_000] {
        for (step, stride) in [(0.05, 1), (0.01, 1), (0.05, 10), (0.05, 100)] {
            measure::<f32, 3>("f32 3D", count, step, stride);
        }
        measure::<f64, 3>("f64 3D", count, 0.05, 1);
        measure::<f32, 2>("f32 2D", count, 0.05, 1);
    }
    measure_rays(100_000);
}

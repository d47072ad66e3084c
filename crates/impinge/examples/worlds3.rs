//! Many worlds at once: a game server runs each match in a world of its own, on its own thread.
//! Worlds share only their shapes. A match has the same bits whether it runs alone or beside
//! others, so it can be replayed from its seed. Each line of the output is one match: the numbers
//! of contacts that began, ended and are left, and a hash of depths.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::thread;

use impinge::dim3::prelude::*;

/// The data of a ball is its velocity per step.
type World = CollisionWorld<f32, Vector<f32>>;

const BALLS: usize = 60;
const STEPS: usize = 200;
const MATCHES: u64 = 8;

/// Half the size of the hall.
const HALL: f32 = 4.0;

/// The result of a match: its numbers of started and stopped contacts, and a hash.
#[derive(Debug, PartialEq)]
struct Summary {
    started: usize,
    stopped: usize,
    /// The number of pairs in contact at the end.
    touching: usize,
    hash: u64,
}

/// A small generator of random numbers that gives the same sequence on every machine. See
/// Marsaglia, "Xorshift RNGs", 2003.
struct Dice(u64);

impl Dice {
    /// Returns a number from −1 to 1 with 24 bits.
    fn roll(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
    }

    fn vector(&mut self) -> Vector<f32> {
        Vector::new(self.roll(), self.roll(), self.roll())
    }
}

/// Simulates a match. Balls fly through a hall and through each other; a ball that would leave the
/// hall is reflected.
fn play(ball: &ShapeHandle<f32>, seed: u64) -> Summary {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)); // spreads similar seeds
    let mut world = World::new(0.05);
    for _ in 0..BALLS {
        let (position, velocity) = (Isometry::from(dice.vector() * HALL), dice.vector() * 0.1);
        world.add(
            position,
            ball.clone(),
            CollisionGroups::new(),
            ContactQuery::default(),
            velocity,
        );
    }
    // The hash FNV-1a over the bits of the deepest depth of each manifold, in the order in which
    // the world returns the manifolds.
    let mut summary = Summary { started: 0, stopped: 0, touching: 0, hash: 0xcbf2_9ce4_8422_2325 };
    for _ in 0..STEPS {
        advance(&mut world);
        world.update();
        let begins = |event: &&ContactEvent| matches!(event, ContactEvent::Started(..));
        let started = world.contact_events().iter().filter(begins).count();
        summary.started += started;
        summary.stopped += world.contact_events().len() - started;
        for (_, _, manifold) in world.contact_manifolds() {
            let depth = manifold.deepest_contact().expect("manifolds hold contacts").contact.depth;
            summary.hash =
                (summary.hash ^ u64::from(depth.to_bits())).wrapping_mul(0x0100_0000_01b3);
        }
    }
    summary.touching = world.contact_manifolds().count();
    summary
}

/// Moves all balls by a step.
fn advance(world: &mut World) {
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    for handle in handles {
        let ball = world.collision_object_mut(handle).expect("no ball is removed");
        let mut place = ball.position().translation.vector;
        let velocity = ball.data_mut();
        for axis in 0..3 {
            if (place[axis] + velocity[axis]).abs() > HALL {
                velocity[axis] = -velocity[axis];
            }
        }
        place += *velocity;
        world.set_position(handle, Isometry::from(place));
    }
}

fn main() {
    let ball = ShapeHandle::new(Ball::new(0.5));
    // One thread for each match, all with the same shape.
    let together: Vec<Summary> = thread::scope(|scope| {
        let ball = &ball;
        let threads = (1..=MATCHES).map(|seed| scope.spawn(move || play(ball, seed)));
        // All threads are spawned before the first is joined.
        let threads: Vec<_> = threads.collect();
        threads.into_iter().map(|thread| thread.join().expect("matches do not fail")).collect()
    });
    for (seed, summary) in (1..).zip(&together) {
        let Summary { started, stopped, touching, hash } = summary;
        println!("match {seed}: {started} begun − {stopped} ended = {touching} left, {hash:016x}");
    }

    let alone: Vec<Summary> = (1..=MATCHES).map(|seed| play(&ball, seed)).collect();
    assert_eq!(together, alone, "the same bits as one after the other");
    for (n, summary) in together.iter().enumerate() {
        assert_eq!(
            summary.started,
            summary.stopped + summary.touching,
            "each contact ends once or lasts"
        );
        assert!(summary.started > 100, "match {n} has contacts");
        assert!(
            together[..n].iter().all(|other| other.hash != summary.hash),
            "no two matches are alike"
        );
    }
}

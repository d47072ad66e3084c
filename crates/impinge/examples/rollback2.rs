//! A game for two over a network with a delay of eight frames. Each side plays on at once and
//! predicts the input of the other player. When an input arrives that was predicted wrong, the side
//! rewinds the world to the state before that frame and plays the frames since then again. Marks of
//! the world record only changes, so nothing is copied. The output is how often this happened, and
//! the hash on both sides, which must be equal.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::collections::{BTreeMap, VecDeque};

use impinge::dim2::prelude::*;
use impinge::dim2::world::WorldMark;

/// The data is the number of times that an object was touched. Rewinding the world also rewinds the
/// data.
type World = CollisionWorld<f32, u32>;

const FRAMES: usize = 240;
/// The number of frames after which an input arrives.
const DELAY: usize = 8;

/// Returns the direction in which a player walks in a frame, by the keys that the player presses.
fn input(player: usize, frame: usize) -> Vector<f32> {
    let keys = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    Vector::from(keys[(frame / [23, 31][player] + 2 * player) % 4])
}

/// Builds a field of boxes with two players; the first two objects are the players.
fn build() -> (World, [CollisionObjectHandle; 2]) {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    let body = ShapeHandle::new(Ball::new(0.45));
    let players = [-3.25, 3.25]
        .map(|x| world.add(Isometry::translation(x, 0.0), body.clone(), groups, query, 0));
    let crate_ = ShapeHandle::new(Cuboid::new(Vector::new(0.4, 0.4)));
    for n in 0..400_u16 {
        let (column, row) = (f32::from(n % 20) - 9.5, f32::from(n / 20) - 9.5);
        let place = Isometry::translation(1.2 * column, 1.2 * row);
        world.add(place, crate_.clone(), groups, query, 0);
    }
    (world, players)
}

/// Simulates one frame: the players walk, and the objects that they touch are pushed out of the
/// way.
fn step(world: &mut World, players: [CollisionObjectHandle; 2], inputs: [Vector<f32>; 2]) {
    for (player, input) in players.into_iter().zip(inputs) {
        move_by(world, player, input * 0.0625);
    }
    world.update();
    let mut pushes = BTreeMap::<_, Vector<f32>>::new();
    for (object1, object2, manifold) in world.contact_manifolds() {
        let Some(deepest) = manifold.deepest_contact() else { continue };
        let push = deepest.contact.normal.into_inner() * deepest.contact.depth.max(0.0);
        for (object, push) in [(object1.handle(), -push), (object2.handle(), push)] {
            *pushes.entry(object).or_insert_with(Vector::zeros) += push;
        }
    }
    for (object, push) in pushes.into_iter().filter(|(object, _)| !players.contains(object)) {
        move_by(world, object, push);
    }
    for event in world.contact_events().to_vec() {
        let (first, second) = event.handles();
        for handle in [first, second] {
            *world.collision_object_mut(handle).expect("nobody is removed").data_mut() += 1;
        }
    }
}

fn move_by(world: &mut World, handle: CollisionObjectHandle, way: Vector<f32>) {
    let mut position = *world.collision_object(handle).expect("nobody is removed").position();
    position.translation.vector += way;
    world.set_position(handle, position);
}

/// Returns a hash of all positions, data and contacts (FNV-1a).
fn hash(world: &World) -> u64 {
    let objects = world.collision_objects().flat_map(|object| {
        let place = object.position().translation;
        [place.x.to_bits(), place.y.to_bits(), *object.data()]
    });
    let depths = world.contact_manifolds().flat_map(|(_, _, manifold)| manifold.contacts());
    let all = objects.chain(depths.map(|point| point.contact.depth.to_bits()));
    all.fold(0xcbf2_9ce4_8422_2325, |hash: u64, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The program on the machine of one player.
struct Side {
    me: usize,
    world: World,
    players: [CollisionObjectHandle; 2],
    /// The state before each of the last frames, and the input of the other player that was used
    /// for the frame.
    frames: VecDeque<(WorldMark, Vector<f32>)>,
    /// The inputs of the other player that have arrived.
    arrived: Vec<Vector<f32>>,
    /// The index of the next frame.
    now: usize,
    returns: usize,
    repeated: usize,
}

impl Side {
    fn new(me: usize) -> Self {
        let (world, players) = build();
        let (frames, arrived) = (VecDeque::new(), Vec::new());
        Self { me, world, players, frames, arrived, now: 0, returns: 0, repeated: 0 }
    }

    /// Simulates the next frame. If the input of the other player has not arrived, the last one
    /// that arrived is used as prediction.
    fn play(&mut self) {
        let last = self.arrived.last().copied().unwrap_or_else(Vector::zeros);
        let other = self.arrived.get(self.now).copied().unwrap_or(last);
        let mut inputs = [input(self.me, self.now), other];
        if self.me == 1 {
            inputs.reverse();
        }
        self.frames.push_back((self.world.mark(), other));
        if self.frames.len() > DELAY {
            self.frames.pop_front();
        }
        step(&mut self.world, self.players, inputs);
        self.now += 1;
    }

    /// Stores an input of the other player: it is for the first frame without a received input,
    /// which was simulated some frames ago. If the prediction of this input was wrong, simulates
    /// this frame and all later frames again.
    fn receive(&mut self, input: Vector<f32>) {
        let frame = self.arrived.len();
        self.arrived.push(input);
        let back = self.now - frame;
        let place = self.frames.len() - back;
        let (mark, guess) = self.frames[place];
        if guess == input {
            return;
        }
        self.world.rewind(mark);
        self.frames.truncate(place);
        self.now = frame;
        (0..back).for_each(|_| self.play());
        self.returns += 1;
        self.repeated += back;
    }
}

fn main() {
    let mut sides = [Side::new(0), Side::new(1)];
    for frame in 0..FRAMES + DELAY {
        for side in &mut sides {
            if let Some(sent) = frame.checked_sub(DELAY) {
                side.receive(input(1 - side.me, sent));
            }
            if frame < FRAMES {
                side.play();
            }
        }
    }

    // Runs the game without a network: every input is known in its frame.
    let (mut world, players) = build();
    for frame in 0..FRAMES {
        step(&mut world, players, [0, 1].map(|player| input(player, frame)));
    }
    for Side { me, world: here, returns, repeated, .. } in &sides {
        println!(
            "player {me}: {returns} returns, {repeated} frames again, hash {:016x}",
            hash(here)
        );
        assert_eq!(hash(here), hash(&world), "the game that both would have played without delay");
        assert!(*returns > 4, "guesses were wrong");
    }
    let touched = world.collision_objects().filter(|object| *object.data() > 0).count();
    println!("{touched} of {} objects were touched", world.len());
    assert!(touched > 20, "there was something to agree on");
}

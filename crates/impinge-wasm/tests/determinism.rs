//! Tests that a scene gives the same bits in a second run, with every instruction set of the
//! machine, with any number of threads, in every build and on every platform.
//!
//! The hash of a scene covers everything that the world reports after each step: manifolds (points,
//! normals, depths, features, contact ids), proximities and events. `golden/state_hashes.txt` has
//! the final hash of each scene, dimension and scalar. It is the same on every platform and in
//! every build, because the pipeline only adds, multiplies, divides, takes roots, compares and
//! rounds, in a fixed order, and takes sines from a software library. The library of this
//! package plays the same scenes in WebAssembly. The file changes only together with a deliberate
//! change of results; then run `IMPINGE_BLESS=1 cargo test --workspace --test determinism` and
//! commit the file.
//!
//! The test is in this package, because the package `impinge` enables more features for its tests:
//! so the optimised build with several threads is also the library of the Python package.

#[macro_use]
#[path = "../../impinge/tests/it/support/scene_stage/runs.rs"]
mod runs;
#[path = "../../impinge/tests/it/support/scene_stage/mod.rs"]
mod scene_stage;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;

use impinge::broad_phase::Lanes;
use impinge_scenes::{
    few_moving, mixed_shapes, mixed_sizes, pile, sparse_drift, spawn_and_despawn, tower,
};
use runs::{Outcome, Run};
use scene_stage::Play;

impl<const D: usize> Run<D> {
    /// Runs the scene twice, with steps taken back, with each instruction set of the machine and,
    /// with the feature `parallel`, on 1, 2 and 4 threads. Asserts that all outcomes are equal, and
    /// returns the outcome.
    fn in_every_way<N: Play<D>>(&self) -> Outcome {
        let outcome = self.play::<N>(None);
        assert_eq!(self.play::<N>(None), outcome, "a second run");
        assert_eq!(self.play_again::<N>(), outcome, "with steps taken back");
        for lanes in Lanes::available() {
            assert_eq!(self.play::<N>(Some(lanes)), outcome, "with {lanes:?}");
        }
        #[cfg(feature = "parallel")]
        for threads in [1, 2, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let both = || (self.play::<N>(None), self.play_again::<N>());
            let here = pool.expect("a pool").install(both);
            assert_eq!(here, (outcome, outcome), "on {threads} threads");
        }
        outcome
    }

    /// Runs the scene with both scalars and compares the hashes with the golden file. Asserts that
    /// the scene has enough contacts and events for the hash to mean anything.
    fn check(&self)
    where
        f32: Play<D>,
        f64: Play<D>,
    {
        for (scalar, outcome) in
            [("f32", self.in_every_way::<f32>()), ("f64", self.in_every_way::<f64>())]
        {
            assert!(outcome.contacts > 50 && outcome.events > 20, "too little: {outcome:?}");
            compare_with_golden(&self.key(scalar), outcome.hash);
        }
    }
}

fn golden_file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden/state_hashes.txt")
}

/// Reads the golden hashes, by key; the map is empty if the file cannot be read. Each line of the
/// file has the scene, the dimension, the scalar and 16 hexadecimal digits.
fn golden() -> BTreeMap<String, u64> {
    let text = fs::read_to_string(golden_file()).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let entry = |line: &str| {
        let (key, hash) = line.rsplit_once(' ').expect("a key and a hash");
        (key.to_owned(), u64::from_str_radix(hash, 16).expect("16 digits"))
    };
    lines.map(entry).collect()
}

/// Held while the golden file is read and rewritten, since tests run on several threads.
static FILE: Mutex<()> = Mutex::new(());

fn compare_with_golden(key: &str, hash: u64) {
    let _alone = FILE.lock().expect("no other comparison panics while it holds this");
    let mut known = golden();
    if std::env::var_os("IMPINGE_BLESS").is_none() {
        let expected = known.get(key).copied();
        drop(_alone);
        assert_eq!(expected, Some(hash), "{key}: {hash:016x} (see the comment at the top)");
        return;
    }
    known.insert(key.to_owned(), hash);
    let lines = known.iter().map(|(key, hash)| format!("{key} {hash:016x}\n"));
    let head = "# Made by the test `determinism`; see the comment at its top.\n".to_owned();
    fs::write(golden_file(), std::iter::once(head).chain(lines).collect::<String>())
        .expect("the golden file can be written");
}

macro_rules! tests {
    ($($name:ident: $run:expr;)*) => {
        $(
            #[test]
            fn $name() {
                $run.check();
            }
        )*
    };
}

for_each_run!(tests);

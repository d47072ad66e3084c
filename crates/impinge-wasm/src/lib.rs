//! Hashes that must be the same on every target: the golden hashes of the test `determinism`, the
//! hashes of query results for all pairs of shapes, and the hashes of the recordings in the
//! repository.
//!
//! The native program of this package prints them. The WebAssembly module exports functions with
//! numeric arguments and results, by which `compare.mjs` reads the hashes in Node.

#[macro_use]
#[path = "../../impinge/tests/it/support/scene_stage/runs.rs"]
mod runs;
mod answers;
mod recordings;
#[path = "../../impinge/tests/it/support/scene_stage/mod.rs"]
mod scene_stage;

use std::sync::OnceLock;

use impinge_scenes::{
    few_moving, mixed_shapes, mixed_sizes, pile, sparse_drift, spawn_and_despawn, tower,
};

use runs::Run;
use scene_stage::Play;

/// A named computation of a hash.
pub struct Check {
    /// The name; for scenes, the name in the golden file.
    pub name: String,
    /// Computes the hash.
    pub hash: Box<dyn Fn() -> u64 + Send + Sync>,
}

impl core::fmt::Debug for Check {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.name)
    }
}

/// Returns all checks, in a fixed order.
#[must_use]
pub fn checks() -> &'static [Check] {
    static CHECKS: OnceLock<Vec<Check>> = OnceLock::new();
    CHECKS.get_or_init(|| {
        let mut checks = Vec::new();
        macro_rules! add {
            ($($name:ident: $run:expr;)*) => {
                $(add_run(&$run, &mut checks);)*
            };
        }
        for_each_run!(add);
        let mut add = |name: &str, hash: fn() -> u64| {
            checks.push(Check { name: name.to_owned(), hash: Box::new(hash) });
        };
        add("answers 2 f32", answers::in_plane::<f32>);
        add("answers 2 f64", answers::in_plane::<f64>);
        add("answers 3 f32", answers::in_space::<f32>);
        add("answers 3 f64", answers::in_space::<f64>);
        add("recording 2 f32", recordings::in_plane);
        add("recording 3 f64", recordings::in_space);
        checks
    })
}

fn add_run<const D: usize>(run: &Run<D>, checks: &mut Vec<Check>)
where
    f32: Play<D>,
    f64: Play<D>,
{
    let (run32, run64) = (run.clone(), run.clone());
    let hash32 = move || run32.play_again::<f32>().hash;
    let hash64 = move || run64.play_again::<f64>().hash;
    checks.push(Check { name: run.key("f32"), hash: Box::new(hash32) });
    checks.push(Check { name: run.key("f64"), hash: Box::new(hash64) });
}

/// The functions that the WebAssembly module exports.
#[cfg(target_family = "wasm")]
mod exports {
    #![expect(unsafe_code, reason = "the attribute that keeps a name counts as unsafe")]

    /// Returns the number of checks.
    #[unsafe(no_mangle)]
    extern "C" fn count() -> usize {
        super::checks().len()
    }

    /// Returns byte `byte` of the name of check `check`; zero beyond the end of the name.
    #[unsafe(no_mangle)]
    extern "C" fn name(check: usize, byte: usize) -> u32 {
        super::checks()[check].name.as_bytes().get(byte).copied().unwrap_or(0).into()
    }

    /// Returns the hash of check `check`.
    #[unsafe(no_mangle)]
    extern "C" fn hash(check: usize) -> u64 {
        (super::checks()[check].hash)()
    }
}

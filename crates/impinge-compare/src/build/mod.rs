//! The suite of what is made once: trees of boxes, meshes, hulls, broad phases and worlds with everything new.
//! Each contender makes its own from the same boxes, triangles or points; this is timed, in milliseconds. Then all
//! are asked the same, and the answers compared.
//!
//! With the feature `bytes` memory is counted instead: what is left allocated, per object, when all is
//! made. The events of the first step, which whoever asks for pairs keeps, are in it: 12 to 24 bytes per
//! pair. What is only lent to a contender is not.

mod contenders;
mod hulls;
mod measure;
mod meshes;
pub mod world;

use crate::Arguments;
use crate::broad::FAST;
use crate::broad::swarm::{Plan, Swarm};
use crate::table::Table;
use contenders::{boxes, phases, worlds};
use measure::{Maker, UNIT, measure};

/// Runs all cases of at most so many objects.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new(if UNIT == "ms" { "build" } else { "bytes" }, UNIT);
    let fits = |count: &usize| arguments.includes(*count);
    for count in [10_000, 100_000, 1_000_000].into_iter().filter(fits) {
        let cells = Swarm::new(Plan { count, ..FAST }).cells;
        let mut add = |what: &str, makers: Vec<Maker<'_>>| {
            table.add(measure(&format!("{what}, {count}"), count, &makers));
        };
        add("tree of boxes", boxes(&cells));
        add("broad phase and pairs", phases(&cells));
        add("world and contacts", worlds(&cells));
    }
    for side in [100, 707] {
        let mesh = meshes::Terrain::new(side);
        let count = mesh.triangles.len();
        if fits(&count) {
            let case = format!("mesh, {count} triangles");
            table.add(measure(&case, count, &meshes::makers(&mesh)));
        }
    }
    for count in [20, 100, 500, 2000].into_iter().filter(fits) {
        let clouds = hulls::Clouds::new(count);
        let case = format!("{} hulls of {count} points on a ball", clouds.len());
        table.add(measure(&case, count, &hulls::makers(&clouds)));
    }
    vec![table]
}

//! The suite of construction: trees of boxes, meshes, hulls, broad phases and worlds. Each
//! contender builds its structure from the same boxes, triangles or points; this is timed, in
//! milliseconds. Then all run the same queries, and the results are compared.
//!
//! With the feature `bytes` the suite counts memory instead: the bytes that stay allocated after
//! construction, per object. These bytes include the events of the first step, which a caller that
//! wants pairs keeps: 12 to 24 bytes per pair. Memory that a contender borrows is not counted.

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

/// Runs all cases up to the requested number of objects.
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

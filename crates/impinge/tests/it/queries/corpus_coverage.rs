//! Tests that every case of the corpus of bugs is run: for each kind of query, a test listed here
//! asserts the number of cases that it runs.

use crate::support::query_support;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use query_support::corpus::{narrow_phase, regression};

/// For each kind of query, the file that runs all of its cases with both scalars, and the number of
/// cases.
const RUN: [(&str, &str, usize); 12] = [
    ("convex_hull", "queries/hull/corpus.rs", 8),
    ("linear_cast", "queries/query_corpus.rs", 27),
    ("local_aabb", "queries/ray_corpus.rs", 1),
    ("nonlinear_cast", "cases/sweeps.rs", 1),
    ("point_projection", "queries/ray_corpus.rs", 8),
    ("point_sign_grid", "queries/ray_corpus.rs", 1),
    ("ray", "queries/ray_corpus.rs", 19),
    ("ray_aabb", "queries/ray_corpus.rs", 3),
    ("segment_segment", "queries/query_corpus.rs", 5),
    ("signed_distance", "queries/query_corpus.rs", 89),
    ("world_point_projection", "worlds/world_corpus.rs", 1),
    ("world_scenario", "worlds/world_corpus.rs", 14),
];

/// Cases that are not run, with the reason.
const EXEMPT: [(&str, &str); 1] =
    [("box2d-756-sliver", "asks for a moment of inertia: there are no masses here")];

#[test]
fn each_case_is_run_or_exempt_by_name() {
    let (mut counts, mut exempt) = (BTreeMap::new(), Vec::new());
    for case in regression() {
        let id = case["id"].as_str().expect("a name").to_owned();
        if EXEMPT.iter().any(|(name, _)| *name == id) {
            exempt.push(id);
            continue;
        }
        let query = case["query"].as_str().expect("a question").to_owned();
        *counts.entry(query).or_insert(0_usize) += 1;
    }
    let expected: BTreeMap<_, _> =
        RUN.iter().map(|(query, _, count)| ((*query).to_owned(), *count)).collect();
    assert_eq!(counts, expected, "kinds of questions and their cases");
    assert_eq!(exempt, EXEMPT.map(|(id, _)| id.to_owned()), "exempted cases exist, once each");
    assert_eq!(counts.values().sum::<usize>() + exempt.len(), 178, "the whole file");
    assert_eq!(narrow_phase().len(), 1600, "the other file, which query_corpus.rs runs");
}

#[test]
fn names_are_given_once() {
    for cases in [regression(), narrow_phase()] {
        let mut ids: Vec<_> = cases.iter().map(|case| case["id"].to_string()).collect();
        ids.sort();
        let count = ids.len();
        ids.dedup();
        assert_eq!(ids.len(), count, "no two cases have one name");
    }
}

/// Asserts that each listed file contains the name of its kind of query as a string.
#[test]
fn files_ask_what_they_are_said_to() {
    for (query, file, _) in RUN {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it").join(file);
        let text = fs::read_to_string(path).expect("the test is there");
        assert!(text.contains(&format!("\"{query}\"")), "{file} asks for {query}");
    }
}

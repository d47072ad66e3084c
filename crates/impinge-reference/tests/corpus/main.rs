//! Compares the reference with the corpus: cases in which published libraries erred, with expected
//! values that were computed independently of this crate.

mod distances;
mod read;
mod scenarios;

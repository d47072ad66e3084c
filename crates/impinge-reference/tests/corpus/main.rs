//! The reference against the corpus of known answers: cases on which published libraries erred,
//! with expected values that were found independently of this crate.

mod distances;
mod read;
mod scenarios;

//! Tests that all samples run, are recorded, and show what their descriptions claim.

mod claims;
mod entries;
mod motion_claims;
mod support;

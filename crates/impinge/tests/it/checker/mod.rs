//! Compares the configuration checker with single queries, and tests which inputs it refuses.

mod aligned;
mod brute;
mod random;
mod refused;
mod robots;

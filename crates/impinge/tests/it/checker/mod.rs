//! The configuration checker against single calls, and what it refuses.

mod aligned;
mod brute;
mod random;
mod refused;
mod robots;

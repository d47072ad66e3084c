#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| impinge_fuzz::nonlinear_time_of_impact(data));

//! Queries about everything in a world: against every object one by one, by hand, and at the edges.

/// Runs each check for both scalars and dimensions.
macro_rules! in_tests {
    ($($check:ident),* $(,)?) => {
        mod both_scalars_and_dimensions {
            $(
                #[test]
                fn $check() {
                    super::$check::<f32, 2>();
                    super::$check::<f32, 3>();
                    #[cfg(feature = "f64")]
                    super::$check::<f64, 2>();
                    #[cfg(feature = "f64")]
                    super::$check::<f64, 3>();
                }
            )*
        }
    };
}

mod against_all;
mod by_hand;
mod stage;

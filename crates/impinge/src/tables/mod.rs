//! Entries, which are compiled in this crate instead of the caller, and algorithms by dimension.
//!
//! Generic code is compiled where it is first used with concrete types: in the user's crate, at the optimisation level
//! of that crate, and again after each change there. So the public functions of the library are thin shells around
//! *entries*: functions that this crate compiles for each scalar and dimension. [`compiled!`] generates them from a
//! list of signatures. A program links those that it calls and what they call.
//!
//! ```text
//!   query::distance::<f32, 3>     generic, compiled in the user's crate
//!     -> entries::distance_in_world::<f32, 3>     a shell, inlined
//!          -> <Here as Entries<f32, 3>>::distance_in_world    not generic: compiled here, if its features are on
//!               -> separation::distance_in_world::<f32, 3>    generic code again, compiled here with the entry
//! ```
//!
//! Code that differs by dimension is a method of [`ByDimension`], which has one `impl` for each. This module stands
//! beside the floors: it is the only one that lower floors may use to reach higher ones.

mod by_dimension;
#[cfg(feature = "f64")]
mod double;
pub(crate) mod entries;

pub(crate) use self::by_dimension::ByDimension;

/// Declares entries: a trait with a method for each, its four implementations for [`Here`], and for each entry a
/// function that is generic over `N: Space<D>` and calls the method for `N` and `D`.
///
/// An `inlined trait` has entries that are too small to be called: if the user's build has no debug assertions, the
/// generic code is compiled into the caller. In a debug build, which does not optimise the caller, a call is many times
/// as fast, whether this crate is optimised there or not.
///
/// A list `where feature = "…"` is compiled here only with that feature.
///
/// Signatures use `N` and `D`, which are concrete where targets are named. Without the feature of a dimension its
/// entries are compiled where they are used, which is nowhere.
macro_rules! compiled {
    ($(#[$about:meta])* trait $entries:ident; $($list:tt)*) => {
        $crate::tables::compiled! { @list called, all(); $(#[$about])* trait $entries; $($list)* }
    };
    ($(#[$about:meta])* trait $entries:ident where $needed:meta; $($list:tt)*) => {
        $crate::tables::compiled! { @list called, $needed; $(#[$about])* trait $entries; $($list)* }
    };
    ($(#[$about:meta])* inlined trait $entries:ident; $($list:tt)*) => {
        $crate::tables::compiled! { @list inlined, all(); $(#[$about])* trait $entries; $($list)* }
    };
    (
        @list $mode:ident, $needed:meta;
        $(#[$about:meta])*
        trait $entries:ident;
        $(
            $(#[$meta:meta])*
            fn $name:ident $(<$life:lifetime>)? ($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? = $target:expr;
        )*
    ) => {
        $(#[$about])*
        #[allow(unnameable_types, private_interfaces, reason = "for this crate alone")]
        pub trait $entries<N, const D: usize> {
            $(
                $(#[$meta])*
                fn $name$(<$life>)?($($argument: $type),*) $(-> $result)?
                where
                    N: $crate::math::Space<D>;
            )*
        }

        $(
            $(#[$meta])*
            #[inline(always)]
            pub(crate) fn $name<$($life,)? N: $crate::math::Space<D>, const D: usize>(
                $($argument: $type),*
            ) $(-> $result)? {
                $crate::tables::compiled! { @$mode $entries, $name, $target, ($($argument),*) }
            }
        )*

        $crate::tables::compiled! { @of f32, 2, all(feature = "dim2", $needed), $entries;
            $( $(#[$meta])* fn $name $(<$life>)? ($($argument: $type),*) $(-> $result)? = $target; )* }
        $crate::tables::compiled! { @of f32, 3, all(feature = "dim3", $needed), $entries;
            $( $(#[$meta])* fn $name $(<$life>)? ($($argument: $type),*) $(-> $result)? = $target; )* }
        #[cfg(feature = "f64")]
        $crate::tables::compiled! { @of f64, 2, all(feature = "dim2", $needed), $entries;
            $( $(#[$meta])* fn $name $(<$life>)? ($($argument: $type),*) $(-> $result)? = $target; )* }
        #[cfg(feature = "f64")]
        $crate::tables::compiled! { @of f64, 3, all(feature = "dim3", $needed), $entries;
            $( $(#[$meta])* fn $name $(<$life>)? ($($argument: $type),*) $(-> $result)? = $target; )* }
    };
    (@called $entries:ident, $name:ident, $target:expr, ($($argument:ident),*)) => {
        <<N as $crate::tables::Compiled<D>>::Here as $entries<N, D>>::$name($($argument),*)
    };
    (@inlined $entries:ident, $name:ident, $target:expr, ($($argument:ident),*)) => {
        if cfg!(debug_assertions) {
            $crate::tables::compiled! { @called $entries, $name, $target, ($($argument),*) }
        } else {
            $target($($argument),*)
        }
    };
    (
        @of $scalar:ty, $dimension:literal, $needed:meta, $entries:ident;
        $(
            $(#[$meta:meta])*
            fn $name:ident $(<$life:lifetime>)? ($($argument:ident: $type:ty),*) $(-> $result:ty)? = $target:expr;
        )*
    ) => {
        const _: () = {
            type N = $scalar;
            const D: usize = $dimension;
            #[allow(private_interfaces, reason = "for this crate alone")]
            impl $entries<N, D> for $crate::tables::Here {
                $(
                    $(#[$meta])*
                    #[cfg_attr(not($needed), inline)]
                    fn $name$(<$life>)?($($argument: $type),*) $(-> $result)? {
                        $target($($argument),*)
                    }
                )*
            }
        };
    };
}
pub(crate) use compiled;

/// Implements the entries and algorithms of all scalars and dimensions. A separate type, so that a user's `N` does not
/// get methods of the library.
#[expect(unnameable_types, reason = "for this crate alone")]
#[derive(Debug)]
pub struct Here;

/// A scalar with entries in `D` dimensions. Sealed, since it cannot be named outside.
#[expect(unnameable_types, reason = "for this crate alone")]
pub trait Compiled<const D: usize>: Sized {
    /// Always [`Here`].
    type Here: entries::Entries<Self, D>
        + entries::SmallEntries<Self, D>
        + crate::batch::BatchEntries<Self, D>
        + crate::checker::CheckerEntries<Self, D>
        + crate::partitioning::SearchEntries<Self, D>
        + crate::shape::FieldEntries<Self, D>
        + crate::shape::MeshEntries<Self, D>
        + crate::world::SmallWorldEntries<Self, D>
        + crate::world::WorldEntries<Self, D>;
}

impl Compiled<2> for f32 {
    type Here = Here;
}

impl Compiled<3> for f32 {
    type Here = Here;
}

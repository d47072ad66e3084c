//! Entries (functions that are compiled in this crate instead of the caller's), and the algorithms
//! that differ by dimension.
//!
//! Generic code is compiled where it is first used with concrete types: in the user's crate, at the
//! optimisation level of that crate, and again after each change there. So the public functions of
//! the library are thin generic wrappers around *entries*: functions that this crate compiles for
//! each scalar and dimension. [`compiled!`] generates the entries from a list of signatures. A
//! program links only the entries that it calls, and their callees.
//!
//! ```text
//!   query::distance::<f32, 3>     generic, compiled in the user's crate
//!     -> entries::distance_in_world::<f32, 3>     a wrapper, inlined
//!          -> <Here as Entries<f32, 3>>::distance_in_world    not generic: compiled here, if its features are on
//!               -> separation::distance_in_world::<f32, 3>    generic code again, compiled here with the entry
//! ```
//!
//! Code that differs by dimension is a method of [`ByDimension`], which has one `impl` for each
//! dimension. This module is on no floor of `ARCHITECTURE.md`: it is the only module through which
//! lower floors may reach higher floors.

mod by_dimension;
#[cfg(feature = "f64")]
mod double;
pub(crate) mod entries;

pub(crate) use self::by_dimension::ByDimension;

/// Declares entries. Generates a trait with a method for each entry, the implementations of this
/// trait for [`Here`] (two scalars, two dimensions), and for each entry a generic function over
/// `N: Space<D>` that calls the method for `N` and `D`.
///
/// An `inlined trait` has entries whose work is small compared with a call: in a build without
/// debug assertions, their generic code is compiled into the caller. A build with debug assertions
/// usually does not optimise the caller. In such a build a call of the entry is many times as fast
/// as its code in the caller, even if this crate is not optimised either.
///
/// Entries of a list `where feature = "…"` are compiled in this crate only with that feature, else
/// in the crates that call them.
///
/// Signatures use `N` and `D`, which are concrete types and numbers in the implementations. Without
/// the feature of a dimension, its entries are `#[inline]` functions that no one calls, so they are
/// not compiled.
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

/// The type that implements the entries and algorithms of all scalars and dimensions. They are not
/// methods of the scalar, since these would be visible on a user's `N`.
#[expect(unnameable_types, reason = "for this crate alone")]
#[derive(Debug)]
pub struct Here;

/// A scalar with entries in `D` dimensions. The trait is sealed: other crates cannot name it.
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

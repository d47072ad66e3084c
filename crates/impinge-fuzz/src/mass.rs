//! Mass properties of one shape.

use impinge::math::{Point, Space, Vector};
use impinge::query::{MassError, mass_properties};
use impinge::shape::Compound;

use crate::place::Dimension;
use crate::shapes::{anatomy, is_unbounded, parts_of, reach, shape};
use crate::{Bytes, Task, dispatch};

struct Masses;

/// Fuzzes [`mass_properties`].
pub fn mass(data: &[u8]) {
    dispatch(Masses, data);
}

impl Task for Masses {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let shape = shape::<N, M, D>(bytes);
        let (position, density) = (M::position(bytes), bytes.number::<N>());
        let found = mass_properties(&*shape, density);
        let context = || format!("{found:?} of the density {density}\n{}", anatomy(&*shape));
        let is_density = density >= N::ZERO && density.is_finite_number();
        let body = match &found {
            Ok(body) => body,
            Err(MassError::Unbounded { part } | MassError::NotClosed { part }) => {
                assert!(*part < parts_of(&*shape).unwrap_or(1), "{}", context());
                return;
            }
            Err(error) => {
                assert!(!error.to_string().is_empty(), "{}", context());
                return;
            }
        };
        assert!(is_density && !is_unbounded(&*shape), "{}", context());
        let inverse = body.inverse_mass();
        assert!(body.mass() >= N::ZERO && inverse >= N::ZERO, "{}", context());
        assert!(inverse.is_finite_number() && body.mass().is_finite_number(), "{}", context());
        // The centre of a convex shape lies in its box. The centre of a mesh with winding numbers
        // of both signs may be anywhere, so composites are not checked.
        if bytes.is_moderate() && parts_of(&*shape).is_none() {
            let (aabb, noise) = (shape.local_aabb(), reach(&*shape) * N::EPSILON * N::lit(64.0));
            let around = Vector::<N, D>::repeat(noise);
            let (low, high) = (aabb.mins() - around, aabb.maxs() + around);
            let is_in =
                |p: &Point<N, D>| (0..D).all(|axis| low[axis] <= p[axis] && p[axis] <= high[axis]);
            assert!(is_in(body.center_of_mass()), "{}", context());
        }
        let placed = Compound::try_new(vec![(M::stored(position), shape.clone())]);
        let Ok(placed) = placed.map(|compound| mass_properties(&compound, density)) else { return };
        // The solid may be too far away for a finite centre.
        let Ok(placed) = placed else { return };
        assert_eq!(placed.mass(), body.mass(), "{}", context());
    }
}

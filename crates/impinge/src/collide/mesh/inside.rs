//! Contacts of connected pieces of one shape that lie wholly inside a body of the other shape.
//! These contacts push the piece out through the nearest part of the body's boundary.

use super::part_contact::{Arena, contact_of_solids};
use super::scene::Scene;
use super::{PartContacts, Query};
use crate::collide::parts::{Exit, InsidePiece, InsidePieces, find_exits, held_pieces};
use crate::math::{Space, Unit};
use crate::shape::Plane;

impl<N: Space<D>, const D: usize> Query<'_, N, D> {
    /// Returns the pieces that are inside of bodies, and removes the contacts of their parts with
    /// the boundary from `contacts`: from inside, the boundary is not a surface to touch.
    ///
    /// A piece with a part that overlaps the boundary is not returned: the contacts of its parts
    /// push it out.
    pub(super) fn take_inside(&self, contacts: &mut PartContacts<N, D>) -> InsidePieces<N, D> {
        if self.is_self || !self.between.has_bodies() {
            return InsidePieces::new();
        }
        let mut pieces = held_pieces(self.between);
        let is_of = |piece: &InsidePiece<N, D>, parts| piece.has(self.between, parts);
        pieces.retain(|piece| {
            let crosses = |contact: &super::PartContact<N, D>| {
                contact.distance <= N::ZERO && is_of(piece, contact.parts())
            };
            !contacts.iter().any(crosses)
        });
        find_exits(self.between, &mut pieces);
        contacts.retain(|contact| !pieces.iter().any(|piece| is_of(piece, contact.parts())));
        pieces
    }

    /// Appends the contacts of a piece that is inside: the contacts of its parts with the
    /// half-space below the exit plane. Appends nothing if [`InsidePiece::exit`] returns `None`.
    pub(super) fn add_inside(
        &self,
        scene: &Scene<'_, N, D>,
        piece: &InsidePiece<N, D>,
        contacts: &mut PartContacts<N, D>,
        arena: &mut Arena<N, D>,
    ) {
        let Some(Exit { point, outward, parts }) = piece.exit() else { return };
        let inner = piece.inner;
        let outward =
            if inner == 0 { self.between.pair.pose12.inverse_vector(&outward) } else { outward };
        let Ok(plane) = Plane::try_new(Unit::new_unchecked(outward)) else { return };
        piece.each_part(self.between, |part| {
            let (placed, mut pair_parts) = (scene.above(&plane, &point, (inner, part)), parts);
            pair_parts[inner] = part;
            contacts.extend(contact_of_solids(&placed, pair_parts, self.request, arena));
        });
    }
}

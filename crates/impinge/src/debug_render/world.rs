//! Drawing of a world.

use super::drawing::draw_box;
use super::{DebugDrawing, DebugOptions, DebugRender, Drawn};
use crate::bounding_volume::Aabb;
use crate::collide::Placed;
use crate::math::{Point, Space};
use crate::query::Proximity;
use crate::tables::entries;
use crate::world::{CollisionObject, CollisionWorld};

impl<N: Space<D>, const D: usize> DebugDrawing<N, D> {
    /// Draws a world: everything for which [`options`](Self::options) has a style.
    ///
    /// Shapes and tight boxes are drawn at the current positions of the objects. Contacts, boxes of
    /// the broad phase, and the list of pairs with proximity are as of the last update. For a pair
    /// with proximity, a line is drawn between the nearest points of the objects, or between their
    /// origins if they intersect. For disjoint objects no line is drawn.
    ///
    /// The cost is O(n) for n drawn objects, plus sorting the contacts by handles, plus a mesh for
    /// each shape that was not drawn before.
    pub fn world<T>(
        &mut self,
        world: &CollisionWorld<N, D, T>,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        self.forget_dropped();
        self.tree_nodes(world, renderer);
        self.boxes(world, renderer);
        for object in world.collision_objects() {
            if let Some(style) = self.object_style(object.handle()) {
                let (mesh, position) = (self.mesh(object.shape()), object.position());
                renderer.mesh(mesh, position, style.color, Drawn::Object);
            }
        }
        self.manifolds(world, renderer);
        self.proximities(world, renderer);
    }

    /// Draws the boxes of the broad phase's nodes. They are drawn first, so that they do not cover
    /// other objects.
    fn tree_nodes<T>(&self, world: &CollisionWorld<N, D, T>, renderer: &mut dyn DebugRender<N, D>) {
        if let Some(style) = &self.options.tree_node {
            let mut draw = |aabb: &Aabb<N, D>| draw_box(aabb, style, Drawn::TreeNode, renderer);
            world.broad_phase().visit_nodes(&mut draw);
        }
    }

    /// Draws the boxes of each object: first its tight box, then its loosened box.
    fn boxes<T>(&self, world: &CollisionWorld<N, D, T>, renderer: &mut dyn DebugRender<N, D>) {
        let (tight, loosened) = (&self.options.tight_box, &self.options.loosened_box);
        for object in world.collision_objects() {
            if let Some(style) = tight {
                let pose = object.shape().geometry().pose_at(object.position());
                let aabb = object.shape().aabb(&pose);
                draw_box(&aabb, style, Drawn::TightBox, renderer);
            }
            if let Some(style) = loosened
                && let Some(aabb) = world.broad_phase().loosened(object.proxy_handle())
            {
                draw_box(&aabb, style, Drawn::LoosenedBox, renderer);
            }
        }
    }

    /// Draws the contacts of all pairs, sorted by handles, since views come in memory order.
    fn manifolds<T>(&self, world: &CollisionWorld<N, D, T>, renderer: &mut dyn DebugRender<N, D>) {
        let DebugOptions { contact_point, contact_normal, manifold, .. } = self.options;
        if contact_point.or(contact_normal).or(manifold).is_none() {
            return;
        }
        // A stable sort keeps the order within a pair.
        let mut views: Vec<_> = world.contact_views().collect();
        views.sort_by_key(|(object1, object2, _)| (object1.handle(), object2.handle()));
        for (_, _, view) in views {
            self.contacts(view.contacts().map(|point| point.contact), renderer);
        }
    }

    /// Draws a line for each pair that is near or intersects, sorted by handles.
    fn proximities<T>(
        &self,
        world: &CollisionWorld<N, D, T>,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        let Some(style) = self.options.proximity else { return };
        let pairs = world.proximity_pairs();
        let mut near: Vec<_> =
            pairs.filter(|(_, _, pair)| pair.proximity() != Proximity::Disjoint).collect();
        near.sort_by_key(|(object1, object2, _)| (object1.handle(), object2.handle()));
        for (object1, object2, _) in near {
            renderer.line(ends_between(object1, object2), style.color, Drawn::Proximity);
        }
    }
}

/// Returns the nearest points of two objects; their origins if they intersect.
fn ends_between<N: Space<D>, const D: usize, T>(
    object1: &CollisionObject<N, D, T>,
    object2: &CollisionObject<N, D, T>,
) -> [Point<N, D>; 2] {
    let objects = [object1, object2];
    let [placed1, placed2] = objects.map(|object| {
        let shape = object.shape().geometry();
        Placed { pose: shape.pose_at(object.position()), shape }
    });
    match entries::touching_in_world(&placed1, &placed2, N::INFINITY) {
        Some(found) if found.distance > N::ZERO => [found.point1, found.point2],
        _ => objects.map(|object| Point::from(N::translation(object.position()))),
    }
}

//! Drawing of a world with Bevy's gizmos.

use core::fmt;
use core::marker::PhantomData;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_color::Color as BevyColor;
use bevy_ecs::prelude::{IntoScheduleConfigs, Res, ResMut, Resource};
use bevy_gizmos::config::GizmoConfigGroup;
use bevy_gizmos::gizmos::{GizmoBuffer, Gizmos};
use bevy_math::Vec3;
use impinge::debug_render::{Color, DebugDrawing, DebugOptions, DebugRender, Drawn};
use impinge::math::Point;

use crate::glam::Glam;
use crate::{Collisions, DefaultWorld, ImpingeSystems, WorldKey};

/// The options for drawing a world as lines: by default colliders, contact points and normals. A resource; change
/// its [`options`](Self::set_options) at any time.
#[derive(Resource)]
pub struct DebugGizmos<const D: usize, W: WorldKey = DefaultWorld>
where
    f32: Glam<D>,
{
    drawing: DebugDrawing<f32, D>,
    is_enabled: bool,
    key: PhantomData<W>,
}

impl<const D: usize, W: WorldKey> Default for DebugGizmos<D, W>
where
    f32: Glam<D>,
{
    fn default() -> Self {
        let drawing = DebugDrawing::new(DebugOptions::default());
        Self { drawing, is_enabled: true, key: PhantomData }
    }
}

impl<const D: usize, W: WorldKey> DebugGizmos<D, W>
where
    f32: Glam<D>,
{
    /// Sets the drawn layers, and the sizes of points and normals.
    pub fn set_options(&mut self, options: DebugOptions<f32>) {
        self.drawing.set_options(options);
    }

    /// Disables or enables drawing.
    pub fn set_enabled(&mut self, is_enabled: bool) {
        self.is_enabled = is_enabled;
    }

    /// Draws a world into the gizmos of a system or into a buffer of yours. Does nothing while
    /// drawing is disabled.
    pub fn draw<C: GizmoConfigGroup, E: Send + Sync + 'static>(
        &mut self,
        collisions: &Collisions<D, W>,
        gizmos: &mut GizmoBuffer<C, E>,
    ) {
        if self.is_enabled {
            self.drawing.world(collisions.world(), &mut GizmoLines { gizmos });
        }
    }
}

impl<const D: usize, W: WorldKey> fmt::Debug for DebugGizmos<D, W>
where
    f32: Glam<D>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DebugGizmos").field("is_enabled", &self.is_enabled).finish_non_exhaustive()
    }
}

/// Draws a world with the default gizmos in `PostUpdate`. Needs Bevy's `GizmoPlugin`, and [`DebugGizmos`], which it
/// inserts.
#[derive(Clone, Copy, Debug, Default)]
pub struct DebugGizmosPlugin<const D: usize, W = DefaultWorld>(PhantomData<W>);

impl<const D: usize, W: WorldKey> Plugin for DebugGizmosPlugin<D, W>
where
    f32: Glam<D>,
{
    fn build(&self, app: &mut App) {
        app.init_resource::<DebugGizmos<D, W>>()
            .add_systems(PostUpdate, draw::<D, W>.after(ImpingeSystems::Report));
    }
}

fn draw<const D: usize, W: WorldKey>(
    collisions: Res<'_, Collisions<D, W>>,
    mut drawing: ResMut<'_, DebugGizmos<D, W>>,
    mut gizmos: Gizmos<'_, '_>,
) where
    f32: Glam<D>,
{
    drawing.draw(&collisions, &mut gizmos);
}

/// A back end of the library's drawing that draws lines with gizmos; for drawings of your own.
pub struct GizmoLines<'a, C: GizmoConfigGroup, E: Send + Sync + 'static> {
    /// The output for lines.
    pub gizmos: &'a mut GizmoBuffer<C, E>,
}

impl<C: GizmoConfigGroup, E: Send + Sync + 'static> fmt::Debug for GizmoLines<'_, C, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GizmoLines").finish_non_exhaustive()
    }
}

impl<const D: usize, C: GizmoConfigGroup, E: Send + Sync + 'static> DebugRender<f32, D>
    for GizmoLines<'_, C, E>
where
    f32: Glam<D>,
{
    fn line(&mut self, ends: [Point<f32, D>; 2], color: Color, _: Drawn) {
        // In 2D the z coordinate is zero.
        let place = |point: &Point<f32, D>| {
            let coordinate = |axis: usize| point.coords.get(axis).copied().unwrap_or_default();
            Vec3::new(coordinate(0), coordinate(1), coordinate(2))
        };
        let [from, to] = &ends;
        let [red, green, blue] = color.rgb;
        let color = BevyColor::srgba_u8(red, green, blue, color.alpha);
        self.gizmos.line(place(from), place(to), color);
    }
}

//! Tests that the plugin draws a world with gizmos if and only if drawing is enabled.

use bevy_asset::Assets;
use bevy_gizmos::config::DefaultGizmoConfigGroup;
use bevy_gizmos::{AppGizmoBuilder, GizmoAsset};
use bevy_impinge::{DebugGizmos, DebugGizmosPlugin, Glam};

use crate::support::{app, spawn};

/// Returns the number of gizmo assets that an app draws, without a renderer.
fn drawn<const D: usize>(is_enabled: bool) -> usize
where
    f32: Glam<D>,
{
    let mut app = app::<D>();
    app.init_resource::<Assets<GizmoAsset>>().init_gizmo_group::<DefaultGizmoConfigGroup>();
    app.add_plugins(DebugGizmosPlugin::<D>::default());
    app.world_mut().resource_mut::<DebugGizmos<D>>().set_enabled(is_enabled);
    spawn::<D>(&mut app, 0.0);
    app.update();
    app.world().resource::<Assets<GizmoAsset>>().iter().count()
}

#[test]
fn the_plugin_draws_what_is_in_the_world() {
    assert_eq!((drawn::<2>(true), drawn::<3>(true)), (1, 1), "one list of lines");
    assert_eq!((drawn::<2>(false), drawn::<3>(false)), (0, 0), "nothing");
}

//! Tests of compounds, meshes, polylines and height fields.

mod cast_out_of_floors;
mod closed_meshes;
mod composite_contacts;
mod composite_distance;
mod composite_impact;
mod composite_laws;
mod composite_points;
mod composite_rays;
mod composite_worlds;
mod compounds;
mod doubled_parts;
mod ghosts;
mod ghosts_in_valleys;
mod height_field_seams;
mod height_fields;
mod internal_edges;
mod internal_edges_of_lines;
mod large_hulls;
mod meshes;
mod replaced_terrain;
mod resting;
mod solid_meshes;
mod thin_triangles;

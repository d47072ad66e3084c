//! Tests of queries of one shape and of two.

mod corpus_coverage;
mod directions;
mod extremes;
mod hull;
mod impact;
mod impact_laws;
mod impact_starts;
mod impact_turning;
mod mass;
mod nested;
mod pair_table;
mod point_by_hand;
mod point_shapes;
mod procedural;
mod query_corpus;
mod query_laws;
mod query_values;
mod ray_batches;
mod ray_by_hand;
mod ray_corpus;
mod ray_kinds;
mod ray_shapes;
mod scale;
mod scale_of_answers;
mod scaling;
mod shared_corners;

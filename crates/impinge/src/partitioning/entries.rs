//! Entry points for trees of boxes, whose generic code is compiled in this crate.

use super::{BoxTree, BoxTreeError, Question, Sweep};
use crate::bounding_volume::Aabb;
use crate::tables::compiled;

compiled! {
    /// Entry points for building and searching trees of boxes.
    trait SearchEntries;

    fn build(boxes: Vec<Aabb<N, D>>) -> Result<BoxTree<N, D>, BoxTreeError> = BoxTree::build;

    fn refit(tree: &mut BoxTree<N, D>, boxes: &[Aabb<N, D>]) -> Result<(), BoxTreeError> =
        BoxTree::refit_to;

    fn each(tree: &BoxTree<N, D>, question: &Question<'_, N, D>, found: &mut dyn FnMut(u32)) =
        BoxTree::answer;

    fn by_time(
        tree: &BoxTree<N, D>,
        sweep: &Sweep<N, D>,
        limit: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) = BoxTree::by_time;

    fn near_first(
        tree: &BoxTree<N, D>,
        sweep: &Sweep<N, D>,
        limit: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) = BoxTree::near_first;

    fn by_distance(
        tree: &BoxTree<N, D>,
        own: &Aabb<N, D>,
        limit: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) = BoxTree::by_distance;

    fn nearest_first(
        tree: &BoxTree<N, D>,
        own: &Aabb<N, D>,
        limit: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) = BoxTree::nearest_first;
}

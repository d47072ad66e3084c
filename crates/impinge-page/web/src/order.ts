// The order in which the parts of a picture are drawn. Parts that are tested for depth hide each other by depth. Each
// of the other parts covers all earlier parts.

/**
 * Opaque solids in 3D write depth. Transparent solids and lines are drawn after them and write no depth, so they do not
 * hide each other. In 2D nothing writes depth, so the order alone decides what is covered.
 */
export const ORDER = {
  grid: 0,
  solids: 1,
  /** Edges of solids in 3D, tested for depth. */
  edges: 2,
  transparentSolids: 3,
  /** Edges in 2D, where solids would cover them. */
  edgesOfAreas: 4,
  /** Boxes, trees and outlines, tested for depth. */
  lines: 5,
  /** This and all later parts are not tested: manifolds, normals and contacts are on surfaces or within solids. */
  areas: 6,
  linesAbove: 7,
  answers: 8,
  dots: 9,
};

// In which order a picture is painted. Depth decides among what is tested for it; the rest covers what came before.

/**
 * Opaque solids write depth. Whatever is transparent or a line is drawn after them, and writes none, so that all of it
 * remains visible. In 2D nothing has depth: the order is that of the layers of a drawing.
 */
export const ORDER = {
  grid: 0,
  solids: 1,
  /** Of solids in 3D, tested for depth. */
  edges: 2,
  transparentSolids: 3,
  /** In 2D, where solids would cover them. */
  edgesOfAreas: 4,
  /** Boxes, trees and outlines in space: tested for depth. */
  lines: 5,
  /** From here on nothing is tested: manifolds, normals and contacts lie on surfaces or within solids. */
  areas: 6,
  linesAbove: 7,
  answers: 8,
  dots: 9,
};

// Shaded views of an object in parallel projection, with their place in the object's own lengths.
#pragma once

#include "ostraka/catalogue/entry.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/render/view.h"

namespace ostraka::detail {

/// How a view is made.
struct ViewStyle {
    int pixels = 600;       ///< pixels along the longer side
    bool shaded = true;     ///< false: no picture, only the extent and the outline
    bool outlined = false;  ///< true: with the curves of the silhouette
};

/// A view of the object, whose z axis points up; the origin of the view's coordinates is the projection of the origin.
/// `mesh`: the same triangles, for the outline.
CatalogueView make_view(const TriangleSoup& soup, const Mesh& mesh, const View& view, const ViewStyle& style);

/// Adds the places of those landmarks to the view that no part of the surface hides.
void mark_landmarks(CatalogueView& view, const View& direction, const SurfaceSearch& surface,
                    const std::vector<std::array<double, 3>>& landmarks);

/// A mesh of unconnected triangles, for soups that are no manifold.
Mesh loose_mesh(const TriangleSoup& soup);

}  // namespace ostraka::detail

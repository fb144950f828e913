#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Converts triangles of any topology to a polygon soup.
inline PolygonSoup as_polygons(TriangleSoup triangles, MeshExtras extras) {
    PolygonSoup soup;
    soup.points = std::move(triangles.points);
    soup.extras = std::move(extras);
    for (const auto& triangle : triangles.triangles) {
        soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
        soup.polygon_begin.push_back(static_cast<Index>(soup.corners.size()));
    }
    return soup;
}

}  // namespace ostraka

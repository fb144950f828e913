// Measures how well cage coordinates satisfy their defining properties (partition of unity, linear precision, sign).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/files/json.h"

#include <optional>

namespace ostraka {

/// Measured properties of cage coordinates. Lengths are relative to the diagonal of the cage's bounding box.
struct CoordinateCertificate {
    std::string kind;
    std::size_t points = 0, vertices = 0, faces = 0;  ///< number of points, and size of the cage

    double partition = 0;           ///< largest |sum of the vertex weights - 1|
    double linear = 0;              ///< largest distance between a point and the combination of the rest cage by its weights
    Index worst_linear = no_index;  ///< point with that distance

    /// Properties of the kind in this cage, evaluated on the cage itself; absent for kinds that are not defined there. The
    /// weights of coincident vertices are added.
    std::optional<double> lagrange = {};  ///< at the vertices: largest deviation from 1 (own weight) or 0 (others)
    std::optional<double> edges = {};     ///< at three points on each edge: largest deviation from linear weights
    std::optional<double> on_faces = {};  ///< same at three points on each face

    double negative = 0;       ///< share of the vertex weights that are negative
    double negative_rows = 0;  ///< share of the points with a negative weight
    double minimum = 0, maximum = 0;
    double negative_sum = 0;   ///< largest sum of the absolute values of a point's negative weights
    double carriers_mean = 0;  ///< mean number of weights that carry 95 % of the sum of absolute values at a point
    Index carriers_max = 0;    ///< maximum of that number

    /// True if the sums of weights are 1 to 1e-10 and points are reproduced to 1e-9: usable for deformation.
    [[nodiscard]] bool holds() const { return partition <= 1e-10 && linear <= 1e-9; }
};

/// Measures coordinates of `points` in `cage`. Throws Error (usage) if the sizes do not match, Error (input) for a weight that
/// is not finite. O(points x (vertices + faces)).
CoordinateCertificate certify(const Coordinates& coordinates, const Mesh& cage, const std::vector<Point>& points,
                              const CoordinateOptions& options = {});

JsonValue to_json(const CoordinateCertificate& certificate, JsonAllocator& allocator);

}  // namespace ostraka

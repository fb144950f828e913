// Measures how well cage coordinates satisfy their defining properties: partition of unity, linear precision, sign.
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/files/json.h"

#include <optional>

namespace ostraka {

/// Measured properties of cage coordinates. Lengths are relative to the diagonal of the cage's bounding box.
struct CoordinateCertificate {
    std::string kind;                                 ///< kind of coordinates ("mean-value", ...)
    std::size_t points = 0, vertices = 0, faces = 0;  ///< number of points, and of vertices and faces of the cage

    double partition = 0;  ///< largest |sum of the vertex weights of a point - 1|
    /// Largest distance between a point and the combination of the undeformed cage with the point's weights.
    double linear = 0;
    Index worst_linear = no_index;  ///< index of the point with the distance `linear`

    /// Largest deviation of the weights at cage vertices from 1 (own weight) or 0 (other weights). The weights of coincident
    /// vertices are added. None for kinds that are not defined on the cage.
    std::optional<double> lagrange = {};
    /// Largest deviation from linear weights, at three points on each cage edge; none for kinds that are not defined on the cage.
    std::optional<double> edges = {};
    /// Largest deviation from linear weights, at three points on each cage face; none for kinds that are not defined on the cage.
    std::optional<double> on_faces = {};

    double negative = 0;              ///< fraction of the vertex weights that are negative
    double negative_rows = 0;         ///< fraction of the points with a negative weight
    double minimum = 0, maximum = 0;  ///< smallest and largest vertex weight
    double negative_sum = 0;          ///< largest sum of the absolute values of a point's negative weights
    /// Smallest number of weights that carry 95 % of the sum of absolute weights of a point, mean over the points.
    double carriers_mean = 0;
    /// Smallest number of weights that carry 95 % of the sum of absolute weights, maximum over the points.
    Index carriers_max = 0;

    /// True if the weights can be used for deformation: `partition` is at most 1e-10 and `linear` at most 1e-9.
    [[nodiscard]] bool holds() const { return partition <= 1e-10 && linear <= 1e-9; }
};

/// Measures the properties of coordinates of `points` in `cage`. Throws Error (usage) if the sizes do not match, Error (input)
/// for a weight that is not finite. Time: O(points x (vertices + faces)).
CoordinateCertificate certify(const Coordinates& coordinates, const Mesh& cage, const std::vector<Point>& points,
                              const CoordinateOptions& options = {});

JsonValue to_json(const CoordinateCertificate& certificate, JsonAllocator& allocator);

}  // namespace ostraka

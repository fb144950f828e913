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
    /// Largest distance between a point and the position that its weights reproduce from the undeformed cage.
    double linear = 0;
    Index worst_linear = no_index;  ///< index of the point where the distance `linear` occurs

    /// Largest deviation, at the positions of the cage vertices, of the weight of that vertex from 1 or of another weight from
    /// 0. The weights of coincident vertices are added. None for kinds that are not defined on the cage.
    std::optional<double> lagrange = {};
    /// Largest deviation from linear weights, at three points on each cage edge; none for kinds that are not defined on the cage.
    std::optional<double> edges = {};
    /// Largest deviation from linear weights, at three points on each cage face; none for kinds that are not defined on the cage.
    std::optional<double> on_faces = {};

    double negative = 0;              ///< fraction of the vertex weights that are negative
    double negative_rows = 0;         ///< fraction of the points with a negative weight
    double minimum = 0, maximum = 0;  ///< smallest and largest vertex weight
    double negative_sum = 0;          ///< largest sum of the absolute values of a point's negative weights
    /// For each point, the smallest number of weights whose absolute values make up 95 % of the sum over all weights; mean over
    /// the points.
    double dominant_weights_mean = 0;
    /// As `dominant_weights_mean`, but the maximum over the points.
    Index dominant_weights_max = 0;

    /// True if the weights can be used for deformation: `partition` is at most 1e-10 and `linear` at most 1e-9.
    [[nodiscard]] bool holds() const { return partition <= 1e-10 && linear <= 1e-9; }
};

/// Measures the properties of coordinates of `points` in `cage`. Throws Error (usage) if the sizes do not match, Error (input)
/// for a weight that is not finite. Time: O(points x (vertices + faces)).
CoordinateCertificate certify(const Coordinates& coordinates, const Mesh& cage, const std::vector<Point>& points,
                              const CoordinateOptions& options = {});

JsonValue to_json(const CoordinateCertificate& certificate, JsonAllocator& allocator);

}  // namespace ostraka

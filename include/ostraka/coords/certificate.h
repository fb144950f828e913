// What coordinates promise, measured.
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/json.h"

#include <optional>

namespace ostraka {

/// Lengths are shares of the diagonal of the cage's box.
struct CoordinateCertificate {
    std::string kind;
    std::size_t points = 0, vertices = 0, faces = 0;  ///< of the cage

    double partition = 0;           ///< largest |sum of the vertex weights - 1|
    double linear = 0;              ///< largest distance of a point from what its weights make of the cage at rest
    Index worst_linear = no_index;  ///< where

    /// The kind in this cage, evaluated on it; absent for kinds that are not defined there. Weights of vertices at one place
    /// count as one.
    std::optional<double> lagrange = {};  ///< at the vertices: largest deviation of a weight from 1 (its own) or 0
    std::optional<double> edges = {};     ///< at three points on each edge: largest deviation from linear weights
    std::optional<double> on_faces = {};  ///< at three points on each face

    double negative = 0;       ///< share of the vertex weights that are below zero
    double negative_rows = 0;  ///< share of the points that have one
    double minimum = 0, maximum = 0;
    double negative_sum = 0;   ///< largest sum of the absolute values of a point's negative weights
    double carriers_mean = 0;  ///< weights that carry 95 % of the absolute values at a point: mean
    Index carriers_max = 0;    ///< and most

    /// Partition to 1e-10 and linear precision to 1e-9: fit for deformation.
    [[nodiscard]] bool holds() const { return partition <= 1e-10 && linear <= 1e-9; }
};

/// Measures coordinates of `points` in `cage`. Throws Error (usage) if their numbers do not fit, Error (input) for a weight that
/// is not finite. O(points x (vertices + faces)).
CoordinateCertificate certify(const Coordinates& coordinates, const Mesh& cage, const std::vector<Point>& points,
                              const CoordinateOptions& options = {});

JsonValue to_json(const CoordinateCertificate& certificate, JsonAllocator& allocator);

}  // namespace ostraka

// Harmonic coordinates (Joshi, Meyer, DeRose, Green and Sanocki 2007) by linear finite elements.
#include "coords/interior_weights.h"
#include "coords/kinds.h"

#include "ostraka/algebra/cholesky.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/stopwatch.h"

#include <Eigen/Dense>

#include <cmath>

namespace ostraka::coords {

CellGradients gradients_of(const CageInterior& inside) {
    CellGradients result;
    result.volume.reserve(inside.cells().size());
    for (const auto& cell : inside.cells()) {
        const Vector3d a = inside.nodes()[cell[0]];
        Eigen::Matrix3d m;
        for (int k = 0; k < 3; ++k) m.col(k) = inside.nodes()[cell[static_cast<std::size_t>(k) + 1]] - a;
        const double volume = std::fabs(m.determinant()) / 6;
        result.volume.push_back(volume);
        std::array<Vector3d, 4> gradient{};
        // Slivers without volume contribute no energy.
        if (volume > 1e-16) {
            const Eigen::Matrix3d inverse = m.inverse();
            for (int k = 0; k < 3; ++k) gradient[static_cast<std::size_t>(k) + 1] = inverse.row(k).transpose();
            gradient[0] = -gradient[1] - gradient[2] - gradient[3];
        } else {
            gradient.fill(Vector3d::Zero());
        }
        result.of_corner.push_back(gradient);
    }
    return result;
}

WeightMatrix weights_on_cage(const CageInterior& inside, const UnitCage& cage) {
    WeightMatrix weights =
        WeightMatrix::Zero(static_cast<Eigen::Index>(inside.nodes().size()), static_cast<Eigen::Index>(cage.corners.size()));
    for (std::size_t v = 0; v < inside.nodes().size(); ++v) {
        const SurfaceHit& hit = inside.on_cage()[v];
        if (hit.face == no_index) continue;
        const auto corner = corners(cage.mesh, Face(hit.face));
        for (std::size_t k = 0; k < 3; ++k)
            weights(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(corner[k].idx())) += hit.barycentric[k];
    }
    return weights;
}

WeightMatrix harmonic_weights(const CageInterior& inside, const UnitCage& cage) {
    const CellGradients gradients = gradients_of(inside);
    const std::size_t nodes = inside.nodes().size();
    std::vector<int> unknown(nodes, -1);
    int count = 0;
    for (std::size_t v = 0; v < nodes; ++v)
        if (inside.is_within(static_cast<Index>(v))) unknown[v] = count++;
    const auto columns = static_cast<Eigen::Index>(cage.corners.size());
    WeightMatrix weights = weights_on_cage(inside, cage);
    if (count == 0) return weights;
    std::vector<Eigen::Triplet<double, int>> entries, fixed;
    entries.reserve(inside.cells().size() * 6);
    for (std::size_t t = 0; t < inside.cells().size(); ++t) {
        const auto& cell = inside.cells()[t];
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = 0; b < 4; ++b) {
                const int row = unknown[cell[a]], column = unknown[cell[b]];
                if (row < 0 || row < column) continue;
                const double value = gradients.volume[t] * gradients.of_corner[t][a].dot(gradients.of_corner[t][b]);
                if (column >= 0) entries.emplace_back(row, column, value);
                else fixed.emplace_back(row, static_cast<int>(cell[b]), value);
            }
    }
    LowerTriangle matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseMatrix<double, Eigen::RowMajor, int> coupling(count, static_cast<int>(nodes));
    coupling.setFromTriplets(fixed.begin(), fixed.end());
    SparseCholesky cholesky;
    cholesky.analyse(matrix);
    if (!cholesky.factor(matrix))
        throw Error(ErrorKind::failure, "cage", "the harmonic equation cannot be solved on the tetrahedra inside it",
                    "choose another number of nodes, or use mean-value coordinates");
    // Blocks of columns, so that the right-hand sides stay small.
    constexpr Eigen::Index block = 32;
    Progress progress("harmonic", static_cast<std::size_t>(columns));
    for (Eigen::Index first = 0; first < columns; first += block) {
        const Eigen::Index width = std::min(block, columns - first);
        const Eigen::MatrixXd boundary = weights.middleCols(first, width);
        Eigen::MatrixXd values = -(coupling * boundary);
        cholesky.solve(values);
        for (std::size_t v = 0; v < nodes; ++v)
            if (unknown[v] >= 0) weights.row(static_cast<Eigen::Index>(v)).segment(first, width) = values.row(unknown[v]);
        progress.advance(static_cast<std::size_t>(width));
    }
    return weights;
}

namespace {

/// Adds the weights at a position, linear in its tetrahedron, to a row.
void interpolate(const CageInterior& inside, const WeightMatrix& weights, const Vector3d& place, std::span<double> row) {
    const InteriorPlace location = inside.locate(place);
    for (std::size_t k = 0; k < 4; ++k) {
        if (location.weights[k] == 0) continue;
        const double* from = weights.row(static_cast<Eigen::Index>(location.nodes[k])).data();
        for (std::size_t j = 0; j < row.size(); ++j) row[j] += location.weights[k] * from[j];
    }
}

}  // namespace

Coordinates interior_coordinates(const std::string& kind, const Mesh& mesh, const std::vector<Point>& points,
                                 const CoordinateOptions& options,
                                 const std::function<WeightMatrix(const CageInterior&, const UnitCage&)>& weights_of) {
    const UnitCage cage(mesh);
    std::unique_ptr<CageInterior> inside;
    WeightMatrix weights;
    double tetrahedra = 0, at_nodes = 0;
    const Stopwatch watch;
    Coordinates result = bounded_coordinates(
        cage, points, options.snap, options.drop, kind,
        [&] {
            {
                const ScopedSeconds added(tetrahedra);
                inside = std::make_unique<CageInterior>(cage.mesh, options.nodes, kind);
            }
            const ScopedSeconds added(at_nodes);
            weights = weights_of(*inside, cage);
        },
        [&](const Vector3d& place, std::span<double> row) { interpolate(*inside, weights, place, row); });
    result.seconds = {{"tetrahedra", tetrahedra}, {"weights", at_nodes}, {"points", watch.seconds() - tetrahedra - at_nodes}};
    return result;
}

Coordinates harmonic(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    return interior_coordinates("harmonic", mesh, points, options, harmonic_weights);
}

}  // namespace ostraka::coords

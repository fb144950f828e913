#include "ostraka/coords/certificate.h"

#include "ostraka/coords/influence.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

/// Sample points on the cage with the weights of their linear interpolation.
struct OnCage {
    std::vector<Point> points;
    std::vector<std::array<Vertex, 3>> corners;
    std::vector<std::array<double, 3>> weights;
    void add(const Mesh& cage, const std::array<Vertex, 3>& corner, const std::array<double, 3>& weight) {
        const Point& a = cage.point(corner[0]);
        const Vector u = cage.point(corner[1]) - a, v = cage.point(corner[2]) - a;
        points.push_back(a + (weight[1] * u + weight[2] * v));
        corners.push_back(corner);
        weights.push_back(weight);
    }
};

/// One index per vertex, equal for coincident vertices.
std::vector<Index> places_of(const Mesh& cage) {
    std::map<std::array<double, 3>, Index> index_of_position;
    std::vector<Index> place;
    for (const Vertex v : cage.vertices()) {
        const Point& p = cage.point(v);
        place.push_back(
            index_of_position.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(index_of_position.size())).first->second);
    }
    return place;
}

double deviation(const std::string& kind, const Mesh& cage, const OnCage& samples, const CoordinateOptions& options) {
    const Coordinates computed = compute_coordinates(kind, cage, samples.points, options);
    const std::vector<Index> place = places_of(cage);
    double maximum = 0;
    std::vector<double> row(place.size());
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
        std::fill(row.begin(), row.end(), 0.0);
        for (std::size_t j = 0; j < place.size(); ++j)
            row[place[j]] += computed.vertex(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        for (std::size_t k = 0; k < 3; ++k) row[place[samples.corners[i][k]]] -= samples.weights[i][k];
        for (const double x : row) maximum = std::max(maximum, std::fabs(x));
    }
    return maximum;
}

void certify_kind(const Mesh& cage, const CoordinateOptions& options, CoordinateCertificate& result) {
    OnCage vertices, edges, faces;
    // Isolated vertices have no weight.
    for (const Vertex v : cage.vertices())
        if (!cage.is_isolated(v)) vertices.add(cage, {v, v, v}, {1, 0, 0});
    for (const Edge e : cage.edges())
        for (const double t : {0.25, 0.5, 0.9}) {
            const Vertex a = cage.vertex(e, 0), b = cage.vertex(e, 1);
            edges.add(cage, {a, b, b}, {1 - t, t, 0});
        }
    for (const Face f : cage.faces())
        for (const std::array<double, 3>& weight :
             {std::array<double, 3>{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.3, 0.1}, {0.04, 0.16, 0.8}})
            faces.add(cage, corners(cage, f), weight);
    result.lagrange = deviation(result.kind, cage, vertices, options);
    result.edges = deviation(result.kind, cage, edges, options);
    result.on_faces = deviation(result.kind, cage, faces, options);
}

/// Contribution of one point to the certificate.
struct PointCertificate {
    double partition = 0, linear = 0, minimum = 0, maximum = 0, negative_sum = 0;
    Index negative = 0;
    bool finite = true;
};

}  // namespace

CoordinateCertificate certify(const Coordinates& coordinates, const Mesh& cage, const std::vector<Point>& points,
                              const CoordinateOptions& options) {
    const WeightMatrix &W = coordinates.vertex, &Q = coordinates.normal;
    const auto rows = static_cast<Eigen::Index>(points.size()), columns = static_cast<Eigen::Index>(cage.number_of_vertices());
    if (W.rows() != rows || W.cols() != columns ||
        (coordinates.has_normals() && (Q.rows() != rows || Q.cols() != static_cast<Eigen::Index>(cage.number_of_faces()))))
        fail_usage(fmt::format("the coordinates have {} rows and {} columns, not {} and {}", W.rows(), W.cols(), rows, columns),
                   "give the mesh and the cage that they were computed for");
    if (columns == 0) fail_input("cage", "has no vertices");
    CoordinateCertificate result{coordinates.kind, points.size(), cage.number_of_vertices(), cage.number_of_faces()};
    if (coordinate_kind(coordinates.kind).on_cage && cage_levels(cage).size() == 1) certify_kind(cage, options, result);
    if (points.empty()) return result;

    const std::vector<Point> corner = points_of(cage);
    const std::vector<Vector> normals = coordinates.has_normals() ? stretched_normals(cage, corner) : std::vector<Vector>();
    // Divided by the largest extent first, so that the squares do not overflow.
    double extent = 0;
    for (const Point& p : corner)
        for (int k = 0; k < 3; ++k) extent = std::max(extent, std::fabs(p[k] - corner.front()[k]));
    double diagonal = 0;
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] =
            std::minmax_element(corner.begin(), corner.end(), [k](const Point& a, const Point& b) { return a[k] < b[k]; });
        diagonal = std::hypot(diagonal, ((*high)[k] - (*low)[k]) / extent);
    }
    std::vector<PointCertificate> certificates(points.size());
    parallel_for(points.size(), [&](std::size_t i) {
        PointCertificate& certificate = certificates[i];
        const double* w = W.row(static_cast<Eigen::Index>(i)).data();
        double sum = 0;
        Vector error(0, 0, 0);
        certificate.minimum = certificate.maximum = w[0];
        for (std::size_t j = 0; j < corner.size(); ++j) {
            sum += w[j];
            error += w[j] / extent * (corner[j] - points[i]);
            certificate.minimum = std::min(certificate.minimum, w[j]);
            certificate.maximum = std::max(certificate.maximum, w[j]);
            if (w[j] < 0) ++certificate.negative, certificate.negative_sum -= w[j];
        }
        if (coordinates.has_normals()) {
            const double* q = Q.row(static_cast<Eigen::Index>(i)).data();
            for (std::size_t j = 0; j < normals.size(); ++j) error += q[j] / extent * normals[j];
        }
        certificate.partition = std::fabs(sum - 1);
        certificate.linear = std::sqrt(error.squared_length()) / diagonal;
        certificate.finite = std::isfinite(sum) && std::isfinite(certificate.linear);
    });
    double negative = 0, negative_rows = 0;
    result.minimum = certificates[0].minimum;
    result.maximum = certificates[0].maximum;
    for (std::size_t i = 0; i < certificates.size(); ++i) {
        const PointCertificate& certificate = certificates[i];
        if (!certificate.finite)
            fail_input("coordinates", fmt::format("the weights of point {} are not finite", i), "compute them again");
        result.partition = std::max(result.partition, certificate.partition);
        if (certificate.linear > result.linear || i == 0)
            result.linear = certificate.linear, result.worst_linear = static_cast<Index>(i);
        result.minimum = std::min(result.minimum, certificate.minimum);
        result.maximum = std::max(result.maximum, certificate.maximum);
        result.negative_sum = std::max(result.negative_sum, certificate.negative_sum);
        negative += certificate.negative;
        negative_rows += certificate.negative > 0 ? 1 : 0;
    }
    const auto count = static_cast<double>(points.size());
    result.negative = negative / count / static_cast<double>(corner.size());
    result.negative_rows = negative_rows / count;
    for (const Index n : dominant_weight_counts(W)) {
        result.dominant_weights_mean += n / count;
        result.dominant_weights_max = std::max(result.dominant_weights_max, n);
    }
    return result;
}

JsonValue to_json(const CoordinateCertificate& c, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "partition", c.partition, "linearPrecision", c.linear);
    if (c.worst_linear != no_index) add_members(object, allocator, "worstPoint", c.worst_linear);
    if (c.lagrange) add_members(object, allocator, "lagrange", *c.lagrange);
    if (c.edges) add_members(object, allocator, "edgeLinearity", *c.edges);
    if (c.on_faces) add_members(object, allocator, "faceLinearity", *c.on_faces);
    add_members(object, allocator, "negativeShare", c.negative, "negativeRows", c.negative_rows, "negativeSum", c.negative_sum,
                "min", c.minimum, "max", c.maximum, "carriersMean", c.dominant_weights_mean, "carriersMax",
                c.dominant_weights_max);
    return object;
}

}  // namespace ostraka

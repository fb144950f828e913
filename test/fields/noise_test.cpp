// Curvature and thickness of synthetic objects under noise of 0.2 % of the diagonal, part by part, without blends.
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

namespace ostraka {
namespace {

constexpr double noise_share = 0.002;

/// Vertices moved along the normal of the object by a normal distribution of this standard deviation.
Mesh with_noise(const SyntheticObject& object, const Mesh& mesh, double deviation) {
    Mesh noisy = mesh;
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0, deviation);
    for (const Vertex v : noisy.vertices()) {
        const Vector g = object.gradient(mesh.point(v));
        noisy.point(v) = mesh.point(v) + g * (normal(random) / std::sqrt(g.squared_length()));
    }
    return noisy;
}

/// Faces of a part farther than `margin` from every face of another part.
std::vector<Index> inner_faces(const SyntheticMesh& object, std::int32_t part, double margin) {
    std::vector<Point> border_points;
    for (const Edge e : object.mesh.edges()) {
        const Face f = object.mesh.face(object.mesh.halfedge(e, 0)), g = object.mesh.face(object.mesh.halfedge(e, 1));
        const auto a = object.face_labels[f], b = object.face_labels[g];
        if (a != b && (a == part || b == part)) border_points.push_back(object.mesh.point(object.mesh.vertex(e, 0)));
    }
    std::vector<Index> faces;
    for (const Face f : object.mesh.faces()) {
        if (object.face_labels[f] != part) continue;
        const Point p = centroid(object.mesh, f);
        bool is_near = false;
        for (const Point& q : border_points) is_near = is_near || CGAL::squared_distance(p, q) < margin * margin;
        if (!is_near) faces.push_back(f);
    }
    return faces;
}

struct Compared {
    std::string part;
    double clean, noisy;
};

template <class Field>
std::vector<Compared> compare(const std::string& name, std::uint64_t vertices, double margin_share, Field&& field) {
    const SyntheticObject& object = synthetic_object(name);
    MakeOptions options;
    options.vertices = vertices;
    const SyntheticMesh synthetic = make_mesh(object, options);
    const double diagonal = box_diagonal(synthetic.mesh);
    const Mesh noisy = with_noise(object, synthetic.mesh, noise_share * diagonal);
    const std::vector<double> clean_values = field(synthetic.mesh), noisy_values = field(noisy);
    std::vector<Compared> medians;
    for (std::size_t part = 0; part < object.parts.size(); ++part) {
        const std::vector<Index> faces = inner_faces(synthetic, static_cast<std::int32_t>(part), margin_share * diagonal);
        if (faces.size() < 30) continue;  // all of it is blend
        const auto median = [&](const std::vector<double>& values) {
            std::vector<double> part_values, weights;
            for (const Index f : faces) {
                double value = 0, count = 0;
                if (values.size() == synthetic.mesh.number_of_faces()) value = values[f], count = 1;
                else
                    for (const Vertex v : corners(synthetic.mesh, Face(f))) value += values[v], count += 1;
                if (!std::isfinite(value)) continue;
                part_values.push_back(value / count);
                weights.push_back(face_area(synthetic.mesh, Face(f)));
            }
            return quantile(part_values, weights, 0.5);
        };
        medians.push_back({name + " " + object.parts[part], median(clean_values), median(noisy_values)});
    }
    return medians;
}

std::size_t expect_mean_curvature_kept(const std::string& name, std::uint64_t vertices, double scale) {
    CurvatureOptions options;
    options.scale = scale;
    const double diagonal = synthetic_object(name).box().diagonal().norm();
    std::size_t parts = 0;
    for (const Compared& c : compare(name, vertices, scale, [&](const Mesh& mesh) { return curvature(mesh, options).mean; })) {
        if (std::abs(c.clean) * diagonal < 1) continue;  // nearly flat: a relative error is not meaningful
        EXPECT_NEAR(c.noisy, c.clean, 0.05 * std::abs(c.clean)) << c.part;
        std::cout << "mean curvature of " << c.part << ": " << c.clean << " with noise " << c.noisy << '\n';
        ++parts;
    }
    return parts;
}

TEST(Noise, MeanCurvatureMedianPerPartIsRobust) {
    std::size_t parts = 0;
    for (const std::string name : {"sphere", "capsule", "cylinder", "torus", "chair", "teapot"})
        parts += expect_mean_curvature_kept(name, 20000, 0.03);
    // The hand's palm is thin and nearly flat: it needs more vertices and a larger scale.
    parts += expect_mean_curvature_kept("hand", 60000, 0.035);
    EXPECT_GE(parts, 25U);
}

TEST(Noise, ThicknessMedianPerPartIsRobust) {
    ThicknessOptions options;
    options.scale = 0.03;
    options.rays = 12;
    std::size_t parts = 0;
    for (const std::string name : {"capsule", "torus", "box"})
        for (const Compared& c : compare(name, 5000, 0.03, [&](const Mesh& mesh) { return thickness(mesh, options); })) {
            EXPECT_NEAR(c.noisy, c.clean, 0.05 * c.clean) << c.part;
            std::cout << "thickness of " << c.part << ": " << c.clean << " with noise " << c.noisy << '\n' << std::flush;
            ++parts;
        }
    EXPECT_GE(parts, 6U);
}

}  // namespace
}  // namespace ostraka

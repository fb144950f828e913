// Curvature and thickness of synthetic objects under noise of 0.2 % of the diagonal, part by part, blends apart.
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
std::vector<Index> inner_faces(const SyntheticMesh& made, std::int32_t part, double margin) {
    std::vector<Point> rim;
    for (const Edge e : made.mesh.edges()) {
        const Face f = made.mesh.face(made.mesh.halfedge(e, 0)), g = made.mesh.face(made.mesh.halfedge(e, 1));
        const auto a = made.face_labels[f], b = made.face_labels[g];
        if (a != b && (a == part || b == part)) rim.push_back(made.mesh.point(made.mesh.vertex(e, 0)));
    }
    std::vector<Index> faces;
    for (const Face f : made.mesh.faces()) {
        if (made.face_labels[f] != part) continue;
        const Point p = centroid(made.mesh, f);
        bool near = false;
        for (const Point& q : rim) near = near || CGAL::squared_distance(p, q) < margin * margin;
        if (!near) faces.push_back(f);
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
    const SyntheticMesh made = make_mesh(object, options);
    const double diagonal = box_diagonal(made.mesh);
    const Mesh noisy = with_noise(object, made.mesh, noise_share * diagonal);
    const std::vector<double> before = field(made.mesh), after = field(noisy);
    std::vector<Compared> list;
    for (std::size_t part = 0; part < object.parts.size(); ++part) {
        const std::vector<Index> faces = inner_faces(made, static_cast<std::int32_t>(part), margin_share * diagonal);
        if (faces.size() < 30) continue;  // all of it is blend
        const auto median = [&](const std::vector<double>& values) {
            std::vector<double> here, weights;
            for (const Index f : faces) {
                double value = 0, share = 0;
                if (values.size() == made.mesh.number_of_faces()) value = values[f], share = 1;
                else
                    for (const Vertex v : corners(made.mesh, Face(f))) value += values[v], share += 1;
                if (!std::isfinite(value)) continue;
                here.push_back(value / share);
                weights.push_back(face_area(made.mesh, Face(f)));
            }
            return quantile(here, weights, 0.5);
        };
        list.push_back({name + " " + object.parts[part], median(before), median(after)});
    }
    return list;
}

std::size_t expect_mean_curvature_kept(const std::string& name, std::uint64_t vertices, double scale) {
    CurvatureOptions options;
    options.scale = scale;
    const double diagonal = synthetic_object(name).box().diagonal().norm();
    std::size_t parts = 0;
    for (const Compared& c : compare(name, vertices, scale, [&](const Mesh& mesh) { return curvature(mesh, options).mean; })) {
        if (std::abs(c.clean) * diagonal < 1) continue;  // nearly flat: there is no share to speak of
        EXPECT_NEAR(c.noisy, c.clean, 0.05 * std::abs(c.clean)) << c.part;
        std::cout << "mean curvature of " << c.part << ": " << c.clean << " with noise " << c.noisy << '\n';
        ++parts;
    }
    return parts;
}

TEST(Noise, MeanCurvatureKeepsItsMedianPerPart) {
    std::size_t parts = 0;
    for (const std::string name : {"sphere", "capsule", "cylinder", "torus", "chair", "teapot"})
        parts += expect_mean_curvature_kept(name, 20000, 0.03);
    // The hand's palm is thin and nearly flat: it takes more vertices and a wider scale.
    parts += expect_mean_curvature_kept("hand", 60000, 0.035);
    EXPECT_GE(parts, 25U);
}

TEST(Noise, ThicknessKeepsItsMedianPerPart) {
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

#include "ostraka/synthetic/make_mesh.h"

#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace ostraka;

namespace {

SyntheticMesh object_mesh(const std::string& name, std::uint64_t vertices, std::uint64_t seed = 1, double noise = 0) {
    MakeOptions options;
    options.vertices = vertices;
    options.seed = seed;
    options.noise = noise;
    return make_mesh(synthetic_object(name), options);
}

double volume(const Mesh& mesh) {
    double sum = 0;
    for (const Face f : mesh.faces()) {
        const auto c = corners(mesh, f);
        const Vector a = mesh.point(c[0]) - CGAL::ORIGIN, b = mesh.point(c[1]) - CGAL::ORIGIN,
                     d = mesh.point(c[2]) - CGAL::ORIGIN;
        sum += a * CGAL::cross_product(b, d) / 6;
    }
    return sum;
}

int euler_characteristic(const Mesh& mesh) {
    return static_cast<int>(mesh.number_of_vertices()) - static_cast<int>(mesh.number_of_edges()) +
           static_cast<int>(mesh.number_of_faces());
}

/// Number of pieces of each label's faces, joined across edges.
std::vector<int> patches(const SyntheticMesh& m, std::size_t labels) {
    std::vector<int> count(labels, 0);
    std::vector<bool> seen(m.mesh.number_of_faces(), false);
    for (const Face start : m.mesh.faces()) {
        if (seen[start.idx()]) continue;
        const int label = m.face_labels[start.idx()];
        ++count[static_cast<std::size_t>(label)];
        std::vector<Face> stack{start};
        seen[start.idx()] = true;
        while (!stack.empty()) {
            const Face f = stack.back();
            stack.pop_back();
            for (const Halfedge h : m.mesh.halfedges_around_face(m.mesh.halfedge(f))) {
                const Face next = m.mesh.face(m.mesh.opposite(h));
                if (seen[next.idx()] || m.face_labels[next.idx()] != label) continue;
                seen[next.idx()] = true;
                stack.push_back(next);
            }
        }
    }
    return count;
}

class EveryObject : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(EveryObject, IsClosedOrientedOfItsGenusAtEveryResolution) {
    const SyntheticObject& object = synthetic_object(GetParam());
    for (const std::size_t vertices : {object.minimum_vertices, std::size_t{4000}, std::size_t{8000}}) {
        const SyntheticMesh m = object_mesh(object.name, vertices, vertices);
        EXPECT_NEAR(static_cast<double>(m.mesh.number_of_vertices()), static_cast<double>(vertices),
                    0.01 * static_cast<double>(vertices));
        EXPECT_TRUE(CGAL::is_closed(m.mesh));
        EXPECT_TRUE(m.mesh.is_valid());
        EXPECT_EQ(euler_characteristic(m.mesh), 2 - 2 * object.genus) << vertices;
        EXPECT_GT(volume(m.mesh), 0);
        EXPECT_EQ(m.face_labels.size(), m.mesh.number_of_faces());
        EXPECT_EQ(m.vertex_labels.size(), m.mesh.number_of_vertices());
    }
}

TEST_P(EveryObject, TrianglesAreUniformAndFaceOutward) {
    const SyntheticObject& object = synthetic_object(GetParam());
    const SyntheticMesh m = object_mesh(object.name, 8000);
    const double edge = mean_edge_length(m.mesh);
    std::size_t thin = 0;
    for (const Face f : m.mesh.faces()) {
        const auto c = corners(m.mesh, f);
        const Vector area = area_vector(m.mesh, f);
        EXPECT_GT(area * object.gradient(centroid(m.mesh, f)), 0);
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, CGAL::squared_distance(m.mesh.point(c[k]), m.mesh.point(c[(k + 1) % 3])));
        EXPECT_LT(longest, 9 * edge * edge);
        thin += std::sqrt(area.squared_length()) < 0.2 * longest ? 1 : 0;
    }
    EXPECT_LT(thin, m.mesh.number_of_faces() / 200);
}

TEST_P(EveryObject, VerticesLieOnTheSurfaceAndPartsAreWhole) {
    const SyntheticObject& object = synthetic_object(GetParam());
    ASSERT_EQ(object.parts.size(), object.part_colours.size());
    const SyntheticMesh m = object_mesh(object.name, 10000, 3);
    // A few vertices at bends sharper than the triangles can follow stay a little off, where moving them would fold a triangle.
    const double diagonal = box_diagonal(m.mesh), edge = mean_edge_length(m.mesh);
    std::size_t off = 0;
    for (const Vertex v : m.mesh.vertices()) {
        const double distance = std::abs(object.value(m.mesh.point(v)));
        ASSERT_LT(distance, 0.05 * edge);
        off += distance > 1e-9 * diagonal ? 1 : 0;
        ASSERT_EQ(m.vertex_labels[v.idx()], object.part(m.mesh.point(v)));
    }
    EXPECT_LE(off, m.mesh.number_of_vertices() / 500);
    const auto count = patches(m, object.parts.size());
    for (std::size_t part = 0; part < count.size(); ++part) EXPECT_EQ(count[part], 1) << object.parts[part];
}

TEST_P(EveryObject, SlopeKeepsItsBound) {
    // The condition for skipping blocks: no surface within |value| - slack of a point.
    const SyntheticObject& object = synthetic_object(GetParam());
    const SyntheticMesh m = object_mesh(object.name, object.minimum_vertices);
    std::vector<Point> surface;
    for (const Vertex v : m.mesh.vertices()) surface.push_back(m.mesh.point(v));
    const auto box = object.box();
    for (int x = -1; x <= 11; ++x) {
        for (int y = -1; y <= 11; ++y) {
            for (int z = -1; z <= 11; ++z) {
                const Eigen::Vector3d p = box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(x, y, z)) / 10;
                const Point q(p.x(), p.y(), p.z());
                const double bound = std::abs(object.value(q)) - object.slack();
                double nearest = std::numeric_limits<double>::infinity();
                for (const Point& s : surface) nearest = std::min(nearest, CGAL::squared_distance(q, s));
                EXPECT_LE(bound, std::sqrt(nearest) + 1e-6) << p.transpose();
            }
        }
    }
}

TEST_P(EveryObject, GradientIsThatOfTheValue) {
    const SyntheticObject& object = synthetic_object(GetParam());
    const SyntheticMesh m = object_mesh(object.name, object.minimum_vertices);
    const double step = 1e-6 * box_diagonal(m.mesh);
    std::size_t odd = 0;  // the second derivative jumps at some curves, where differences err more
    for (const Vertex v : m.mesh.vertices()) {
        const Point p = m.mesh.point(v);
        const Vector g = object.gradient(p);
        for (int k = 0; k < 3; ++k) {
            Vector d(k == 0 ? step : 0, k == 1 ? step : 0, k == 2 ? step : 0);
            const double difference = (object.value(p + d) - object.value(p - d)) / (2 * step);
            if (std::abs(difference - g[k]) > 1e-3) ++odd;
        }
    }
    EXPECT_LE(odd, m.mesh.number_of_vertices() / 100);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryObject, testing::ValuesIn(synthetic_object_names()),
                         [](const auto& name) { return name.param; });

TEST(MakeMesh, AreaAndVolumeConvergeToTheFormulas) {
    for (const std::string& name : synthetic_object_names()) {
        const SyntheticObject& object = synthetic_object(name);
        if (!object.exact_area) continue;
        double last_area = 1, last_volume = 1;
        for (const std::uint64_t vertices : {1000, 4000, 16000}) {
            const SyntheticMesh m = object_mesh(name, vertices);
            const double area_error = std::abs(surface_area(m.mesh) / *object.exact_area - 1);
            const double volume_error = std::abs(volume(m.mesh) / *object.exact_volume - 1);
            // Second order in the edge length: four times the vertices, a quarter of the error.
            EXPECT_LT(area_error, last_area / 2.5) << name << vertices;
            EXPECT_LT(volume_error, last_volume / 2.5) << name << vertices;
            last_area = area_error, last_volume = volume_error;
        }
        EXPECT_LT(last_area, 1e-3) << name;
        EXPECT_LT(last_volume, 1.5e-3) << name;
    }
}

TEST(MakeMesh, CapsOfTheSphereHaveTheirArea) {
    const SyntheticObject& sphere = synthetic_object("sphere");
    const SyntheticMesh m = object_mesh("sphere", 40000);
    std::vector<double> area(sphere.parts.size(), 0);
    for (const Face f : m.mesh.faces()) area[static_cast<std::size_t>(m.face_labels[f.idx()])] += face_area(m.mesh, f);
    const double exact_area = *sphere.exact_area, edge = mean_edge_length(m.mesh), r = 50;
    for (const auto& [part, share] : {std::pair{1, 0.005}, {2, 0.025}, {3, 0.1}}) {
        const double outline = 2 * CGAL_PI * r * std::sqrt(1 - (1 - 2 * share) * (1 - 2 * share));
        EXPECT_NEAR(area[static_cast<std::size_t>(part)], share * exact_area, 0.1 * edge * outline);
    }
}

TEST(MakeMesh, SameToTheBitForAnyNumberOfThreads) {
    for (const char* name : {"teapot", "box"}) {
        set_threads(1);
        const SyntheticMesh single_threaded = object_mesh(name, 6000, 7, 0.1);
        set_threads(2);
        const SyntheticMesh two_threaded = object_mesh(name, 6000, 7, 0.1);
        set_threads(0);
        EXPECT_EQ(mesh_checksum(single_threaded.mesh), mesh_checksum(two_threaded.mesh));
        EXPECT_EQ(single_threaded.face_labels, two_threaded.face_labels);
        EXPECT_EQ(single_threaded.vertex_labels, two_threaded.vertex_labels);
    }
}

TEST(MakeMesh, SeedsGiveDifferentMeshesOfOneObject) {
    const SyntheticMesh first_mesh = object_mesh("torus", 5000, 1), second_mesh = object_mesh("torus", 5000, 2);
    EXPECT_NE(mesh_checksum(first_mesh.mesh), mesh_checksum(second_mesh.mesh));
    EXPECT_NEAR(surface_area(first_mesh.mesh), surface_area(second_mesh.mesh), 1e-3 * surface_area(first_mesh.mesh));
}

TEST(MakeMesh, NoiseStaysWithinItsShareOfTheEdge) {
    const SyntheticObject& object = synthetic_object("sphere");
    const SyntheticMesh m = object_mesh("sphere", 5000, 1, 0.2);
    const double edge = mean_edge_length(m.mesh);
    double maximum = 0;
    for (const Vertex v : m.mesh.vertices()) maximum = std::max(maximum, std::abs(object.value(m.mesh.point(v))));
    EXPECT_LT(maximum, 0.21 * edge);
    EXPECT_GT(maximum, 0.15 * edge);
}

TEST(MakeMesh, RefusesImpossibleRequests) {
    const auto kind = [](const std::string& name, std::uint64_t vertices, double noise) {
        try {
            object_mesh(name, vertices, 1, noise);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << "no error";
        return ErrorKind::failure;
    };
    EXPECT_EQ(kind("teapot", 100, 0), ErrorKind::usage);
    EXPECT_EQ(kind("teapot", 3, 0), ErrorKind::usage);
    EXPECT_EQ(kind("sphere", 1000, 0.5), ErrorKind::usage);
    EXPECT_EQ(kind("tepot", 1000, 0), ErrorKind::usage);
    try {
        synthetic_object("tepot");
    } catch (const Error& error) {
        EXPECT_NE(error.remedy().find("'teapot'"), std::string::npos);
    }
}

// Cages shared by tests, and test points around them.
#pragma once

#include "meshes.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <random>

namespace ostraka::test {

struct Cage {
    std::string name;
    Mesh mesh;
};

inline std::vector<Cage> synthetic_cages() {
    return {{"sphere", build_mesh(octahedron_sphere(2))},
            {"torus", build_mesh(torus(16, 8))},
            {"box", build_mesh(box(3))},
            {"tiny", build_mesh(moved(octahedron_sphere(2), 1e-100, {0, 0, 0}))},
            {"huge", build_mesh(moved(octahedron_sphere(2), 1e100, {0, 0, 0}))},
            {"far away", build_mesh(moved(torus(16, 8), 1, {1e6, -2e6, 3e6}))}};
}

/// The cages of the shared data: every OBJ file with "cage", "bounding" or "deformed" in its name.
inline std::vector<Cage> shared_cages() {
    std::vector<Cage> read_cages;
    for (const char* folder : {"cage-hand-made", "cage-mvc2005-armadillo", "cage-supercages-arm"}) {
        const Path folder_path = Path(OSTRAKA_SHARED_DATA) / folder;
        std::error_code code;
        std::vector<Path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_path, code)) files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const Path& file : files) {
            const std::string name = file.filename().string();
            if (extension(file) != ".obj" || (name.find("cage") == std::string::npos &&
                                              name.find("bounding") == std::string::npos && !name.starts_with("deformed")))
                continue;
            read_cages.push_back({std::string(folder) + "/" + name, read_mesh(file).mesh});
        }
    }
    return read_cages;
}

inline std::vector<Cage> cages() {
    std::vector<Cage> all_cages = synthetic_cages();
    for (Cage& cage : shared_cages()) all_cages.push_back(std::move(cage));
    return all_cages;
}

/// Points on the vertices, edges and faces of a cage, at distances of 1e-9 to 1e-3 of the diagonal on both sides, and random
/// points in the box and around it.
inline std::vector<Point> places(const Mesh& cage) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    const double diagonal = box_diagonal(cage);
    std::vector<Point> points;
    const auto add_near = [&](const Point& p) {
        points.push_back(p);
        for (const double fraction : {1e-9, 1e-7, 1e-5, 1e-3}) {
            const Vector direction(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
            points.push_back(p + fraction * diagonal / std::sqrt(direction.squared_length()) * direction);
        }
    };
    for (const Vertex v : cage.vertices()) add_near(cage.point(v));
    for (const Edge e : cage.edges()) {
        const Point a = cage.point(cage.vertex(e, 0)), b = cage.point(cage.vertex(e, 1));
        add_near(CGAL::midpoint(a, b));
        add_near(a + unit(random) * (b - a));
    }
    for (const Face f : cage.faces()) {
        const auto [a, b, c] = corners(cage, f);
        add_near(centroid(cage, f));
        double s = unit(random), t = unit(random);
        if (s + t > 1) s = 1 - s, t = 1 - t;
        add_near(cage.point(a) + s * (cage.point(b) - cage.point(a)) + t * (cage.point(c) - cage.point(a)));
    }
    const CGAL::Bbox_3 box = bounding_box(cage);
    for (int i = 0; i < 1000; ++i) {
        const auto random_between = [&](double low, double high) { return low + (1.2 * unit(random) - 0.1) * (high - low); };
        points.emplace_back(random_between(box.xmin(), box.xmax()), random_between(box.ymin(), box.ymax()),
                            random_between(box.zmin(), box.zmax()));
    }
    return points;
}

/// Winding number of the cage around p: the sum of the solid angles (van Oosterom and Strackee 1983) divided by 4 pi.
inline double winding_number(const Mesh& cage, const Point& p) {
    long double sum = 0;
    for (const Face f : cage.faces()) {
        std::array<std::array<long double, 3>, 3> u;
        const auto corner = corners(cage, f);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector v = cage.point(corner[k]) - p;
            const long double x = v.x(), y = v.y(), z = v.z(), r = std::sqrt(x * x + y * y + z * z);
            u[k] = {x / r, y / r, z / r};
        }
        const auto dot = [&](std::size_t a, std::size_t b) { return u[a][0] * u[b][0] + u[a][1] * u[b][1] + u[a][2] * u[b][2]; };
        const long double det = u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) -
                                u[0][1] * (u[1][0] * u[2][2] - u[1][2] * u[2][0]) +
                                u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
        sum += 2 * std::atan2(det, 1 + dot(0, 1) + dot(1, 2) + dot(2, 0));
    }
    return static_cast<double>(sum / (4 * std::numbers::pi_v<long double>));
}

/// Distance from the cage, relative to its diagonal.
inline double distance(const Mesh& cage, const Point& p) {
    const double diagonal = box_diagonal(cage);
    double minimum = INFINITY;
    for (const Face f : cage.faces()) {
        std::array<Point, 3> t;
        const auto corner = corners(cage, f);
        for (std::size_t k = 0; k < 3; ++k) t[k] = CGAL::ORIGIN + (cage.point(corner[k]) - p) / diagonal;
        const auto b = nearest_barycentric(t[0], t[1], t[2], CGAL::ORIGIN);
        const Vector offset = b[0] * (t[0] - CGAL::ORIGIN) + b[1] * (t[1] - CGAL::ORIGIN) + b[2] * (t[2] - CGAL::ORIGIN);
        minimum = std::min(minimum, std::sqrt(offset.squared_length()));
    }
    return minimum;
}

}  // namespace ostraka::test

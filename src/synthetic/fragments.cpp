#include "ostraka/synthetic/fragments.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

SyntheticFragment generate_fragment(const Mesh& object, const Point& centre, const FragmentOptions& options) {
    check_options(options, "fragment");
    const double area = surface_area(object), diagonal = box_diagonal(object);
    if (!(area > 0)) fail_input("mesh", "has no area, so no fragment can be cut from it");
    Random random(options.seed);
    // Random waves in space, with wavelengths of the fragment's size and shorter.
    const double size = std::sqrt(options.share * area);
    struct Wave {
        Vector3d number;
        double phase, height;
    };
    std::vector<Wave> waves;
    for (int k = 0; k < 12; ++k) {
        const double length = size * std::pow(0.15, k / 11.0);
        Vector3d direction(random.normal(), random.normal(), random.normal());
        direction.normalize();
        waves.push_back(
            {2 * pi / length * direction, random.uniform(0, 2 * pi), options.roughness * length * std::sqrt(2.0 / 12)});
    }
    const Vector3d middle = eigen(centre);
    std::vector<double> distance(object.number_of_faces());
    for (const Face face : object.faces()) {
        const Vector3d position = eigen(centroid(object, face));
        distance[face] = (position - middle).norm();
        for (const Wave& wave : waves) distance[face] += wave.height * std::sin(wave.number.dot(position) + wave.phase);
    }
    std::vector<Index> order(distance.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return std::pair(distance[a], a) < std::pair(distance[b], b); });
    std::vector<bool> keep(order.size(), false);
    double sum = 0;
    for (const Index face : order) {
        if (sum >= options.share * area * (1 - 1e-12)) break;
        keep[face] = true;
        sum += face_area(object, Face(face));
    }
    SubMesh piece = keep_faces(object, keep, true);
    if (options.erosion > 0) {
        std::vector<Vector3d> fracture_border;
        for (const Vertex v : piece.mesh.vertices())
            if (piece.mesh.is_border(v) && !object.is_border(Vertex(piece.vertices[v])))
                fracture_border.push_back(eigen(piece.mesh.point(v)));
        const double width = options.erosion * diagonal;
        std::fill(keep.begin(), keep.end(), false);
        for (const Face face : piece.mesh.faces()) {
            const Vector3d position = eigen(centroid(piece.mesh, face));
            keep[piece.faces[face]] = std::none_of(fracture_border.begin(), fracture_border.end(),
                                                   [&](const Vector3d& p) { return (p - position).norm() < width; });
        }
        piece = keep_faces(object, keep, true);
    }
    if (piece.mesh.number_of_faces() == 0)
        throw Error(ErrorKind::failure, "fragment", "is empty after erosion", "increase the share, or reduce the erosion");
    SyntheticFragment result{std::move(piece.mesh), std::move(piece.vertices), std::move(piece.faces), {}};
    std::vector<Vector> normals;
    for (const Vertex v : result.mesh.vertices()) normals.push_back(vertex_normal(object, Vertex(result.vertices[v])));
    if (options.noise > 0)
        for (const Vertex v : result.mesh.vertices())
            result.mesh.point(v) = result.mesh.point(v) + options.noise * diagonal * random.normal() * normals[v];
    if (options.moved) {
        Motion motion;
        Eigen::Quaterniond rotation(random.normal(), random.normal(), random.normal(), random.normal());
        motion.rotation = rotation.normalized().toRotationMatrix();
        motion.translation = diagonal * Vector3d(random.normal(), random.normal(), random.normal());
        for (const Vertex v : result.mesh.vertices()) result.mesh.point(v) = point_of(motion(eigen(result.mesh.point(v))));
        result.pose = motion.inverse();
    }
    return result;
}

void FragmentOptions::declare_options(OptionList& list) {
    list("share", share, "share of the surface area of the object that the fragment keeps", Range{0.001, 1});
    list("roughness", roughness, "amplitude of the waves of the fracture surface", Range{0, 1}, "share of the fragment's size");
    list("noise", noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.1},
         "share of the whole's diagonal");
    list("erosion", erosion, "width of the worn zone along the rim of the fracture", Range{0, 0.5},
         "share of the whole's diagonal");
    list("moved", moved, "rotate and translate the fragment at random", Anything{});
    list("seed", seed, "random seed of the fracture, the noise and the motion", Range{0, 9007199254740992.0});
}

}  // namespace ostraka

#include "class_objects.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/scores.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/statuettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

using Eigen::Vector3d;

std::vector<std::int32_t> typical_labels(const Path& folder, const Mesh& mesh) {
    std::map<std::string, Path> files;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (extension(entry.path()) == ".seg") files[entry.path().filename().string()] = entry.path();
    if (files.empty()) fail_input(folder.string(), "has no .seg", "unpack the archive of labels there");
    std::vector<std::vector<int>> lists;
    for (const auto& [name, file] : files) lists.push_back(read_labels(file, mesh.number_of_faces()));
    std::size_t best = 0;
    double maximum = -2 * static_cast<double>(lists.size());
    for (std::size_t i = 0; i < lists.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < lists.size(); ++j) sum += i == j ? 0 : adjusted_rand_index(lists[i], lists[j]);
        if (sum > maximum) maximum = sum, best = i;
    }
    return lists[best];
}

namespace {

/// One region per connected component of a label with at least 0.5 % of the surface; smaller ones are lost on a simplified
/// mesh.
AnnotationSet parts_by_label(const Mesh& mesh, const std::vector<std::int32_t>& labels) {
    constexpr double minimum = 0.005;
    const FacePieces pieces = face_pieces(
        mesh, [](Face) { return true; }, [&](Halfedge h) { return labels[mesh.face(h)] == labels[mesh.face(mesh.opposite(h))]; });
    std::vector<Annotation> parts(pieces.count);
    std::vector<double> areas(pieces.count, 0);
    for (const Face f : mesh.faces()) {
        parts[pieces.of_face[f]].faces.push_back(f.idx());
        areas[pieces.of_face[f]] += face_area(mesh, f);
    }
    AnnotationSet set;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (areas[p] < minimum * surface_area(mesh)) continue;
        parts[p].id = static_cast<int>(set.annotations.size());
        parts[p].tag = "piece";
        set.annotations.push_back(std::move(parts[p]));
    }
    return set;
}

}  // namespace

AnnotationSet parts_on(const Mesh& mesh, const Mesh& labelled, const std::vector<std::int32_t>& labels) {
    const SurfaceSearch search(labelled);
    std::vector<std::int32_t> nearest;
    for (const Face face : mesh.faces()) nearest.push_back(labels[search.closest(centroid(mesh, face)).face]);
    return parts_by_label(mesh, nearest);
}

std::vector<ClassObject> read_class_objects(const std::string& folder, std::size_t maximum) {
    std::map<std::string, std::map<int, Path>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (extension(entry.path()) == ".off")
            files[entry.path().parent_path().filename().string()][std::stoi(entry.path().stem().string())] = entry.path();
    std::vector<ClassObject> objects;
    for (const auto& [class_name, list] : files) {
        std::size_t taken = 0;
        for (const auto& [number, file] : list) {
            if (taken++ == maximum) break;
            ClassObject object;
            object.class_name = class_name;
            object.member.name = class_name + " " + std::to_string(number);
            object.member.mesh = read_mesh(file).mesh;
            objects.push_back(std::move(object));
        }
    }
    if (objects.empty()) fail_input(folder, "has no <class>/<number>.off", "unpack the archive of models there");
    return objects;
}

namespace {

/// Random side lengths, taper and bend along the height, each with a deviation of 0.1.
void vary(Mesh& mesh, Random& random) {
    constexpr double deviation = 0.1;
    Eigen::AlignedBox3d box;
    for (const Point& p : mesh.points()) box.extend(eigen(p));
    const Vector3d sides{std::exp(random.normal(0, deviation)), std::exp(random.normal(0, deviation)),
                         std::exp(random.normal(0, deviation))};  // evaluated in this order
    const double taper = random.normal(0, deviation), bend_x = random.normal(0, deviation), bend_y = random.normal(0, deviation);
    const double height = box.sizes().z();
    for (const Vertex v : mesh.vertices()) {
        Vector3d p = eigen(mesh.point(v)) - box.center();
        const double up = 2 * p.z() / height;  // -1 to 1
        p.head<2>() *= std::exp(taper * up);
        p.x() += 0.5 * height * bend_x * up * up;
        p.y() += 0.5 * height * bend_y * up * up;
        mesh.point(v) = point_of(Vector3d(sides.cwiseProduct(p)));
    }
}

}  // namespace

std::vector<ClassObject> made_classes(std::size_t learnt, std::size_t asked, std::uint64_t seed, std::uint64_t vertices) {
    std::vector<ClassObject> objects;
    Random random(seed);
    const std::size_t count = learnt + asked;
    PopulationOptions population;
    population.objects = static_cast<int>(count);
    population.seed = seed;
    const std::vector<StatuetteParameters> figurines = draw_population(population);
    for (const char* name : {"capsule", "chair", "figurine", "hand", "head", "statuette", "teapot", "vase"})
        for (std::size_t i = 0; i < count; ++i) {
            ClassObject& object = objects.emplace_back();
            object.class_name = name;
            object.member.name = object.class_name + " " + std::to_string(i + 1);
            object.learnt = i < learnt;
            object.asked = !object.learnt;
            MakeOptions how;
            how.vertices = vertices;
            how.seed = seed + i;
            if (object.class_name == "head") {
                ArchetypeOptions archetype;
                archetype.seed = seed + i;
                object.member.mesh = make_mesh(*head_object(head_archetype(archetype)), how).mesh;
            } else if (object.class_name == "figurine") {
                object.member.mesh = make_mesh(*statuette_object(figurines[i]), how).mesh;
            } else {
                object.member.mesh = make_mesh(synthetic_object(name), how).mesh;
            }
            vary(object.member.mesh, random);
        }
    return objects;
}

namespace {

/// A closed surface from a grid of `rings` x `sides` points: periodic in both directions (a torus), or only around the rings,
/// whose first and last one are poles (a ball).
template <class At>
ClassObject made_of_grid(const char* name, Index rings, Index sides, bool torus, At&& at) {
    TriangleSoup soup;
    const auto add = [&](double u, double v) {
        const Vector3d p = at(u, v);
        soup.points.push_back({p.x(), p.y(), p.z()});
    };
    const Index rows = torus ? rings : rings - 1;
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < sides; ++j) add(static_cast<double>(torus ? i : i + 1) / rings, static_cast<double>(j) / sides);
    const auto index = [&](Index i, Index j) { return (torus ? i % rings : i) * sides + j % sides; };
    for (Index i = 0; i + (torus ? 0 : 1) < rows; ++i)
        for (Index j = 0; j < sides; ++j) {
            soup.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            soup.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    for (const bool last : {false, true}) {
        if (torus) break;
        const auto pole = static_cast<Index>(soup.points.size());
        add(last ? 1 : 0, 0);
        for (Index j = 0; j < sides; ++j) {
            const Index a = index(last ? rows - 1 : 0, j), b = index(last ? rows - 1 : 0, j + 1);
            if (last) soup.triangles.push_back({a, pole, b});
            else soup.triangles.push_back({pole, a, b});
        }
    }
    ClassObject object;
    object.member.name = name;
    object.member.mesh = build_mesh(soup);
    object.whole = measure_whole_shape(object.member.mesh);
    return object;
}

/// A tube of circular section around a closed curve with parameter from 0 to 1.
template <class Curve>
ClassObject tube(const char* name, double radius, Curve&& curve) {
    return made_of_grid(name, 150, 16, true, [&](double u, double v) {
        constexpr double step = 1e-4;
        const Vector3d along = (curve(u + step) - curve(u - step)).normalized();
        const bool upright = curve(u).squaredNorm() > 1e-12 && std::abs(along.z()) > 0.99;
        const Vector3d across = along.cross(upright ? Vector3d::UnitX() : Vector3d::UnitZ()).normalized();
        const double angle = -2 * pi * v;  // outward orientation
        return Vector3d(curve(u) + radius * (std::cos(angle) * across + std::sin(angle) * along.cross(across)));
    });
}

/// A star-shaped surface: radius as a function of direction.
template <class Radius>
ClassObject star_shaped(const char* name, Radius&& radius) {
    return made_of_grid(name, 50, 60, false, [&](double u, double v) {
        const double polar = pi * u, around = 2 * pi * v;
        const Vector3d way(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
        return Vector3d(radius(way).cwiseProduct(way));
    });
}

}  // namespace

std::vector<ClassObject> made_strangers() {
    std::vector<ClassObject> made;
    const auto knot = [](double p, double q) {
        return [p, q](double u) {
            const double t = 2 * pi * u, r = 2 + std::cos(q * t);
            return Vector3d(r * std::cos(p * t), r * std::sin(p * t), -std::sin(q * t));
        };
    };
    made.push_back(tube("knot", 0.4, knot(2, 3)));
    made.push_back(tube("knot of five", 0.3, knot(2, 5)));
    made.push_back(tube("torus", 0.7, [](double u) { return Vector3d(2 * std::cos(2 * pi * u), 2 * std::sin(2 * pi * u), 0); }));
    made.push_back(star_shaped("ball", [](const Vector3d&) { return Vector3d(1, 1, 1); }));
    made.push_back(star_shaped("rod", [](const Vector3d&) { return Vector3d(1, 1, 8); }));
    made.push_back(star_shaped("disc", [](const Vector3d&) { return Vector3d(4, 4, 0.5); }));
    made.push_back(star_shaped("star", [](const Vector3d& way) {
        return Vector3d(Vector3d::Constant(1 + 1.5 * std::pow(way.cwiseAbs().array().cube().sum(), 4)));
    }));
    return made;
}

}  // namespace ostraka::experiments

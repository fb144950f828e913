#include "ostraka/annotation/annotation_file.h"
#include "ostraka/conformance/kit.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/npy.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

bool is_free(const Comparison& comparison, const std::string& freedom) {
    return std::find(comparison.permitted_differences.begin(), comparison.permitted_differences.end(), freedom) !=
           comparison.permitted_differences.end();
}

double length_scale(const Comparison& comparison, const Mesh& mesh) {
    return comparison.scale == "diagonal" ? box_diagonal(mesh) : 1;
}

std::vector<std::array<Index, 3>> triangles_of(const Mesh& mesh) {
    std::vector<std::array<Index, 3>> triangles;
    for (const auto& triangle : to_soup(mesh).triangles) {
        std::array<Index, 3> corners{triangle[0], triangle[1], triangle[2]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.push_back(corners);
    }
    return triangles;
}

std::string surface_difference(const Comparison& comparison, const Mesh& expected, const Mesh& actual) {
    const double limit = comparison.tolerance * length_scale(comparison, expected);
    const auto farthest = [](const Mesh& source, const Mesh& target) {
        const SurfaceSearch search(target);
        double max_distance = 0;
        for (const auto v : source.vertices()) max_distance = std::max(max_distance, search.closest(source.point(v)).distance);
        return max_distance;
    };
    const double actual_to_expected = farthest(actual, expected), expected_to_actual = farthest(expected, actual);
    if (actual_to_expected <= limit && expected_to_actual <= limit) return {};
    return fmt::format("the surfaces differ by up to {}, allowed is {}",
                       digits(std::max(actual_to_expected, expected_to_actual), 4), digits(limit, 4));
}

std::string mesh_difference(const Comparison& comparison, const Mesh& expected, const Mesh& actual) {
    if (is_free(comparison, "triangulation")) return surface_difference(comparison, expected, actual);
    if (expected.number_of_vertices() != actual.number_of_vertices() || expected.number_of_faces() != actual.number_of_faces())
        return fmt::format("{} and {}, expected {} and {}", counted(actual.number_of_vertices(), "vertex"),
                           counted(actual.number_of_faces(), "face"), expected.number_of_vertices(), expected.number_of_faces());
    const double limit = comparison.tolerance * length_scale(comparison, expected);
    std::vector<Index> place(actual.number_of_vertices());  // index of the matching expected vertex
    double max_distance = 0;
    if (is_free(comparison, "vertex order")) {
        std::vector<Point> points;
        for (const auto v : expected.vertices()) points.push_back(expected.point(v));
        const PointTree tree(points);
        std::vector<bool> is_matched(points.size(), false);
        for (const auto v : actual.vertices()) {
            const auto nearest = tree.nearest(actual.point(v));
            max_distance = std::max(max_distance, std::sqrt(nearest.squared));
            if (std::sqrt(nearest.squared) > limit || is_matched[nearest.index])
                return fmt::format("vertex {} is not an expected vertex: the nearest one is at distance {}, allowed is {}",
                                   v.idx(), digits(std::sqrt(nearest.squared), 4), digits(limit, 4));
            is_matched[nearest.index] = true;
            place[v.idx()] = nearest.index;
        }
    } else {
        Index worst = 0;
        for (const auto v : actual.vertices()) {
            const double deviation = std::sqrt(CGAL::squared_distance(actual.point(v), expected.point(v)));
            if (!(deviation <= max_distance)) max_distance = deviation, worst = v.idx();
            place[v.idx()] = v.idx();
        }
        if (!(max_distance <= limit))
            return fmt::format("vertex {} is at distance {} from its expected position, allowed is {}", worst,
                               digits(max_distance, 4), digits(limit, 4));
    }
    auto expected_triangles = triangles_of(expected), actual_triangles = triangles_of(actual);
    for (auto& corners : actual_triangles) {
        for (Index& corner : corners) corner = place[corner];
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    if (is_free(comparison, "vertex order")) {
        std::sort(expected_triangles.begin(), expected_triangles.end());
        std::sort(actual_triangles.begin(), actual_triangles.end());
    }
    for (std::size_t f = 0; f < expected_triangles.size(); ++f)
        if (expected_triangles[f] != actual_triangles[f])
            return "faces have other vertices than expected, first face " + std::to_string(f);
    return {};
}

/// Area of the intersection over area of the union of two face sets (Jaccard index).
double overlap_of(const Mesh& mesh, const std::vector<Index>& a, const std::vector<Index>& b) {
    std::vector<Index> intersection, face_union;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(intersection));
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(face_union));
    const double union_area = area_of(mesh, face_union);
    return union_area > 0 ? area_of(mesh, intersection) / union_area : intersection.size() == face_union.size() ? 1 : 0;
}

/// Hausdorff distance between two vertex sets, relative to the diagonal.
double hausdorff_distance(const Mesh& mesh, const std::vector<Index>& a, const std::vector<Index>& b) {
    if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0 : 1;
    const auto farthest = [&](const std::vector<Index>& source, const std::vector<Index>& target) {
        std::vector<Point> points;
        for (const Index v : target) points.push_back(mesh.point(Vertex(v)));
        const PointTree tree(points);
        double max_squared_distance = 0;
        for (const Index v : source)
            max_squared_distance = std::max(max_squared_distance, tree.nearest(mesh.point(Vertex(v))).squared);
        return std::sqrt(max_squared_distance);
    };
    return std::max(farthest(a, b), farthest(b, a)) / box_diagonal(mesh);
}

std::string annotations_difference(const Comparison& comparison, const AnnotationSet& expected, const AnnotationSet& actual,
                                   const Mesh& mesh) {
    std::vector<std::string> differences;
    for (const Annotation& expected_annotation : expected.annotations) {
        const auto actual_annotation =
            std::find_if(actual.annotations.begin(), actual.annotations.end(), [&](const Annotation& annotation) {
                return annotation.tag == expected_annotation.tag && annotation.type == expected_annotation.type &&
                       annotation.id == expected_annotation.id;
            });
        if (actual_annotation == actual.annotations.end()) {
            differences.push_back(name_of(expected_annotation) + " is missing");
            continue;
        }
        if (expected_annotation.type == AnnotationType::region) {
            const double overlap = overlap_of(mesh, expected_annotation.faces, actual_annotation->faces);
            if (overlap < comparison.tolerance)
                differences.push_back(fmt::format("{} has an overlap of {}, required is {}", name_of(expected_annotation),
                                                  digits(overlap, 4), digits(comparison.tolerance, 4)));
        } else {
            const double distance =
                hausdorff_distance(mesh, touched_vertices(mesh, expected_annotation), touched_vertices(mesh, *actual_annotation));
            if (distance > 1 - comparison.tolerance)
                differences.push_back(fmt::format("{} is at a distance of {} diagonals, allowed is {}",
                                                  name_of(expected_annotation), digits(distance, 4),
                                                  digits(1 - comparison.tolerance, 4)));
        }
    }
    if (actual.annotations.size() > expected.annotations.size())
        differences.push_back(counted(actual.annotations.size() - expected.annotations.size(), "annotation") +
                              " more than expected");
    if (differences.size() > 3)
        differences = {differences[0], differences[1], fmt::format("and {} more", differences.size() - 2)};
    return joined(differences, "; ");
}

std::string array_difference(const Comparison& comparison, const Path& expected, const Path& actual) {
    const NpyArray<double> expected_array = read_npy(expected), actual_array = read_npy(actual);
    if (expected_array.shape != actual_array.shape) return "the array has a different shape";
    double largest = 0, most = 0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < expected_array.values.size(); ++i) {
        if (std::isfinite(expected_array.values[i])) largest = std::max(largest, std::abs(expected_array.values[i]));
        if (std::isnan(expected_array.values[i]) && std::isnan(actual_array.values[i])) continue;
        const double difference_here =
            expected_array.values[i] == actual_array.values[i] ? 0 : std::abs(expected_array.values[i] - actual_array.values[i]);
        if (!(difference_here <= most)) most = difference_here, worst = i;
    }
    const double limit = comparison.tolerance * (comparison.scale == "largest" ? largest : 1);
    if (most <= limit) return {};
    return fmt::format("number {} is {}, expected {}, allowed difference {}", worst, digits(actual_array.values[worst], 6),
                       digits(expected_array.values[worst], 6), digits(limit, 4));
}

/// Collects the differences, with JSON pointers.
void compare_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& actual, const std::string& place,
                    std::vector<std::string>& differences) {
    const auto is_ignored = [&](const std::string& at) {
        return std::any_of(comparison.ignored.begin(), comparison.ignored.end(), [&](const auto& ignored_name) {
            return at == "/" + ignored_name || at.ends_with("/" + ignored_name);
        });
    };
    if (is_ignored(place) || differences.size() > 3) return;
    if (expected.IsNumber() && actual.IsNumber()) {
        const double expected_number = expected.GetDouble(), actual_number = actual.GetDouble();
        const double limit = comparison.tolerance *
                             (comparison.scale == "value" ? std::max(std::abs(expected_number), std::abs(actual_number)) : 1);
        if (!(std::abs(expected_number - actual_number) <= limit))
            differences.push_back(fmt::format("{} is {}, expected {}, allowed difference {}", place, digits(actual_number, 8),
                                              digits(expected_number, 8), digits(limit, 4)));
    } else if (expected.IsObject() && actual.IsObject()) {
        for (const auto& member : expected.GetObject()) {
            const std::string at = place + "/" + text_of(member.name);
            if (place.empty() && !comparison.only.empty() &&
                std::find(comparison.only.begin(), comparison.only.end(), text_of(member.name)) == comparison.only.end())
                continue;
            if (is_ignored(at)) continue;
            const JsonValue* other = find_member(actual, text_of(member.name));
            if (other == nullptr) differences.push_back(at + " is missing");
            else compare_values(comparison, member.value, *other, at, differences);
        }
    } else if (expected.IsArray() && actual.IsArray()) {
        if (expected.Size() != actual.Size())
            differences.push_back(fmt::format("{} has {} entries, expected {}", place, actual.Size(), expected.Size()));
        else
            for (rapidjson::SizeType i = 0; i < expected.Size(); ++i)
                compare_values(comparison, expected[i], actual[i], place + "/" + std::to_string(i), differences);
    } else if (expected != actual) {
        differences.push_back(fmt::format("{} is {}, expected {}", place, printable(to_compact_text(actual), 60),
                                          printable(to_compact_text(expected), 60)));
    }
}

}  // namespace

std::string difference_of_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& actual) {
    std::vector<std::string> differences;
    compare_values(comparison, expected, actual, "", differences);
    return joined(differences, "; ");
}

std::string difference(const Comparison& comparison, const Path& expected, const Path& actual, const Path& expected_mesh,
                       const Path& actual_mesh) {
    if (!file_exists(actual)) return "was not written";
    if (comparison.method == "exists") return size_of_file(actual) == 0 ? "is empty" : "";
    try {
        if (comparison.method == "bytes") return read_file(expected) == read_file(actual) ? "" : "has different bytes";
        if (comparison.method == "array") return array_difference(comparison, expected, actual);
        if (comparison.method == "values") {
            Json expected_json = read_json(expected), actual_json = read_json(actual);
            for (Json* document : {&expected_json, &actual_json})
                if (document->IsObject()) document->RemoveMember("provenance");
            return difference_of_values(comparison, expected_json, actual_json);
        }
        if (comparison.method == "mesh") return mesh_difference(comparison, read_mesh(expected).mesh, read_mesh(actual).mesh);
        const Mesh annotated_mesh = read_mesh(expected_mesh).mesh;
        AnnotationSet actual_annotations;
        if (expected_mesh == actual_mesh) {
            actual_annotations = read_annotations(actual, annotated_mesh);
        } else {  // on the backend's own mesh, which must equal the expected one
            const Mesh backend_mesh = read_mesh(actual_mesh).mesh;
            if (backend_mesh.number_of_faces() != annotated_mesh.number_of_faces())
                return "belong to a mesh other than the expected one";
            actual_annotations = read_annotations(actual, backend_mesh);
        }
        return annotations_difference(comparison, read_annotations(expected, annotated_mesh), actual_annotations, annotated_mesh);
    } catch (const Error& error) {
        return std::string("cannot be read: ") + error.what();
    }
}

}  // namespace ostraka

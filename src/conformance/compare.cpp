#include "ostraka/annotation/annotation_file.h"
#include "ostraka/conformance/kit.h"
#include "ostraka/core/npy.h"
#include "ostraka/core/words.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

bool is_free(const Comparison& comparison, const std::string& freedom) {
    return std::find(comparison.freedoms.begin(), comparison.freedoms.end(), freedom) != comparison.freedoms.end();
}

double scale_of(const Comparison& comparison, const Mesh& mesh) { return comparison.of == "diagonal" ? box_diagonal(mesh) : 1; }

std::vector<std::array<Index, 3>> triangles_of(const Mesh& mesh) {
    std::vector<std::array<Index, 3>> all;
    for (const auto& triangle : to_soup(mesh).triangles) {
        std::array<Index, 3> corners{triangle[0], triangle[1], triangle[2]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.push_back(corners);
    }
    return all;
}

std::string distances_apart(const Comparison& comparison, const Mesh& expected, const Mesh& got) {
    const double limit = comparison.within * scale_of(comparison, expected);
    const auto farthest = [](const Mesh& from, const Mesh& to) {
        const SurfaceSearch search(to);
        double most = 0;
        for (const auto v : from.vertices()) most = std::max(most, search.closest(from.point(v)).distance);
        return most;
    };
    const double there = farthest(got, expected), back = farthest(expected, got);
    if (there <= limit && back <= limit) return {};
    return "the surfaces are up to " + digits(std::max(there, back), 4) + " apart, allowed is " + digits(limit, 4);
}

std::string mesh_difference(const Comparison& comparison, const Mesh& expected, const Mesh& got) {
    if (is_free(comparison, "triangulation")) return distances_apart(comparison, expected, got);
    if (expected.number_of_vertices() != got.number_of_vertices() || expected.number_of_faces() != got.number_of_faces())
        return counted(got.number_of_vertices(), "vertex") + " and " + counted(got.number_of_faces(), "face") + ", expected " +
               std::to_string(expected.number_of_vertices()) + " and " + std::to_string(expected.number_of_faces());
    const double limit = comparison.within * scale_of(comparison, expected);
    std::vector<Index> place(got.number_of_vertices());  // index of the matching expected vertex
    double most = 0;
    if (is_free(comparison, "vertex order")) {
        std::vector<Point> points;
        for (const auto v : expected.vertices()) points.push_back(expected.point(v));
        const PointTree tree(points);
        std::vector<bool> taken(points.size(), false);
        for (const auto v : got.vertices()) {
            const auto near = tree.nearest(got.point(v));
            most = std::max(most, std::sqrt(near.squared));
            if (std::sqrt(near.squared) > limit || taken[near.index])
                return "vertex " + std::to_string(v.idx()) + " is none of the expected ones: the nearest is " +
                       digits(std::sqrt(near.squared), 4) + " away, allowed is " + digits(limit, 4);
            taken[near.index] = true;
            place[v.idx()] = near.index;
        }
    } else {
        Index worst = 0;
        for (const auto v : got.vertices()) {
            const double apart = std::sqrt(CGAL::squared_distance(got.point(v), expected.point(v)));
            if (!(apart <= most)) most = apart, worst = v.idx();
            place[v.idx()] = v.idx();
        }
        if (!(most <= limit))
            return "vertex " + std::to_string(worst) + " is " + digits(most, 4) + " away from its place, allowed is " +
                   digits(limit, 4);
    }
    auto wanted = triangles_of(expected), found = triangles_of(got);
    for (auto& corners : found) {
        for (Index& corner : corners) corner = place[corner];
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    if (is_free(comparison, "vertex order")) {
        std::sort(wanted.begin(), wanted.end());
        std::sort(found.begin(), found.end());
    }
    for (std::size_t f = 0; f < wanted.size(); ++f)
        if (wanted[f] != found[f]) return "faces join other vertices, the first of them face " + std::to_string(f);
    return {};
}

/// Area of the intersection over area of the union of two face sets (Jaccard index).
double overlap_of(const Mesh& mesh, const std::vector<Index>& a, const std::vector<Index>& b) {
    std::vector<Index> both, any;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(any));
    const double all = area_of(mesh, any);
    return all > 0 ? area_of(mesh, both) / all : both.size() == any.size() ? 1 : 0;
}

/// Hausdorff distance between two vertex sets, relative to the diagonal.
double apart(const Mesh& mesh, const std::vector<Index>& a, const std::vector<Index>& b) {
    if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0 : 1;
    const auto farthest = [&](const std::vector<Index>& from, const std::vector<Index>& to) {
        std::vector<Point> points;
        for (const Index v : to) points.push_back(mesh.point(Vertex(v)));
        const PointTree tree(points);
        double most = 0;
        for (const Index v : from) most = std::max(most, tree.nearest(mesh.point(Vertex(v))).squared);
        return std::sqrt(most);
    };
    return std::max(farthest(a, b), farthest(b, a)) / box_diagonal(mesh);
}

std::string annotations_difference(const Comparison& comparison, const AnnotationSet& expected, const AnnotationSet& got,
                                   const Mesh& mesh) {
    std::vector<std::string> wrong;
    for (const Annotation& wanted : expected.annotations) {
        const auto found = std::find_if(got.annotations.begin(), got.annotations.end(), [&](const Annotation& one) {
            return one.tag == wanted.tag && one.type == wanted.type && one.id == wanted.id;
        });
        if (found == got.annotations.end()) {
            wrong.push_back(name_of(wanted) + " is missing");
            continue;
        }
        if (wanted.type == AnnotationType::region) {
            const double overlap = overlap_of(mesh, wanted.faces, found->faces);
            if (overlap < comparison.within)
                wrong.push_back(name_of(wanted) + " overlaps by " + digits(overlap, 4) + ", asked is " +
                                digits(comparison.within, 4));
        } else {
            const double far = apart(mesh, touched_vertices(mesh, wanted), touched_vertices(mesh, *found));
            if (far > 1 - comparison.within)
                wrong.push_back(name_of(wanted) + " is " + digits(far, 4) + " of the diagonal away, allowed is " +
                                digits(1 - comparison.within, 4));
        }
    }
    if (got.annotations.size() > expected.annotations.size())
        wrong.push_back(counted(got.annotations.size() - expected.annotations.size(), "annotation") + " too many");
    if (wrong.size() > 3) wrong = {wrong[0], wrong[1], "and " + std::to_string(wrong.size() - 2) + " more"};
    return joined(wrong, "; ");
}

std::string array_difference(const Comparison& comparison, const Path& expected, const Path& got) {
    const NpyArray<double> wanted = read_npy(expected), found = read_npy(got);
    if (wanted.shape != found.shape) return "the array has another shape";
    double largest = 0, most = 0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        if (std::isfinite(wanted.values[i])) largest = std::max(largest, std::abs(wanted.values[i]));
        if (std::isnan(wanted.values[i]) && std::isnan(found.values[i])) continue;
        const double off = wanted.values[i] == found.values[i] ? 0 : std::abs(wanted.values[i] - found.values[i]);
        if (!(off <= most)) most = off, worst = i;
    }
    const double limit = comparison.within * (comparison.of == "largest" ? largest : 1);
    if (most <= limit) return {};
    return "number " + std::to_string(worst) + " is " + digits(found.values[worst], 6) + ", expected " +
           digits(wanted.values[worst], 6) + ", allowed difference " + digits(limit, 4);
}

/// Collects the differences, with JSON pointers.
void compare_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& got, const std::string& place,
                    std::vector<std::string>& wrong) {
    const auto skipped = [&](const std::string& at) {
        return std::any_of(comparison.but.begin(), comparison.but.end(),
                           [&](const auto& one) { return at == "/" + one || at.ends_with("/" + one); });
    };
    if (skipped(place) || wrong.size() > 3) return;
    if (expected.IsNumber() && got.IsNumber()) {
        const double wanted = expected.GetDouble(), found = got.GetDouble();
        const double limit = comparison.within * (comparison.of == "value" ? std::max(std::abs(wanted), std::abs(found)) : 1);
        if (!(std::abs(wanted - found) <= limit))
            wrong.push_back(place + " is " + digits(found, 8) + ", expected " + digits(wanted, 8) + ", allowed difference " +
                            digits(limit, 4));
    } else if (expected.IsObject() && got.IsObject()) {
        for (const auto& member : expected.GetObject()) {
            const std::string at = place + "/" + text_of(member.name);
            if (place.empty() && !comparison.only.empty() &&
                std::find(comparison.only.begin(), comparison.only.end(), text_of(member.name)) == comparison.only.end())
                continue;
            if (skipped(at)) continue;
            const JsonValue* other = find_member(got, text_of(member.name));
            if (other == nullptr) wrong.push_back(at + " is missing");
            else compare_values(comparison, member.value, *other, at, wrong);
        }
    } else if (expected.IsArray() && got.IsArray()) {
        if (expected.Size() != got.Size())
            wrong.push_back(place + " has " + std::to_string(got.Size()) + " entries, expected " +
                            std::to_string(expected.Size()));
        else
            for (rapidjson::SizeType i = 0; i < expected.Size(); ++i)
                compare_values(comparison, expected[i], got[i], place + "/" + std::to_string(i), wrong);
    } else if (expected != got) {
        wrong.push_back(place + " is " + printable(to_compact_text(got), 60) + ", expected " +
                        printable(to_compact_text(expected), 60));
    }
}

}  // namespace

std::string difference_of_values(const Comparison& comparison, const JsonValue& expected, const JsonValue& got) {
    std::vector<std::string> wrong;
    compare_values(comparison, expected, got, "", wrong);
    return joined(wrong, "; ");
}

std::string difference(const Comparison& comparison, const Path& expected, const Path& got, const Path& expected_mesh,
                       const Path& got_mesh) {
    if (!file_exists(got)) return "was not written";
    if (comparison.as == "exists") return size_of_file(got) == 0 ? "is empty" : "";
    try {
        if (comparison.as == "bytes") return read_file(expected) == read_file(got) ? "" : "has other bytes";
        if (comparison.as == "array") return array_difference(comparison, expected, got);
        if (comparison.as == "values") {
            Json wanted = read_json(expected), found = read_json(got);
            for (Json* one : {&wanted, &found})
                if (one->IsObject()) one->RemoveMember("provenance");
            return difference_of_values(comparison, wanted, found);
        }
        if (comparison.as == "mesh") return mesh_difference(comparison, read_mesh(expected).mesh, read_mesh(got).mesh);
        const Mesh wanted_on = read_mesh(expected_mesh).mesh;
        AnnotationSet found;
        if (expected_mesh == got_mesh) {
            found = read_annotations(got, wanted_on);
        } else {  // on the backend's own mesh, which must equal the expected one
            const Mesh own = read_mesh(got_mesh).mesh;
            if (own.number_of_faces() != wanted_on.number_of_faces()) return "are on another mesh than expected";
            found = read_annotations(got, own);
        }
        return annotations_difference(comparison, read_annotations(expected, wanted_on), found, wanted_on);
    } catch (const Error& error) {
        return std::string("cannot be read: ") + error.what();
    }
}

}  // namespace ostraka

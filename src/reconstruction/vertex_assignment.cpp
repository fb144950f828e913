#include "ostraka/reconstruction/vertex_assignment.h"
#include "ostraka/core/angles.h"

#include "reconstruction/assignment.h"
#include "reconstruction/outline_correspondences.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

namespace {

/// The vertices of a part, with their positions on outlines.
struct Part {
    std::vector<Index> vertices;
    std::vector<Point> places;
    std::vector<Vector> normals;
    std::vector<bool> boundary;
    std::vector<int> inner, outer;  ///< positions in `vertices` of interior and outline vertices
    /// Arc length along the outline for each outline vertex and each landmark; negative: none.
    std::vector<std::vector<double>> arc_lengths;
};

/// Arc lengths from each vertex of a path onwards to one of them, continuing at the start of a closed path; negative if there
/// is no path.
std::vector<double> arc_lengths_to(const Mesh& mesh, const VertexPath& vertex_path, std::size_t goal) {
    const std::size_t n = vertex_path.vertices.size();
    std::vector<double> arc_lengths(n, -1);
    double length = 0;
    for (std::size_t k = 0; k < n; ++k) {
        if (k > 0) {
            if (goal < k && !vertex_path.closed) break;
            const std::size_t a = (goal + n - k) % n, b = (a + 1) % n;
            length += std::sqrt(
                CGAL::squared_distance(mesh.point(Vertex(vertex_path.vertices[a])), mesh.point(Vertex(vertex_path.vertices[b]))));
        }
        arc_lengths[(goal + n - k) % n] = length;
    }
    return arc_lengths;
}

Part part_of(const Mesh& mesh, const Annotation& annotation, const std::vector<Index>& landmarks, const std::string& whose) {
    Part part;
    part.vertices = touched_vertices(mesh, annotation);
    if (part.vertices.empty())
        fail_input(fmt::format("{}, annotation '{}'", whose, annotation.tag), "has no vertices", "remove its match");
    std::map<Index, int> position;
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
        position.emplace(part.vertices[i], static_cast<int>(i));
        part.places.push_back(mesh.point(Vertex(part.vertices[i])));
        part.normals.push_back(vertex_normal(mesh, Vertex(part.vertices[i])));
    }
    const std::vector<VertexPath> vertex_paths = vertex_paths_of(mesh, annotation);
    part.boundary.assign(part.vertices.size(), annotation.type != AnnotationType::region);
    for (const VertexPath& vertex_path : vertex_paths)
        for (const Index v : vertex_path.vertices) part.boundary[static_cast<std::size_t>(position.at(v))] = true;
    part.arc_lengths.assign(part.vertices.size(), std::vector<double>(landmarks.size(), -1));
    for (std::size_t l = 0; l < landmarks.size(); ++l) {
        const Point& place = mesh.point(Vertex(landmarks[l]));
        const VertexPath* nearest = nullptr;
        std::size_t goal = 0;
        double minimum = std::numeric_limits<double>::infinity();
        for (const VertexPath& vertex_path : vertex_paths)
            for (std::size_t i = 0; i < vertex_path.vertices.size(); ++i)
                if (const double d = CGAL::squared_distance(mesh.point(Vertex(vertex_path.vertices[i])), place); d < minimum) {
                    minimum = d;
                    nearest = &vertex_path;
                    goal = i;
                }
        if (nearest == nullptr) continue;
        const std::vector<double> arc_lengths = arc_lengths_to(mesh, *nearest, goal);
        for (std::size_t i = 0; i < arc_lengths.size(); ++i)
            part.arc_lengths[static_cast<std::size_t>(position.at(nearest->vertices[i]))][l] = arc_lengths[i];
    }
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
        (part.boundary[i] ? part.outer : part.inner).push_back(static_cast<int>(i));
    return part;
}

/// Sum of |difference of arc lengths| over the landmarks that both reach.
double outline_cost(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t l = 0; l < a.size(); ++l)
        if (a[l] >= 0 && b[l] >= 0) sum += std::abs(a[l] - b[l]);
    return sum;
}

/// Normalises a cost to 0 to 1.
struct Scale {
    double minimum = 0, maximum = 0;
    [[nodiscard]] double operator()(double value) const {
        return maximum > minimum ? (value - minimum) / (maximum - minimum) : 0;
    }
};

class Assigner {
public:
    Assigner(Part ours, Part theirs, const VertexAssignmentOptions& options)
        : ours_(std::move(ours)), theirs_(std::move(theirs)), options_(options), min_cosine_(std::cos(options.angle * pi / 180)) {
        for (const bool outer : {false, true}) {
            std::vector<Point> places;
            for (const int j : outer ? theirs_.outer : theirs_.inner)
                places.push_back(theirs_.places[static_cast<std::size_t>(j)]);
            trees_[outer ? 1 : 0] = PointTree(places);
        }
        find_scales();
    }

    VertexAssignment run() {
        VertexAssignment result;
        result.vertices = ours_.vertices;
        const std::size_t n = result.vertices.size();
        result.counterpart.assign(n, no_index);
        result.cost.assign(n, std::numeric_limits<double>::infinity());
        const bool each_once = options_.counterpart == VertexAssignmentOptions::Counterpart::one_to_one;
        const auto max_count = static_cast<std::size_t>(each_once ? options_.candidates : 1);
        std::vector<std::vector<std::pair<double, int>>> candidates(n);
        parallel_for(n, 64, [&](std::size_t i) { candidates[i] = best(static_cast<int>(i), max_count); });
        std::vector<int> chosen(n, -1);
        if (each_once) {
            const double sum = options_.boundary + options_.distance + options_.outline, unit = 1e9 / std::max(sum, 1e-300);
            std::vector<fitting::AssignmentArc> arcs;
            for (std::size_t i = 0; i < n; ++i)
                for (const auto& [cost, j] : candidates[i]) arcs.push_back({static_cast<int>(i), j, std::llround(unit * cost)});
            chosen = fitting::assign_columns(static_cast<int>(n), static_cast<int>(theirs_.vertices.size()), arcs,
                                             std::llround(1e9 * options_.unassigned));
        } else {
            for (std::size_t i = 0; i < n; ++i)
                if (!candidates[i].empty()) chosen[i] = candidates[i].front().second;
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (chosen[i] < 0) continue;
            result.counterpart[i] = theirs_.vertices[static_cast<std::size_t>(chosen[i])];
            result.cost[i] = cost(static_cast<int>(i), chosen[i]);
            result.total += result.cost[i];
        }
        return result;
    }

private:
    [[nodiscard]] double distance(int i, int j) const {
        return std::sqrt(
            CGAL::squared_distance(ours_.places[static_cast<std::size_t>(i)], theirs_.places[static_cast<std::size_t>(j)]));
    }
    [[nodiscard]] bool both_outer(int i, int j) const {
        return ours_.boundary[static_cast<std::size_t>(i)] && theirs_.boundary[static_cast<std::size_t>(j)];
    }
    [[nodiscard]] double outline_difference(int i, int j) const {
        return both_outer(i, j) ? outline_cost(ours_.arc_lengths[static_cast<std::size_t>(i)],
                                               theirs_.arc_lengths[static_cast<std::size_t>(j)])
                                : 0;
    }
    [[nodiscard]] double cost(int i, int j) const {
        const bool differ = ours_.boundary[static_cast<std::size_t>(i)] != theirs_.boundary[static_cast<std::size_t>(j)];
        return options_.boundary * boundary_(differ ? 1 : 0) + options_.distance * distance_(distance(i, j)) +
               options_.outline * outline_(outline_difference(i, j));
    }
    [[nodiscard]] bool allowed(int i, int j) const {
        if (options_.search_radius > 0 && distance(i, j) > options_.search_radius) return false;
        return options_.angle >= 180 ||
               ours_.normals[static_cast<std::size_t>(i)] * theirs_.normals[static_cast<std::size_t>(j)] >= min_cosine_;
    }

    /// Min and max of each cost over all pairs.
    void find_scales() {
        std::vector<double> nearest(ours_.vertices.size()), farthest(ours_.vertices.size());
        parallel_for(nearest.size(), 64, [&](std::size_t i) {
            nearest[i] = std::numeric_limits<double>::infinity();
            farthest[i] = 0;
            for (const PointTree& tree : trees_) {
                nearest[i] = std::min(nearest[i], std::sqrt(tree.nearest(ours_.places[i]).squared));
                farthest[i] = std::max(farthest[i], std::sqrt(tree.farthest_squared(ours_.places[i])));
            }
        });
        distance_ = {*std::min_element(nearest.begin(), nearest.end()), *std::max_element(farthest.begin(), farthest.end())};
        const bool same = (!ours_.inner.empty() && !theirs_.inner.empty()) || (!ours_.outer.empty() && !theirs_.outer.empty());
        const bool differ = (!ours_.inner.empty() && !theirs_.outer.empty()) || (!ours_.outer.empty() && !theirs_.inner.empty());
        boundary_ = {same ? 0.0 : 1.0, differ ? 1.0 : 0.0};
        std::vector<double> minimum(ours_.outer.size(), std::numeric_limits<double>::infinity()), maximum(ours_.outer.size(), 0);
        parallel_for(ours_.outer.size(), 16, [&](std::size_t k) {
            for (const int j : theirs_.outer) {
                const double d = outline_difference(ours_.outer[k], j);
                minimum[k] = std::min(minimum[k], d);
                maximum[k] = std::max(maximum[k], d);
            }
        });
        const bool has_zero = !(ours_.inner.empty() && theirs_.inner.empty());  // pairs with an interior vertex cost nothing
        if (!ours_.outer.empty() && !theirs_.outer.empty())
            outline_ = {has_zero ? 0.0 : *std::min_element(minimum.begin(), minimum.end()),
                        *std::max_element(maximum.begin(), maximum.end())};
    }

    /// The best admissible counterparts of a vertex, best first; examines more than wanted of each kind if some are not
    /// admissible.
    [[nodiscard]] std::vector<std::pair<double, int>> best(int i, std::size_t max_count) const {
        std::vector<std::pair<double, int>> candidates;
        for (const int kind : {0, 1}) {
            const auto& group = kind == 1 ? theirs_.outer : theirs_.inner;
            if (group.empty()) continue;
            if (kind == 1 && ours_.boundary[static_cast<std::size_t>(i)]) {
                for (const int j : group)
                    if (allowed(i, j)) candidates.emplace_back(cost(i, j), j);
                continue;
            }
            for (std::size_t count = std::min(max_count + 4, group.size());; count = std::min(4 * count, group.size())) {
                std::vector<std::pair<double, int>> admissible;
                const auto near = trees_[kind].neighbours(ours_.places[static_cast<std::size_t>(i)], count);
                for (const PointTree::Near& neighbour : near)
                    if (const int j = group[neighbour.index]; allowed(i, j)) admissible.emplace_back(cost(i, j), j);
                const bool beyond =
                    options_.search_radius > 0 && near.back().squared > options_.search_radius * options_.search_radius;
                if (admissible.size() < max_count && count < group.size() && !beyond) continue;
                candidates.insert(candidates.end(), admissible.begin(), admissible.end());
                break;
            }
        }
        std::sort(candidates.begin(), candidates.end());
        if (candidates.size() > max_count) candidates.resize(max_count);
        return candidates;
    }

    Part ours_, theirs_;
    const VertexAssignmentOptions& options_;
    double min_cosine_;
    std::array<PointTree, 2> trees_;  ///< of the fragment's interior and outline vertices
    Scale distance_, boundary_, outline_;
};

}  // namespace

VertexAssignment assign_vertices(const Mesh& mesh, const Annotation& part, const Mesh& fragment, const Annotation& of_fragment,
                                 const std::vector<std::pair<Index, Index>>& landmarks, const VertexAssignmentOptions& options) {
    check_options(options, "correspondence");
    if (!(options.boundary + options.distance + options.outline > 0))
        fail_usage("all three weights of the vertex assignment are zero", "give one of them");
    std::vector<Index> ours, theirs;
    for (const auto& [a, b] : landmarks) {
        if (a >= mesh.number_of_vertices() || b >= fragment.number_of_vertices())
            fail_input("landmark", "names a vertex that does not exist", "give vertices of the template and of the fragment");
        ours.push_back(a);
        theirs.push_back(b);
    }
    return Assigner(part_of(mesh, part, ours, "template"), part_of(fragment, of_fragment, theirs, "fragment"), options).run();
}

void VertexAssignmentOptions::declare_options(OptionList& list) {
    list("counterpart", counterpart,
         "counterpart of a template vertex: the best vertex of the fragment, or an assignment that uses each vertex once",
         Choices{"best", "one-to-one"});
    list("boundary-weight", boundary, "weight of vertices on an outline relative to vertices inside the annotation",
         Range{0, 1e6});
    list("distance-weight", distance, "weight of the distance of counterparts", Range{0, 1e6});
    list("outline-weight", outline, "weight of the positions along the outline, from landmark to landmark", Range{0, 1e6});
    list("assignment-reach", search_radius, "maximum distance of a counterpart, in the unit of the meshes; 0: unlimited",
         Range{0, 1e60});
    list("assignment-angle", angle, "maximum angle between the normals of counterparts", Range{0, 180}, "degrees");
    list("candidates", candidates, "one-to-one: number of counterparts tried per vertex", Range{1, 1000});
    list("unassigned", unassigned, "one-to-one: cost of a template vertex without a counterpart", Range{0, 1e6},
         "share of the weights' sum");
}

}  // namespace ostraka

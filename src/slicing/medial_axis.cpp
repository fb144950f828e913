// Voronoi edges of boundary samples, pruned and joined into poly-lines.
#include "ostraka/slicing/medial_axis.h"

#include "slicing/strips.h"

#include "ostraka/core/error.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

namespace {

struct Sample {
    Vector2d place;
    int contour = 0;
    double along = 0;  ///< arc length up to here
};

using Info = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
using Number = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Info, Number>>;

std::vector<Sample> sample(const std::vector<Contour>& contours, int samples) {
    std::vector<Sample> sampled;
    for (std::size_t c = 0; c < contours.size() && contours[c].closed; ++c) {
        const auto& points = contours[c].points;
        double along = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
            const double piece = (b - a).norm();
            const int parts = std::max(1, static_cast<int>(std::ceil(piece * samples / contours[c].length)));
            for (int k = 0; k < parts; ++k)
                sampled.push_back({a + double(k) / parts * (b - a), static_cast<int>(c), along + piece * k / parts});
            along += piece;
        }
    }
    return sampled;
}

/// A Voronoi edge between two nodes.
struct Link {
    int from, to;
    double residue;
};

struct Graph {
    std::vector<Vector2d> places;
    std::vector<double> radii;
    std::vector<Link> links;
};

Graph voronoi(const std::vector<Contour>& contours, int samples) {
    const auto sampled = sample(contours, samples);
    Delaunay delaunay;
    Delaunay::Face_handle hint;
    for (std::size_t i = 0; i < sampled.size(); ++i) {
        const std::size_t before = delaunay.number_of_vertices();
        const auto vertex = delaunay.insert({sampled[i].place.x(), sampled[i].place.y()}, hint);
        if (delaunay.number_of_vertices() > before) vertex->info() = i;
        hint = vertex->face();
    }
    Graph graph;
    const detail::Strips strips(contours);
    std::vector<int> inside, on;
    // Sorted by samples: CGAL's traversal order of edges depends on memory addresses.
    std::vector<std::pair<std::array<std::size_t, 3>, Delaunay::Face_handle>> triangles;
    for (auto f = delaunay.all_faces_begin(); f != delaunay.all_faces_end(); ++f) f->info() = -1;
    for (auto f = delaunay.finite_faces_begin(); f != delaunay.finite_faces_end(); ++f) {
        std::array<std::size_t, 3> corners{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.emplace_back(corners, f);
    }
    std::sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [corners, f] : triangles) {
        const Sample& first = sampled[corners[0]];
        // Relative to the first corner, to avoid cancellation far from the origin.
        const Vector2d b = sampled[corners[1]].place - first.place, c = sampled[corners[2]].place - first.place;
        const double twice = 2 * (b.x() * c.y() - b.y() * c.x());
        const Vector2d centre(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(),
                              b.x() * c.squaredNorm() - c.x() * b.squaredNorm());
        const Vector2d place = first.place + centre / twice;
        if (!place.allFinite()) continue;
        strips.locate(place, inside, on);
        // Number of outer contours around the point minus that of holes: positive within the material.
        int nesting = 0;
        for (const int k : inside) nesting += contours[static_cast<std::size_t>(k)].hole ? -1 : 1;
        if (nesting <= 0 || !on.empty()) continue;
        f->info() = static_cast<int>(graph.places.size());
        graph.places.push_back(place);
        graph.radii.push_back((centre / twice).norm());
    }
    for (const auto& entry : triangles) {
        const Delaunay::Face_handle f = entry.second;
        for (int k = 0; k < 3; ++k) {
            const auto g = f->neighbor(k);
            if (f->info() < 0 || g->info() <= f->info()) continue;
            const Sample &a = sampled[f->vertex(Delaunay::cw(k))->info()], &b = sampled[f->vertex(Delaunay::ccw(k))->info()];
            double residue = 1;
            if (a.contour == b.contour) {
                const double contour_length = contours[static_cast<std::size_t>(a.contour)].length,
                             arc = std::abs(a.along - b.along);
                residue = (std::min(arc, contour_length - arc) - (a.place - b.place).norm()) / contour_length;
            }
            graph.links.push_back({f->info(), g->info(), residue});
        }
    }
    std::sort(graph.links.begin(), graph.links.end(),
              [](const Link& a, const Link& b) { return std::pair(a.from, a.to) < std::pair(b.from, b.to); });
    return graph;
}

/// Merges the nodes of links no longer than `minimum` into the node with the lowest index.
void contract(Graph& graph, double minimum, double floor) {
    DisjointSets sets(graph.places.size());
    for (const auto& link : graph.links) {
        if (link.residue < floor) continue;
        if ((graph.places[static_cast<std::size_t>(link.from)] - graph.places[static_cast<std::size_t>(link.to)]).norm() >
            minimum)
            continue;
        sets.unite(static_cast<std::size_t>(link.from), static_cast<std::size_t>(link.to));
    }
    for (auto& link : graph.links)
        for (int* node : {&link.from, &link.to}) *node = static_cast<int>(sets.find(static_cast<std::size_t>(*node)));
}

MedialAxis::Level prune(const Graph& graph, double residue) {
    MedialAxis::Level level;
    level.residue = residue;
    std::vector<std::vector<std::pair<int, int>>> incident_links(graph.places.size());  // link, node at the other end
    int single_node = -1;
    double strongest = -1;
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
        const Link& link = graph.links[k];
        if (link.residue < residue) continue;
        if (link.from == link.to) {
            if (link.residue > strongest) strongest = link.residue, single_node = link.from;
            continue;
        }
        incident_links[static_cast<std::size_t>(link.from)].emplace_back(static_cast<int>(k), link.to);
        incident_links[static_cast<std::size_t>(link.to)].emplace_back(static_cast<int>(k), link.from);
    }
    std::vector<bool> used(graph.links.size(), false);
    const auto follow = [&](int node, std::pair<int, int> step) {
        MedialAxis::Branch branch;
        const auto add = [&](int n) {
            branch.points.push_back(graph.places[static_cast<std::size_t>(n)]);
            branch.radii.push_back(graph.radii[static_cast<std::size_t>(n)]);
        };
        add(node);
        while (true) {
            used[static_cast<std::size_t>(step.first)] = true;
            add(step.second);
            level.length += (branch.points.back() - branch.points[branch.points.size() - 2]).norm();
            const auto& next = incident_links[static_cast<std::size_t>(step.second)];
            if (next.size() != 2 || step.second == node) break;
            const auto following = next[0].first == step.first ? next[1] : next[0];
            if (used[static_cast<std::size_t>(following.first)]) break;
            step = following;
        }
        level.branches.push_back(std::move(branch));
    };
    for (const bool loops : {false, true})
        for (std::size_t n = 0; n < incident_links.size(); ++n) {
            if (!loops && incident_links[n].size() == 2) continue;
            for (const auto& step : incident_links[n])
                if (!used[static_cast<std::size_t>(step.first)]) follow(static_cast<int>(n), step);
        }
    if (level.branches.empty() && single_node >= 0)
        level.branches.push_back(
            {{graph.places[static_cast<std::size_t>(single_node)]}, {graph.radii[static_cast<std::size_t>(single_node)]}});
    return level;
}

}  // namespace

MedialAxis medial_axis(const Slice& slice, const std::vector<double>& residues, int samples) {
    for (const double residue : residues)
        if (!(residue >= 0.001 && residue <= 1))
            fail_usage(fmt::format("the residue {} is out of range", std::to_string(residue)), "use 0.001 to 1");
    if (samples < 20 || samples > 1000000) fail_usage(fmt::format("the number of samples is {}", samples), "use 20 to a million");
    MedialAxis axis;
    std::vector<Contour> contours;
    double size = 0;
    for (const Slice& component : components(slice))
        for (const auto& contour : component.contours) contours.push_back(contour), size = std::max(size, contour.length);
    if (contours.empty() || !slice.completeness.has_areas()) {
        for (const double residue : residues) axis.levels.push_back({residue, 0, {}});
        return axis;
    }
    Graph graph = voronoi(contours, samples);
    contract(graph, 1e-6 * size, 0.001);
    for (const double residue : residues) axis.levels.push_back(prune(graph, residue));
    return axis;
}

}  // namespace ostraka

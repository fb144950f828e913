#include "ostraka/fracture/facets.h"

#include "fracture/facet_sides.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/mesh/disjoint_sets.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr std::size_t fracture_label = static_cast<std::size_t>(Facet::fracture);

class Finder {
public:
    Finder(const Mesh& mesh, const FacetEvidence& evidence, const std::vector<double>& log_odds, const FacetOptions& options)
        : mesh_(mesh), graph_(evidence.graph), walls_(evidence.walls), convexity_(evidence.convexity), options_(options) {
        for (const double odds : log_odds) probability_.push_back(1 / (1 + std::exp(-std::clamp(odds, -limit, limit))));
    }

    Facets run() {
        classify_fractures();
        answer();
        classify_sides();
        finish();
        return std::move(result_);
    }

private:
    /// Bound of the log odds of a single patch.
    static constexpr double limit = 6;

    /// Convex turn of the surface at or near a contact, in crease angles: edges are rounded.
    [[nodiscard]] double turn_at(const FacetGraph::Contact& contact) const {
        // Near the edge of two planes, points lie about a quarter of the dihedral angle below the tangent plane.
        const double about = 2 * (convexity_[contact.a] + convexity_[contact.b]);
        return std::max({0.0, contact.dihedral_angle, about}) / (options_.crease_angle * degree);
    }

    /// Cost of the boundary at each contact: its length, reduced at or near sharp convex turns.
    [[nodiscard]] std::vector<double> boundary() const {
        const double width = std::min(0.05 * graph_.size, walls_.thickness > 0 ? 0.5 * walls_.thickness : graph_.size);
        std::vector<double> costs;
        for (const auto& contact : graph_.contacts) {
            const double turn = turn_at(contact);
            costs.push_back(options_.coherence * width * contact.length * (0.03 + std::exp(-turn * turn)));
        }
        return costs;
    }

    /// Once a fracture is found, the probability threshold is lowered: most missed area is at worn edges.
    void classify_fractures() {
        constexpr double even = 0, likely = 0.4;  // added to log odds
        if (label_fractures(even)) label_fractures(likely);
        double intact = 0;
        for (std::size_t p = 0; p < labels_.size(); ++p) intact += labels_[p] == fracture_label ? 0 : graph_.areas[p];
        constexpr double little = 0.02;  // share of the area: a fracture is recognised by contrast with intact surface
        if (intact > little * graph_.area) return;
        std::fill(labels_.begin(), labels_.end(), 0);
    }

    bool label_fractures(double shift) {
        const std::size_t n = graph_.count();
        std::vector<std::vector<double>> costs(2, std::vector<double>(n));
        for (std::size_t p = 0; p < n; ++p) {
            const double odds = shift + std::log(probability_[p] / (1 - probability_[p]));
            costs[0][p] = graph_.areas[p] * std::log1p(std::exp(odds));
            costs[1][p] = graph_.areas[p] * std::log1p(std::exp(-odds));
        }
        labels_ = min_cost_labels(graph_, costs, boundary());
        for (std::size_t& label : labels_) label = label == 1 ? fracture_label : 0;
        return std::find(labels_.begin(), labels_.end(), fracture_label) != labels_.end();
    }

    /// Whether most of the intact surface is a wall with two intact sides.
    [[nodiscard]] bool is_shell(const std::vector<Index>& intact) {
        double total = 0, over_wall = 0, typical = 0;
        std::vector<std::pair<double, double>> depths;
        for (const Index p : intact) {
            total += graph_.areas[p];
            const Index behind = walls_.behind[p];
            if (!(walls_.opposite[p] > 0.7 && walls_.depth[p] < options_.wall * graph_.size) || behind == no_index ||
                labels_[behind] == fracture_label)
                continue;
            over_wall += graph_.areas[p];
            depths.emplace_back(walls_.depth[p], graph_.areas[p]);
        }
        if (!graph_.closed || !(over_wall > 0.5 * total)) return false;
        result_.thickness = weighted_median(depths);
        for (const auto& [depth, area] : depths)
            if (depth > 0.5 * result_.thickness && depth < 2 * result_.thickness) typical += area;
        return typical > 0.7 * over_wall;
    }

    void classify_sides() {
        std::vector<Index> intact;
        for (std::size_t p = 0; p < labels_.size(); ++p)
            if (labels_[p] != fracture_label) intact.push_back(static_cast<Index>(p));
        outward_.assign(graph_.count(), 1);
        result_.shell = intact.size() < labels_.size() && is_shell(intact);
        if (!result_.shell) {
            result_.thickness = 0;
            return;
        }
        outward_ = outwardness(mesh_, graph_, intact, result_.notes);
        std::vector<std::vector<double>> costs(2, std::vector<double>(graph_.count(), 0));
        for (const Index p : intact) {
            costs[0][p] = graph_.areas[p] * (1 - outside(p));
            costs[1][p] = graph_.areas[p] * outside(p);
        }
        std::vector<double> between = boundary();
        for (std::size_t c = 0; c < between.size(); ++c)
            if (labels_[graph_.contacts[c].a] == fracture_label || labels_[graph_.contacts[c].b] == fracture_label)
                between[c] = 0;
        const std::vector<std::size_t> side = min_cost_labels(graph_, costs, between);
        for (const Index p : intact) labels_[p] = side[p];
    }

    /// How far a patch faces away from the inside of the vessel, 0 to 1.
    [[nodiscard]] double outside(std::size_t p) const { return std::clamp((outward_[p] + 0.3) / 0.6, 0.0, 1.0); }

    /// A connected surface that is classified as fracture.
    struct FractureSurface {
        double area = 0, supported_area = 0;  ///< area; area times probability of fracture
        double outline = 0, folded = 0;       ///< length of the outline; length along convex edges
    };
    [[nodiscard]] std::vector<FractureSurface> fracture_surfaces() const {
        DisjointSets connected(labels_.size());
        const auto is_fracture = [&](Index p) { return labels_[p] == fracture_label; };
        for (const auto& contact : graph_.contacts)
            if (is_fracture(contact.a) && is_fracture(contact.b)) connected.unite(contact.a, contact.b);
        std::vector<FractureSurface> surfaces(labels_.size());
        for (Index p = 0; p < labels_.size(); ++p) {
            if (!is_fracture(p)) continue;
            FractureSurface& surface = surfaces[connected.find(p)];
            surface.area += graph_.areas[p];
            surface.supported_area += graph_.areas[p] * probability_[p];
        }
        constexpr double least_turn = 0.5;  // crease angles
        for (const auto& contact : graph_.contacts) {
            if (is_fracture(contact.a) == is_fracture(contact.b)) continue;
            FractureSurface& surface = surfaces[connected.find(is_fracture(contact.a) ? contact.a : contact.b)];
            surface.outline += contact.length;
            if (turn_at(contact) > least_turn) surface.folded += contact.length;
        }
        return surfaces;
    }

    /// Evidence of a fracture is a surface of some size that an edge separates from the intact surface.
    void answer() {
        double fracture_area = 0, supported_area = 0, expected = 0;
        constexpr double min_folded = 0.4;  // share of the outline
        constexpr double min_area = 0.005;  // share of the area
        for (const FractureSurface& surface : fracture_surfaces()) {
            if (surface.area < min_area * graph_.area || !(surface.folded > min_folded * surface.outline)) continue;
            fracture_area += surface.area;
            supported_area += surface.supported_area;
        }
        for (std::size_t p = 0; p < labels_.size(); ++p) expected += graph_.areas[p] * probability_[p];
        constexpr double little = 0.1;  // share of the area
        constexpr double min_support = 0.65;
        result_.answer = fracture_area > 0
                             ? (supported_area > min_support * fracture_area ? Facets::Answer::broken : Facets::Answer::unclear)
                             : (expected < little * graph_.area ? Facets::Answer::whole : Facets::Answer::unclear);
        if (result_.answer == Facets::Answer::whole) std::replace(labels_.begin(), labels_.end(), fracture_label, std::size_t{0});
        if (result_.answer == Facets::Answer::unclear)
            result_.notes.emplace_back(
                fracture_area > 0 ? "the surface classified as fracture may be a rough or shaped surface: inspect it"
                                  : "it cannot be determined whether there is a fracture: part of the surface may be one");
        if (!graph_.closed) result_.notes.emplace_back("the mesh is open: walls are detected only where rays hit another side");
    }

    void finish() {
        const auto label = [&](Face f) { return labels_[graph_.patch_of_face[f]]; };
        const FacePieces pieces = face_pieces(
            mesh_, [](Face) { return true; },
            [&](Halfedge h) { return label(mesh_.face(h)) == label(mesh_.face(mesh_.opposite(h))); });
        result_.segments.resize(pieces.count);
        for (const Face f : mesh_.faces()) {
            const Index p = graph_.patch_of_face[f];
            const double area = face_area(mesh_, f), sure = labels_[p] == fracture_label ? probability_[p] : 1 - probability_[p];
            const double side = labels_[p] == 0 ? outside(p) : labels_[p] == fracture_label ? 1 : 1 - outside(p);
            FacetSegment& segment = result_.segments[pieces.of_face[f]];
            segment.facet = static_cast<Facet>(labels_[p]);
            segment.faces.push_back(static_cast<Index>(f));
            segment.area += area;
            segment.confidence += area * std::min(sure, side);
            result_.of_face.push_back(segment.facet);
            result_.probability.push_back(probability_[p]);
            result_.confidence += area * std::min(sure, side) / graph_.area;
        }
        for (FacetSegment& segment : result_.segments) segment.confidence /= segment.area > 0 ? segment.area : 1;
        std::stable_sort(result_.segments.begin(), result_.segments.end(),
                         [](const FacetSegment& a, const FacetSegment& b) { return a.area > b.area; });
    }

    const Mesh& mesh_;
    const FacetGraph& graph_;
    const Walls& walls_;
    const std::vector<double>& convexity_;
    const FacetOptions& options_;
    std::vector<double> probability_;  ///< per patch: probability of being fracture
    std::vector<std::size_t> labels_;  ///< per patch: a Facet
    std::vector<double> outward_;      ///< per patch: see outwardness
    Facets result_;
};

}  // namespace

double Facets::area(Facet facet) const {
    double sum = 0;
    for (const FacetSegment& segment : segments)
        if (segment.facet == facet) sum += segment.area;
    return sum;
}

std::string to_string(Facets::Answer answer) { return enum_name(answer, {"broken", "whole", "unclear"}); }

Facets find_facets(const Mesh& mesh, const FacetEvidence& evidence, const std::vector<double>& log_odds,
                   const FacetOptions& options) {
    check_options(options, "facets");
    if (log_odds.size() != evidence.graph.count() || evidence.graph.patch_of_face.size() != mesh.number_of_faces())
        fail_usage("the evidence and the log odds belong to another mesh", "compute them from this mesh");
    return Finder(mesh, evidence, log_odds, options).run();
}

Facets find_facets(const Mesh& mesh, const FacetOptions& options) {
    check_options(options, "facets");
    const FacetEvidence evidence = facet_evidence(mesh);
    return find_facets(mesh, evidence, facet_model().log_odds(evidence), options);
}

void FacetOptions::declare_options(OptionList& list) {
    list("facet-crease-angle", crease_angle,
         "angle between the normals of two faces above which a convex edge is likely to bound a fracture surface", Range{5, 120},
         "degrees");
    list("facet-wall", wall, "maximum wall thickness of a two-sided fragment, as a share of the root of its area",
         Range{0.01, 1});
    list("facet-coherence", coherence,
         "weight of the agreement with the labels of neighbouring faces, relative to the features of the face itself",
         Range{0, 100});
}

}  // namespace ostraka

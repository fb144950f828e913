#include "ostraka/reconstruction/annotation_matches.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/relation/topology.h"

#include <fmt/core.h>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/maximum_weighted_matching.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// Features of an annotation for matching.
struct MatchFeatures {
    const Annotation* annotation;
    std::set<std::string> containers;  ///< tags
    Vector3d centre = Vector3d::Zero();
    double size = 0;    ///< diagonal of its bounding box
    double extent = 0;  ///< area of a region, length of a line
};

std::vector<MatchFeatures> matching_features(AnnotatedMeshView object, const Motion& pose) {
    const ContainmentOrder order = topology(object).order;
    std::vector<MatchFeatures> result;
    for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i) {
        const Annotation& annotation = object.annotations.annotations[i];
        MatchFeatures features{&annotation, {}};
        for (const std::size_t c : order.containers[i])
            if (!object.annotations.annotations[c].all) features.containers.insert(object.annotations.annotations[c].tag);
        Eigen::AlignedBox3d box;
        double weight = 0;
        const auto add = [&](const Vector3d& place, double w) {
            features.centre += w * place;
            weight += w;
        };
        if (annotation.type == AnnotationType::region) {
            for (const auto& [face, share] : face_area_fractions(object.mesh, annotation)) {
                const double area = share * face_area(object.mesh, Face(face)) * pose.scale * pose.scale;
                features.extent += area;
                add(pose(eigen(centroid(object.mesh, Face(face)))), area);
            }
        }
        for (const auto& line : annotation.polylines)
            for (std::size_t k = 1; k < line.size(); ++k) {
                const Vector3d a = pose(eigen(object.mesh.point(Vertex(line[k - 1])))),
                               b = pose(eigen(object.mesh.point(Vertex(line[k]))));
                features.extent += (b - a).norm();
                add((a + b) / 2, (b - a).norm());
            }
        for (const Index v : touched_vertices(object.mesh, annotation)) {
            const Vector3d place = pose(eigen(object.mesh.point(Vertex(v))));
            box.extend(place);
            if (annotation.type == AnnotationType::point) add(place, 1);
        }
        if (weight > 0) features.centre /= weight;
        features.size = box.isEmpty() ? 0 : box.diagonal().norm();
        result.push_back(std::move(features));
    }
    return result;
}

/// Share of the common attributes that agree; 1 if there are none.
double agreement(const Annotation& a, const Annotation& b) {
    double sum = 0;
    int count = 0;
    for (const Attribute& ours : a.attributes)
        for (const Attribute& theirs : b.attributes) {
            if (ours.name != theirs.name) continue;
            const Note *our_note = ours.note(), *their_note = theirs.note();
            const Measure *our_measure = ours.measure(), *their_measure = theirs.measure();
            if (our_note != nullptr && their_note != nullptr) {
                sum += our_note->text == their_note->text ? 1 : 0;
            } else if (our_measure != nullptr && their_measure != nullptr) {
                const double our_value = our_measure->value.value_or(0), their_value = their_measure->value.value_or(0);
                if (!(our_value > 0 && their_value > 0)) continue;
                sum += std::min(our_value, their_value) / std::max(our_value, their_value);
            } else {
                continue;
            }
            ++count;
        }
    return count > 0 ? sum / count : 1;
}

AnnotationMatch compare(const MatchFeatures& theirs, const MatchFeatures& ours, double diagonal) {
    AnnotationMatch match{theirs.annotation->id, ours.annotation->id};
    match.attributes = agreement(*ours.annotation, *theirs.annotation);
    if (!theirs.containers.empty()) {
        std::size_t common = 0;
        for (const std::string& tag : theirs.containers) common += ours.containers.count(tag);
        match.containers = static_cast<double>(common) / static_cast<double>(theirs.containers.size());
    }
    const double size = std::max(ours.size, 0.05 * diagonal), distance = (ours.centre - theirs.centre).norm() / size;
    match.place = std::exp(-distance * distance);
    if (theirs.extent > ours.extent) match.extent = theirs.extent > 0 ? ours.extent / theirs.extent : 1;
    match.score = (match.attributes + match.containers + match.place + match.extent) / 4;
    return match;
}

}  // namespace

std::vector<AnnotationMatch> match_annotations(AnnotatedMeshView scaled, AnnotatedMeshView fragment, const Motion& pose,
                                               const std::vector<StatedMatch>& stated, const AnnotationMatchOptions& options) {
    check_options(options, "annotation matches");
    const std::vector<MatchFeatures> ours = matching_features(scaled, {}), theirs = matching_features(fragment, pose);
    const double diagonal = box_diagonal(scaled.mesh);
    const auto position_of = [](const std::vector<MatchFeatures>& annotations, int id, const char* whose) {
        for (std::size_t i = 0; i < annotations.size(); ++i)
            if (annotations[i].annotation->id == id) return i;
        fail_input("stated matches", fmt::format("name annotation {}, which the {} does not have", id, whose),
                   "list its ids with 'annotation list'");
    };
    std::vector<AnnotationMatch> result;
    std::vector<bool> used(ours.size(), false), has_statement(theirs.size(), false);
    for (const StatedMatch& statement : stated) {
        const std::size_t b = position_of(theirs, statement.fragment_annotation, "fragment");
        if (has_statement[b])
            fail_input("stated matches", fmt::format("name annotation {} of the fragment twice", statement.fragment_annotation),
                       "keep one of them");
        has_statement[b] = true;
        if (!statement.template_annotation) continue;
        const std::size_t a = position_of(ours, *statement.template_annotation, "template");
        if (ours[a].annotation->type != theirs[b].annotation->type)
            fail_input("stated matches",
                       fmt::format("match a {} (annotation {} of the fragment) with a {} (annotation {} of the template)",
                                   to_string(theirs[b].annotation->type), statement.fragment_annotation,
                                   to_string(ours[a].annotation->type), *statement.template_annotation),
                       "match annotations of the same type");
        used[a] = true;
        result.push_back(compare(theirs[b], ours[a], diagonal));
        result.back().stated = true;
    }

    // Maximum weight assignment among annotations of one type and tag.
    using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                                        boost::property<boost::edge_weight_t, double>>;
    const std::size_t n = theirs.size();
    Graph graph(n + ours.size());
    std::map<std::pair<std::size_t, std::size_t>, AnnotationMatch> candidates;
    for (std::size_t b = 0; b < n; ++b)
        for (std::size_t a = 0; a < ours.size(); ++a) {
            const Annotation &x = *theirs[b].annotation, &y = *ours[a].annotation;
            if (has_statement[b] || used[a] || x.type != y.type || x.all || y.all || x.tag.empty() || x.tag != y.tag) continue;
            const AnnotationMatch match = compare(theirs[b], ours[a], diagonal);
            if (match.score < options.min_score) continue;
            candidates.emplace(std::pair(b, a), match);
            boost::add_edge(b, n + a, match.score, graph);
        }
    if (!candidates.empty()) {
        std::vector<boost::graph_traits<Graph>::vertex_descriptor> mate(n + ours.size());
        boost::maximum_weighted_matching(graph, mate.data());
        for (const auto& [pair, match] : candidates)
            if (mate[pair.first] == n + pair.second) result.push_back(match);
    }
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return a.fragment_annotation < b.fragment_annotation; });
    return result;
}

void AnnotationMatchOptions::declare_options(OptionList& list) {
    list("min-score", min_score, "minimum score, from 0 to 1, of the agreement of two matched annotations", Range{0, 1});
}

}  // namespace ostraka

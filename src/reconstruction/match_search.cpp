#include "reconstruction/match_search.h"

#include "reconstruction/outline_correspondences.h"
#include "reconstruction/shared_faces.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>

namespace ostraka {

namespace {

/// Any face at a vertex that has one, also at a border.
Face face_at(const Mesh& mesh, Vertex vertex) {
    for (const Face face : mesh.faces_around_target(mesh.halfedge(vertex)))
        if (face != Mesh::null_face()) return face;
    return Mesh::null_face();
}

constexpr int no_label = -1;

/// For each face the number of the smallest region that contains it.
std::vector<int> face_labels(const Mesh& mesh, const std::vector<std::pair<const Annotation*, int>>& regions) {
    std::vector<int> labels(mesh.number_of_faces(), no_label);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        double area = 0;
        for (const Index face : regions[r].first->faces) area += face_area(mesh, Face(face));
        order.emplace_back(area, r);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a > b; });
    for (const auto& [area, r] : order)
        for (const Index face : regions[r].first->faces) labels[face] = regions[r].second;
    return labels;
}

}  // namespace

MatchSearch::~MatchSearch() = default;

MatchSearch::MatchSearch(AnnotatedMeshView template_object, const std::vector<PlacedFragment>& fragments, double scale,
                         Guides guides)
    : scale_(scale), template_(template_object.mesh), fragments_(fragments) {
    Motion unit;
    unit.scale = 1 / scale;
    // Regions present on any fragment.
    std::vector<std::pair<const Annotation*, int>> ours;
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const PlacedFragment& fragment = fragments[k];
        std::vector<std::pair<const Annotation*, int>> theirs;
        for (const AnnotationMatch& match : fragment.matches) {
            const Annotation *a = template_object.annotations.find(match.template_annotation),
                             *b = fragment.annotations->find(match.fragment_annotation);
            if (a == nullptr || b == nullptr || a->type != b->type) continue;
            if (a->type == AnnotationType::region && !a->all && !b->all) {
                theirs.emplace_back(b, a->id);
                if (std::none_of(ours.begin(), ours.end(), [&](const auto& entry) { return entry.first == a; }))
                    ours.emplace_back(a, a->id);
            } else if (a->type == AnnotationType::point && a->points.size() == 1 && b->points.size() == 1) {
                correspondences_.push_back(
                    {a->points.front(), eigen(fragment.mesh.point(Vertex(b->points.front()))) / scale, 0, static_cast<int>(k)});
                landmarks_.emplace_back(a->points.front(), b->points.front());
                landmark_fragment_.push_back(static_cast<int>(k));
            }
        }
        const std::vector<int> labels = face_labels(fragment.mesh, theirs);
        for (const auto& [region, label] : theirs) {
            Counterpart counterpart{static_cast<int>(k), label, {}};
            counterpart.region.tag = region->tag;
            counterpart.region.type = AnnotationType::region;
            for (const Index face : region->faces)
                if (labels[face] == label && (fragment.facets.empty() || fragment.facets[face] != Facet::fracture))
                    counterpart.region.faces.push_back(face);
            if (!counterpart.region.faces.empty()) counterparts_.push_back(std::move(counterpart));
        }
        const bool has_trees = fragment.trees != nullptr;
        trees_.push_back(has_trees ? fragment.trees : std::make_shared<FragmentTrees>(fragment.mesh, fragment.facets));
        to_template_.push_back(has_trees ? unit.after(fragment.pose) : unit);
        to_fragment_.push_back(to_template_.back().inverse());
        joints_.add(static_cast<int>(k), fragment.mesh, labels, fragment.facets, trees_.back()->end_vertices(), scale);
        for (const auto& [label, part] : trees_.back()->parts(labels)) parts_[label].push_back({static_cast<int>(k), &part});
    }
    face_labels_ = face_labels(template_object.mesh, ours);
    if (guides == Guides::paths) add_path_correspondences(template_object.annotations);
}

void MatchSearch::add_path_correspondences(const AnnotationSet& set) {
    for (std::size_t k = 0; k < fragments_.size(); ++k) {
        const PlacedFragment& fragment = fragments_[k];
        std::vector<bool> broken = intact_faces(fragment.facets);
        broken.flip();
        std::vector<std::pair<Index, Index>> landmarks;
        for (std::size_t l = 0; l < landmarks_.size(); ++l)
            if (landmark_fragment_[l] == static_cast<int>(k)) landmarks.push_back(landmarks_[l]);
        if (landmarks.empty()) continue;
        for (const AnnotationMatch& match : fragment.matches) {
            const Annotation *a = set.find(match.template_annotation), *b = fragment.annotations->find(match.fragment_annotation);
            if (a == nullptr || b == nullptr || a->type != b->type || a->type == AnnotationType::point || a->all || b->all)
                continue;
            Annotation outer = *b;
            if (!broken.empty()) std::erase_if(outer.faces, [&](Index f) { return broken[f]; });
            for (const OutlineCorrespondence& correspondence :
                 outline_correspondences(template_, *a, fragment.mesh, outer, broken, landmarks, scale_)) {
                // Of nested parts the innermost one decides.
                const auto ring = template_.faces_around_target(template_.halfedge(Vertex(correspondence.vertex)));
                const bool ours = a->type == AnnotationType::line || std::any_of(ring.begin(), ring.end(), [&](Face face) {
                                      return face != Mesh::null_face() && face_labels_[face] == a->id;
                                  });
                if (ours)
                    correspondences_.push_back({correspondence.vertex, correspondence.place / scale_, correspondence.length,
                                                static_cast<int>(k), a->type == AnnotationType::region});
            }
        }
    }
}

void MatchSearch::recognise_shared_faces() {
    for (const PlacedFragment& fragment : fragments_) {
        std::vector<bool> broken = intact_faces(fragment.facets);
        broken.flip();
        std::vector<Index> vertices = shared_vertices(template_, fragment.mesh, scale_, broken);
        bool complete = !vertices.empty();
        for (const Face face : fragment.mesh.faces())
            for (const Vertex v : corners(fragment.mesh, face))
                complete = complete && (vertices[v] != no_index || (!broken.empty() && broken[face]));
        shared_.push_back(complete ? std::move(vertices) : std::vector<Index>());
    }
    std::erase_if(correspondences_, [&](const CorrespondenceConstraint& correspondence) {
        return !shared_[static_cast<std::size_t>(correspondence.fragment)].empty();
    });
}

std::vector<VertexMatch> MatchSearch::shared_matches(const Mesh& mesh, const std::vector<Index>& vertex_map) const {
    std::vector<VertexMatch> shared;
    for (std::size_t k = 0; k < shared_.size(); ++k) {
        if (shared_[k].empty()) continue;
        shared.resize(mesh.number_of_vertices());
        const Mesh& fragment = fragments_[k].mesh;
        for (const Vertex v : fragment.vertices()) {
            const Index ours = shared_[k][v];
            if (ours == no_index) continue;
            const Index vertex = vertex_map.empty() ? ours : vertex_map[ours];
            if (vertex == no_index || shared[vertex].fragment >= 0) continue;
            const Vector3d moved = eigen(mesh.point(Vertex(vertex))) - eigen(template_.point(Vertex(ours)));
            shared[vertex] = {static_cast<int>(k), face_at(fragment, v), eigen(fragment.point(v)) / scale_ + moved, 0};
        }
    }
    return shared;
}

MatchSearch::Labels MatchSearch::labels(const Mesh& mesh, const std::vector<Index>& face_origin,
                                        const std::vector<Index>& vertex_map) const {
    Labels labels;
    for (Index f = 0; f < mesh.number_of_faces(); ++f)
        labels.of_face.push_back(face_labels_[face_origin.empty() ? f : face_origin[f]]);
    labels.of_vertex.resize(mesh.number_of_vertices());
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        std::vector<int>& vertex_labels = labels.of_vertex[v];
        for (const Face face : mesh.faces_around_target(mesh.halfedge(v))) {
            if (face == Mesh::null_face()) continue;
            const int label = labels.of_face[face];
            if (std::find(vertex_labels.begin(), vertex_labels.end(), label) == vertex_labels.end())
                vertex_labels.push_back(label);
        }
        std::sort(vertex_labels.begin(), vertex_labels.end());
    }
    labels.shared = shared_matches(mesh, vertex_map);
    return labels;
}

std::vector<VertexMatch> MatchSearch::matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                              double search_radius, double min_cosine) const {
    const std::size_t n = labels.of_vertex.size();
    // Normals of the current shape.
    std::vector<Vector3d> normals(n, Vector3d::Zero());
    for (const Face face : connectivity.faces()) {
        const auto c = corners(connectivity, face);
        const Vector3d a = current.col(static_cast<Eigen::Index>(c[0])), b = current.col(static_cast<Eigen::Index>(c[1])),
                       d = current.col(static_cast<Eigen::Index>(c[2]));
        const Vector3d area = (b - a).cross(d - a);
        for (const Vertex v : c) normals[v] += area;
    }
    std::vector<VertexMatch> result(n);
    parallel_for(n, [&](std::size_t i) {
        const double length = normals[i].norm();
        if (!(length > 0)) return;
        const Vector3d place = current.col(static_cast<Eigen::Index>(i));
        double nearest = search_radius;
        for (const int label : labels.of_vertex[i]) {
            const auto entry = parts_.find(label);
            if (entry == parts_.end()) continue;
            for (const Part& candidate : entry->second) {
                const FragmentPart& part = *candidate.part;
                const auto k = static_cast<std::size_t>(candidate.fragment);
                const Motion& to_fragment = to_fragment_[k];
                const auto hit = part.search->closest_compatible(point_of(to_fragment(place)),
                                                                 vector_of(to_fragment.rotation * normals[i] / length),
                                                                 min_cosine, nearest * to_fragment.scale);
                if (!hit) continue;
                // Beyond the fragment's end, its rim would be the nearest point for all vertices.
                constexpr double on_edge = 1e-6;
                const Face face(hit->face);
                const auto c = corners(part.mesh, face);
                bool at_end = false;
                for (const Halfedge h : part.mesh.halfedges_around_face(part.mesh.halfedge(face))) {
                    const Vertex opposite = part.mesh.target(part.mesh.next(h));
                    for (std::size_t corner = 0; corner < 3; ++corner)
                        if (c[corner] == opposite && hit->barycentric[corner] < on_edge)
                            at_end = at_end || part.edge_ends[part.mesh.edge(h)];
                }
                for (std::size_t corner = 0; corner < 3; ++corner)
                    at_end = at_end || (hit->barycentric[corner] > 1 - on_edge && part.vertex_ends[c[corner]]);
                nearest = hit->distance / to_fragment.scale;
                result[i] =
                    at_end ? VertexMatch()
                           : VertexMatch{candidate.fragment, part.faces[hit->face], to_template_[k](eigen(hit->point)), nearest};
            }
        }
    });
    return result;
}

std::vector<VertexMatch> MatchSearch::sliding_matches(const Points& current, const Mesh& connectivity, const Labels& labels,
                                                      double search_radius, double min_cosine, std::vector<Slide>& slides) const {
    std::vector<VertexMatch> result = matches(current, connectivity, labels, search_radius, min_cosine);
    slides.assign(result.size(), {});
    parallel_for(result.size(), [&](std::size_t i) {
        const Vector3d place = current.col(static_cast<Eigen::Index>(i));
        if (!labels.shared.empty()) {
            // For such a fragment it is known which vertices are on it.
            const bool on_shared_fragment =
                result[i].fragment >= 0 && !shared_[static_cast<std::size_t>(result[i].fragment)].empty();
            if (const VertexMatch& shared = labels.shared[i]; shared.fragment >= 0) {
                result[i] = shared;
                result[i].distance = (shared.place - place).norm();
                return;
            }
            if (on_shared_fragment) result[i] = {};
        }
        if (const auto joint = joints_.nearest(place, labels.of_vertex[i], search_radius)) {
            const int fragment = joint->match.fragment;
            if (fragment < 0 || shared_.empty() || shared_[static_cast<std::size_t>(fragment)].empty()) {
                result[i] = joint->match;
                slides[i] = {joint->along * joint->along.transpose(), true};
                return;
            }
        }
        if (result[i].fragment < 0) return;
        const Vector3d n = normal(result[i]);
        slides[i].free = Eigen::Matrix3d::Identity() - n * n.transpose();
    });
    return result;
}

Vector3d MatchSearch::normal(const VertexMatch& match) const {
    const auto k = static_cast<std::size_t>(match.fragment);
    return (to_template_[k].rotation * eigen(area_vector(trees_[k]->mesh(), Face(match.face)))).normalized();
}

std::vector<FragmentSample> MatchSearch::samples(int count) const {
    double area = 0;
    for (const auto& [label, parts] : parts_)
        for (const Part& part : parts) area += surface_area(part.part->mesh);
    std::vector<FragmentSample> samples;
    const double each = area / count;
    double sum = 0, next = 0.5 * each;
    for (const auto& [label, parts] : parts_)
        for (const Part& part : parts) {
            const Mesh& mesh = part.part->mesh;
            const Motion& motion = to_template_[static_cast<std::size_t>(part.fragment)];
            for (const Face face : mesh.faces()) {
                sum += face_area(mesh, face);
                if (next >= sum) continue;
                const Vector3d normal = motion.rotation * eigen(area_vector(mesh, face));
                samples.push_back({motion(eigen(centroid(mesh, face))), normal.normalized(), label});
                while (next < sum) next += each;
            }
        }
    return samples;
}

void MatchSearch::assign(const Points& current, const Mesh& connectivity, const Labels& labels,
                         const VertexAssignmentOptions& template_options, std::vector<VertexMatch>& matches) const {
    Mesh mesh = connectivity;
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(scale_ * current.col(static_cast<Eigen::Index>(v)));
    VertexAssignmentOptions options = template_options;
    options.search_radius *= scale_;
    for (const Counterpart& counterpart : counterparts_) {
        Annotation part;
        part.type = AnnotationType::region;
        for (Index f = 0; f < labels.of_face.size(); ++f)
            if (labels.of_face[f] == counterpart.label) part.faces.push_back(f);
        if (part.faces.empty()) continue;
        const PlacedFragment& fragment = fragments_[static_cast<std::size_t>(counterpart.fragment)];
        std::vector<std::pair<Index, Index>> landmarks;
        if (labels.of_face.size() == face_labels_.size()) {
            const std::vector<Index> ours = touched_vertices(mesh, part),
                                     theirs = touched_vertices(fragment.mesh, counterpart.region);
            for (std::size_t l = 0; l < landmarks_.size(); ++l)
                if (landmark_fragment_[l] == counterpart.fragment &&
                    std::binary_search(ours.begin(), ours.end(), landmarks_[l].first) &&
                    std::binary_search(theirs.begin(), theirs.end(), landmarks_[l].second))
                    landmarks.push_back(landmarks_[l]);
        }
        const VertexAssignment assignment = assign_vertices(mesh, part, fragment.mesh, counterpart.region, landmarks, options);
        for (std::size_t i = 0; i < assignment.vertices.size(); ++i) {
            const Index v = assignment.vertices[i], fragment_vertex = assignment.counterpart[i];
            VertexMatch& match = matches[v];
            // Of several fragments with the part, the nearest one is used.
            const bool replaceable = match.fragment == counterpart.fragment || match.fragment < 0;
            if (fragment_vertex == no_index ||
                trees_[static_cast<std::size_t>(counterpart.fragment)]->end_vertices()[fragment_vertex]) {
                if (replaceable) match = VertexMatch();
                continue;
            }
            const Eigen::Vector3d place = eigen(fragment.mesh.point(Vertex(fragment_vertex))) / scale_;
            const double distance = (place - current.col(static_cast<Eigen::Index>(v))).norm();
            if (!replaceable && match.distance <= distance) continue;
            match = {counterpart.fragment, face_at(fragment.mesh, Vertex(fragment_vertex)), place, distance};
        }
    }
}

}  // namespace ostraka

#include "ostraka/annotation/annotation_maps.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/shortest_path.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

namespace ostraka {

namespace {

/// Collects the ids per element in the order of the annotations, then interns them: equal sets are looked up once per run of
/// elements.
template <class ElementIndex>
void store(Mesh& mesh, const char* name, std::vector<std::pair<Index, int>>& entries, AnnotationTable& table) {
    auto map = mesh.add_property_map<ElementIndex, std::uint32_t>(name, 0).first;
    std::fill(map.begin(), map.end(), 0U);
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    std::vector<int> ids, last_ids;
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < entries.size();) {
        const Index element = entries[i].first;
        ids.clear();
        for (; i < entries.size() && entries[i].first == element; ++i) ids.push_back(entries[i].second);
        if (last == 0 || ids != last_ids) {
            last = table.intern(ids);
            last_ids = ids;
        }
        map[ElementIndex(element)] = last;
    }
}

template <class ElementIndex>
auto stored(const Mesh& mesh, const char* name) {
    const auto [map, found] = mesh.property_map<ElementIndex, std::uint32_t>(name);
    if (!found) fail_work("mesh", std::string("has no property map ") + name, "attach the annotations first");
    return map;
}

/// Joins edges (pairs of vertices, in any order, without repeats) into vertex paths by greedy walking: paths begin and end at
/// vertices whose degree is not two; the remaining paths are closed (first = last). Deterministic: lowest vertex first. O(n log
/// n).
std::vector<std::vector<Index>> join_into_paths(const std::vector<std::pair<Index, Index>>& edges) {
    struct Link {
        Index from, to;
        std::size_t edge;
        bool operator<(const Link& other) const { return std::tie(from, to) < std::tie(other.from, other.to); }
    };
    std::vector<Link> links;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        links.push_back({edges[e].first, edges[e].second, e});
        links.push_back({edges[e].second, edges[e].first, e});
    }
    std::sort(links.begin(), links.end());
    std::vector<bool> used(edges.size(), false);
    const auto around = [&](Index vertex) {
        return std::equal_range(links.begin(), links.end(), Link{vertex, 0, 0},
                                [](const Link& a, const Link& b) { return a.from < b.from; });
    };
    const auto unused = [&](Index vertex) {
        const auto [first, last] = around(vertex);
        return std::find_if(first, last, [&](const Link& link) { return !used[link.edge]; }) != last;
    };
    const auto degree = [&](Index vertex) {
        const auto [first, last] = around(vertex);
        return last - first;
    };
    std::vector<std::vector<Index>> vertex_paths;
    const auto walk = [&](const Link& start) {
        std::vector<Index> vertex_path{start.from, start.to};
        used[start.edge] = true;
        while (vertex_path.back() != vertex_path.front() && degree(vertex_path.back()) == 2 && unused(vertex_path.back())) {
            const auto [first, last] = around(vertex_path.back());
            const auto next = std::find_if(first, last, [&](const Link& link) { return !used[link.edge]; });
            used[next->edge] = true;
            vertex_path.push_back(next->to);
        }
        vertex_paths.push_back(std::move(vertex_path));
    };
    for (const Link& link : links)
        if (!used[link.edge] && degree(link.from) != 2) walk(link);
    for (const Link& link : links)
        if (!used[link.edge]) walk(link);
    return vertex_paths;
}

/// Finds the current elements of the annotations.
class Collector {
public:
    Collector(const Mesh& mesh, const AnnotationTable& table, const AnnotationSet& before, const std::vector<Index>& vertex_map)
        : mesh_(mesh), table_(table), vertex_map_(vertex_map), search_(mesh), edge_sets_(stored<Edge>(mesh, edge_annotations)) {
        // One pass over the mesh collects the elements of all annotations.
        for (const auto& annotation : before.annotations) faces_[annotation.id], edges_[annotation.id], vertices_[annotation.id];
        const auto face_sets = stored<Face>(mesh, face_annotations);
        for (const Face face : mesh.faces()) hand_out(face_sets[face], face, faces_);
        for (const Edge edge : mesh.edges()) hand_out(edge_sets_[edge], edge, edges_);
        const auto vertex_sets = stored<Vertex>(mesh, vertex_annotations);
        for (const Vertex vertex : mesh.vertices()) hand_out(vertex_sets[vertex], vertex, vertices_);
    }

    void follow(Annotation& annotation) {
        if (annotation.type == AnnotationType::point) points(annotation);
        else if (annotation.type == AnnotationType::line) line(annotation);
        else region(annotation);
    }

private:
    template <class Element>
    void hand_out(std::uint32_t set, Element element, std::map<int, std::vector<Index>>& lists) {
        if (set == 0) return;
        for (const int id : table_.ids(set))
            if (const auto list = lists.find(id); list != lists.end()) list->second.push_back(static_cast<Index>(element));
    }

    [[nodiscard]] Index now(Index before) const { return before < vertex_map_.size() ? vertex_map_[before] : no_index; }

    void points(Annotation& annotation) {
        if (vertex_map_.empty()) {
            annotation.points = vertices_.at(annotation.id);
        } else {
            std::vector<Index> kept;
            for (const Index vertex : annotation.points)
                if (now(vertex) != no_index && std::find(kept.begin(), kept.end(), now(vertex)) == kept.end())
                    kept.push_back(now(vertex));
            annotation.points = std::move(kept);
        }
        if (annotation.points.empty()) add_note(annotation, "all its points are gone");
    }

    void line(Annotation& annotation) {
        if (vertex_map_.empty()) {
            annotation.polylines = vertex_paths(edges_.at(annotation.id));
        } else {
            std::vector<std::vector<Index>> polylines;
            for (const auto& polyline : annotation.polylines) follow(polyline, annotation, polylines);
            if (polylines.empty()) degrade(annotation, annotation.polylines);
            else annotation.polylines = std::move(polylines);
        }
        if (annotation.type == AnnotationType::line && annotation.polylines.empty())
            add_note(annotation, "all its poly-lines are gone");
    }

    void region(Annotation& annotation) {
        const auto outlines = table_.outlines.find(annotation.id);
        annotation.faces = faces_.at(annotation.id);
        if (annotation.all && annotation.faces.size() != mesh_.number_of_faces()) {
            annotation.faces.resize(mesh_.number_of_faces());  // faces added by an edit belong to the whole as well
            for (Index face = 0; face < annotation.faces.size(); ++face) annotation.faces[face] = face;
        }
        if (!annotation.faces.empty()) return;
        annotation.all = false;
        std::vector<std::vector<Index>> walks;
        if (outlines != table_.outlines.end())
            for (Outline walk : outlines->second) {
                walk.push_back(walk.front());
                walks.push_back(std::move(walk));
            }
        degrade(annotation, walks);
    }

    std::vector<std::vector<Index>> vertex_paths(const std::vector<Index>& edges) const {
        std::vector<std::pair<Index, Index>> pairs;
        for (const Index edge : edges) {
            const Halfedge h = mesh_.halfedge(Edge(edge));
            pairs.emplace_back(mesh_.source(h), mesh_.target(h));
        }
        return join_into_paths(pairs);
    }

    /// Reduces an annotation, given as walks over the old mesh, to a line along the edges that remain, or to points.
    void degrade(Annotation& annotation, const std::vector<std::vector<Index>>& walks) {
        const std::string was = to_string(annotation.type);
        std::set<std::pair<Index, Index>> edges;
        std::set<Index> vertices;
        for (const auto& walk : walks) {
            Index last = no_index;
            for (const Index vertex : walk) {
                const Index here = vertex_map_.empty() ? vertex : now(vertex);
                if (here == no_index || here >= mesh_.number_of_vertices()) continue;
                vertices.insert(here);
                if (last != no_index && last != here && find_halfedge(mesh_, Vertex(last), Vertex(here)).is_valid())
                    edges.insert(std::minmax(last, here));
                last = here;
            }
        }
        annotation.polylines.clear();
        if (!edges.empty()) {
            annotation.type = AnnotationType::line;
            annotation.polylines = join_into_paths({edges.begin(), edges.end()});
        } else {
            annotation.type = AnnotationType::point;
            annotation.points.assign(vertices.begin(), vertices.end());
        }
        if (vertices.empty()) add_note(annotation, "the " + was + " is gone: none of its elements is left");
        else add_note(annotation, "the " + was + " is too small for this resolution and became a " + to_string(annotation.type));
    }

    /// Maps one poly-line by the vertex map. Equal consecutive vertices are merged; a segment that is no longer an edge is
    /// followed along edges that carry the annotation; if there are none, the poly-line is split and a note reports it.
    void follow(const std::vector<Index>& polyline, Annotation& annotation, std::vector<std::vector<Index>>& result) {
        std::vector<Index> current;
        const auto finish = [&] {
            if (current.size() > 1) result.push_back(current);
            current.clear();
        };
        for (const Index vertex : polyline) {
            const Index here = now(vertex);
            if (here == no_index || here >= mesh_.number_of_vertices()) {
                add_note(annotation, "a part of a poly-line is gone");
                finish();
                continue;
            }
            if (current.empty()) {
                current.push_back(here);
            } else if (current.back() != here) {
                const std::vector<Index> link = joined(current.back(), here, annotation.id);
                if (link.empty()) {
                    add_note(annotation, "a poly-line was cut: two of its vertices are not joined any more");
                    finish();
                    current.push_back(here);
                } else {
                    current.insert(current.end(), link.begin() + 1, link.end());
                }
            }
        }
        finish();
    }

    std::vector<Index> joined(Index a, Index b, int id) {
        if (find_halfedge(mesh_, Vertex(a), Vertex(b)).is_valid()) return {a, b};
        if (on_line_.first != id) {
            on_line_ = {id, std::vector<bool>(mesh_.number_of_vertices(), false)};
            for (const Index edge : edges_.at(id)) {
                const Halfedge h = mesh_.halfedge(Edge(edge));
                on_line_.second[mesh_.source(h)] = on_line_.second[mesh_.target(h)] = true;
            }
        }
        PathSearch::Query query;
        query.blocked = [this](Vertex v) { return !on_line_.second[v]; };
        return search_.find(Vertex(a), Vertex(b), query);
    }

    static void add_note(Annotation& annotation, const std::string& text) {
        if (annotation.note.find(text) != std::string::npos) return;
        annotation.note += (annotation.note.empty() ? "" : "; ") + text;
    }

    const Mesh& mesh_;
    const AnnotationTable& table_;
    const std::vector<Index>& vertex_map_;
    PathSearch search_;
    Mesh::Property_map<Edge, std::uint32_t> edge_sets_;
    std::map<int, std::vector<Index>> faces_, edges_, vertices_;
    std::pair<std::optional<int>, std::vector<bool>> on_line_;
};

}  // namespace

AnnotationTable::AnnotationTable() { intern({}); }

std::uint32_t AnnotationTable::intern(const std::vector<int>& ids) {
    const auto [entry, added] = numbers_.emplace(ids, static_cast<std::uint32_t>(sets_.size()));
    if (added) sets_.push_back(ids);
    return entry->second;
}

bool AnnotationTable::contains(std::uint32_t set, int id) const {
    const auto& list = ids(set);
    return std::binary_search(list.begin(), list.end(), id);
}

AnnotationTable attach_annotations(Mesh& mesh, const AnnotationSet& set) {
    check_cancelled();
    if (mesh.has_garbage()) fail_work("mesh", "has removed elements", "collect its garbage before attaching annotations");
    AnnotationTable table;
    std::vector<std::pair<Index, int>> vertices, edges, faces, cuts;
    for (const auto& annotation : set.annotations) {
        for (const Index vertex : annotation.points) vertices.emplace_back(vertex, annotation.id);
        for (const auto& polyline : annotation.polylines)
            for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
                edges.emplace_back(mesh.edge(find_halfedge(mesh, Vertex(polyline[k]), Vertex(polyline[k + 1]))), annotation.id);
        for (const Index face : annotation.faces) faces.emplace_back(face, annotation.id);
        if (annotation.type == AnnotationType::region && is_free(annotation))
            for (const auto& [face, share] : filling_of(mesh, annotation).cut) cuts.emplace_back(face, annotation.id);
        if (annotation.type == AnnotationType::region && !annotation.all)
            table.outlines[annotation.id] = extract_outlines(mesh, annotation.faces);
    }
    store<Vertex>(mesh, vertex_annotations, vertices, table);
    store<Edge>(mesh, edge_annotations, edges, table);
    store<Face>(mesh, face_annotations, faces, table);
    store<Face>(mesh, face_cuts, cuts, table);
    return table;
}

AnnotationSet collect_annotations(const Mesh& mesh, const AnnotationTable& table, const AnnotationSet& before,
                                  const std::vector<Index>& vertex_map) {
    check_cancelled();
    if (mesh.has_garbage()) fail_work("mesh", "has removed elements", "collect its garbage before reading annotations back");
    Collector collector(mesh, table, before, vertex_map);
    AnnotationSet set = before;
    for (Annotation& annotation : set.annotations) {
        annotation.curves.clear();  // they belong to the mesh before; its elements represent the annotation from here on
        collector.follow(annotation);
        move_pins(annotation, vertex_map, mesh.number_of_vertices());
    }
    return set;
}

void detach_annotations(Mesh& mesh) {
    if (auto [map, found] = mesh.property_map<Vertex, std::uint32_t>(vertex_annotations); found) mesh.remove_property_map(map);
    if (auto [map, found] = mesh.property_map<Edge, std::uint32_t>(edge_annotations); found) mesh.remove_property_map(map);
    for (const char* name : {face_annotations, face_cuts})
        if (auto [map, found] = mesh.property_map<Face, std::uint32_t>(name); found) mesh.remove_property_map(map);
}

void move_pins(Annotation& annotation, const std::vector<Index>& vertex_map, std::size_t vertex_count) {
    for (auto& attribute : annotation.attributes) {
        if (Descriptor* descriptor = attribute.descriptor()) descriptor->stale = true;
        if (attribute.measure() == nullptr) continue;
        Measure& measure = *attribute.measure();
        const auto loses_a_pin = [&](std::vector<Index>& pins) {
            bool lost = false;
            for (Index& pin : pins) {
                if (!vertex_map.empty()) pin = pin < vertex_map.size() ? vertex_map[pin] : no_index;
                lost = lost || pin >= vertex_count;
            }
            return lost;
        };
        const bool lost = loses_a_pin(measure.points);
        // A repeated picking that loses a pin is dropped; the others stay.
        std::erase_if(measure.repeats, loses_a_pin);
        measure.locations.clear();
        measure.uncertainty.reset();
        measure.stale = true;
        if (!lost) continue;
        // A measure without its pins cannot be recomputed: only its value is kept, as a descriptor.
        Descriptor last_value;
        if (measure.value) last_value.values.push_back(*measure.value);
        last_value.unit = measure.unit;
        last_value.stale = true;
        attribute.value = std::move(last_value);
    }
}

}  // namespace ostraka

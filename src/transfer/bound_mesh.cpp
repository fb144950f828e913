#include "ostraka/transfer/bound_mesh.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/io/carry_extras.h"
#include "ostraka/measure/measure.h"
#include "ostraka/transfer/project_curves.h"
#include "transfer/corner_texture.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>

namespace ostraka {

namespace {

constexpr const char *face_colour = "f:file-colour", *face_label = "f:file-label", *face_material = "f:file-material",
                     *vertex_colour = "v:file-colour", *vertex_label = "v:file-label";

template <class Key, class Value>
void to_map(Mesh& mesh, const std::string& name, const std::vector<Value>& values) {
    if (values.empty()) return;
    auto map = mesh.add_property_map<Key, Value>(name, Value{}).first;
    for (std::size_t i = 0; i < values.size(); ++i) map[Key(static_cast<Index>(i))] = values[i];
}

template <class Key, class Value>
void from_map(Mesh& mesh, const std::string& name, std::size_t count, std::vector<Value>& values) {
    auto [map, found] = mesh.property_map<Key, Value>(name);
    if (!found) return;
    values.clear();
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) values.push_back(map[Key(static_cast<Index>(i))]);
    mesh.remove_property_map(map);
}

/// Names of the property maps of further values.
std::string name_of_values(const char* element, std::size_t index) { return fmt::format("{}:file-value-{}", element, index); }

/// Carries data through edge collapses: unites the annotation sets of merged edges and vertices,
/// moves texture coordinates and interpolates values.
class BoundData final : public CollapseVisitor {
public:
    BoundData(Mesh& mesh, AnnotationTable& table, bool annotated, const MeshExtras& extras)
        : table_(table), annotated_(annotated) {
        if (annotated) {
            vertices_ = mesh.property_map<Vertex, std::uint32_t>(vertex_annotations).first;
            edges_ = mesh.property_map<Edge, std::uint32_t>(edge_annotations).first;
        }
        if (!extras.corner_texture.empty()) texture_.emplace(mesh);
        for (std::size_t i = 0; i < extras.vertex_values.size(); ++i)
            values_.push_back(mesh.property_map<Vertex, double>(name_of_values("v", i)).first);
    }
    void merge_vertices(Mesh&, Vertex kept, Vertex removed) override {
        if (annotated_) vertices_[kept] = unite(vertices_[kept], vertices_[removed]);
    }
    void merge_edges(Mesh&, Edge kept, Edge removed) override {
        if (annotated_) edges_[kept] = unite(edges_[kept], edges_[removed]);
    }
    void place_vertex(Mesh& mesh, Halfedge h, const Point& position) override {
        if (texture_) texture_->place_vertex(mesh, h, position);
        if (values_.empty()) return;
        const Point &source = mesh.point(mesh.source(h)), &target = mesh.point(mesh.target(h));
        const double length = CGAL::squared_distance(source, target);
        const double share = length > 0 ? std::clamp((position - source) * (target - source) / length, 0.0, 1.0) : 1;
        for (auto& values : values_) {
            double& value = values[mesh.target(h)];
            if (share < 1) value = (1 - share) * values[mesh.source(h)] + share * value;
        }
    }
    void replace_halfedge(Mesh&, Halfedge kept, Halfedge replaced) override {
        if (texture_) texture_->replace_halfedge(kept, replaced);
    }

private:
    std::uint32_t unite(std::uint32_t a, std::uint32_t b) {
        if (a == b || b == 0) return a;
        if (a == 0) return b;
        std::vector<int> ids;
        std::set_union(table_.ids(a).begin(), table_.ids(a).end(), table_.ids(b).begin(), table_.ids(b).end(),
                       std::back_inserter(ids));
        return table_.intern(ids);
    }
    AnnotationTable& table_;
    bool annotated_;
    Mesh::Property_map<Vertex, std::uint32_t> vertices_;
    Mesh::Property_map<Edge, std::uint32_t> edges_;
    std::optional<CornerTexture> texture_;
    std::vector<Mesh::Property_map<Vertex, double>> values_;  ///< interpolated along the collapsed edge
};

/// Texture coordinates of a refined mesh: those of old vertices, and the means of those of the parents of new vertices, in the
/// old face that contains the face.
std::vector<TexturePoint> refined_texture(const Mesh& mesh, const RefineResult& refined,
                                          const std::vector<std::array<Index, 3>>& old_triangles,
                                          const std::vector<TexturePoint>& old_texture) {
    std::vector<TexturePoint> texture;
    if (old_texture.empty()) return texture;
    std::vector<std::vector<Index>> parts(old_triangles.size());
    for (Index face = 0; face < refined.face_origin.size(); ++face) parts[refined.face_origin[face]].push_back(face);
    texture.resize(3 * refined.face_origin.size());
    std::map<Index, TexturePoint> at;  // texture coordinates of vertices in the current old face
    const std::function<TexturePoint(Index)> coordinates = [&](Index vertex) {
        if (const auto entry = at.find(vertex); entry != at.end()) return entry->second;
        const auto [a, b] = refined.parents[vertex - refined.old_vertices];
        const TexturePoint first = coordinates(a), second = coordinates(b);
        return at[vertex] = {(first[0] + second[0]) / 2, (first[1] + second[1]) / 2};
    };
    for (std::size_t old_face = 0; old_face < old_triangles.size(); ++old_face) {
        at.clear();
        for (std::size_t k = 0; k < 3; ++k) at[old_triangles[old_face][k]] = old_texture[3 * old_face + k];
        for (const Index face : parts[old_face]) {
            const auto vertices = corners(mesh, Face(face));
            for (std::size_t k = 0; k < 3; ++k) texture[3 * static_cast<std::size_t>(face) + k] = coordinates(vertices[k]);
        }
    }
    return texture;
}

BoundMesh::Totals totals_of(const Mesh& mesh) { return {mesh.number_of_vertices(), mesh.number_of_faces(), surface_area(mesh)}; }

}  // namespace

BoundMesh::BoundMesh(MeshFile file, std::optional<AnnotationSet> annotated)
    : mesh(std::move(file.mesh)), extras(std::move(file.extras)), annotations(std::move(annotated)) {
    before = after = totals_of(mesh);
    if (!annotations) return;
    for (const Annotation& annotation : annotations->annotations) {
        const Size size = size_of(annotation);
        changes.push_back({annotation.id, annotation.tag, annotation.type, size, size, false, {}});
    }
}

SimplifyResult BoundMesh::simplify(const SimplifyOptions& options) {
    keep_curved();
    AnnotationTable table = attach();
    BoundData data(mesh, table, annotations.has_value(), extras);
    MarkedParts parts = marked(table, options.outlines == SimplifyOptions::Outlines::protect);
    if (!extras.corner_texture.empty() || !extras.face_materials.empty()) parts.seams = texture_seams(mesh, extras);
    SimplifyResult result = ostraka::simplify(mesh, options, parts, &data);
    detach(table, result.vertex_map);
    return result;
}

RefineResult BoundMesh::refine(const RefineOptions& options) {
    keep_curved();
    const AnnotationTable table = attach();
    const std::vector<std::array<Index, 3>> old_triangles =
        extras.corner_texture.empty() ? std::vector<std::array<Index, 3>>() : to_soup(mesh).triangles;
    const std::vector<TexturePoint> old_texture = detach_texture(mesh);
    RefineResult result = ostraka::refine(mesh, options);
    extras.corner_texture = refined_texture(mesh, result, old_triangles, old_texture);
    attach_texture(mesh, extras.corner_texture);
    const auto from_parents = [&]<class Value>(const std::string& name, const std::vector<Value>&, const auto& between) {
        auto [map, found] = mesh.property_map<Vertex, Value>(name);
        if (!found) return;
        for (std::size_t i = 0; i < result.parents.size(); ++i) {
            const auto [a, b] = result.parents[i];
            map[Vertex(static_cast<Index>(result.old_vertices + i))] = between(map[Vertex(a)], map[Vertex(b)]);
        }
    };
    from_parents(vertex_colour, extras.vertex_colours, [](Colour a, const Colour& b) {
        for (std::size_t k = 0; k < 4; ++k) a[k] = static_cast<std::uint8_t>((int(a[k]) + int(b[k]) + 1) / 2);
        return a;
    });
    from_parents(vertex_label, extras.vertex_labels, [](std::int32_t a, std::int32_t) { return a; });
    for (std::size_t i = 0; i < extras.vertex_values.size(); ++i)
        from_parents(name_of_values("v", i), extras.vertex_values[i].values, [](double a, double b) { return a / 2 + b / 2; });
    std::vector<Index> kept(result.old_vertices);
    for (Index v = 0; v < kept.size(); ++v) kept[v] = v;
    detach(table, kept);
    return result;
}

void BoundMesh::keep_curved() {
    if (annotations && any_free(*annotations)) curved_ = std::make_shared<const AnnotatedMesh>(AnnotatedMesh{mesh, *annotations});
}

AnnotationTable BoundMesh::attach() {
    AnnotationTable table;
    if (annotations) {
        // Free annotations are not attached to elements of the mesh.
        AnnotationSet bound = *annotations;
        for (Annotation& annotation : bound.annotations)
            if (is_free(annotation)) {
                annotation.curves.clear();
                annotation.points.clear();
                annotation.polylines.clear();
                annotation.faces.clear();
            }
        table = attach_annotations(mesh, bound);
    }
    to_map<Face>(mesh, face_colour, extras.face_colours);
    to_map<Face>(mesh, face_label, extras.face_labels);
    to_map<Face>(mesh, face_material, extras.face_materials);
    to_map<Vertex>(mesh, vertex_colour, extras.vertex_colours);
    to_map<Vertex>(mesh, vertex_label, extras.vertex_labels);
    for (std::size_t i = 0; i < extras.vertex_values.size(); ++i)
        to_map<Vertex>(mesh, name_of_values("v", i), extras.vertex_values[i].values);
    for (std::size_t i = 0; i < extras.face_values.size(); ++i)
        to_map<Face>(mesh, name_of_values("f", i), extras.face_values[i].values);
    attach_texture(mesh, extras.corner_texture);
    return table;
}

void BoundMesh::detach(const AnnotationTable& table, const std::vector<Index>& vertex_map) {
    after = totals_of(mesh);
    from_map<Face>(mesh, face_colour, mesh.number_of_faces(), extras.face_colours);
    from_map<Face>(mesh, face_label, mesh.number_of_faces(), extras.face_labels);
    from_map<Face>(mesh, face_material, mesh.number_of_faces(), extras.face_materials);
    from_map<Vertex>(mesh, vertex_colour, mesh.number_of_vertices(), extras.vertex_colours);
    from_map<Vertex>(mesh, vertex_label, mesh.number_of_vertices(), extras.vertex_labels);
    for (std::size_t i = 0; i < extras.vertex_values.size(); ++i)
        from_map<Vertex>(mesh, name_of_values("v", i), mesh.number_of_vertices(), extras.vertex_values[i].values);
    for (std::size_t i = 0; i < extras.face_values.size(); ++i)
        from_map<Face>(mesh, name_of_values("f", i), mesh.number_of_faces(), extras.face_values[i].values);
    extras.corner_texture = detach_texture(mesh);
    if (!annotations) return;
    annotations = collect_annotations(mesh, table, AnnotationSet(*annotations), vertex_map);
    detach_annotations(mesh);
    if (curved_) {
        for (auto& note : project_free_annotations(*curved_, mesh, *annotations)) notes.push_back(std::move(note));
        curved_.reset();
    }
    for (auto& note : refresh_measures(mesh, *annotations).notes) notes.push_back(std::move(note));
    for (Change& change : changes) {
        const Annotation* now = annotations->find(change.id);
        change.after = now == nullptr ? Size() : size_of(*now);
        change.degenerate = now != nullptr && now->type != change.type;
        change.note = now == nullptr ? "lost" : now->note;
    }
}

MarkedParts BoundMesh::marked(const AnnotationTable& table, bool protects) const {
    MarkedParts parts;
    if (!annotations) return parts;
    const auto regions = mesh.property_map<Face, std::uint32_t>(face_annotations).first;
    const auto lines = mesh.property_map<Edge, std::uint32_t>(edge_annotations).first;
    const auto points = mesh.property_map<Vertex, std::uint32_t>(vertex_annotations).first;
    // On the border, the outlines of regions are marked; that of the whole object only if outlines are protected.
    std::vector<bool> has_outline(table.size(), false);
    for (std::uint32_t set = 0; set < table.size(); ++set)
        for (const int id : table.ids(set)) has_outline[set] = has_outline[set] || protects || !annotations->find(id)->all;
    parts.edges.assign(mesh.number_of_edges(), false);
    parts.vertices.assign(mesh.number_of_vertices(), false);
    for (const Edge e : mesh.edges()) {
        const Face f = mesh.face(mesh.halfedge(e, 0)), g = mesh.face(mesh.halfedge(e, 1));
        const bool outline = f.is_valid() && g.is_valid() ? regions[f] != regions[g] : has_outline[regions[f.is_valid() ? f : g]];
        parts.edges[e] = outline || lines[e] != 0;
    }
    for (const Vertex v : mesh.vertices()) parts.vertices[v] = points[v] != 0;
    if (!protects) return parts;
    for (const Annotation& annotation : annotations->annotations)
        for (const Attribute& attribute : annotation.attributes)
            for (const Index v : pins_of(attribute)) parts.vertices.at(v) = true;
    return parts;
}

BoundMesh::Size BoundMesh::size_of(const Annotation& annotation) const {
    Size size;
    if (annotation.type == AnnotationType::region) {
        const RegionMeasures region = measure_region(mesh, annotation);
        size = {annotation.faces.size(), region.area, region.perimeter};
    } else if (annotation.type == AnnotationType::line) {
        for (const auto& line : annotation.polylines) size.elements += line.size() - 1;
        size.length = length_of(mesh, annotation);
    } else {
        size.elements = annotation.points.size();
    }
    return size;
}

}  // namespace ostraka

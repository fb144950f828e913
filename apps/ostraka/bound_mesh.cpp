#include "bound_mesh.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <cmath>

namespace ostraka::app {

namespace {

constexpr const char *face_colour = "f:file-colour", *face_label = "f:file-label", *vertex_colour = "v:file-colour",
                     *vertex_label = "v:file-label", *vertex_texture = "v:file-texture";

template <class Key, class Value>
void attach(Mesh& mesh, const char* name, const std::vector<Value>& values) {
    if (values.empty()) return;
    auto map = mesh.add_property_map<Key, Value>(name, Value{}).first;
    for (std::size_t i = 0; i < values.size(); ++i) map[Key(static_cast<Index>(i))] = values[i];
}

template <class Key, class Value>
void detach(Mesh& mesh, const char* name, std::size_t count, std::vector<Value>& values) {
    auto [map, found] = mesh.property_map<Key, Value>(name);
    if (!found) return;
    values.clear();
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) values.push_back(map[Key(static_cast<Index>(i))]);
    mesh.remove_property_map(map);
}

/// Unites the sets of poly-lines on edges, and of points on vertices, that merge.
class AnnotationMerger final : public CollapseVisitor {
public:
    explicit AnnotationMerger(AnnotationTable& table) : table_(table) {}
    void bind(Mesh& mesh) {
        vertices_ = mesh.property_map<Vertex, std::uint32_t>(vertex_annotations).first;
        edges_ = mesh.property_map<Edge, std::uint32_t>(edge_annotations).first;
    }
    void merge_vertices(Mesh&, Vertex kept, Vertex removed) override {
        vertices_[kept] = unite(vertices_[kept], vertices_[removed]);
    }
    void merge_edges(Mesh&, Edge kept, Edge removed) override { edges_[kept] = unite(edges_[kept], edges_[removed]); }

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
    Mesh::Property_map<Vertex, std::uint32_t> vertices_;
    Mesh::Property_map<Edge, std::uint32_t> edges_;
};

void write_index_map(const std::string& file, const char* kind, const std::vector<Index>& map, std::size_t count,
                     const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-map", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "kind", kind, allocator);
    add_member(document, "from", JsonValue(static_cast<std::uint64_t>(map.size())), allocator);
    add_member(document, "to", JsonValue(static_cast<std::uint64_t>(count)), allocator);
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(map.size()), allocator);
    for (const Index i : map) list.PushBack(i == no_index ? std::int64_t{-1} : static_cast<std::int64_t>(i), allocator);
    add_member(document, "map", std::move(list), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    write_json(file, document);
}

std::string change(double before, double after) {
    if (!(before > 0)) return "";
    return number(100 * (after / before - 1), 3) + " %";
}

}  // namespace

BoundMesh::BoundMesh(const BoundMeshFiles& files, Provenance& provenance) : files_(files) {
    check_mesh_extension(files.output);
    if (files.annotations.empty() != files.annotations_out.empty())
        fail_usage("annotations are read from one file and written to another",
                   "give both --annotations and --annotations-out, or neither");
    const std::string kind = extension(files.output);
    if (!files.annotations_out.empty() && (kind == ".stl" || kind == ".glb"))
        fail_usage("a " + kind + " file does not keep the vertices that annotations name",
                   "write the mesh as .ply, .obj or .off");
    std::vector<Path> inputs{files.input}, outputs{files.output};
    if (!files.annotations.empty()) inputs.emplace_back(files.annotations);
    for (const std::string& file : {files.annotations_out, files.labels_out, files.vertex_map, files.face_map})
        if (!file.empty()) outputs.emplace_back(file);
    check_outputs(inputs, outputs);
    for (const Path& input : inputs) provenance.add_input(input);

    MeshFile file = read_mesh(files.input);
    mesh = std::move(file.mesh);
    notes_ = std::move(file.notes);
    if (!file.extras.corner_texture.empty())
        notes_.emplace_back("texture coordinates per corner are not carried and are left out");
    if (!files.labels_out.empty() && file.extras.face_labels.empty())
        fail_usage(files.input + " holds no face labels to write", "leave out --labels-out");
    totals_before_ = totals(mesh);
    if (!files.annotations.empty()) {
        before_ = read_annotations(files.annotations, mesh, files.reading);
        for (const Annotation& annotation : before_->annotations)
            rows_.push_back({annotation.id, annotation.tag, to_string(annotation.type), measure(annotation), {}, {}});
        table_ = attach_annotations(mesh, *before_);
        auto merger = std::make_unique<AnnotationMerger>(table_);
        merger->bind(mesh);
        visitor_ = std::move(merger);
    }
    attach<Face>(mesh, face_colour, file.extras.face_colours);
    attach<Face>(mesh, face_label, file.extras.face_labels);
    attach<Vertex>(mesh, vertex_colour, file.extras.vertex_colours);
    attach<Vertex>(mesh, vertex_label, file.extras.vertex_labels);
    attach<Vertex>(mesh, vertex_texture, file.extras.vertex_texture);
}

MarkedParts BoundMesh::marked(bool pins) const {
    MarkedParts parts;
    if (!before_) return parts;
    const auto regions = mesh.property_map<Face, std::uint32_t>(face_annotations).first;
    const auto lines = mesh.property_map<Edge, std::uint32_t>(edge_annotations).first;
    const auto points = mesh.property_map<Vertex, std::uint32_t>(vertex_annotations).first;
    // On the border, the outlines of regions count, but not that of the whole object.
    std::vector<bool> has_outline(table_.size(), false);
    for (std::uint32_t set = 0; set < table_.size(); ++set)
        for (const int id : table_.ids(set)) has_outline[set] = has_outline[set] || !before_->find(id)->all;
    parts.edges.assign(mesh.number_of_edges(), false);
    parts.vertices.assign(mesh.number_of_vertices(), false);
    for (const Edge e : mesh.edges()) {
        const Face f = mesh.face(mesh.halfedge(e, 0)), g = mesh.face(mesh.halfedge(e, 1));
        const bool outline = f.is_valid() && g.is_valid() ? regions[f] != regions[g] : has_outline[regions[f.is_valid() ? f : g]];
        parts.edges[e] = outline || lines[e] != 0;
    }
    for (const Vertex v : mesh.vertices()) parts.vertices[v] = points[v] != 0;
    if (!pins) return parts;
    for (const Annotation& annotation : before_->annotations)
        for (const Attribute& attribute : annotation.attributes)
            for (const Index v : pins_of(attribute.measure)) parts.vertices.at(v) = true;
    return parts;
}

void BoundMesh::follow(const SimplifyResult& result) {
    vertex_map_ = result.vertex_map;
    face_map_ = result.face_map;
    collect(vertex_map_);
}

void BoundMesh::follow(const RefineResult& result) {
    std::vector<Index> kept(result.old_vertices);
    for (Index v = 0; v < kept.size(); ++v) kept[v] = v;
    // New vertices lie between two others: means of colours and texture coordinates, the label of one of them.
    const auto parents_of = [&](const auto& action) {
        for (std::size_t i = 0; i < result.parents.size(); ++i)
            action(Vertex(static_cast<Index>(result.old_vertices + i)), Vertex(result.parents[i][0]),
                   Vertex(result.parents[i][1]));
    };
    if (auto [colour, found] = mesh.property_map<Vertex, Colour>(vertex_colour); found)
        parents_of([&map = colour](Vertex v, Vertex a, Vertex b) {
            for (std::size_t k = 0; k < 4; ++k) map[v][k] = static_cast<std::uint8_t>((int(map[a][k]) + int(map[b][k]) + 1) / 2);
        });
    if (auto [label, found] = mesh.property_map<Vertex, std::int32_t>(vertex_label); found)
        parents_of([&map = label](Vertex v, Vertex a, Vertex) { map[v] = std::int32_t{map[a]}; });
    if (auto [texture, found] = mesh.property_map<Vertex, std::array<float, 2>>(vertex_texture); found)
        parents_of([&map = texture](Vertex v, Vertex a, Vertex b) {
            for (std::size_t k = 0; k < 2; ++k) map[v][k] = (map[a][k] + map[b][k]) / 2;
        });
    collect(kept);
}

void BoundMesh::collect(const std::vector<Index>& vertex_map) {
    totals_after_ = totals(mesh);
    if (!before_) return;
    after_ = collect_annotations(mesh, table_, *before_, vertex_map);
    detach_annotations(mesh);
    for (auto& note : refresh_measures(mesh, *after_).notes) notes_.push_back(std::move(note));
    for (Row& row : rows_) {
        const Annotation* annotation = after_->find(row.id);
        if (annotation == nullptr) {
            row.note = "lost";
            continue;
        }
        row.after = measure(*annotation);
        row.after.degenerate = to_string(annotation->type) != row.type;
        row.note = annotation->note;
    }
}

std::vector<std::string> BoundMesh::write(const Provenance& provenance) {
    MeshExtras extras;
    detach<Face>(mesh, face_colour, mesh.number_of_faces(), extras.face_colours);
    detach<Face>(mesh, face_label, mesh.number_of_faces(), extras.face_labels);
    detach<Vertex>(mesh, vertex_colour, mesh.number_of_vertices(), extras.vertex_colours);
    detach<Vertex>(mesh, vertex_label, mesh.number_of_vertices(), extras.vertex_labels);
    detach<Vertex>(mesh, vertex_texture, mesh.number_of_vertices(), extras.vertex_texture);
    WriteOptions options;
    options.encoding = files_.ascii ? Encoding::ascii : Encoding::binary;
    options.comment = provenance.to_line();
    for (auto& note : write_mesh(files_.output, mesh, extras, options)) notes_.push_back(std::move(note));
    if (!files_.labels_out.empty()) write_labels(files_.labels_out, extras.face_labels);
    if (!files_.vertex_map.empty())
        write_index_map(files_.vertex_map, "vertex", vertex_map_, mesh.number_of_vertices(), provenance);
    if (!files_.face_map.empty()) write_index_map(files_.face_map, "face", face_map_, mesh.number_of_faces(), provenance);
    if (after_) {
        write_annotations(files_.annotations_out, *after_, mesh, Path(files_.output).filename().string(), provenance);
        for (const auto& note : after_->notes) notes_.push_back(note);
    }
    return notes_;
}

BoundMesh::Totals BoundMesh::totals(const Mesh& mesh) {
    return {mesh.number_of_vertices(), mesh.number_of_faces(), surface_area(mesh)};
}

BoundMesh::Measures BoundMesh::measure(const Annotation& annotation) const {
    Measures measures;
    if (annotation.type == AnnotationType::region) {
        const RegionMeasures region = measure_region(mesh, annotation.faces);
        measures = {annotation.faces.size(), region.area, region.perimeter, false};
    } else if (annotation.type == AnnotationType::line) {
        for (const auto& line : annotation.polylines)
            for (std::size_t i = 1; i < line.size(); ++i) {
                ++measures.elements;
                measures.length +=
                    std::sqrt(CGAL::squared_distance(mesh.point(Vertex(line[i - 1])), mesh.point(Vertex(line[i]))));
            }
    } else {
        measures.elements = annotation.points.size();
    }
    return measures;
}

void BoundMesh::add_to_report(JsonValue& result, JsonAllocator& allocator) const {
    const auto count = [](std::size_t n) { return JsonValue(static_cast<std::uint64_t>(n)); };
    for (const auto& [name, totals] : {std::pair{"input", totals_before_}, std::pair{"output", totals_after_}}) {
        JsonValue member(rapidjson::kObjectType);
        add_member(member, "vertices", count(totals.vertices), allocator);
        add_member(member, "faces", count(totals.faces), allocator);
        add_member(member, "area", JsonValue(totals.area), allocator);
        add_member(result, name, std::move(member), allocator);
    }
    if (!before_) return;
    JsonValue list(rapidjson::kArrayType);
    for (const Row& row : rows_) {
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "id", JsonValue(row.id), allocator);
        add_member(entry, "tag", row.tag, allocator);
        add_member(entry, "type", row.type, allocator);
        for (const auto& [name, measures] : {std::pair{"before", row.before}, std::pair{"after", row.after}}) {
            JsonValue member(rapidjson::kObjectType);
            add_member(member, "elements", count(measures.elements), allocator);
            add_member(member, "area", JsonValue(measures.area), allocator);
            add_member(member, "length", JsonValue(measures.length), allocator);
            add_member(entry, name, std::move(member), allocator);
        }
        add_member(entry, "degenerate", JsonValue(row.after.degenerate), allocator);
        add_member(entry, "note", row.note, allocator);
        list.PushBack(entry, allocator);
    }
    add_member(result, "annotations", std::move(list), allocator);
}

std::string BoundMesh::tables() const {
    std::string text = table(
        {"", "vertices", "faces", "area"},
        {{"before", std::to_string(totals_before_.vertices), std::to_string(totals_before_.faces), number(totals_before_.area)},
         {"after", std::to_string(totals_after_.vertices), std::to_string(totals_after_.faces), number(totals_after_.area)}});
    if (rows_.empty()) return text;
    std::vector<std::vector<std::string>> rows;
    for (const Row& row : rows_)
        rows.push_back({std::to_string(row.id), row.tag, row.type, std::to_string(row.before.elements),
                        std::to_string(row.after.elements), number(row.before.area), change(row.before.area, row.after.area),
                        number(row.before.length), change(row.before.length, row.after.length), row.note});
    return text + "\n" + table({"id", "tag", "type", "elements", "after", "area", "change", "length", "change", "note"}, rows);
}

void add_bound_mesh_flags(CLI::App* command, BoundMeshFiles& files) {
    command->add_option("input", files.input, "mesh to read: .ply, .obj, .off, .stl")->required();
    command->add_option("output", files.output, "mesh to write: .ply, .obj, .off, .stl, .glb")->required();
    command->add_option("--annotations", files.annotations, "annotations of the input mesh (.ant.json)");
    command->add_option("--annotations-out", files.annotations_out, "where to write the annotations of the output mesh");
    command->add_option("--labels-out", files.labels_out,
                        "where to write the face labels that the input mesh carries, one a line");
    command->add_flag("--ascii", files.ascii, "write PLY and STL as text");
    add_flags(command, files.reading);
}

}  // namespace ostraka::app

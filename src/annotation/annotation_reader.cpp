// Conversion of JSON to annotations.
#include "annotation/annotation_places.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

using places::fail;
using std::to_string;

using VertexPaths = std::vector<std::vector<Index>>;

std::vector<Index> indices_of(const JsonValue::ConstArray& list) {
    std::vector<Index> indices;
    indices.reserve(list.Size());
    for (const auto& value : list) indices.push_back(value.GetUint());
    return indices;
}

VertexPaths vertex_paths_of(const JsonValue& object, const char* name) {
    VertexPaths vertex_paths;
    for (const auto& vertex_path : list_in(object, name)) vertex_paths.push_back(indices_of(vertex_path.GetArray()));
    return vertex_paths;
}

/// Adds a note for members that the format does not define: they are lost when the set is written.
void note_unknown(const JsonValue& object, const std::set<std::string>& known, const std::string& pointer,
                  std::vector<std::string>& notes) {
    for (const auto& member : object.GetObject()) {
        const std::string name = text_of(member.name);
        if (!known.contains(name)) notes.push_back("at " + pointer + '/' + name + ": an unknown member, not kept");
    }
}

Measure measure_of(const JsonValue& object) {
    Measure measure;
    measure.tool = text_in(object, "tool");
    measure.points = indices_of(list_in(object, "points"));
    for (const auto& location : list_in(object, "locations"))
        measure.locations.push_back(face_point(location["face"].GetUint(), triple_of(location["barycentric"])));
    if (const JsonValue* direction = find_member(object, "direction")) measure.direction = triple_of(*direction);
    measure.exact = text_in(object, "geodesic") == "exact";
    measure.repeats = vertex_paths_of(object, "repeats");
    measure.value = number_in(object, "value");
    measure.uncertainty = number_in(object, "uncertainty");
    measure.unit = text_in(object, "unit");
    measure.stale = flag_in(object, "stale");
    return measure;
}

Attribute attribute_of(const JsonValue& object, const std::string& where, const std::string& at,
                       std::vector<std::string>& notes) {
    Attribute attribute;
    attribute.id = object["id"].GetInt();
    attribute.name = text_in(object, "name");
    const std::string type = text_in(object, "type");
    if (type == "semantic") {
        note_unknown(object, {"id", "name", "type", "note", "origin"}, at, notes);
        if (find_member(object, "note") == nullptr)
            fail(where, at, "a semantic attribute without a note", "add the member \"note\"");
        attribute.value = Note{text_in(object, "note"), text_in(object, "origin")};
    } else if (type == "measure") {
        note_unknown(object, {"id", "name", "type", "measure"}, at, notes);
        const JsonValue* measure = find_member(object, "measure");
        if (measure == nullptr) fail(where, at, "an attribute of type measure without a measure", "add the member \"measure\"");
        note_unknown(*measure,
                     {"tool", "points", "locations", "direction", "geodesic", "repeats", "value", "uncertainty", "unit", "stale"},
                     at + "/measure", notes);
        attribute.value = measure_of(*measure);
    } else {
        note_unknown(object, {"id", "name", "type", "value", "file", "sha256", "unit", "stale"}, at, notes);
        auto& descriptor = attribute.value.emplace<Descriptor>();
        if (const JsonValue* value = find_member(object, "value")) {
            descriptor.is_list = value->IsArray();
            for (const auto& element : list_in(object, "value")) descriptor.values.push_back(element.GetDouble());
            if (!descriptor.is_list) descriptor.values.push_back(value->GetDouble());
        }
        descriptor.file = text_in(object, "file");
        descriptor.unit = text_in(object, "unit");
        descriptor.stale = flag_in(object, "stale");
        descriptor.sha256 = text_in(object, "sha256");
        if (find_member(object, "value") != nullptr && !descriptor.file.empty())
            fail(where, at, "a descriptor with a value and a file", "keep one of them");
        if (descriptor.file.empty() && !descriptor.sha256.empty())
            fail(where, at, "a checksum without a file", "remove sha256, or name the file");
    }
    return attribute;
}

std::vector<Attribute> attributes_of(const JsonValue::ConstArray& list, const std::string& where, const std::string& at,
                                     std::vector<std::string>& notes) {
    std::vector<Attribute> attributes;
    for (const auto& attribute : list)
        attributes.push_back(attribute_of(attribute, where, at + '/' + to_string(attributes.size()), notes));
    return attributes;
}

/// Reads the outlines and checks each vertex and edge. The prototype repeats the first vertex at the end.
std::vector<Outline> outlines_of(const JsonValue& object, const Mesh& mesh, const std::string& where, const std::string& at) {
    std::vector<Outline> outlines = vertex_paths_of(object, "boundaries");
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        Outline& outline = outlines[i];
        const std::string here = at + "/boundaries/" + to_string(i);
        places::check_vertices(mesh, outline, where, here);
        if (outline.size() > 3 && outline.front() == outline.back()) outline.pop_back();
        if (outline.size() < 3)
            fail(where, here, "an outline of " + to_string(outline.size()) + (outline.size() == 1 ? " vertex" : " vertices"),
                 "an outline needs three or more");
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const std::size_t next = (k + 1) % outline.size();
            places::check_edge(mesh, outline[k], outline[next], where, here + '/' + to_string(next));
        }
    }
    return outlines;
}

/// The directed edges of outlines, sorted: two sets of outlines with equal edges bound the same faces from the same side.
std::vector<std::pair<Index, Index>> directed_edges(const std::vector<Outline>& outlines) {
    std::vector<std::pair<Index, Index>> edges;
    for (const Outline& outline : outlines)
        for (std::size_t k = 0; k < outline.size(); ++k) edges.emplace_back(outline[k], outline[(k + 1) % outline.size()]);
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Adds the closed component of each seed. No outline may pass through such a component.
void fill_seeds(const std::vector<Index>& seeds, const std::vector<Outline>& outlines, const Mesh& mesh,
                std::vector<bool>& selected, const std::string& where, const std::string& at) {
    if (seeds.empty()) return;
    std::vector<bool> outlined(mesh.number_of_edges(), false);
    for (const auto& [a, b] : directed_edges(outlines)) outlined[mesh.edge(find_halfedge(mesh, Vertex(a), Vertex(b)))] = true;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        const std::string here = at + "/seeds/" + to_string(i);
        places::check_face(mesh, seeds[i], where, here);
        if (selected[seeds[i]])
            fail(where, here, "the seed lies in a part that is selected already", "give one seed for each whole component");
        flood_faces(mesh, Face(seeds[i]), selected, [&](Halfedge h) {
            if (outlined[mesh.edge(h)])
                fail(where, here, "the seed's component is cut by an outline",
                     "outlines say what they enclose; a seed stands for a whole closed component");
            return true;
        });
    }
}

std::vector<Index> faces_of(const JsonValue& object, const Mesh& mesh, bool all, const std::string& where,
                            const std::string& at) {
    const std::vector<Outline> outlines = outlines_of(object, mesh, where, at);
    const std::vector<Index> seeds = indices_of(list_in(object, "seeds"));
    if (!all && find_member(object, "faces") == nullptr) {
        if (find_member(object, "boundaries") == nullptr && seeds.empty())
            fail(where, at, "a region without boundaries", "add \"boundaries\", \"faces\", \"seeds\" or \"all\": true");
        Filling filling = fill_outlines(mesh, outlines);
        if (filling.conflicts > 0)
            fail(where, at + "/boundaries",
                 to_string(filling.conflicts) + " faces lie to the left of one outline and to the right of another",
                 "the interior lies to the left of each edge: turn the outlines that run the wrong way, and let them not cross");
        fill_seeds(seeds, outlines, mesh, filling.selected, where, at);
        return flagged(filling.selected);
    }
    std::vector<Index> faces;
    if (all) {
        faces.resize(mesh.number_of_faces());
        std::iota(faces.begin(), faces.end(), Index{0});
    } else {
        faces = indices_of(list_in(object, "faces"));
        for (std::size_t i = 0; i < faces.size(); ++i) places::check_face(mesh, faces[i], where, at + "/faces/" + to_string(i));
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
    if (!outlines.empty() && directed_edges(outlines) != directed_edges(extract_outlines(mesh, faces)))
        fail(where, at + "/boundaries",
             std::string("the boundaries are not those of ") + (all ? "the whole mesh" : "the faces listed"),
             "keep one of the two");
    return faces;
}

/// A place in a file: a vertex, [vertex, vertex, fraction along the edge], or a face with barycentric coordinates.
SurfacePoint surface_point_of(const JsonValue& value, const Mesh& mesh, const std::string& where, const std::string& at) {
    if (value.IsUint()) {
        places::check_vertex(mesh, value.GetUint(), where, at);
        return vertex_point(value.GetUint());
    }
    if (value.IsArray()) {
        if (value.Size() != 3 || !value[0].IsUint() || !value[1].IsUint())
            fail(where, at, "is no place on an edge", "give [vertex, vertex, share of the way between them]");
        const Index a = value[0].GetUint(), b = value[1].GetUint();
        places::check_vertex(mesh, a, where, at + "/0");
        places::check_vertex(mesh, b, where, at + "/1");
        places::check_edge(mesh, a, b, where, at);
        const double share = value[2].GetDouble();
        if (!(share > 0 && share < 1))
            fail(where, at + "/2", "the share of the way is not between 0 and 1", "at an end of the edge, give the vertex");
        return ordered_edge_point(a, b, share);
    }
    const Index face = value["face"].GetUint();
    places::check_face(mesh, face, where, at + "/face");
    const std::array<double, 3> weights = triple_of(value["barycentric"]);
    if (!(std::abs(weights[0] + weights[1] + weights[2] - 1) <= 1e-6))
        fail(where, at + "/barycentric", "the weights do not sum to one", "give three weights whose sum is 1");
    constexpr double rim = 1e-12;
    return stored_point(mesh, surface_point(mesh, face, weights, rim));
}

/// Whether there are curves; if so, the elements of the annotation are computed from them.
bool read_curves(const JsonValue& object, const Mesh& mesh, const std::string& where, const std::string& at,
                 Annotation& annotation) {
    for (const auto& list : list_in(object, "curves")) {
        const std::string here = at + "/curves/" + to_string(annotation.curves.size());
        auto& curve = annotation.curves.emplace_back();
        for (const auto& value : list.GetArray())
            curve.push_back(surface_point_of(value, mesh, where, here + '/' + to_string(curve.size())));
    }
    if (!is_free(annotation)) return false;
    if (annotation.all) fail(where, at + "/curves", "the whole mesh has no outlines", "drop \"curves\" or \"all\"");
    const std::vector<Index> seeds = indices_of(list_in(object, "seeds"));
    for (std::size_t i = 0; i < seeds.size(); ++i) places::check_face(mesh, seeds[i], where, at + "/seeds/" + to_string(i));
    annotation.faces = seeds;  // whole components, given by one face each
    try {
        compute_elements(mesh, annotation);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        fail(where, at + "/curves", error.where() + ": " + error.problem(), error.remedy());
    }
    return true;
}

std::vector<Information> information_of(const JsonValue::ConstArray& list, const std::string& where, const std::string& at,
                                        std::vector<std::string>& notes) {
    std::vector<Information> result;
    for (const JsonValue& object : list) {
        const std::string here = at + '/' + to_string(result.size());
        note_unknown(object, {"kind", "value", "title", "sha256"}, here, notes);
        Information& one = result.emplace_back();
        const std::string kind = text_in(object, "kind");
        for (const auto known :
             {Information::Kind::text, Information::Kind::image, Information::Kind::link, Information::Kind::file})
            if (ostraka::to_string(known) == kind) one.kind = known;
        one.value = text_in(object, "value");
        one.title = text_in(object, "title");
        one.sha256 = text_in(object, "sha256");
        if (!one.sha256.empty() && !one.is_local()) fail(where, here, "a checksum belongs to local files only", "remove sha256");
    }
    return result;
}

Annotation annotation_of(const JsonValue& object, const Mesh& mesh, const std::string& where, const std::string& at,
                         std::vector<std::string>& notes) {
    note_unknown(object,
                 {"id", "tag", "colour", "type", "points", "polylines", "boundaries", "faces", "seeds", "all", "curves", "note",
                  "information", "attributes"},
                 at, notes);
    Annotation annotation;
    annotation.id = object["id"].GetInt();
    annotation.tag = text_in(object, "tag");
    if (const JsonValue* colour = find_member(object, "colour"))
        annotation.colour = {(*colour)[0].GetInt(), (*colour)[1].GetInt(), (*colour)[2].GetInt()};
    const std::string type = text_in(object, "type");
    const auto rest = [&] {
        annotation.note = text_in(object, "note");
        annotation.attributes = attributes_of(list_in(object, "attributes"), where, at + "/attributes", notes);
        annotation.information = information_of(list_in(object, "information"), where, at + "/information", notes);
        return annotation;
    };
    const auto require = [&](const char* member) {
        if (find_member(object, member) == nullptr)
            fail(where, at, "an annotation of type " + type + " without " + member,
                 std::string("add the member \"") + member + '"');
    };
    const auto refuse = [&](std::initializer_list<const char*> members) {
        for (const char* member : members)
            if (find_member(object, member) != nullptr)
                fail(where, at + '/' + member, "does not belong to an annotation of type " + type,
                     "remove it or correct the type");
    };
    if (type == "point") {
        annotation.type = AnnotationType::point;
        refuse({"polylines", "boundaries", "faces", "seeds", "all"});
        if (read_curves(object, mesh, where, at, annotation)) return rest();
        require("points");
        annotation.points = indices_of(list_in(object, "points"));
    } else if (type == "line") {
        annotation.type = AnnotationType::line;
        refuse({"points", "boundaries", "faces", "seeds", "all"});
        if (read_curves(object, mesh, where, at, annotation)) return rest();
        require("polylines");
        annotation.polylines = vertex_paths_of(object, "polylines");
    } else {
        refuse({"points", "polylines"});
        annotation.all = flag_in(object, "all");
        if (read_curves(object, mesh, where, at, annotation)) return rest();
        annotation.faces = faces_of(object, mesh, annotation.all, where, at);
    }
    return rest();
}

/// Checks that the file was made for this mesh.
void check_mesh(const JsonValue& document, const Mesh& mesh, const std::string& where, bool force,
                std::vector<std::string>& notes) {
    const JsonValue* made_for = find_member(document, "mesh");
    if (made_for == nullptr) {
        notes.emplace_back("the file does not say which mesh it was made for: only indices and edges could be checked");
        return;
    }
    note_unknown(*made_for, {"file", "vertices", "faces", "sha256"}, "/mesh", notes);
    std::string differences;
    const auto differ = [&](const std::string& text) { differences += (differences.empty() ? "" : ", ") + text; };
    const auto count = [&](const char* name, std::size_t here) {
        const JsonValue* value = find_member(*made_for, name);
        if (value != nullptr && (!value->IsUint64() || value->GetUint64() != here)) {
            const std::string there = value->IsUint64() ? to_string(value->GetUint64()) : "a number of";
            differ(there + " " + name + " instead of " + to_string(here));
        }
    };
    count("vertices", mesh.number_of_vertices());
    count("faces", mesh.number_of_faces());
    const std::string checksum = text_in(*made_for, "sha256");
    if (differences.empty() && !checksum.empty() && checksum != mesh_checksum(mesh))
        differ("other coordinates or triangles (the checksum differs, the counts agree)");
    if (differences.empty()) return;
    const std::string name = text_in(*made_for, "file");
    const std::string what = "made for another mesh" + (name.empty() ? std::string() : " ('" + name + "')") + ": " + differences;
    if (!force)
        fail(where, "/mesh", what,
             "give that mesh, carry the annotations over with 'ostraka annotation transfer', or override with --force-mesh where "
             "the command has it");
    notes.push_back(what + "; used all the same, as asked");
}

}  // namespace

std::vector<Attribute> attributes_from_json(const JsonValue& list, const std::string& where, const std::string& pointer) {
    std::vector<std::string> notes;
    return attributes_of(list.GetArray(), where, pointer, notes);
}

AnnotationSet annotations_from_json(const JsonValue& document, const Mesh& mesh, const std::string& where,
                                    const ReadAnnotationsOptions& options) {
    check_format(document, "ostraka-annotations", where, "give an annotation file ('ostraka-annotations')");
    AnnotationSet set;
    if (is_prototype(document)) {
        std::vector<std::string> notes;
        const Json converted = convert_prototype(document, where, notes);
        set = annotations_from_json(converted, mesh, where, options);
        notes.insert(notes.end(), set.notes.begin(), set.notes.end());
        set.notes = std::move(notes);
        return set;
    }
    validate(document, "annotations", where);
    if (const JsonValue* version = find_member(document, "version");
        version != nullptr && (!version->IsInt() || version->GetInt() > 2))
        fail(where, "/version", "the file is of a newer version than 2", "use a newer ostraka");
    note_unknown(document, {"format", "version", "mesh", "unit", "class", "up", "annotations", "provenance"}, "", set.notes);
    check_mesh(document, mesh, where, options.force_mesh, set.notes);
    set.object_class = text_in(document, "class");
    set.unit = text_in(document, "unit");
    if (const JsonValue* up = find_member(document, "up")) set.up = triple_of(*up);
    if (const JsonValue* provenance = find_member(document, "provenance"))
        set.provenance.CopyFrom(*provenance, set.provenance.GetAllocator());
    const std::size_t most_held = 100 * mesh.number_of_faces() + 50'000'000;
    std::size_t held = 0;
    for (const auto& annotation : list_in(document, "annotations")) {
        const std::string at = "/annotations/" + to_string(set.annotations.size());
        set.annotations.push_back(annotation_of(annotation, mesh, where, at, set.notes));
        // Limits the memory: an outline of three vertices may enclose the whole mesh.
        held += set.annotations.back().faces.size();
        if (held > most_held)
            fail(where, at, "the regions together hold more than " + to_string(most_held) + " faces",
                 "give fewer at once, or a coarser mesh");
    }
    places::check_set({mesh, set}, where, true);
    return set;
}

void ReadAnnotationsOptions::declare_options(OptionList& list) {
    list("force-mesh", force_mesh, "accept annotations made for another mesh if all their vertices, faces and edges exist here",
         Anything{});
}

AnnotationSet read_annotations(const Path& file, const Mesh& mesh, const ReadAnnotationsOptions& options) {
    return annotations_from_json(read_json(file), mesh, file.string(), options);
}

std::vector<Information> information_from_json(const JsonValue::ConstArray& list, const std::string& where,
                                               const std::string& pointer) {
    std::vector<std::string> notes;
    return information_of(list, where, pointer, notes);
}

}  // namespace ostraka

// The prototype's .fct files: facets of a fragment by their borders and inner vertices.
#include "interchange/prototype_files.h"

#include "interchange/landmark_formats.h"
#include "interchange/text.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/mesh/flood.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

using namespace interchange;

bool is_facet_type(const std::string& text) { return text == "external" || text == "internal" || text == "fracture"; }

std::string facet_type(const Annotation& annotation) {
    for (const Attribute& attribute : annotation.attributes)
        if (const Note* note = attribute.note();
            note != nullptr && (attribute.name == "facet" || attribute.name == "type") && is_facet_type(note->text))
            return note->text;
    return "external";
}

class FctReader {
public:
    FctReader(const std::string& bytes, const Mesh& mesh, const std::string& where) : bytes_(bytes), mesh_(mesh), where_(where) {}

    AnnotationSet read() {
        (void)field("Filename:");
        const auto count = parse_int(field("Number of Facets:"));
        if (!count || *count < 0) fail("the number of facets is not a number", "correct the header");
        AnnotationSet set;
        for (int i = 0; i < *count; ++i) set.annotations.push_back(facet(i));
        if (next()) set.notes.push_back(fmt::format("line {}: text after the last facet is ignored", number_));
        return set;
    }

private:
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
        fail_input(fmt::format("{}, line {}", where_, std::max<std::size_t>(number_, 1)), problem, remedy);
    }

    /// Reads the next line into `line_`; false at the end.
    bool next_line() {
        if (position_ >= bytes_.size()) return false;
        line_ = trimmed(line_at(bytes_, position_));
        ++number_;
        return true;
    }
    /// Reads the next non-blank line.
    bool next() {
        while (next_line())
            if (!line_.empty()) return true;
        return false;
    }
    std::string_view field(std::string_view name) {
        if (!next() || !line_.starts_with(name))
            fail(fmt::format("'{}' is expected", name), "give a complete .fct file of the prototype");
        return trimmed(line_.substr(name.size()));
    }

    std::vector<Index> indices() const {
        std::vector<Index> result;
        for (const std::string_view word : split_words(line_, " \t,;[]")) {
            const auto value = parse_int(word);
            if (!value) fail(fmt::format("'{}' is not a vertex index", one_line(word.substr(0, 40))), "give vertex indices");
            if (*value < 0 || static_cast<std::size_t>(*value) >= mesh_.number_of_vertices())
                fail(fmt::format("vertex {} does not exist: the mesh has {} vertices", *value, mesh_.number_of_vertices()),
                     "give the mesh that the facets were made for");
            result.push_back(static_cast<Index>(*value));
        }
        return result;
    }

    Annotation facet(int id) {
        Annotation annotation;
        annotation.id = id;
        annotation.colour = distinct_colour(static_cast<std::size_t>(id));
        annotation.tag = as_utf8(field("Facet ID:"));
        const std::string type(field("Type:"));
        if (!is_facet_type(type)) fail("unknown type", "use external, internal or fracture");
        annotation.attributes.push_back({0, "facet", Note{type, {}}});
        (void)field("Border:");
        std::vector<Outline> borders;
        bool has_vertices = false;
        while (next()) {
            if (line_.starts_with("Vertices:")) {
                has_vertices = true;
                break;
            }
            Outline border = indices();
            while (border.size() > 1 && border.front() == border.back()) border.pop_back();
            for (std::size_t k = 0; k < border.size(); ++k) {
                const Index a = border[k], b = border[(k + 1) % border.size()];
                if (border.size() < 3 || !find_halfedge(mesh_, Vertex(a), Vertex(b)).is_valid())
                    fail(fmt::format("the border is not a closed path along edges of the mesh: {} to {}", a, b),
                         "give the mesh that the facets were made for");
            }
            if (!border.empty()) borders.push_back(std::move(border));
        }
        if (!has_vertices) fail("'Vertices:' is expected", "the file may be cut off");
        std::vector<Index> inner;
        if (next_line()) inner = indices();
        annotation.faces = flagged(side(borders, inner));
        if (annotation.faces.empty())
            fail(fmt::format("the facet '{}' contains no face", one_line(annotation.tag).substr(0, 40)), "correct its border");
        return annotation;
    }

    /// The side of the borders that contains the inner vertices, plus the components without a border that contain inner
    /// vertices.
    [[nodiscard]] std::vector<bool> side(std::vector<Outline> borders, const std::vector<Index>& inner) const {
        const auto count_inside = [&](const std::vector<bool>& selected) {
            std::size_t count = 0;
            for (const Index vertex : inner) {
                const Halfedge h = mesh_.halfedge(Vertex(vertex));
                bool within = h.is_valid();
                if (within)
                    for (const Face face : mesh_.faces_around_target(h))
                        within = within && (face == Mesh::null_face() || selected[face]);
                count += within ? 1 : 0;
            }
            return count;
        };
        std::vector<bool> selected = fill_outlines(mesh_, borders).selected;
        for (Outline& border : borders) std::reverse(border.begin(), border.end());
        std::vector<bool> opposite_side = fill_outlines(mesh_, borders).selected;
        if (count_inside(opposite_side) > count_inside(selected)) selected = std::move(opposite_side);

        std::vector<bool> visited(selected.size(), false);
        for (const Index vertex : inner) {
            const Halfedge h = mesh_.halfedge(Vertex(vertex));
            if (!h.is_valid()) continue;
            const Face start = mesh_.is_border(h) ? mesh_.face(mesh_.opposite(h)) : mesh_.face(h);
            if (selected[start] || visited[start]) continue;
            const std::vector<Face> component = flood_faces(mesh_, start, visited);
            if (std::any_of(component.begin(), component.end(), [&](Face face) { return selected[face]; })) continue;
            for (const Face face : component) selected[face] = true;
        }
        return selected;
    }

    const std::string& bytes_;
    const Mesh& mesh_;
    const std::string& where_;
    std::size_t position_ = 0, number_ = 0;
    std::string_view line_;
};

}  // namespace

bool has_facet(const Annotation& annotation) {
    return annotation.type == AnnotationType::region && !annotation.all && !annotation.faces.empty();
}

std::string prototype_facets(AnnotatedMeshView object, const std::string& mesh_file, std::vector<std::string>& notes) {
    std::string body;
    std::size_t count = 0, unsupported = 0, attributes = 0, changed = 0;
    for (const Annotation& annotation : object.annotations.annotations) {
        if (!has_facet(annotation)) {
            ++unsupported;
            continue;
        }
        ++count;
        attributes += annotation.attributes.size();
        changed += has_control(annotation.tag) ? 1 : 0;
        body += fmt::format("Facet ID: {}\nType: {}\nBorder:\n", one_line(annotation.tag), facet_type(annotation));
        std::vector<bool> on_border(object.mesh.number_of_vertices(), false);
        for (Outline outline : extract_outlines(object.mesh, annotation.faces)) {
            for (const Index vertex : outline) on_border[vertex] = true;
            outline.push_back(outline.front());
            body += joined_numbers(outline) + "\n";
        }
        std::vector<Index> inner = touched_vertices(object.mesh, annotation);
        std::erase_if(inner, [&](Index vertex) { return on_border[vertex]; });
        body += fmt::format("Vertices:\n{}\n\n", joined_numbers(inner));
    }
    if (unsupported > 0)
        notes.push_back(counted(unsupported, "annotation") + " left out: the format stores regions with a border only");
    if (attributes > 0) notes.push_back(counted(attributes, "attribute") + " left out, except for the facet's type");
    if (changed > 0)
        notes.push_back(counted(changed, "tag") + " contained line breaks or control characters, which were replaced by blanks");
    return fmt::format("Filename: {}\nNumber of Facets: {}\n\n{}", one_line(Path(mesh_file).filename().string()), count, body);
}

AnnotationSet read_prototype_facets(const std::string& bytes, const Mesh& mesh, const std::string& where) {
    return FctReader(bytes, mesh, where).read();
}

}  // namespace ostraka

#include "operations/annotation/mesh_labels.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/core/text.h"
#include "ostraka/files/npy.h"
#include "ostraka/io/obj_parts.h"
#include "ostraka/render/values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// The numbers as labels, NaN as no label; nullopt if one is not a whole number of 32 bits.
std::optional<std::vector<std::int32_t>> whole_numbers(const std::vector<double>& values) {
    std::vector<std::int32_t> labels;
    labels.reserve(values.size());
    for (const double value : values) {
        if (std::isnan(value)) {
            labels.push_back(no_label);
            continue;
        }
        if (value != std::floor(value) || std::abs(value) > 2147483647.0) return std::nullopt;
        labels.push_back(static_cast<std::int32_t>(value));
    }
    return labels;
}

struct Column {
    const NamedValues* values;
    bool on_faces;
};

std::vector<Column> columns_of(const MeshFile& file) {
    std::vector<Column> columns;
    for (const NamedValues& column : file.extras.face_values) columns.push_back({&column, true});
    for (const NamedValues& column : file.extras.vertex_values) columns.push_back({&column, false});
    return columns;
}

std::vector<std::int32_t> on_faces(const MeshFile& file, const std::vector<std::int32_t>& labels, bool are_of_faces) {
    return are_of_faces ? labels : face_labels_from_vertices(file.mesh, labels);
}

MeshLabels from_column(const MeshFile& file, const Column& column, const std::string& where) {
    const auto labels = whole_numbers(column.values->values);
    const std::string name = printable(column.values->name, 60);
    if (!labels)
        fail_input(where, fmt::format("the values '{}' are not whole numbers", name), "name a property of whole numbers");
    return {on_faces(file, *labels, column.on_faces),
            {},
            fmt::format("the values '{}' of {}", name, column.on_faces ? "faces" : "vertices")};
}

MeshLabels named_values(const MeshFile& file, const std::string& name, const std::string& where) {
    std::vector<std::string> names;
    for (const Column& column : columns_of(file)) {
        // CloudCompare writes a scalar field "Class" as "scalar_Class".
        if (column.values->name == name || column.values->name == "scalar_" + name) return from_column(file, column, where);
        names.push_back(printable(column.values->name, 60));
    }
    fail_input(where, fmt::format("has no values '{}'", printable(name, 60)),
               names.empty() ? "it has no values of vertices or faces at all" : "it has " + joined(names));
}

/// The label property, or the only property of whole numbers whose name suggests labels.
MeshLabels usual_labels(const MeshFile& file, const std::string& where) {
    if (!file.extras.face_labels.empty()) return {file.extras.face_labels, {}, ""};
    if (!file.extras.vertex_labels.empty()) return {face_labels_from_vertices(file.mesh, file.extras.vertex_labels), {}, ""};
    std::vector<Column> candidates;
    for (const Column& column : columns_of(file)) {
        const std::string name = lower_case(column.values->name);
        static constexpr const char* words[]{"label", "segment", "class", "cluster", "part"};
        const bool suggests_labels = std::any_of(std::begin(words), std::end(words),
                                                 [&](const char* word) { return name.find(word) != std::string::npos; });
        if (suggests_labels && whole_numbers(column.values->values)) candidates.push_back(column);
    }
    if (candidates.size() == 1) return from_column(file, candidates.front(), where);
    const auto name_of_column = [](const Column& column) { return "values:" + printable(column.values->name, 60); };
    if (!candidates.empty())
        fail_input(where, fmt::format("has {} properties of labels", candidates.size()),
                   fmt::format("name one with --from: {}", joined(candidates, ", ", name_of_column)));
    const auto columns = columns_of(file);
    fail_input(
        where, "has no labels",
        "give a PLY file with a face or vertex property \"label\", a label file or a recipe, or name the source with --from: " +
            joined(label_sources()) + (columns.empty() ? "" : ", " + joined(columns, ", ", name_of_column)));
}

MeshLabels by_colour(const MeshFile& file, const std::string& where) {
    const bool of_faces = !file.extras.face_colours.empty();
    const std::vector<Colour>& colours = of_faces ? file.extras.face_colours : file.extras.vertex_colours;
    if (colours.empty()) fail_input(where, "has no colours of faces or vertices", "name another source with --from");
    std::map<std::array<std::uint8_t, 3>, std::int32_t> number;
    MeshLabels result;
    std::vector<std::int32_t> labels;
    for (const Colour& colour : colours) {
        const std::array<std::uint8_t, 3> rgb{colour[0], colour[1], colour[2]};
        const auto [entry, added] = number.try_emplace(rgb, static_cast<std::int32_t>(number.size()));
        if (added) {
            constexpr std::size_t max_colours = 1000;
            if (number.size() > max_colours)
                fail_input(where, fmt::format("has more than {} colours: they are shades, not labels", max_colours),
                           "name another source with --from");
            result.names[entry->second] = fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
        }
        labels.push_back(entry->second);
    }
    result.of_face = on_faces(file, labels, of_faces);
    result.source = of_faces ? "the colours of the faces" : "the colours of the vertices";
    return result;
}

MeshLabels by_statement(const MeshFile& file, const Path& path, ObjStatement statement, const std::string& where) {
    static constexpr const char* words[]{"groups", "objects", "materials"};
    const std::string kind = words[static_cast<std::size_t>(statement)];
    if (path.empty() || extension(path) != ".obj")
        fail_input(where, fmt::format("has no {}", kind), fmt::format("give an OBJ file with {}", kind));
    const ObjParts parts = read_obj_parts(path, statement);
    if (parts.names.empty())
        fail_input(where, fmt::format("assigns no {} to its faces", kind), "name another source with --from");
    MeshLabels result;
    for (std::size_t i = 0; i < parts.names.size(); ++i) result.names[static_cast<std::int32_t>(i)] = parts.names[i];
    for (std::size_t f = 0; f < file.mesh.number_of_faces(); ++f) {
        const std::size_t polygon = file.polygon_of_triangle.empty() ? f : file.polygon_of_triangle[f];
        if (polygon >= parts.of_polygon.size())
            fail_input(where, fmt::format("its {} do not match its faces", kind), "write the file again");
        result.of_face.push_back(parts.of_polygon[polygon]);
    }
    result.source = fmt::format("the {} of the file", kind);
    return result;
}

MeshLabels by_material(const MeshFile& file, const Path& path, const std::string& where) {
    if (file.extras.face_materials.empty()) return by_statement(file, path, ObjStatement::material, where);
    MeshLabels result{{}, {}, "the materials of the file"};
    for (const Index material : file.extras.face_materials) {
        const std::int32_t label = material == no_index ? no_label : static_cast<std::int32_t>(material);
        result.of_face.push_back(label);
        if (label == no_label || material >= file.extras.appearance.materials.size()) continue;
        const std::string& name = file.extras.appearance.materials[material].name;
        if (!name.empty()) result.names[label] = name;
    }
    return result;
}

}  // namespace

const std::vector<std::string>& label_sources() {
    static const std::vector<std::string> sources{"label", "group", "object", "material", "colour"};
    return sources;
}

MeshLabels labels_from(const MeshFile& file, const Path& path, const std::string& source, const std::string& where) {
    if (source.empty() || source == "label") return usual_labels(file, where);
    if (source == "group") return by_statement(file, path, ObjStatement::group, where);
    if (source == "object") return by_statement(file, path, ObjStatement::object, where);
    if (source == "material") return by_material(file, path, where);
    if (source == "colour") return by_colour(file, where);
    if (source.starts_with("values:")) return named_values(file, source.substr(7), where);
    fail_usage(fmt::format("--from '{}' is not a source of labels", printable(source, 60)),
               "use one of " + joined(label_sources()) + ", values:NAME");
}

MeshLabels labels_in_file(const Path& labels, const MeshFile& mesh) {
    const std::size_t faces = mesh.mesh.number_of_faces(), vertices = mesh.mesh.number_of_vertices();
    if (extension(labels) != ".npy") return {read_labels(labels, faces, mesh.polygon_of_triangle), {}, ""};
    const auto numbers = whole_numbers(read_values(labels));
    if (!numbers) fail_input(labels.string(), "contains numbers that are not labels", "save whole numbers of 32 bits");
    if (numbers->size() == faces) return {*numbers, {}, ""};
    const std::size_t polygons =
        mesh.polygon_of_triangle.empty()
            ? faces
            : *std::max_element(mesh.polygon_of_triangle.begin(), mesh.polygon_of_triangle.end()) + std::size_t{1};
    if (numbers->size() == polygons) {
        MeshLabels result;
        for (const Index polygon : mesh.polygon_of_triangle) result.of_face.push_back((*numbers)[polygon]);
        return result;
    }
    if (numbers->size() == vertices)
        return {face_labels_from_vertices(mesh.mesh, *numbers), {}, "labels of vertices, by majority of the corners"};
    fail_input(labels.string(), fmt::format("{} labels for a mesh of {} faces and {} vertices", numbers->size(), faces, vertices),
               "give the labels of this mesh, one for each face or vertex");
}

}  // namespace ostraka

// ostraka mesh convert: one mesh file into another.
#include "command.h"

#include "ostraka/io/mesh_file.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Arguments {
    std::string input, output, map;
    bool ascii = false, binary = false;
};

/// Which polygon of the input each triangle of the output was cut from.
void write_map(const Arguments& arguments, const TriangulatedSoup& triangles, std::size_t polygon_count,
               const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-map", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "kind", "face", allocator);
    add_member(document, "description", "for each triangle written the polygon of the input it was cut from", allocator);
    add_member(document, "from", JsonValue(static_cast<std::uint64_t>(triangles.soup.triangles.size())), allocator);
    add_member(document, "to", JsonValue(static_cast<std::uint64_t>(polygon_count)), allocator);
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(triangles.soup.triangles.size()), allocator);
    for (std::size_t t = 0; t < triangles.soup.triangles.size(); ++t)
        list.PushBack(triangles.triangle_polygon.empty() ? static_cast<Index>(t) : triangles.triangle_polygon[t], allocator);
    add_member(document, "map", std::move(list), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    write_json(arguments.map, document);
}

void report(const Session& session, const Provenance& provenance, const std::vector<std::pair<const char*, std::size_t>>& counts,
            const std::vector<std::string>& notes) {
    if (session.json) {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        for (const auto& [name, count] : counts)
            add_member(result, name, JsonValue(static_cast<std::uint64_t>(count)), allocator);
        for (const auto& note : notes) list.PushBack(json_string(note, allocator), allocator);
        add_member(result, "notes", std::move(list), allocator);
        session.print_report(provenance, document, result);
        return;
    }
    std::vector<std::string> names, values;
    for (const auto& [name, count] : counts) {
        names.emplace_back(name);
        values.push_back(std::to_string(count));
    }
    if (!session.quiet) std::cout << table(names, {values});
}

int convert(const Session& session, const Arguments& arguments) {
    check_mesh_extension(arguments.output);
    check_outputs({arguments.input}, {arguments.output, arguments.map});
    PolygonSoup polygons = read_polygons(arguments.input);
    const std::size_t polygon_count = polygons.polygon_count();
    const TriangulatedSoup triangles = triangulate(std::move(polygons));

    Provenance provenance;
    provenance.command = "mesh convert";
    provenance.options.emplace_back("encoding", arguments.ascii ? "ascii" : "binary");
    provenance.add_input(arguments.input);
    WriteOptions options;
    options.encoding = arguments.ascii ? Encoding::ascii : Encoding::binary;
    options.comment = provenance.to_line();
    std::vector<std::string> notes = triangles.notes;
    for (auto& note : write_triangles(arguments.output, triangles.soup, triangles.extras, options))
        notes.push_back(std::move(note));
    if (!arguments.map.empty()) write_map(arguments, triangles, polygon_count, provenance);
    for (const auto& note : notes) session.note("note: " + note);
    report(
        session, provenance,
        {{"vertices", triangles.soup.points.size()}, {"polygons", polygon_count}, {"triangles", triangles.soup.triangles.size()}},
        notes);
    return done;
}

}  // namespace

void add_mesh_convert(CLI::App& mesh, Session& session) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        session.add(mesh, "convert", "write a mesh in another format, polygons cut into triangles, vertex order kept",
                    [&session, arguments] { return convert(session, *arguments); });
    command->add_option("input", arguments->input, "mesh to read: .ply, .obj, .off, .stl")->required();
    command->add_option("output", arguments->output, "mesh to write: .ply, .obj, .off, .stl, .glb")->required();
    CLI::Option* binary = command->add_flag("--binary", arguments->binary, "write PLY and STL as bytes (the default)");
    command->add_flag("--ascii", arguments->ascii, "write PLY and STL as text")->excludes(binary);
    command->add_option("--map", arguments->map, "JSON file to write: for each triangle the polygon it was cut from");
}

}  // namespace ostraka::app

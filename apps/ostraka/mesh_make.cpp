#include "command.h"

#include "ostraka/io/mesh_file.h"
#include "ostraka/shapes/make_mesh.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct MakeInput {
    std::string object, output, labels;
    bool list = false;
    MakeOptions options;
};

/// What was made of one part.
struct PartTally {
    std::size_t faces = 0, vertices = 0;
    double area = 0;
};

std::vector<PartTally> tally_parts(const MadeObject& object, const MadeMesh& made) {
    std::vector<PartTally> tallies(object.parts.size());
    for (const Face face : made.mesh.faces()) {
        PartTally& tally = tallies[static_cast<std::size_t>(made.face_labels[face.idx()])];
        ++tally.faces;
        tally.area += face_area(made.mesh, face);
    }
    for (const auto label : made.vertex_labels) ++tallies[static_cast<std::size_t>(label)].vertices;
    return tallies;
}

MeshExtras extras_of(const MadeObject& object, const MadeMesh& made) {
    MeshExtras extras;
    extras.face_labels = made.face_labels;
    extras.vertex_labels = made.vertex_labels;
    const auto colour = [&](std::int32_t label) {
        const auto& [red, green, blue] = object.part_colours[static_cast<std::size_t>(label)];
        return Colour{red, green, blue, 255};
    };
    for (const auto label : made.face_labels) extras.face_colours.push_back(colour(label));
    for (const auto label : made.vertex_labels) extras.vertex_colours.push_back(colour(label));
    return extras;
}

int list_objects(const MakeInput& input, const Session& session) {
    const auto names = input.object.empty() ? made_object_names() : std::vector<std::string>{input.object};
    Json document;
    auto& allocator = document.GetAllocator();
    JsonValue objects(rapidjson::kArrayType);
    std::vector<std::vector<std::string>> rows;
    for (const auto& name : names) {
        const MadeObject& object = made_object(name);
        JsonValue entry(rapidjson::kObjectType), parts(rapidjson::kArrayType);
        add_member(entry, "name", object.name, allocator);
        add_member(entry, "class", object.object_class, allocator);
        add_member(entry, "description", object.description, allocator);
        add_member(entry, "unit", object.unit, allocator);
        add_member(entry, "genus", JsonValue(object.genus), allocator);
        add_member(entry, "minimumVertices", JsonValue(static_cast<std::uint64_t>(object.minimum_vertices)), allocator);
        for (std::size_t part = 0; part < object.parts.size(); ++part) {
            parts.PushBack(json_string(object.parts[part], allocator), allocator);
            rows.push_back({part == 0 ? object.name : "", part == 0 ? std::to_string(object.genus) : "",
                            part == 0 ? std::to_string(object.minimum_vertices) : "", std::to_string(part), object.parts[part]});
        }
        add_member(entry, "parts", std::move(parts), allocator);
        objects.PushBack(std::move(entry), allocator);
    }
    if (session.json) {
        Provenance provenance;
        provenance.command = "mesh make";
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "objects", std::move(objects), allocator);
        session.print_report(provenance, document, result);
    } else {
        std::cout << table({"object", "genus", "least vertices", "label", "part"}, rows);
    }
    return done;
}

JsonValue report_of(const MadeObject& object, const MadeMesh& made, const std::vector<PartTally>& tallies, double area,
                    JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), parts(rapidjson::kArrayType);
    add_member(result, "object", object.name, allocator);
    add_member(result, "class", object.object_class, allocator);
    add_member(result, "unit", object.unit, allocator);
    add_member(result, "vertices", JsonValue(static_cast<std::uint64_t>(made.mesh.number_of_vertices())), allocator);
    add_member(result, "faces", JsonValue(static_cast<std::uint64_t>(made.mesh.number_of_faces())), allocator);
    add_member(result, "genus", JsonValue(object.genus), allocator);
    add_member(result, "area", JsonValue(area), allocator);
    add_member(result, "meanEdgeLength", JsonValue(mean_edge_length(made.mesh)), allocator);
    for (std::size_t part = 0; part < tallies.size(); ++part) {
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "label", JsonValue(static_cast<std::uint64_t>(part)), allocator);
        add_member(entry, "name", object.parts[part], allocator);
        add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(tallies[part].faces)), allocator);
        add_member(entry, "vertices", JsonValue(static_cast<std::uint64_t>(tallies[part].vertices)), allocator);
        add_member(entry, "area", JsonValue(tallies[part].area), allocator);
        parts.PushBack(std::move(entry), allocator);
    }
    add_member(result, "parts", std::move(parts), allocator);
    return result;
}

int make(const MakeInput& input, const Session& session) {
    if (input.list) return list_objects(input, session);
    if (input.object.empty()) fail_usage("no object is named", "name one of those that 'ostraka mesh make --list' shows");
    const MadeObject& object = made_object(input.object);
    if (input.output.empty())
        fail_usage("no output file is named", "write: ostraka mesh make " + input.object + " " + input.object + ".ply");
    check_mesh_extension(input.output);
    std::vector<Path> outputs{input.output};
    if (!input.labels.empty()) outputs.emplace_back(input.labels);
    check_outputs({}, outputs);

    const auto begin = std::chrono::steady_clock::now();
    const MadeMesh made = make_mesh(object, input.options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

    Provenance provenance;
    provenance.command = "mesh make";
    provenance.options = list_options(input.options);
    provenance.options.insert(provenance.options.begin(), {"object", object.name});
    WriteOptions write_options;
    write_options.comment = provenance.to_line();
    for (const auto& note : write_mesh(input.output, made.mesh, extras_of(object, made), write_options))
        session.note(input.output + ": " + note);
    if (!input.labels.empty()) {
        std::string lines;
        for (const auto label : made.face_labels) lines += std::to_string(label) + "\n";
        write_file(input.labels, lines);
    }

    const auto tallies = tally_parts(object, made);
    double area = 0;
    for (const PartTally& tally : tallies) area += tally.area;
    if (session.json) {
        Json document;
        auto& allocator = document.GetAllocator();
        JsonValue result = report_of(object, made, tallies, area, allocator), run(rapidjson::kObjectType);
        add_member(run, "seconds", JsonValue(seconds), allocator);
        session.print_report(provenance, document, result, &run);
        return done;
    }
    std::vector<std::vector<std::string>> rows;
    for (std::size_t part = 0; part < tallies.size(); ++part) {
        rows.push_back({std::to_string(part), object.parts[part], std::to_string(tallies[part].faces), number(tallies[part].area),
                        number(100 * tallies[part].area / area, 3)});
    }
    std::cout << object.object_class << ": " << made.mesh.number_of_vertices() << " vertices, " << made.mesh.number_of_faces()
              << " faces, genus " << object.genus << ", mean edge " << number(mean_edge_length(made.mesh), 3) << " "
              << object.unit << "\n"
              << table({"label", "part", "faces", "area " + object.unit + "2", "% of area"}, rows);
    return done;
}

}  // namespace

void add_mesh_make(CLI::App& mesh, Session& session) {
    auto input = std::make_shared<MakeInput>();
    CLI::App* command = session.add(mesh, "make", "make a closed mesh of an object whose parts are known exactly",
                                    [input, &session] { return make(*input, session); });
    command->add_option("object", input->object, "what to make (see --list)");
    command->add_option("output", input->output, "mesh file to write; PLY keeps labels and colours of faces and vertices");
    command->add_option("--labels", input->labels, "text file to write: the label of each face, one a line");
    command->add_flag("--list", input->list, "show the objects, their parts and labels");
    add_flags(command, input->options);
}

}  // namespace ostraka::app

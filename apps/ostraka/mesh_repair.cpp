// ostraka mesh repair: an oriented manifold out of any file with faces.
#include "diagnosis_report.h"

#include "ostraka/io/repair.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Arguments {
    std::string input, output, vertex_map, face_map, report;
    RepairOptions options;
};

JsonValue step_json(const RepairStep& step, JsonAllocator& allocator) {
    JsonValue value(rapidjson::kObjectType), counts(rapidjson::kObjectType);
    add_member(value, "step", step.name, allocator);
    for (const auto& [name, count] : step.counts)
        add_member(counts, name, JsonValue(static_cast<std::uint64_t>(count)), allocator);
    add_member(value, "counts", std::move(counts), allocator);
    return value;
}

/// Old index -> new index, -1 for what is gone.
void write_map(const std::string& file, const char* kind, const std::vector<Index>& map, std::size_t to, bool by_distance,
               const Provenance& provenance) {
    if (file.empty()) return;
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-map", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "kind", kind, allocator);
    add_member(document, "from", JsonValue(static_cast<std::uint64_t>(map.size())), allocator);
    add_member(document, "to", JsonValue(static_cast<std::uint64_t>(to)), allocator);
    if (by_distance) add_member(document, "method", "nearest", allocator);
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(map.size()), allocator);
    for (const Index i : map) list.PushBack(i == no_index ? std::int64_t{-1} : static_cast<std::int64_t>(i), allocator);
    add_member(document, "map", std::move(list), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    write_json(file, document);
}

JsonValue result_json(const RepairResult& repaired, const std::vector<std::string>& notes, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), steps(rapidjson::kArrayType), said(rapidjson::kArrayType);
    for (const auto& step : repaired.steps) steps.PushBack(step_json(step, allocator), allocator);
    for (const auto& note : notes) said.PushBack(json_string(note, allocator), allocator);
    add_member(result, "sound", JsonValue(repaired.after.defects().empty()), allocator);
    add_member(result, "steps", std::move(steps), allocator);
    add_member(result, "notes", std::move(said), allocator);
    add_member(result, "maps", repaired.maps_by_distance ? "nearest" : "exact", allocator);
    add_member(result, "after", to_json(repaired.after, allocator), allocator);
    return result;
}

void print_table(const RepairResult& repaired) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& step : repaired.steps) {
        const std::size_t before = rows.size();
        for (const auto& [name, count] : step.counts)
            if (count > 0) rows.push_back({rows.size() == before ? step.name : "", name, std::to_string(count)});
        if (rows.size() == before) rows.push_back({step.name, "nothing to do", "-"});
    }
    std::cout << table({"step", "", "count"}, rows) << '\n';
    std::vector<std::vector<std::string>> after;
    for (auto& row : to_rows(repaired.after))
        if (row[0] == "vertices" || row[0] == "triangles" || row[0] == "components" || row[0] == "border loops" ||
            row[0] == "area" || row[0] == "volume" || row[0] == "verdict")
            after.push_back(row);
    std::cout << "after\n";
    print_rows(after);
}

int run_repair(const Session& session, const Arguments& arguments) {
    check_mesh_extension(arguments.output);
    std::vector<Path> outputs{arguments.output};
    for (const auto& file : {arguments.vertex_map, arguments.face_map, arguments.report})
        if (!file.empty()) outputs.emplace_back(file);
    check_outputs({arguments.input}, outputs);
    check_options(arguments.options, "mesh repair");
    const TriangulatedSoup read = triangulate(read_polygons(arguments.input));
    const RepairResult repaired = in_file(arguments.input, [&] { return repair(read.soup, read.extras, arguments.options); });
    Provenance provenance;
    provenance.command = "mesh repair";
    provenance.options = list_options(arguments.options);
    provenance.add_input(arguments.input);
    WriteOptions writing;
    writing.comment = provenance.to_line();
    std::vector<std::string> notes = read.notes;
    notes.insert(notes.end(), repaired.notes.begin(), repaired.notes.end());
    for (auto& note : write_mesh(arguments.output, repaired.mesh, repaired.extras, writing)) notes.push_back(std::move(note));
    write_map(arguments.vertex_map, "vertex", repaired.vertex_map, repaired.mesh.number_of_vertices(), repaired.maps_by_distance,
              provenance);
    write_map(arguments.face_map, "face", repaired.face_map, repaired.mesh.number_of_faces(), repaired.maps_by_distance,
              provenance);

    for (const auto& note : notes) session.note("note: " + note);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    if (!arguments.report.empty()) {
        Json report(rapidjson::kObjectType);
        add_member(report, "format", "ostraka-report", report.GetAllocator());
        add_member(report, "command", provenance.command, report.GetAllocator());
        add_member(report, "result", result_json(repaired, notes, report.GetAllocator()), report.GetAllocator());
        add_member(report, "provenance", provenance.to_json(report.GetAllocator()), report.GetAllocator());
        write_json(arguments.report, report);
    }
    if (session.json) {
        JsonValue result = result_json(repaired, notes, allocator);
        session.print_report(provenance, document, result);
    } else {
        print_table(repaired);
    }
    return repaired.after.defects().empty() ? done : answer_is_no;
}

}  // namespace

void add_mesh_repair(CLI::App& mesh, Session& session) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        session.add(mesh, "repair", "make an oriented manifold; exit code 3 if it is still open or intersects itself",
                    [&session, arguments] { return run_repair(session, *arguments); });
    command->add_option("input", arguments->input, "mesh to read: .ply, .obj, .off, .stl")->required();
    command->add_option("output", arguments->output, "mesh to write: .ply, .obj, .off, .stl, .glb")->required();
    command->add_option("--vertex-map", arguments->vertex_map, "JSON file to write: old vertex to new vertex, -1 for dropped");
    command->add_option("--face-map", arguments->face_map, "JSON file to write: old triangle to new triangle, -1 for dropped");
    command->add_option("--report", arguments->report, "JSON file to write: the report of --json");
    add_flags(command, arguments->options);
}

}  // namespace ostraka::app

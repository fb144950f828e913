// ostraka mesh info: what a file holds and what is wrong with it.
#include "diagnosis_report.h"

#include "ostraka/io/mesh_file.h"

#include <chrono>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Arguments {
    std::string input;
    DiagnoseOptions options;
};

/// Names of what the file holds beside its geometry.
std::vector<std::string> names_of(const MeshExtras& extras) {
    std::vector<std::string> names;
    if (!extras.vertex_colours.empty()) names.emplace_back("vertex colours");
    if (!extras.face_colours.empty()) names.emplace_back("face colours");
    if (!extras.vertex_labels.empty()) names.emplace_back("vertex labels");
    if (!extras.face_labels.empty()) names.emplace_back("face labels");
    if (!extras.vertex_texture.empty()) names.emplace_back("texture coordinates per vertex");
    if (!extras.corner_texture.empty()) names.emplace_back("texture coordinates per corner");
    return names;
}

/// Polygons with fewer than three distinct corners, which give no triangle.
std::size_t count_degenerate(const PolygonSoup& soup) {
    std::size_t count = 0;
    std::vector<Index> corners;
    for (std::size_t p = 0; p < soup.polygon_count(); ++p) {
        corners.assign(soup.corners.begin() + soup.polygon_begin[p], soup.corners.begin() + soup.polygon_begin[p + 1]);
        std::sort(corners.begin(), corners.end());
        count += std::unique(corners.begin(), corners.end()) - corners.begin() < 3;
    }
    return count;
}

using Seconds = std::vector<std::pair<std::string, double>>;

void print_shares(const Session& session, const Seconds& seconds) {
    double total = 0;
    for (const auto& [part, time] : seconds) total += time;
    std::string line = "time: " + number(total, 3) + " s;";
    for (const auto& [part, time] : seconds) line += " " + part + " " + number(100 * time / total, 2) + " %,";
    line.pop_back();
    session.note(line);
}

int info(const Session& session, const Arguments& arguments) {
    Seconds seconds;
    auto started = std::chrono::steady_clock::now();
    const auto lap = [&](const char* part) {
        const auto now = std::chrono::steady_clock::now();
        seconds.emplace_back(part, std::chrono::duration<double>(now - started).count());
        started = now;
    };
    PolygonSoup polygons = read_polygons(arguments.input);
    lap("read");
    const std::size_t polygon_count = polygons.polygon_count(), degenerate = count_degenerate(polygons);
    const std::vector<std::string> extras = names_of(polygons.extras);
    const TriangulatedSoup triangles = triangulate(std::move(polygons));
    lap("triangulate");
    const MeshDiagnosis diagnosis = in_file(arguments.input, [&] { return diagnose(triangles.soup, arguments.options); });
    seconds.insert(seconds.end(), diagnosis.seconds.begin(), diagnosis.seconds.end());
    const bool sound = diagnosis.defects().empty() && degenerate == 0;

    for (const auto& note : triangles.notes) session.note("note: " + note);
    print_shares(session, seconds);
    if (session.json) {
        Provenance provenance;
        provenance.command = "mesh info";
        provenance.options = list_options(arguments.options);
        provenance.add_input(arguments.input);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result = to_json(diagnosis, allocator);
        result["sound"].SetBool(sound);
        add_member(result, "polygons", JsonValue(static_cast<std::uint64_t>(polygon_count)), allocator);
        add_member(result, "degenerate_polygons", JsonValue(static_cast<std::uint64_t>(degenerate)), allocator);
        JsonValue holds(rapidjson::kArrayType), notes(rapidjson::kArrayType);
        for (const auto& name : extras) holds.PushBack(json_string(name, allocator), allocator);
        for (const auto& note : triangles.notes) notes.PushBack(json_string(note, allocator), allocator);
        add_member(result, "holds", std::move(holds), allocator);
        add_member(result, "notes", std::move(notes), allocator);
        JsonValue run(rapidjson::kObjectType), times(rapidjson::kObjectType);
        for (const auto& [part, time] : seconds) add_member(times, part, JsonValue(time), allocator);
        add_member(run, "seconds", std::move(times), allocator);
        session.print_report(provenance, document, result, &run);
    } else {
        auto rows = to_rows(diagnosis);
        rows.insert(rows.begin() + 2, {"polygons", std::to_string(polygon_count)});
        rows.insert(rows.begin() + 3, {"polygons with fewer than three corners", std::to_string(degenerate)});
        std::string held;
        for (const auto& name : extras) held += (held.empty() ? "" : ", ") + name;
        rows.insert(rows.end() - 1, {"holds", held.empty() ? "nothing but the geometry" : held});
        print_rows(rows);
    }
    return sound ? done : answer_is_no;
}

}  // namespace

void add_mesh_info(CLI::App& mesh, Session& session) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = session.add(
        mesh, "info",
        "count, measure and examine a mesh; exit code 3 if it is not closed, oriented, manifold and free of self-intersections",
        [&session, arguments] { return info(session, *arguments); });
    command->add_option("input", arguments->input, "mesh to read: .ply, .obj, .off, .stl")->required();
    add_flags(command, arguments->options);
}

}  // namespace ostraka::app

// ostraka mesh simplify, refine, remesh: the same object at another resolution.
#include "bound_mesh.h"

#include "ostraka/remesh/remesh.h"

#include <chrono>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

class Clock {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

using Facts = std::vector<std::pair<const char*, JsonValue>>;

void print(const Session& session, const Provenance& provenance, const BoundMesh& bound, Json& document, Facts facts,
           const std::vector<std::string>& notes, double seconds) {
    for (const auto& note : notes) session.note("note: " + note);
    if (!session.json) {
        if (!session.quiet) std::cout << bound.tables();
        return;
    }
    auto& allocator = document.GetAllocator();
    JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType), run(rapidjson::kObjectType);
    bound.add_to_report(result, allocator);
    for (auto& [name, value] : facts) add_member(result, name, std::move(value), allocator);
    for (const auto& note : notes) list.PushBack(json_string(note, allocator), allocator);
    add_member(result, "notes", std::move(list), allocator);
    add_member(run, "seconds", JsonValue(seconds), allocator);
    session.print_report(provenance, document, result, &run);
}

JsonValue count(std::size_t n) { return JsonValue(static_cast<std::uint64_t>(n)); }

struct SimplifyArguments {
    BoundMeshFiles files;
    SimplifyOptions options;
    bool protect = false;
};

int run_simplify(const Session& session, SimplifyArguments& arguments) {
    SimplifyOptions& options = arguments.options;
    if (arguments.protect) options.outlines = "protect";
    Provenance provenance{"mesh simplify", list_options(options), {}};
    BoundMesh bound(arguments.files, provenance);
    const Clock clock;
    const SimplifyResult result = simplify(bound.mesh, options, bound.marked(options.outlines == "protect"), bound.visitor());
    const double seconds = clock.seconds();
    bound.follow(result);
    std::vector<std::string> notes = bound.write(provenance);
    if (!result.reached) notes.push_back("the wanted number could not be reached: " + result.stop_reason);
    if (result.outlines_broken) notes.emplace_back("outlines or lines had to be merged to reach the number");
    if (result.isolated_dropped > 0) notes.push_back(std::to_string(result.isolated_dropped) + " isolated vertices were dropped");
    Json document;
    Facts facts;
    facts.emplace_back("reached", JsonValue(result.reached));
    facts.emplace_back("stop_reason", json_string(result.stop_reason, document.GetAllocator()));
    facts.emplace_back("collapses", count(result.collapses));
    facts.emplace_back("outlines_broken", JsonValue(result.outlines_broken));
    facts.emplace_back("isolated_dropped", count(result.isolated_dropped));
    print(session, provenance, bound, document, std::move(facts), notes, seconds);
    return result.reached ? done : answer_is_no;
}

struct RefineArguments {
    BoundMeshFiles files;
    RefineOptions options;
};

int run_refine(const Session& session, const RefineArguments& arguments) {
    Provenance provenance{"mesh refine", list_options(arguments.options), {}};
    BoundMesh bound(arguments.files, provenance);
    const Clock clock;
    const RefineResult result = refine(bound.mesh, arguments.options);
    const double seconds = clock.seconds();
    bound.follow(result);
    const std::vector<std::string> notes = bound.write(provenance);
    Json document;
    Facts facts;
    facts.emplace_back("levels", JsonValue(result.levels));
    facts.emplace_back("bisections", count(result.bisections));
    print(session, provenance, bound, document, std::move(facts), notes, seconds);
    return done;
}

struct RemeshArguments {
    std::string input, output;
    bool ascii = false;
    RemeshOptions options;
};

int run_remesh(const Session& session, const RemeshArguments& arguments) {
    check_mesh_extension(arguments.output);
    check_outputs({arguments.input}, {arguments.output});
    Provenance provenance{"mesh remesh", list_options(arguments.options), {}};
    provenance.add_input(arguments.input);
    const MeshFile file = read_mesh(arguments.input);
    std::vector<std::string> notes = file.notes;
    const MeshExtras& extras = file.extras;
    if (!extras.vertex_colours.empty() || !extras.face_colours.empty() || !extras.vertex_labels.empty() ||
        !extras.face_labels.empty() || !extras.vertex_texture.empty() || !extras.corner_texture.empty())
        notes.emplace_back("colours, labels and texture coordinates belong to the old mesh and are left out");
    const Clock clock;
    const RemeshResult result = remesh(file.mesh, arguments.options);
    const double seconds = clock.seconds();
    WriteOptions options;
    options.encoding = arguments.ascii ? Encoding::ascii : Encoding::binary;
    options.comment = provenance.to_line();
    for (auto& note : write_mesh(arguments.output, result.mesh, {}, options)) notes.push_back(std::move(note));
    if (!result.reached)
        notes.push_back("the wanted number could not be reached: stopped at " + std::to_string(result.mesh.number_of_vertices()) +
                        " vertices, fewer would change the topology or turn faces over");
    for (const auto& note : notes) session.note("note: " + note);
    const double area_before = surface_area(file.mesh), area_after = surface_area(result.mesh);
    if (session.json) {
        Json document;
        auto& allocator = document.GetAllocator();
        JsonValue report(rapidjson::kObjectType), list(rapidjson::kArrayType), run(rapidjson::kObjectType);
        for (const auto& [name, mesh, area] :
             {std::tuple{"input", &file.mesh, area_before}, {"output", &result.mesh, area_after}}) {
            JsonValue member(rapidjson::kObjectType);
            add_member(member, "vertices", count(mesh->number_of_vertices()), allocator);
            add_member(member, "faces", count(mesh->number_of_faces()), allocator);
            add_member(member, "area", JsonValue(area), allocator);
            add_member(report, name, std::move(member), allocator);
        }
        add_member(report, "reached", JsonValue(result.reached), allocator);
        add_member(report, "target_edge_length", JsonValue(result.target_edge_length), allocator);
        add_member(report, "vertices_before_adjustment", count(result.remeshed), allocator);
        add_member(report, "deviation", JsonValue(result.deviation), allocator);
        for (const auto& note : notes) list.PushBack(json_string(note, allocator), allocator);
        add_member(report, "notes", std::move(list), allocator);
        add_member(run, "seconds", JsonValue(seconds), allocator);
        session.print_report(provenance, document, report, &run);
    } else if (!session.quiet) {
        const auto row = [](const char* name, const Mesh& mesh, double area) {
            return std::vector<std::string>{name, std::to_string(mesh.number_of_vertices()),
                                            std::to_string(mesh.number_of_faces()), number(area)};
        };
        std::cout << table({"", "vertices", "faces", "area"},
                           {row("before", file.mesh, area_before), row("after", result.mesh, area_after)});
    }
    return result.reached ? done : answer_is_no;
}

}  // namespace

void add_mesh_resize(CLI::App& mesh, Session& session) {
    auto simplify_arguments = std::make_shared<SimplifyArguments>();
    CLI::App* command = session.add(mesh, "simplify", "fewer vertices, with annotations, labels and colours carried along",
                                    [&session, simplify_arguments] { return run_simplify(session, *simplify_arguments); });
    add_bound_mesh_flags(command, simplify_arguments->files);
    add_flags(command, simplify_arguments->options);
    command->get_option("--vertices")->required();
    command
        ->add_flag("--protect-outlines", simplify_arguments->protect, "the same as --outlines protect; pins of measures stay too")
        ->excludes("--outlines");
    command->add_option("--vertex-map", simplify_arguments->files.vertex_map,
                        "JSON file to write: the new vertex of each old one");
    command->add_option("--face-map", simplify_arguments->files.face_map,
                        "JSON file to write: the new face of each old one, -1 where it vanished");

    auto refine_arguments = std::make_shared<RefineArguments>();
    command = session.add(mesh, "refine", "more vertices, with annotations, labels and colours carried along",
                          [&session, refine_arguments] { return run_refine(session, *refine_arguments); });
    add_bound_mesh_flags(command, refine_arguments->files);
    add_flags(command, refine_arguments->options);

    auto remesh_arguments = std::make_shared<RemeshArguments>();
    command = session.add(mesh, "remesh", "a new mesh of the same surface, independent of the old one",
                          [&session, remesh_arguments] { return run_remesh(session, *remesh_arguments); });
    command->add_option("input", remesh_arguments->input, "mesh to read: .ply, .obj, .off, .stl")->required();
    command->add_option("output", remesh_arguments->output, "mesh to write: .ply, .obj, .off, .stl, .glb")->required();
    command->add_flag("--ascii", remesh_arguments->ascii, "write PLY and STL as text");
    add_flags(command, remesh_arguments->options);
    command->get_option("--vertices")->required();
}

}  // namespace ostraka::app

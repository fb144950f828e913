#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/transfer/transfer.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct TransferCommand {
    std::string source, annotations, target, output;
    std::string back, refined, map, ply;
    bool no_overlap = false;
    ReadAnnotationsOptions reading;
    TransferOptions options;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

JsonValue score_to_json(const TransferScore& score, JsonAllocator& allocator) {
    JsonValue value(rapidjson::kObjectType);
    const auto add = [&](const char* name, JsonValue member) { add_member(value, name, std::move(member), allocator); };
    add("id", JsonValue(score.id));
    add_member(value, "tag", score.tag, allocator);
    add_member(value, "sourceType", to_string(score.source_type), allocator);
    add_member(value, "targetType", to_string(score.target_type), allocator);
    add_member(value, "outcome", score.outcome, allocator);
    if (!score.note.empty()) add_member(value, "note", score.note, allocator);
    if (score.source_type == AnnotationType::region) {
        const Distortions d = distortions(score);
        add("sourceArea", JsonValue(score.source_area));
        add("targetArea", JsonValue(score.target_area));
        add("sourcePerimeter", JsonValue(score.source_length));
        add("targetPerimeter", JsonValue(score.target_length));
        if (score.target_type == AnnotationType::region && score.target_area > 0) {
            JsonValue distortion(rapidjson::kObjectType);
            const std::pair<const char*, double> columns[] = {
                {"A", d.area},        {"P", d.perimeter}, {"P/A", d.perimeter_by_area}, {"A/P", d.area_by_perimeter},
                {"C", d.circularity}, {"average", d.mean}};
            for (const auto& [name, number_value] : columns) add_member(distortion, name, JsonValue(number_value), allocator);
            add("distortion", std::move(distortion));
        }
        if (score.overlap) add("overlap", JsonValue(*score.overlap));
        if (score.wrong_side) add("wrongSide", JsonValue(*score.wrong_side));
    } else {
        add("sourceLength", JsonValue(score.source_length));
        add("targetLength", JsonValue(score.target_length));
    }
    if (score.hausdorff) add("hausdorff", JsonValue(*score.hausdorff));
    JsonValue places(rapidjson::kObjectType);
    const std::pair<const char*, std::size_t> counts[] = {
        {"vertices", score.vertices},          {"byRay", score.by_ray},        {"byClosestPoint", score.by_closest_point},
        {"withoutPlace", score.without_place}, {"relocated", score.relocated}, {"detours", score.detours}};
    for (const auto& [name, count] : counts) add_member(places, name, JsonValue(static_cast<std::uint64_t>(count)), allocator);
    add("correspondence", std::move(places));
    add("crossingsResolved", JsonValue(score.crossings_resolved));
    add("voted", JsonValue(score.voted));
    return value;
}

JsonValue scores_to_json(const std::vector<TransferScore>& scores, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const TransferScore& score : scores) list.PushBack(score_to_json(score, allocator), allocator);
    return list;
}

/// Less than 1e-9 % is what rounding leaves of nothing.
std::string percent(double share) { return std::abs(share) < 1e-11 ? "0" : number(100 * share, 3); }

void print_scores(const std::string& title, const std::vector<TransferScore>& scores) {
    std::vector<std::vector<std::string>> rows;
    for (const TransferScore& s : scores) {
        const bool region =
            s.source_type == AnnotationType::region && s.target_type == AnnotationType::region && s.outcome == "kept";
        const Distortions d = distortions(s);
        std::string remarks = s.outcome == "kept" ? "" : s.outcome;
        const auto remark = [&](const std::string& text) { remarks += (remarks.empty() ? "" : "; ") + text; };
        if (s.by_closest_point > 0) remark(std::to_string(s.by_closest_point) + " by closest point");
        if (s.without_place > 0) remark(std::to_string(s.without_place) + " without a place");
        if (s.relocated > 0) remark(std::to_string(s.relocated) + " on another layer, placed again");
        if (s.detours > 0) remark(std::to_string(s.detours) + " detours");
        if (s.voted) remark("outlines crossed, filled face by face");
        else if (s.crossings_resolved) remark("crossing outlines resolved");
        if (!s.note.empty()) remark(s.note);
        const auto if_region = [&](double share) { return region ? percent(share) : std::string("-"); };
        rows.push_back({std::to_string(s.id), s.tag, to_string(s.target_type), if_region(d.area),
                        s.source_length > 0 && s.outcome == "kept" ? percent(d.perimeter) : "-", if_region(d.perimeter_by_area),
                        if_region(d.area_by_perimeter), if_region(d.circularity), if_region(d.mean),
                        s.hausdorff ? number(*s.hausdorff, 3) : "-", s.overlap && region ? number(*s.overlap, 5) : "-",
                        std::to_string(s.by_ray) + "/" + std::to_string(s.vertices), remarks});
    }
    std::cout << title << "\n"
              << table({"id", "tag", "type", "A %", "P %", "P/A %", "A/P %", "C %", "mean %", "Hausdorff", "overlap", "by ray",
                        "remarks"},
                       rows);
}

Provenance provenance_of(const TransferCommand& command, const std::vector<Path>& inputs) {
    Provenance provenance;
    provenance.command = "annotation transfer";
    provenance.options = list_options(command.options);
    if (command.reading.force_mesh) provenance.options.emplace_back("force-mesh", "true");
    for (const Path& input : inputs) provenance.add_input(input);
    return provenance;
}

int run(const Session& session, TransferCommand& command) {
    command.options.overlap = !command.no_overlap;
    check_options(command.options, "annotation transfer");
    if (command.output.empty()) fail_usage("the output has no name", "name a file (*.ant.json)");
    const std::vector<Path> inputs{command.source, command.annotations, command.target};
    std::vector<Path> outputs{command.output};
    for (const std::string* more : {&command.back, &command.refined, &command.map, &command.ply})
        if (!more->empty()) outputs.emplace_back(*more);
    check_outputs(inputs, outputs);
    if (command.options.refine != !command.refined.empty())
        fail_usage("--refine inserts vertices on the target",
                   "give --refine together with --refined-mesh FILE for the mesh that results");
    if (!command.map.empty() && command.refined.empty()) fail_usage("--map goes with --refine", "leave it out or refine");
    for (const std::string* mesh : {&command.refined, &command.ply})
        if (!mesh->empty()) check_mesh_extension(*mesh);
    if (const std::string kind = extension(command.refined); kind == ".stl" || kind == ".glb")
        fail_usage("annotations need a mesh whose vertices keep their order, which " + kind + " files do not",
                   "write a .ply, .obj or .off");

    const auto start = std::chrono::steady_clock::now();
    const MeshFile source = read_mesh(command.source);
    const AnnotationSet set = read_annotations(command.annotations, source.mesh, command.reading);
    const MeshFile target = read_mesh(command.target);
    const double reading = seconds_since(start);
    const auto tree_start = std::chrono::steady_clock::now();
    const auto search = in_file(command.target, [&] { return std::make_unique<SurfaceSearch>(target.mesh); });
    const double tree = seconds_since(tree_start);
    TransferResult there = in_file(command.target, [&] { return transfer(source.mesh, set, *search, command.options); });

    const Mesh& on = there.refined ? there.refined->mesh : target.mesh;
    std::optional<TransferResult> back;
    if (!command.back.empty()) {
        const auto home = in_file(command.source, [&] { return std::make_unique<SurfaceSearch>(source.mesh); });
        TransferOptions options = command.options;
        options.refine = false;
        back = transfer(on, there.annotations, *home, options);
    }

    // All work is done: what is written now is complete.
    const Provenance provenance = provenance_of(command, inputs);
    for (const auto* notes : {&source.notes, &target.notes, &set.notes})
        for (const std::string& note : *notes) session.note(note);
    if (there.refined) {
        WriteOptions writing;
        writing.comment = provenance.to_line();
        for (const std::string& note : write_mesh(command.refined, on, {}, writing)) session.note(command.refined + ": " + note);
        if (!command.map.empty()) {
            Json map(rapidjson::kObjectType);
            auto& allocator = map.GetAllocator();
            add_member(map, "format", "ostraka-map", allocator);
            add_member(map, "version", JsonValue(1), allocator);
            add_member(map, "kind", "face-origin", allocator);
            JsonValue list(rapidjson::kArrayType);
            for (const Index f : there.refined->face_origin) list.PushBack(f, allocator);
            add_member(map, "map", std::move(list), allocator);
            write_json(command.map, map);
        }
    }
    write_annotations(command.output, there.annotations, on, there.refined ? command.refined : command.target, provenance);

    if (back) write_annotations(command.back, back->annotations, source.mesh, command.source, provenance);
    if (!command.ply.empty()) {
        WriteOptions writing;
        writing.comment = provenance.to_line();
        for (const std::string& note : write_mesh(command.ply, on, colour_by_annotation(on, there.annotations), writing))
            session.note(command.ply + ": " + note);
    }

    if (session.json) {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), times(rapidjson::kObjectType);
        add_member(result, "annotations", scores_to_json(there.scores, allocator), allocator);
        if (back) add_member(result, "back", scores_to_json(back->scores, allocator), allocator);
        const std::pair<const char*, double> laps[] = {{"reading", reading},
                                                       {"tree", tree},
                                                       {"correspondence", there.times.correspondence},
                                                       {"paths", there.times.paths},
                                                       {"regions", there.times.regions},
                                                       {"scores", there.times.scores}};
        for (const auto& [name, seconds] : laps) add_member(times, name, JsonValue(seconds), allocator);
        session.print_report(provenance, document, result, &times);
    } else {
        print_scores(Path(command.source).filename().string() + " -> " + Path(command.target).filename().string(), there.scores);
        if (back) print_scores("and back", back->scores);
        session.note("reading " + number(reading, 3) + " s, search tree " + number(tree, 3) + " s, correspondence " +
                     number(there.times.correspondence, 3) + " s, paths " + number(there.times.paths, 3) + " s, regions " +
                     number(there.times.regions, 3) + " s, scores " + number(there.times.scores, 3) + " s");
    }
    const auto is_lost = [](const TransferScore& score) { return score.outcome == "lost"; };
    return std::any_of(there.scores.begin(), there.scores.end(), is_lost) ? answer_is_no : done;
}

}  // namespace

void add_annotation_transfer(CLI::App& annotation, Session& session) {
    const auto command = std::make_shared<TransferCommand>();
    CLI::App* app = session.add(annotation, "transfer",
                                "carry annotations to another resolution of the same object, and say how faithful they are",
                                [&session, command] { return run(session, *command); });
    app->add_option("source", command->source, "the annotated mesh")->required();
    app->add_option("annotations", command->annotations, "its annotations")->required();
    app->add_option("target", command->target, "the mesh at another resolution")->required();
    app->add_option("output", command->output, "the annotations on the target (*.ant.json)")->required();
    app->add_option("--back", command->back, "transfer them back to the source as well, into this file, and score that");
    app->add_option("--ply", command->ply,
                    "write the target in the colours of its annotations (PLY or another format with colours)");
    app->add_option("--refined-mesh", command->refined, "with --refine: the target with the inserted vertices");
    app->add_option("--map", command->map, "with --refine: new face -> old face, as JSON");
    app->add_flag("--no-overlap", command->no_overlap, "do not measure the overlap (the slowest score)");
    command->options.correspondence.describe(*std::make_unique<FlagVisitor>(FlagVisitor{app}));
    FlagVisitor visitor{app};
    visitor("metric", command->options.metric, "what paths between corresponding vertices minimise",
            Choices{"euclidean", "segment", "combined"});
    visitor("spikes", command->options.spikes, "prune spikes of an outline, avoid used vertices while tracing it, or keep them",
            Choices{"prune", "avoid", "keep"});
    visitor("rounding", command->options.rounding,
            "faces that the true outline crosses: as the paths leave them (path), to the side that holds most of them (area), or "
            "so that area and "
            "perimeter are met as well (balanced)",
            Choices{"path", "area", "balanced"});
    visitor("cover", command->options.cover,
            "the transferred region overlaps the source region, encloses it or is enclosed by it",
            Choices{"overlapping", "enclosing", "enclosed"});
    app->add_flag("--refine", command->options.refine,
                  "insert vertices on the target so that outlines are exact (with --refined-mesh)");
    app->add_flag("--force", command->options.force, "go on although the meshes differ in size or position");
    add_flags(app, command->reading);
}

}  // namespace ostraka::app

// ostraka deform: an edit of a shape that keeps what its annotations and relations ask for.
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/semantic/deform.h"

#include <chrono>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Deform {
    std::string mesh, annotations, edit, output, cage, weights, graph, annotations_out, cage_out;
    DeformOptions options;
    RelationOptions tolerances;
    bool states = false;

    int run(const Session& session) {
        check_options(options, "deform");
        check_options(tolerances, "deform");
        if (cage.empty() != weights.empty()) fail_usage("--cage and --weights belong together", "give both: see 'cage weights'");
        if (cage.empty() && !cage_out.empty()) fail_usage("--cage-out without --cage", "add --cage and --weights");
        std::vector<Path> inputs{mesh, annotations, edit}, outputs{output};
        for (const std::string& file : {cage, weights, graph})
            if (!file.empty()) inputs.emplace_back(file);
        for (const std::string& file : {annotations_out, cage_out})
            if (!file.empty()) outputs.emplace_back(file);
        const Json steps = read_json(edit);
        validate(steps, "edit", edit);
        std::vector<Path> state_files;
        if (states)
            for (rapidjson::SizeType i = 0; i < steps["steps"].Size(); ++i) {
                const Path path(output);
                state_files.push_back(path.parent_path() /
                                      (path.stem().string() + "-step" + std::to_string(i + 1) + path.extension().string()));
                outputs.push_back(state_files.back());
            }
        check_outputs(inputs, outputs);
        Provenance provenance{"deform", list_options(options), {}};
        for (auto& option : list_options(tolerances)) provenance.options.push_back(std::move(option));
        for (const Path& input : inputs) provenance.add_input(input);

        const auto start = std::chrono::steady_clock::now();
        const MeshFile object = read_mesh(mesh);
        AnnotationSet set = read_annotations(annotations, object.mesh);
        MeshFile around;
        Coordinates coordinates;
        HandleSpace space{object.mesh, set};
        if (!cage.empty()) {
            around = read_mesh(cage);
            coordinates = read_coordinates(weights, object.mesh, around.mesh);
            space.cage = &around.mesh;
            space.coordinates = &coordinates;
        }
        RelationGraph relations;
        if (!graph.empty()) relations = read_graph(graph, set);
        const DeformResult result = deform(space, relations, steps, edit, options, tolerances);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

        Mesh shaped = object.mesh;
        for (const Vertex v : shaped.vertices()) shaped.point(v) = result.points[v];
        write_mesh(output, shaped, object.extras);
        if (states) {
            const auto followed = follow_edit(steps, space, edit);
            for (std::size_t i = 0; i < followed.size(); ++i) {
                const auto points = cage.empty() ? followed[i].handles : deformed(coordinates, around.mesh, followed[i].handles);
                Mesh state = object.mesh;
                for (const Vertex v : state.vertices()) state.point(v) = points[v];
                write_mesh(state_files[i], state, object.extras);
            }
        }
        if (!cage_out.empty()) {
            for (const Vertex v : around.mesh.vertices()) around.mesh.point(v) = result.cage[v];
            write_mesh(cage_out, around.mesh, around.extras);
        }
        if (!annotations_out.empty()) {
            const auto refreshed = refresh_measures(shaped, set);
            for (const auto& note : refreshed.notes) session.note("note: " + note);
            write_annotations(annotations_out, set, shaped, Path(output).filename().string(), provenance);
        }
        print(session, provenance, result, seconds);
        return result.acceptable ? done : answer_is_no;
    }

private:
    static void print(const Session& session, const Provenance& provenance, const DeformResult& result, double seconds) {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue report(rapidjson::kObjectType), list(rapidjson::kArrayType), run(rapidjson::kObjectType);
        std::vector<std::vector<std::string>> rows;
        for (const ConstraintReport& constraint : result.constraints) {
            JsonValue entry(rapidjson::kObjectType), deviations(rapidjson::kArrayType), residual(rapidjson::kObjectType);
            add_member(entry, "id", JsonValue(constraint.id), allocator);
            add_member(entry, "type", constraint.type, allocator);
            add_member(entry, "weight", JsonValue(constraint.weight), allocator);
            add_member(entry, "hard", JsonValue(constraint.hard), allocator);
            add_member(entry, "used", JsonValue(constraint.used), allocator);
            add_member(entry, "before", to_string(constraint.before), allocator);
            add_member(entry, "verdict", to_string(constraint.verdict), allocator);
            add_member(entry, "text", constraint.text, allocator);
            std::string words;
            for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
                const Deviation& d = constraint.deviations[i];
                JsonValue deviation(rapidjson::kObjectType);
                const double before = i < constraint.before_values.size() ? constraint.before_values[i] : 0;
                add_member(deviation, "quantity", d.quantity, allocator);
                add_member(deviation, "before", JsonValue(before), allocator);
                add_member(deviation, "value", JsonValue(*d.value), allocator);
                add_member(deviation, "tolerance", JsonValue(*d.tolerance), allocator);
                add_member(deviation, "unit", d.unit, allocator);
                deviations.PushBack(deviation, allocator);
                words += (words.empty() ? "" : "; ") + d.quantity + " " + number(*d.value, 4) + " (was " + number(before, 4) +
                         ", at most " + number(*d.tolerance, 4) + ")" + (d.unit.empty() ? "" : " " + d.unit);
            }
            if (!constraint.text.empty()) words += (words.empty() ? "" : "; ") + constraint.text;
            add_member(entry, "deviations", std::move(deviations), allocator);
            for (const auto& [name, value] : {std::pair{"mean", constraint.mean},
                                              {"median", constraint.median},
                                              {"min", constraint.least},
                                              {"max", constraint.most}})
                add_member(residual, name, JsonValue(value), allocator);
            add_member(residual, "constraints", JsonValue(static_cast<std::uint64_t>(constraint.low_level)), allocator);
            add_member(entry, "residual", std::move(residual), allocator);
            list.PushBack(entry, allocator);
            rows.push_back({std::to_string(constraint.id), constraint.type,
                            number(constraint.weight) + (constraint.hard ? ", hard" : ""),
                            constraint.used ? to_string(constraint.verdict) : "left out", words});
        }
        add_member(report, "acceptable", JsonValue(result.acceptable), allocator);
        add_member(report, "iterations", JsonValue(result.summary.iterations), allocator);
        add_member(report, "rounds", JsonValue(result.rounds), allocator);
        add_member(report, "stopped", result.solved ? std::string(describe(result.summary.stop)) : "nothing to solve", allocator);
        add_member(report, "constraints", std::move(list), allocator);
        add_member(run, "seconds", JsonValue(seconds), allocator);
        if (session.json) {
            session.print_report(provenance, document, report, &run);
            return;
        }
        if (!rows.empty()) std::cout << table({"id", "constraint", "weight", "verdict", "how well"}, rows);
        if (result.solved)
            std::cout << (result.rounds > 0 ? std::to_string(result.rounds) + (result.rounds == 1 ? " round" : " rounds") +
                                                  " for the hard constraints, the last with "
                                            : "")
                      << result.summary.iterations << (result.summary.iterations == 1 ? " iteration: " : " iterations: ")
                      << describe(result.summary.stop) << '\n';
        std::cout << (result.constraints.empty() ? "no constraints"
                      : result.acceptable        ? "acceptable: every constraint holds"
                                                 : "not acceptable: a constraint does not hold")
                  << '\n';
    }
};

}  // namespace

void add_deform(CLI::App& tool, Session& session) {
    const auto deform = std::make_shared<Deform>();
    CLI::App* command =
        session.add(tool, "deform", "edit a shape so that its meaning survives (exit code 3: a constraint does not hold)",
                    [&session, deform] { return deform->run(session); });
    command->add_option("mesh", deform->mesh, "mesh file")->required();
    command->add_option("annotations", deform->annotations, "its annotations (.ant.json)")->required();
    command->add_option("edit", deform->edit, "what is done to the handles (.edit.json)")->required();
    command->add_option("output", deform->output, "deformed mesh to write")->required();
    command->add_option("--graph", deform->graph, "relationships (.graph.json): those that are constraints are kept");
    command->add_option("--cage", deform->cage, "cage whose vertices are the handles; without it, the mesh's own are");
    command->add_option("--weights", deform->weights, "weights of 'cage weights' (.npy)");
    command->add_option("--annotations-out", deform->annotations_out, "annotations of the deformed mesh, measures taken anew");
    command->add_flag("--states", deform->states,
                      "also write the shape after each step of the edit, before constraints: output-step1 ...");
    command->add_option("--cage-out", deform->cage_out, "the cage after the deformation");
    add_flags(command, deform->options);
    add_flags(command, deform->tolerances);
}

}  // namespace ostraka::app

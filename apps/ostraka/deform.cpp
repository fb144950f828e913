// ostraka deform: an edit of a shape that keeps what its annotations and relations ask for.
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/bundle/template.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/semantic/deform.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace ostraka::app {

namespace {

/// What is deformed, from files of its own or from a template.
struct Subject {
    MeshFile object, around;
    AnnotationSet set;
    RelationGraph relations;
    std::optional<Coordinates> coordinates;
    [[nodiscard]] HandleSpace space() const {
        return {object.mesh, set, coordinates ? &around.mesh : nullptr, coordinates ? &*coordinates : nullptr};
    }
};

struct Deform {
    std::vector<std::string> files;
    std::string cage, weights, graph, annotations_out, cage_out;
    DeformOptions options;
    RelationOptions tolerances;
    bool states = false;

    int run(const Session& session) {
        check_options(options, "deform");
        check_options(tolerances, "deform");
        if (files.size() != 3 && files.size() != 4)
            fail_usage(std::to_string(files.size()) + " files are given",
                       "give MESH ANNOTATIONS EDIT OUTPUT, or TEMPLATE EDIT OUTPUT");
        if (cage.empty() != weights.empty()) fail_usage("--cage and --weights belong together", "give both: see 'cage weights'");
        const Path output = files.back(), edit = files[files.size() - 2];
        std::optional<TemplateFile> bundle;
        if (files.size() == 3) bundle = read_template(files[0]);
        std::vector<Path> inputs(files.begin(), files.end() - 1), outputs{output};
        if (bundle)
            for (const TemplatePart& part : bundle->parts) inputs.push_back(part.file);
        for (const std::string& file : {cage, weights, graph})
            if (!file.empty()) inputs.emplace_back(file);
        // Weights are several files.
        std::vector<Path> sets;
        if (!weights.empty()) sets.emplace_back(weights);
        if (bundle)
            for (const TemplatePart* part : bundle->of("coordinates")) sets.push_back(part->file);
        for (const Path& file : sets)
            for (const Path& companion : {coordinate_header_file(file), normal_weights_file(file)})
                if (std::filesystem::exists(companion)) inputs.push_back(companion);
        for (const std::string& file : {annotations_out, cage_out})
            if (!file.empty()) outputs.emplace_back(file);
        const Json steps = read_json(edit);
        validate(steps, "edit", edit);
        std::vector<Path> state_files;
        if (states)
            for (rapidjson::SizeType i = 0; i < steps["steps"].Size(); ++i) {
                state_files.push_back(output.parent_path() /
                                      (output.stem().string() + "-step" + std::to_string(i + 1) + output.extension().string()));
                outputs.push_back(state_files.back());
            }
        check_outputs(inputs, outputs);
        Provenance provenance{"deform", list_options(options), {}};
        for (auto& option : list_options(tolerances)) provenance.options.push_back(std::move(option));
        for (const Path& input : inputs) provenance.add_input(input);

        const auto start = std::chrono::steady_clock::now();
        Subject subject = bundle ? from_template(*bundle) : from_files();
        if (!cage_out.empty() && !subject.coordinates)
            fail_usage("--cage-out without a cage", "add --cage and --weights, or a cage and its coordinates to the template");
        const std::string graph_name = !graph.empty() ? graph : "the template's graph";
        const DeformResult result =
            deform(subject.space(), subject.relations, steps, edit.string(), options, tolerances, graph_name);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

        const auto with = [](const MeshFile& file, const std::vector<Point>& points) {
            Mesh mesh = file.mesh;
            for (const Vertex v : mesh.vertices()) mesh.point(v) = points[v];
            return mesh;
        };
        const Mesh shaped = with(subject.object, result.points);
        write_mesh(output, shaped, subject.object.extras);
        if (states) {
            const auto followed = follow_edit(steps, subject.space(), edit.string());
            for (std::size_t i = 0; i < followed.size(); ++i)
                write_mesh(state_files[i],
                           with(subject.object, subject.coordinates
                                                    ? deformed(*subject.coordinates, subject.around.mesh, followed[i].handles)
                                                    : followed[i].handles),
                           subject.object.extras);
        }
        if (!cage_out.empty()) write_mesh(cage_out, with(subject.around, result.cage), subject.around.extras);
        if (!annotations_out.empty()) {
            const auto refreshed = refresh_measures(shaped, subject.set);
            for (const auto& note : refreshed.notes) session.note("note: " + note);
            write_annotations(annotations_out, subject.set, shaped, output.filename().string(), provenance);
        }
        // Constraints say nothing of what else became of the surface.
        const auto crossings = [](const Mesh& mesh) { return self_intersections(to_soup(mesh), 100'000).pairs.size(); };
        const std::size_t crossing = crossings(shaped), before = crossing > 0 ? crossings(subject.object.mesh) : 0;
        if (crossing > before)
            session.note("note: the deformed surface crosses itself in " + std::to_string(crossing) + " pairs of faces (" +
                         std::to_string(before) + " before): look at it; 'mesh info' tells where");
        for (std::size_t i = 0; i < result.selected.size(); ++i)
            session.note("step " + std::to_string(i + 1) + ": " + std::to_string(result.selected[i]) + " of " +
                         std::to_string(subject.coordinates ? subject.around.mesh.number_of_vertices()
                                                            : subject.object.mesh.number_of_vertices()) +
                         (subject.coordinates ? " cage vertices" : " vertices"));
        print(session, provenance, result, seconds, crossing);
        return result.acceptable ? done : answer_is_no;
    }

private:
    Subject from_files() const {
        Subject subject;
        subject.object = read_mesh(files[0]);
        subject.set = read_annotations(files[1], subject.object.mesh);
        take_flags(subject);
        return subject;
    }

    Subject from_template(const TemplateFile& bundle) const {
        Template loaded = load_template(bundle);
        for (const Finding& finding : loaded.findings)
            if (finding.defect) fail_input(files[0] + ", " + finding.where, finding.text, "mend it: 'template check' tells all");
        if (!loaded.mesh) fail_input(files[0], "has no mesh", "pack one");
        if (!loaded.annotations) fail_input(files[0], "has no annotations", "pack them, or give a mesh and its annotations");
        Subject subject;
        subject.object = std::move(*loaded.mesh);
        subject.set = std::move(*loaded.annotations);
        if (loaded.graph) subject.relations = std::move(*loaded.graph);
        // The first cage that has coordinates.
        const auto cages = bundle.of("cage");
        std::string why_not;
        for (std::size_t i = 0; i < cages.size() && cage.empty() && !subject.coordinates; ++i)
            for (const TemplatePart* part : bundle.of("coordinates")) {
                if (subject.coordinates || !loaded.cages[i]) continue;
                try {
                    subject.coordinates = read_coordinates(part->file, subject.object.mesh, *loaded.cages[i]);
                    subject.around.mesh = *loaded.cages[i];
                } catch (const Error& error) {
                    why_not = error.what();  // those of another cage, perhaps
                }
            }
        if (cage.empty() && !subject.coordinates && !why_not.empty())
            fail_input(files[0], "has a cage and coordinates that do not go together: " + why_not,
                       "make them anew with 'cage weights', or give --cage and --weights");
        take_flags(subject);
        return subject;
    }

    void take_flags(Subject& subject) const {
        if (!cage.empty()) {
            subject.around = read_mesh(cage);
            subject.coordinates = read_coordinates(weights, subject.object.mesh, subject.around.mesh);
        }
        if (!graph.empty()) subject.relations = read_graph(graph, subject.set);
    }

    static JsonValue to_json(const Deviation& d, std::optional<double> before, JsonAllocator& allocator) {
        JsonValue deviation(rapidjson::kObjectType);
        add_member(deviation, "quantity", d.quantity, allocator);
        if (before) add_member(deviation, "before", JsonValue(*before), allocator);
        add_member(deviation, "value", JsonValue(*d.value), allocator);
        add_member(deviation, "tolerance", JsonValue(*d.tolerance), allocator);
        add_member(deviation, "unit", d.unit, allocator);
        return deviation;
    }

    /// What fights with what, in a sentence each.
    static std::vector<std::string> words_of(const DeformResult& result) {
        std::vector<std::string> lines;
        const auto name = [&](int id) {
            for (const ConstraintReport& report : result.constraints)
                if (report.id == id) return std::to_string(id) + " (" + report.type + ")";
            return std::to_string(id);
        };
        for (const ConstraintConflict& conflict : result.conflicts) {
            std::string freed, gives;
            for (const int id : conflict.freed) freed += (freed.empty() ? "" : ", ") + name(id);
            for (const Deviation& d : conflict.deviations)
                if (*d.value > *d.tolerance)
                    gives += (gives.empty() ? "" : "; ") + d.quantity + " " + number(*d.value, 4) + " instead of at most " +
                             number(*d.tolerance, 4) + (d.unit.empty() ? "" : " " + d.unit);
            lines.push_back(name(conflict.id) + " fights with " + freed + ": if " + std::to_string(conflict.id) +
                            " is left out, " + (conflict.freed.size() == 1 ? "the other holds" : "the others hold") +
                            (gives.empty() ? ", and so does " + std::to_string(conflict.id)
                                           : "; " + std::to_string(conflict.id) + " would have to give: " + gives));
        }
        if (result.untried > 0)
            lines.push_back(std::to_string(result.untried) +
                            " constraints were not left out to see: raise --conflicts to try them");
        return lines;
    }

    static void print(const Session& session, const Provenance& provenance, const DeformResult& result, double seconds,
                      std::size_t crossing) {
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
                const double before = i < constraint.before_values.size() ? constraint.before_values[i] : 0;
                deviations.PushBack(to_json(d, before, allocator), allocator);
                words += (words.empty() ? "" : "; ") + d.quantity + " " + number(*d.value, 4) + " (was " + number(before, 4) +
                         ", at most " + number(*d.tolerance, 4) + ")" + (d.unit.empty() ? "" : " " + d.unit);
            }
            if (!constraint.text.empty()) words += (words.empty() ? "" : "; ") + constraint.text;
            add_member(entry, "deviations", std::move(deviations), allocator);
            for (const auto& [name, value] : {std::pair{"mean", constraint.mean},
                                              {"median", constraint.median},
                                              {"min", constraint.least},
                                              {"max", constraint.most},
                                              {"greatest distance", constraint.distance}})
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
        add_member(report, "stopped", result.passes > 0 ? std::string(describe(result.summary.stop)) : "nothing to solve",
                   allocator);
        add_member(report, "passes", JsonValue(result.passes), allocator);
        add_member(report, "constraints", std::move(list), allocator);
        JsonValue conflicts(rapidjson::kArrayType);
        for (const ConstraintConflict& conflict : result.conflicts) {
            JsonValue entry(rapidjson::kObjectType), freed(rapidjson::kArrayType), deviations(rapidjson::kArrayType);
            for (const int id : conflict.freed) freed.PushBack(id, allocator);
            for (const Deviation& d : conflict.deviations) deviations.PushBack(to_json(d, {}, allocator), allocator);
            add_member(entry, "id", JsonValue(conflict.id), allocator);
            add_member(entry, "freed", std::move(freed), allocator);
            add_member(entry, "deviations", std::move(deviations), allocator);
            conflicts.PushBack(entry, allocator);
        }
        add_member(report, "conflicts", std::move(conflicts), allocator);
        add_member(report, "selfIntersections", JsonValue(static_cast<std::uint64_t>(crossing)), allocator);
        add_member(run, "seconds", JsonValue(seconds), allocator);
        if (session.json) {
            session.print_report(provenance, document, report, &run);
            return;
        }
        if (!rows.empty()) std::cout << table({"id", "constraint", "weight", "verdict", "how well"}, rows);
        if (result.passes > 0)
            std::cout << (result.rounds > 0 ? std::to_string(result.rounds) + (result.rounds == 1 ? " round" : " rounds") +
                                                  " for the hard constraints, the last with "
                                            : "")
                      << result.summary.iterations << (result.summary.iterations == 1 ? " iteration: " : " iterations: ")
                      << describe(result.summary.stop)
                      << (result.passes > 1 ? "; " + std::to_string(result.passes) + " passes" : "") << '\n';
        for (const std::string& line : words_of(result)) std::cout << line << '\n';
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
    command
        ->add_option(
            "files", deform->files,
            "MESH ANNOTATIONS EDIT OUTPUT, or TEMPLATE EDIT OUTPUT: a mesh file and its annotations (.ant.json), or a "
            "template (.template.json) with its graph, cage and coordinates; the edit (.edit.json); the deformed mesh to "
            "write")
        ->required()
        ->expected(-1);
    command->add_option("--graph", deform->graph,
                        "relationships (.graph.json): those that are constraints are kept; instead of the template's");
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

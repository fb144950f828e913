// ostraka template sample | propagate
#include "template_class.h"

#include "ostraka/family/propagate.h"
#include "ostraka/family/sample.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

std::string padded(std::size_t number, std::size_t most) {
    std::string text = std::to_string(number);
    return std::string(std::to_string(most).size() - text.size(), '0') + text;
}

struct Draw {
    std::string file, output;
    SampleOptions options;

    int run(const Session& session) const {
        check_options(options, "sample");
        Provenance provenance{"template sample", list_options(options), {}};
        const ShapeClass learnt = read_class(file);
        provenance.add_input(file);
        const LoadedTemplate loaded = load_class_template(learnt.template_file, provenance);
        check_topology(learnt, file, loaded.mesh, learnt.template_file);
        const Sampling result = sample_class(learnt, loaded.known(), options);
        make_folder(output);
        OutputTransaction transaction;
        WriteOptions how;
        how.comment = provenance.to_line();
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue report = report_of(learnt, result, allocator);
        for (std::size_t i = 0; i < result.samples.size(); ++i) {
            const std::string name = name_of(learnt, i, result.samples.size());
            const Mesh mesh = with_points(loaded.mesh, result.samples[i].points);
            write_mesh(Path(output) / (name + ".ply"), mesh, {}, how);
            AnnotationSet set;
            set.object_class = loaded.set.object_class;
            set.unit = loaded.set.unit;
            set.up = loaded.set.up;
            set.annotations = loaded.set.annotations;
            static_cast<void>(refresh_measures(mesh, set));
            write_annotations(Path(output) / (name + ".ant.json"), set, mesh, name + ".ply", provenance);
        }
        Json written;
        written.CopyFrom(report, written.GetAllocator());
        add_member(written, "provenance", provenance.to_json(written.GetAllocator()), written.GetAllocator());
        write_json(Path(output) / (learnt.name + ".samples.json"), written);
        transaction.commit();
        if (session.json) session.print_report(provenance, document, report);
        else print(learnt, result);
        return result.samples.size() == static_cast<std::size_t>(options.count) ? done : answer_is_no;
    }

private:
    static std::string name_of(const ShapeClass& learnt, std::size_t i, std::size_t count) {
        return learnt.name + "-" + padded(i + 1, count);
    }

    static JsonValue report_of(const ShapeClass& learnt, const Sampling& result, JsonAllocator& allocator) {
        const auto count = [](std::size_t n) { return JsonValue(static_cast<std::uint64_t>(n)); };
        JsonValue report(rapidjson::kObjectType), samples(rapidjson::kArrayType), rejected(rapidjson::kObjectType),
            examples(rapidjson::kArrayType);
        add_member(report, "format", "ostraka-samples", allocator);
        add_member(report, "version", JsonValue(1), allocator);
        add_member(report, "class", learnt.name, allocator);
        add_member(report, "tried", count(result.tried), allocator);
        add_member(report, "accepted", count(result.samples.size()), allocator);
        add_member(report, "acceptance", JsonValue(result.acceptance()), allocator);
        add_member(rejected, "constraints", count(result.by_constraints), allocator);
        add_member(rejected, "ranges", count(result.by_ranges), allocator);
        add_member(rejected, "selfIntersections", count(result.by_intersections), allocator);
        add_member(report, "rejected", std::move(rejected), allocator);
        for (const std::string& text : result.examples) examples.PushBack(json_string(text, allocator), allocator);
        add_member(report, "examples", std::move(examples), allocator);
        add_member(report, "diversity", JsonValue(result.diversity), allocator);
        add_member(report, "diversityOfMembers", JsonValue(result.of_members), allocator);
        for (std::size_t i = 0; i < result.samples.size(); ++i) {
            const ClassSample& sample = result.samples[i];
            JsonValue item(rapidjson::kObjectType), list(rapidjson::kArrayType);
            add_member(item, "name", name_of(learnt, i, result.samples.size()), allocator);
            add_member(item, "moved", JsonValue(sample.moved), allocator);
            for (const double b : sample.coefficients) list.PushBack(b, allocator);
            if (!sample.coefficients.empty()) add_member(item, "coefficients", std::move(list), allocator);
            JsonValue edits(rapidjson::kArrayType);
            for (const std::string& text : sample.edits) edits.PushBack(json_string(text, allocator), allocator);
            if (!sample.edits.empty()) add_member(item, "edits", std::move(edits), allocator);
            samples.PushBack(item, allocator);
        }
        add_member(report, "samples", std::move(samples), allocator);
        return report;
    }

    static void print(const ShapeClass& learnt, const Sampling& result) {
        std::cout << result.samples.size() << " of " << result.tried << " draws of '" << printable(learnt.name) << "' accepted ("
                  << number(100 * result.acceptance(), 3) << " %); rejected by constraints " << result.by_constraints
                  << ", by learnt ranges " << result.by_ranges << ", by self-intersections " << result.by_intersections << '\n';
        for (const std::string& text : result.examples) std::cout << "  such as: " << printable(text) << '\n';
        if (result.samples.size() < 2) std::cout << "no diversity: it is the mean distance of two; that of the members ";
        else
            std::cout << "diversity (mean distance of two) " << number(100 * result.diversity, 3)
                      << " % of the mean size, that of the members ";
        std::cout << number(100 * result.of_members, 3) << " %\n";
    }
};

struct Propagate {
    std::vector<std::string> files;
    std::string output;
    PropagateOptions options;
    bool given = false;

    int run(const Session& session) {
        if (given) options.correspondence = "given";
        check_options(options.fit, "propagate");
        if (files.size() < 2) fail_usage("there is no member", "give TEMPLATE MEMBER ...");
        const std::vector<std::string> members(files.begin() + 1, files.end());
        check_names(members);
        Provenance provenance{"template propagate", list_options(options.fit), {}};
        provenance.options.emplace_back("correspondence", options.correspondence);
        const LoadedTemplate loaded = load_class_template(files[0], provenance);
        if (loaded.set.annotations.empty())
            fail_input(files[0], "has no annotations", "pack them: there is nothing to propagate");
        make_folder(output);
        std::vector<Path> inputs{files[0]}, outputs;
        for (const std::string& file : members) {
            const std::string name = object_name(file);
            inputs.emplace_back(file);
            const Path beside = Path(file).parent_path() / (name + ".ant.json");
            if (std::filesystem::exists(beside)) inputs.push_back(beside);
            for (const char* ending : {".ant.json", ".fitted.ply", ".fitted.ant.json"})
                outputs.push_back(Path(output) / (name + ending));
        }
        check_outputs(inputs, outputs);
        OutputTransaction transaction;
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue report(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        bool all = true;
        for (const std::string& file : members) {
            Provenance own = provenance;
            const WholeObject member = read_member(file, own);
            const Propagated result = in_file(file, [&] { return propagate(loaded.known(), member, options); });
            JsonValue item(rapidjson::kObjectType), notes(rapidjson::kArrayType);
            add_member(item, "name", member.name, allocator);
            if (result.fit.problem.empty()) {
                write(file, loaded, member, result, own);
                add_member(item, "placedBy", result.fit.placed_by, allocator);
                add_member(item, "annotations", JsonValue(static_cast<std::uint64_t>(result.on_member->annotations.size())),
                           allocator);
                add_member(item, "liesOn", JsonValue(result.lies_on), allocator);
            } else {
                add_member(item, "problem", result.fit.problem, allocator);
            }
            add_member(item, "lost", JsonValue(static_cast<std::uint64_t>(result.lost)), allocator);
            if (result.fit.residuals) {
                const FitResiduals& r = *result.fit.residuals;
                add_member(item, "distance", JsonValue(r.distance), allocator);
                add_member(item, "distanceBack", JsonValue(r.back), allocator);
                add_member(item, "unmatched", JsonValue(r.unmatched), allocator);
                add_member(item, "unexplained", JsonValue(r.unexplained), allocator);
                add_member(item, "stretch", JsonValue(r.stretch), allocator);
                add_member(item, "bend", JsonValue(r.bend), allocator);
            }
            all = all && result.complete();
            for (const std::string& note : result.notes) notes.PushBack(json_string(note, allocator), allocator);
            add_member(item, "notes", std::move(notes), allocator);
            list.PushBack(item, allocator);
            const auto residual = [&](double FitResiduals::*value) {
                return result.fit.residuals ? number(100 * (*result.fit.residuals).*value, 3) : std::string("-");
            };
            rows.push_back(
                {printable(member.name), result.fit.problem.empty() ? result.fit.placed_by : "left out",
                 residual(&FitResiduals::distance), residual(&FitResiduals::unmatched), residual(&FitResiduals::unexplained),
                 result.on_member ? std::to_string(result.on_member->annotations.size()) : "-", std::to_string(result.lost),
                 std::to_string(result.notes.size()), result.lies_on ? printable(result.fit.problem) : "does not lie on it"});
            for (const std::string& note : result.notes) session.note(printable(member.name) + ": " + printable(note));
        }
        add_member(report, "members", std::move(list), allocator);
        transaction.commit();
        if (session.json) session.print_report(provenance, document, report);
        else
            std::cout << table(
                {"member", "laid on by", "distance %", "unmatched %", "unexplained %", "annotations", "lost", "notes", ""}, rows);
        return all ? done : answer_is_no;
    }

private:
    void write(const std::string& file, const LoadedTemplate& loaded, const WholeObject& member, const Propagated& result,
               const Provenance& provenance) const {
        const Path folder(output);
        const Mesh fitted = with_points(loaded.mesh, result.fit.points);
        WriteOptions how;
        how.comment = provenance.to_line();
        write_mesh(folder / (member.name + ".fitted.ply"), fitted, {}, how);
        write_annotations(folder / (member.name + ".fitted.ant.json"), result.on_template, fitted, member.name + ".fitted.ply",
                          provenance);
        write_annotations(folder / (member.name + ".ant.json"), *result.on_member, member.mesh, Path(file).filename().string(),
                          provenance);
    }
};

}  // namespace

void add_template_sample(CLI::App& bundle, Session& session) {
    const auto draw = std::make_shared<Draw>();
    CLI::App* command = session.add(
        bundle, "sample", "draw new members of a class, kept where its constraints hold (exit code 3: fewer than wanted)",
        [&session, draw] { return draw->run(session); });
    command->add_option("class", draw->file, "class (.class.json), as 'template learn' writes it")->required();
    command->add_option("--output", draw->output, "folder for meshes, annotations and NAME.samples.json; made if it is missing");
    add_flags(command, draw->options);

    const auto spread = std::make_shared<Propagate>();
    command =
        session.add(bundle, "propagate",
                    "lay a template onto members of its class and carry its annotations to them (exit code 3: some are lost, or "
                    "the template does not lie on a member)",
                    [&session, spread] { return spread->run(session); });
    command->add_option("files", spread->files, "the template (.template.json), then a mesh file for each member")
        ->required()
        ->expected(-1);
    command->add_option("--output", spread->output,
                        "folder for NAME.ant.json, NAME.fitted.ply and NAME.fitted.ant.json; made if it is missing");
    command->add_flag("--given", spread->given, "all members have the template's triangles");
    add_flags(command, spread->options.fit);
}

}  // namespace ostraka::app

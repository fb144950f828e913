// ostraka fit: from fragments to the whole object.
#include "command.h"
#include "turns_text.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/bundle/template.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/family/class_file.h"
#include "ostraka/family/fragment_thresholds.h"
#include "ostraka/fitting/assembly.h"
#include "ostraka/fitting/fragment_file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <set>

namespace ostraka::app {

namespace {

namespace fs = std::filesystem;

struct Fit {
    std::vector<std::string> files;
    std::string output, assembly, class_file;
    ReconstructOptions options;
    FragmentFileOptions reading;
    bool placed = false, fresh = false;
    std::function<bool(const std::string&)> told = {};  ///< whether a flag was given

    int run(const Session& session) {
        check_options(options, "fit");
        check_options(reading, "fit");
        if (files.size() < 2) fail_usage("there is no fragment", "give TEMPLATE FRAGMENT ...");
        if (output.empty()) fail_usage("there is no folder to write to", "give --output FOLDER");
        const TemplateFile bundle = read_template(files[0]);
        Provenance provenance{"fit", list_options(options), {}};
        for (auto& option : list_options(reading)) provenance.options.push_back(std::move(option));
        const auto take = [&](const Path& file) {
            provenance.add_input(file);
            inputs.push_back(file);
        };
        take(files[0]);
        for (const TemplatePart& part : bundle.parts) take(part.file);
        Template loaded = load_template(bundle);
        for (const Finding& finding : loaded.findings)
            if (finding.defect) fail_input(files[0] + ", " + finding.where, finding.text, "mend it: 'template check' tells all");
        if (!loaded.mesh) fail_input(files[0], "has no mesh", "pack one");
        if (!loaded.annotations) fail_input(files[0], "has no annotations", "pack them: what is common is found by them");
        const Json said = assembly.empty() ? Json() : read_json(assembly);
        if (!assembly.empty()) {
            validate(said, "assembly", assembly);
            take(assembly);
        }

        AssemblyNames names{Path(files[0]).filename().string(), {}};
        std::vector<Fragment> fragments(files.size() - 1);
        std::vector<const Fragment*> pointers;
        std::vector<std::vector<StatedMatch>> stated;
        std::set<std::string> taken;
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            read(files[k + 1], fragments[k], provenance, session);
            if (!taken.insert(fragments[k].name).second)
                fail_usage("two fragments are called '" + printable(fragments[k].name) + "'", "rename one of the files");
            names.fragments.push_back(fragments[k].name);
            pointers.push_back(&fragments[k]);
            stated.push_back(assembly.empty() ? std::vector<StatedMatch>()
                                              : stated_matches(said, fragments[k], *loaded.annotations, assembly));
        }
        if (!assembly.empty())
            for (const std::string& name : unused_statements(said, names.fragments))
                session.note("note: " + assembly + " states matches of '" + printable(name) + "', which is no fragment here");
        for (std::size_t k = 0; k < fragments.size(); ++k)
            if (const std::string& ours = loaded.annotations->unit, &theirs = fragments[k].annotations.unit;
                !ours.empty() && !theirs.empty() && ours != theirs)
                fail_input(files[k + 1], "is in " + printable(theirs) + ", and the template in " + printable(ours),
                           "bring all files to one unit");
        const RelationGraph graph = loaded.graph ? std::move(*loaded.graph) : RelationGraph();
        std::optional<ShapePrior> prior;
        if (!class_file.empty()) {
            const ShapeClass learnt = read_class(class_file);
            take(class_file);
            check_topology(learnt, class_file, loaded.mesh->mesh, files[0]);
            prior = prior_of(learnt.modes);
            if (learnt.modes.variances.empty())
                session.note("note: " + class_file +
                             " has no modes (one member, or all of one shape): its mean shape alone counts");
            take_thresholds(learnt);
            provenance.options = list_options(options);
            for (auto& option : list_options(reading)) provenance.options.push_back(std::move(option));
        }
        std::optional<TemplateCage> cage;
        if (options.fit.space != "mesh") {
            if (prior)
                fail_usage("--class changes the template's shape, and its cage does not follow", "leave --class or --space out");
            cage = cage_of(bundle, loaded, session);
        }
        Reconstructor reconstructor(loaded.mesh->mesh, *loaded.annotations, graph, options, prior ? &*prior : nullptr,
                                    cage ? &*cage : nullptr);
        for (std::size_t k = 0; k < pointers.size(); ++k) reconstructor.add(*pointers[k], std::move(stated[k]));
        PoseSearches& searches = reconstructor.searches();
        if (!fresh) remember(searches, session);
        const Reconstruction result = reconstructor.run();
        if (searches.reused() > 0)
            session.note("note: " + std::to_string(searches.reused()) + " of " +
                         std::to_string(searches.reused() + searches.made()) +
                         " searches of poses are those of an earlier fit in " + printable(output) +
                         ": template, fragment and options are the same");
        if (const double scale = result.placement.scale;
            result.placement.any() && (scale > options.placement.unit_ratio || scale * options.placement.unit_ratio < 1))
            session.note("note: the template is scaled by " + number(scale, 4) + ": are all files in one unit?");
        write(*loaded.mesh, *loaded.annotations, fragments, names, result, searches, provenance, session);
        print(session, provenance, names, result);
        return result.verdict == Compatibility::compatible ? done : answer_is_no;
    }

private:
    std::vector<Path> inputs;
    std::vector<FragmentThreshold> learnt_thresholds;  ///< those that hold because the class says so

    /// What the class's members show takes the place of the defaults, not of what is told. What scans and measuring leave is not
    /// seen on members: a constraint may always be off by the default.
    void take_thresholds(const ShapeClass& learnt) {
        for (FragmentThreshold& threshold : fragment_thresholds(learnt)) {
            double& value = threshold.option == "residual"          ? options.residual
                            : threshold.option == "scale-tolerance" ? options.scale_tolerance
                                                                    : options.slack;
            if (told("--" + threshold.option) || (threshold.option == "slack" && threshold.value < value)) continue;
            value = std::min(threshold.value, threshold.option == "residual" ? 10.0 : 1000.0);
            threshold.value = value;
            learnt_thresholds.push_back(std::move(threshold));
        }
    }

    /// Which thresholds the verdict went by, and where they are from.
    [[nodiscard]] JsonValue thresholds_to_json(JsonAllocator& allocator) const {
        JsonValue list(rapidjson::kArrayType);
        for (const auto& [name, value] :
             {std::pair{"residual", options.residual}, {"scale-tolerance", options.scale_tolerance}, {"slack", options.slack}}) {
            JsonValue one(rapidjson::kObjectType);
            const auto found = std::find_if(learnt_thresholds.begin(), learnt_thresholds.end(),
                                            [&, &name = name](const FragmentThreshold& each) { return each.option == name; });
            const bool by_class = found != learnt_thresholds.end();
            add_member(one, "option", name, allocator);
            add_member(one, "value", JsonValue(value), allocator);
            add_member(one, "from", by_class ? "class" : told(std::string("--") + name) ? "told" : "default", allocator);
            if (by_class) add_member(one, "members", JsonValue(static_cast<std::uint64_t>(found->members)), allocator);
            list.PushBack(one, allocator);
        }
        return list;
    }

    void read(const std::string& file, Fragment& fragment, Provenance& provenance, const Session& session) {
        FragmentFile one = read_fragment(file, reading);
        for (const Path& input : one.inputs) {
            provenance.add_input(input);
            inputs.push_back(input);
        }
        for (const auto& note : one.notes) session.note("note: " + printable(file) + ": " + note);
        fragment = std::move(one.fragment);
        if (session.json || fragment.facets.empty()) return;
        std::array<double, 3> area{};
        for (const Face face : fragment.mesh.faces())
            area.at(static_cast<std::size_t>(fragment.facets[face])) += face_area(fragment.mesh, face);
        const double all = area[0] + area[1] + area[2];
        std::cout << printable(fragment.name) << ": facets by " << one.facets_from << ": outer " << number(100 * area[0] / all, 3)
                  << " %, inner " << number(100 * area[1] / all, 3) << " %, fracture " << number(100 * area[2] / all, 3)
                  << " %\n";
    }

    /// The template's annotations on the completed object.
    static AnnotationSet carry(const Mesh& mesh, const AnnotationSet& set, const Reconstruction& result) {
        Mesh fitted = mesh;
        for (const Vertex v : fitted.vertices()) fitted.point(v) = result.points[v];
        TransferOptions options;
        options.overlap = false;
        options.force = true;
        return transfer(fitted, set, SurfaceSearch(result.object.mesh), options).annotations;
    }

    /// The template's first cage, with its coordinates if it has some that go together; one that is made if it has none.
    TemplateCage cage_of(const TemplateFile& bundle, const Template& loaded, const Session& session) const {
        const Mesh& mesh = loaded.mesh->mesh;
        for (const std::optional<Mesh>& cage : loaded.cages) {
            if (!cage) continue;
            for (const TemplatePart* part : bundle.of("coordinates")) {
                try {
                    Coordinates coordinates = read_coordinates(part->file, mesh, *cage);
                    if (!coordinates.has_normals()) return {*cage, std::move(coordinates)};
                } catch (const Error&) {  // those of another cage: they are computed
                    continue;
                }
            }
            try {
                return template_in_cage(mesh, *cage);
            } catch (const Error& error) {
                fail_input(files[0] + ", " + error.where(), error.problem(), error.remedy());
            }
        }
        session.note("note: the template has no cage: one of 200 vertices was made around it");
        return made_cage(mesh);
    }

    static constexpr const char* kept = "fit.searches.json";

    /// Searches that an earlier fit in the folder made. Whether one is of use here its key says.
    void remember(PoseSearches& searches, const Session& session) const {
        if (!fs::exists(in(kept))) return;
        try {
            const std::size_t damaged = searches.add(read_json(in(kept)), in(kept).string());
            if (damaged > 0)
                session.note("note: " + std::to_string(damaged) + " searches in " + printable(in(kept).string()) +
                             " were changed since they were made: they are made anew");
        } catch (const Error& error) {
            session.note("note: " + printable(in(kept).string()) + " is not used, and written anew: " + error.problem());
        }
    }

    [[nodiscard]] Path in(const std::string& name) const { return Path(output) / name; }

    void write(const MeshFile& file, const AnnotationSet& set, const std::vector<Fragment>& fragments, const AssemblyNames& names,
               const Reconstruction& result, const PoseSearches& searches, const Provenance& provenance,
               const Session& session) const {
        std::error_code code;
        fs::create_directories(output, code);
        if (code) throw Error(ErrorKind::failure, output, "the folder cannot be made: " + code.message(), "name another one");
        std::vector<Path> outputs{in("fit.assembly.json"), in(kept), in("completed.ply"), in("completed.ant.json")};
        for (const std::string& name : names.fragments) outputs.push_back(in(name + ".placed.ply"));
        check_outputs(inputs, outputs);
        const std::vector<Path> before = written_before();
        std::vector<Path> written;
        OutputTransaction transaction;
        Json document(rapidjson::kObjectType);
        JsonValue report = assembly_to_json(result, names, document.GetAllocator());
        add_member(report, "thresholds", thresholds_to_json(document.GetAllocator()), document.GetAllocator());
        add_member(report, "provenance", provenance.to_json(document.GetAllocator()), document.GetAllocator());
        write_json(in("fit.assembly.json"), report);
        if (!searches.empty()) {
            JsonValue known = searches.to_json(document.GetAllocator());
            add_member(known, "provenance", provenance.to_json(document.GetAllocator()), document.GetAllocator());
            write_json(in(kept), known);
            written.push_back(in(kept));
        }
        if (!result.points.empty()) {
            const CompletedObject& object = result.object;
            MeshExtras extras;
            for (const Origin origin : object.origin) {
                extras.face_labels.push_back(static_cast<std::int32_t>(origin));
                extras.face_colours.push_back(origin == Origin::observed       ? Colour{186, 120, 82, 255}
                                              : origin == Origin::interpolated ? Colour{214, 180, 120, 255}
                                                                               : Colour{200, 205, 210, 255});
            }
            WriteOptions how;
            how.comment = provenance.to_line();
            FaceValues fragment{"fragment", {}}, distance{"distance", {}}, confidence{"confidence", {}};
            for (std::size_t f = 0; f < object.origin.size(); ++f) {
                fragment.values.push_back(static_cast<float>(object.fragment[f] + 1));
                distance.values.push_back(static_cast<float>(object.distance[f]));
                confidence.values.push_back(static_cast<float>(object.confidence[f]));
            }
            how.face_values = {std::move(fragment), std::move(distance), std::move(confidence)};
            write_mesh(in("completed.ply"), object.mesh, extras, how);
            for (std::size_t k = 0; k < result.notes.size(); ++k)
                for (const std::string& note : result.notes[k])
                    session.note("note: " + printable(names.fragments[k]) + ": " + note);
            for (const CompletionNote& note : object.notes)
                session.note("note: " + printable(names.fragments[static_cast<std::size_t>(note.fragment)]) + ": " + note.text +
                             "; the template's triangles show what was seen of it");
            AnnotationSet carried = carry(file.mesh, set, result);
            for (const auto& note : refresh_measures(object.mesh, carried).notes) session.note("note: " + note);
            write_annotations(in("completed.ant.json"), carried, object.mesh, "completed.ply", provenance);
            written.insert(written.end(), {in("completed.ply"), in("completed.ant.json")});
        }
        for (std::size_t k = 0; placed && k < fragments.size(); ++k) {
            if (!result.placement.fragments[k].problem.empty()) continue;
            written.push_back(in(fragments[k].name + ".placed.ply"));
            write_mesh(written.back(), moved(fragments[k].mesh, result.placement.fragments[k].pose));
        }
        transaction.commit();
        // What an earlier run left does not stand beside another answer.
        for (const Path& old : before)
            if (std::find(written.begin(), written.end(), old) == written.end()) fs::remove(old, code);
    }

    /// Files of an earlier fit in the folder, by its assembly.
    [[nodiscard]] std::vector<Path> written_before() const {
        std::vector<Path> earlier;
        if (!fs::exists(in("fit.assembly.json"))) return earlier;
        earlier = {in(kept), in("completed.ply"), in("completed.ant.json")};
        try {
            const Json old = read_json(in("fit.assembly.json"));
            validate(old, "assembly", "fit.assembly.json");
            for (const auto& entry : old["fragments"].GetArray()) {
                const std::string name = entry["name"].GetString();
                if (name.find('/') == std::string::npos) earlier.push_back(in(name + ".placed.ply"));
            }
        } catch (const Error&) {  // not one of ours: the files are left alone
            earlier.clear();
        }
        return earlier;
    }

    static std::string searched(const PoseSearchResult& one) {
        return "found, confidence " + number(one.confidence, 3) +
               (one.freedom.kind == FreedomKind::none ? "" : "; open: " + one.freedom.text());
    }

    void print(const Session& session, const Provenance& provenance, const AssemblyNames& names,
               const Reconstruction& result) const {
        if (session.json) {
            Json document(rapidjson::kObjectType);
            JsonValue report = assembly_to_json(result, names, document.GetAllocator()), run(rapidjson::kObjectType),
                      seconds(rapidjson::kObjectType);
            for (const auto& [phase, time] : result.seconds) add_member(seconds, phase, JsonValue(time), document.GetAllocator());
            add_member(run, "seconds", std::move(seconds), document.GetAllocator());
            add_member(report, "thresholds", thresholds_to_json(document.GetAllocator()), document.GetAllocator());
            session.print_report(provenance, document, report, &run);
            return;
        }
        std::vector<std::vector<std::string>> rows;
        for (std::size_t k = 0; k < names.fragments.size(); ++k) {
            const FragmentPlacement& one = result.placement.fragments[k];
            std::size_t used = 0;
            std::string wrong;
            for (const LandmarkResidual& landmark : one.landmarks) {
                used += landmark.used ? 1 : 0;
                if (!landmark.used && one.problem.empty() && !(k < result.searched.size() && result.searched[k].has_value()))
                    wrong += (wrong.empty() ? "" : ", ") + printable(landmark.name);
            }
            rows.push_back({printable(names.fragments[k]),
                            !one.problem.empty()                                           ? "left out"
                            : k < result.searched.size() && result.searched[k].has_value() ? searched(*result.searched[k])
                                                                                           : "placed",
                            std::to_string(used) + " of " + std::to_string(one.landmarks.size()),
                            one.problem.empty() ? number(one.residual, 3) : "-",
                            one.own_scale > 0 ? number(one.own_scale, 4) : "-", wrong});
        }
        std::cout << table({"fragment", "", "landmarks", "residual", "own scale", "wrong landmarks"}, rows);
        if (result.turns) std::cout << turns_text(*result.turns, names.fragments);
        std::cout << "scale of the template " << number(result.placement.scale, 4) << "; observed "
                  << number(100 * result.observed_share, 3) << " % of the surface\n";
        if (result.crossings > 0)
            std::cout << result.crossings
                      << " pairs of faces cross each other that did not in the template: look at the picture; a larger "
                      << "--detail may help\n";
        std::vector<std::vector<std::string>> constraints;
        for (const ConstraintReport& constraint : result.constraints) {
            std::string words = constraint.text;
            for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
                const Deviation& d = constraint.deviations[i];
                words += (words.empty() ? "" : "; ") + d.quantity + " " + number(d.value.value_or(0), 4) + " (was " +
                         number(i < constraint.before_values.size() ? constraint.before_values[i] : 0, 4) + ", at most " +
                         number(d.tolerance.value_or(0), 4) + ")" + (d.unit.empty() ? "" : " " + d.unit);
            }
            const bool objected = std::any_of(result.objections.begin(), result.objections.end(), [&](const Objection& one) {
                return one.kind == ObjectionKind::constraint && one.constraint == constraint.id;
            });
            constraints.push_back({std::to_string(constraint.id), constraint.type,
                                   !constraint.used                                    ? "left out"
                                   : constraint.verdict == Verdict::fails && !objected ? "holds within --slack"
                                                                                       : to_string(constraint.verdict),
                                   words});
        }
        if (!constraints.empty()) std::cout << table({"id", "constraint", "verdict", "how well"}, constraints);
        for (const FragmentThreshold& one : learnt_thresholds)
            std::cout << "--" << one.option << ' ' << number(one.value, 3) << " as " << one.members
                      << " members of the class have it\n";
        for (const Objection& objection : result.objections)
            std::cout << (objection.fragment >= 0
                              ? "against " + printable(names.fragments[static_cast<std::size_t>(objection.fragment)]) + ": "
                              : "constraint " + std::to_string(objection.constraint) + ": ")
                      << printable(objection.text) << '\n';
        std::cout << to_string(result.verdict) << (result.undecided.empty() ? "" : ": cannot decide, because " + result.undecided)
                  << '\n';
    }
};

}  // namespace

void add_fit(CLI::App& tool, Session& session) {
    const auto fit = std::make_shared<Fit>();
    CLI::App* command = session.add(
        tool, "fit",
        "complete an object from fragments by a template of its class, and say whether they go together (exit code 3: they do "
        "not, or it cannot be told)",
        [&session, fit] { return fit->run(session); });
    command
        ->add_option(
            "files", fit->files,
            "the template (.template.json), then a mesh file, or points without faces, for each fragment; NAME.ant.json beside "
            "it are its "
            "annotations: points with the template's tags are landmarks, regions \"outer\", \"inner\", \"fracture\" its facets")
        ->required()
        ->expected(-1);
    command->add_option("--output", fit->output,
                        "folder for completed.ply, completed.ant.json and fit.assembly.json; made if it is missing");
    command->add_option("--assembly", fit->assembly, "an assembly: its matches of annotations with \"stated\": true hold");
    command->add_option(
        "--class", fit->class_file,
        "a class learnt with this template (NAME.class.json of 'template learn'): what no fragment shows is as in its "
        "members that look so where one does; thresholds that are not told are those of its members");
    command->add_flag("--fresh", fit->fresh, "search poses anew, whatever an earlier fit in the folder found");
    command->add_flag("--placed", fit->placed, "also write each fragment where it lies: NAME.placed.ply");
    add_flags(command, fit->options);
    add_flags(command, fit->reading);
    fit->told = [command](const std::string& flag) { return command->get_option(flag)->count() > 0; };
}

}  // namespace ostraka::app

// fit: reconstructs the whole object from fragments.
#include "operations/completed_output.h"
#include "operations/constraint_report.h"
#include "operations/outward.h"

#include "ostraka/measure/measure.h"
#include "ostraka/reconstruction/assembly.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/pose_searches.h"
#include "ostraka/shape_classes/fragment_thresholds.h"
#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <set>

namespace ostraka {

namespace {

struct Fit final : Operation {
    void declare(Parameters& p) override {
        p.input("template", Kind::template_package, object_template, "template of the object's class (.template.json)");
        p.input("fragments", Kind::mesh, files,
                "mesh file or point cloud of each fragment; in NAME.ant.json beside NAME.ply, points with tags of the template "
                "are landmarks, and regions \"outer\", \"inner\" and \"fracture\" classify the surface")
            .many()
            .with_annotations_beside();
        p.output("output", Kind::folder, output,
                 "folder for completed.ply, completed.ant.json and fit.assembly.json; created if missing")
            .flag();
        p.input_option("assembly", Kind::assembly, assembly,
                       "assembly file of an earlier fit: its annotation matches with \"stated\": true are used unchanged");
        p.input_option(
            "class", Kind::shape_class, class_file,
            "class learnt with this template (NAME.class.json of 'template learn'): the unobserved surface is estimated from the "
            "shape variation of the class, and thresholds that are not given as options are taken from the class");
        p.options("fresh", fresh, "search all poses again, and ignore stored results of an earlier fit in the output folder")
            .unrecorded();
        p.options("placed", placed, "also write each fragment in its computed pose, as NAME.placed.ply");
        vocabulary.declare(p, as_template_words);
        options.declare_options(p.options);
        reading.declare_options(p.options);
        for (const char* name : {"residual", "scale-tolerance", "min-tolerance"}) thresholds[name] = p.options.find(name);
        p.report.schema = "assembly";
        p.report.text_table("fragments", {"fragment", "place", "landmarks", "residual", "own scale", "wrong landmarks"});
        p.report.text_table("joints", {"breaks", "turn, degrees", "contact %", "rim %", "residual", "confidence", "turn"});
        p.report.text_table("constraints", {"id", "constraint", "verdict", "how well"});
    }

    void check() const override {
        std::set<std::string> file_names;
        for (std::size_t k = 0; k < files.size(); ++k)
            if (const std::string name = Path(files.file(k)).stem().string(); !file_names.insert(name).second)
                fail_usage(fmt::format("two fragments are called '{}'", name), "rename one of the files");
        if (class_file && options.fit.space != NonRigidOptions::Space::mesh)
            fail_usage("--class changes the template's shape, but not its cage", "leave out --class or --space");
    }

    void run(Context& context, Report& report) override {
        check_usable(*object_template, object_template.file());
        if (!object_template->annotations)
            fail_input(object_template.file(), "has no annotations", "pack them: they identify corresponding parts");
        turned = outward(AnnotatedMeshView(object_template->mesh->mesh, *object_template->annotations), object_template.file(),
                         report);
        const Mesh& mesh = template_object().mesh;
        names.template_file = object_template.file_name();
        std::vector<std::vector<StatedMatch>> stated = read_fragments(context, report);
        const RelationGraph& graph = class_template(*object_template).graph;
        std::optional<ShapePrior> prior;
        const ShapeClass* learnt = nullptr;
        if (class_file) {
            learnt = &class_file.load<ShapeClass>(read_class);
            check_topology(*learnt, class_file.file(), mesh, object_template.file());
            prior = prior_of(learnt->modes);
            if (learnt->modes.variances.empty())
                report.note(class_file.file() +
                            " has no modes of variation (one member, or all members of one shape): only its mean shape is used");
        }
        used_thresholds =
            apply_class_thresholds(options, learnt, [&](const std::string& name) { return thresholds.at(name)->given; });
        std::optional<TemplateCage> cage;
        if (options.fit.space != NonRigidOptions::Space::mesh) {
            context.record([&] { cage = in_file(object_template.file(), [&] { return cage_of(*object_template); }); });
            if (!cage) {
                report.note("the template has no cage: one of 200 vertices was made around it");
                cage = generated_cage(mesh);
            }
        }
        Reconstructor reconstructor(template_object(), graph, options, prior ? &*prior : nullptr, cage ? &*cage : nullptr);
        for (std::size_t k = 0; k < fragments.size(); ++k) reconstructor.add(*fragments[k], std::move(stated[k]));
        // Results must not overwrite fragments; checked before the work starts.
        for (const char* name : {"fit.assembly.json", searches_file, "completed.ply", "completed.ant.json"})
            static_cast<void>(output.in(name));
        for (const std::string& name : names.fragments) static_cast<void>(output.in(name + ".placed.ply"));
        PoseSearches& searches = reconstructor.searches();
        if (!fresh) reuse_searches(searches, report);
        const Reconstruction result = reconstructor.run();
        if (searches.reused() > 0)
            report.note(fmt::format(
                "{} of {} pose searches are reused from an earlier fit in {}: template, fragment and options are the same",
                searches.reused(), searches.reused() + searches.made(), output.file()));
        if (const double scale = result.placement.scale;
            result.placement.any() && (scale > options.placement.unit_ratio || scale * options.placement.unit_ratio < 1))
            report.note(fmt::format("the template is scaled by {}: are all files in one unit?", number(scale, 4)));
        write(context, report, result, searches);
        report_result(report, result);
        for (const auto& [phase, time] : result.seconds) report.run("seconds." + phase, time);
        if (result.verdict != Compatibility::compatible) report.answer_no();
    }

    /// Reads the fragments; returns the matches that a person stated for each.
    std::vector<std::vector<StatedMatch>> read_fragments(Context& context, Report& report) {
        std::vector<std::vector<StatedMatch>> stated;
        if (assembly) validate(*assembly, "assembly", assembly.file());
        for (std::size_t k = 0; k < files.size(); ++k) {
            const FragmentFile& fragment_file = files.load<FragmentFile>(
                [&](const Path& file) { return read_fragment(file, reading); }, k, options_text(reading));
            context.notes(files.file(k), fragment_file.notes);
            fragments.push_back(&fragment_file.fragment);
            fragment_colours.push_back(fragment_file.face_colours);
            if (vocabulary) {
                renamed.push_back(fragment_file.fragment);
                vocabulary.words().rename_like(renamed.back().annotations, *object_template->annotations);
                fragments.back() = &renamed.back();
            }
            names.fragments.push_back(fragment_file.fragment.name);
            stated.push_back(assembly
                                 ? stated_matches(*assembly, *fragments.back(), *object_template->annotations, assembly.file())
                                 : std::vector<StatedMatch>());
            if (fragment_file.fragment.facets.empty()) continue;
            std::array<double, 3> area{};
            for (const Face face : fragment_file.fragment.mesh.faces())
                area.at(static_cast<std::size_t>(fragment_file.fragment.facets[face])) +=
                    face_area(fragment_file.fragment.mesh, face);
            const auto percent = [&](std::size_t i) {
                return number(100 * area.at(i) / (area[0] + area[1] + area[2]), 3) + " %";
            };
            report.line(fmt::format("{}: facets by {}: outer {}, inner {}, fracture {}", printable(fragment_file.fragment.name),
                                    fragment_file.facets_from, percent(0), percent(1), percent(2)));
        }
        if (assembly)
            for (const std::string& name : unused_statements(*assembly, names.fragments))
                report.note(fmt::format("{} states matches of '{}', which is not one of the fragments", assembly.file(), name));
        for (std::size_t k = 0; k < files.size(); ++k)
            if (const std::string& template_unit = object_template->annotations->unit,
                &fragment_unit = fragments[k]->annotations.unit;
                !template_unit.empty() && !fragment_unit.empty() && template_unit != fragment_unit)
                fail_input(files.file(k),
                           fmt::format("is in {}, and the template in {}", printable(fragment_unit), printable(template_unit)),
                           "convert all files to one unit");
        return stated;
    }

    /// The template, with its faces turned over if it is inside out.
    [[nodiscard]] AnnotatedMeshView template_object() const {
        return turned ? AnnotatedMeshView(*turned)
                      : AnnotatedMeshView(object_template->mesh->mesh, *object_template->annotations);
    }

    static constexpr const char* searches_file = "fit.searches.json";

    /// Adds pose searches stored by an earlier fit in the folder. The key of each decides whether it is used.
    void reuse_searches(PoseSearches& searches, Report& report) const {
        const Path file = output.in(searches_file);
        if (!file_exists(file)) return;
        try {
            const std::size_t damaged = searches.add(read_json(file), file.string());
            if (damaged > 0)
                report.note(fmt::format("{} searches in {} were changed since they were stored: they are computed again", damaged,
                                        file.string()));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            report.note(fmt::format("{} is not used, and is written again: {}", file.string(), error.problem()));
        }
    }

    void write(Context& context, Report& report, const Reconstruction& result, const PoseSearches& searches) const {
        Json document;
        JsonValue content = assembly_to_json(result, names, document.GetAllocator());
        add_members(content, document.GetAllocator(), "thresholds", thresholds_to_json(used_thresholds, document.GetAllocator()));
        report.values(content);
        output.write("fit.assembly.json", content);
        if (!searches.empty()) output.write(searches_file, searches.to_json(document.GetAllocator()));
        if (!result.points.empty()) {
            write_completed(output, "completed.ply", result.object, fragment_colours);
            for (std::size_t k = 0; k < result.notes.size(); ++k) context.notes(names.fragments[k], result.notes[k]);
            for (const CompletionNote& note : result.object.notes)
                report.note(fmt::format("{}: {}; its observed surface is represented by the template's triangles",
                                        names.fragments[static_cast<std::size_t>(note.fragment)], note.text));
            AnnotationSet carried_annotations = completed_annotations(template_object(), result);
            report.notes(refresh_measures(result.object.mesh, carried_annotations).notes);
            output.write("completed.ant.json", {result.object.mesh, carried_annotations}, "completed.ply");
        }
        for (std::size_t k = 0; placed && k < fragments.size(); ++k)
            if (const FragmentPlacement& placement = result.placement.fragments[k]; placement.problem.empty())
                output.write(names.fragments[k] + ".placed.ply", moved(fragments[k]->mesh, placement.pose));
    }

    void report_result(Report& report, const Reconstruction& result) const {
        for (std::size_t k = 0; k < names.fragments.size(); ++k) report_fragment(report, result, k);
        if (result.rotations) report_rotations(report, *result.rotations);
        report.line(fmt::format("scale of the template {}; observed {} % of the surface", number(result.placement.scale, 4),
                                number(100 * result.observed_share, 3)));
        if (result.crossings > 0)
            report.line(fmt::format(
                "{} pairs of faces intersect that do not intersect in the template: check the result; a larger --detail may help",
                result.crossings));
        for (const ConstraintReport& constraint : result.constraints) report_constraint(report, result, constraint);
        for (const UsedThreshold& threshold : used_thresholds)
            if (threshold.from == "class")
                report.line(fmt::format("--{} {} from {} members of the class", threshold.option, number(threshold.value, 3),
                                        threshold.members));
        for (const Objection& objection : result.objections)
            report.line(objection.fragment >= 0
                            ? fmt::format("against {}: {}",
                                          printable(names.fragments[static_cast<std::size_t>(objection.fragment)]),
                                          printable(objection.text))
                            : fmt::format("constraint {}: {}", objection.constraint, printable(objection.text)));
        report.line(to_string(result.verdict) + (result.undecided.empty() ? "" : ": cannot decide, because " + result.undecided));
    }

    void report_fragment(Report& report, const Reconstruction& result, std::size_t k) const {
        const FragmentPlacement& placement = result.placement.fragments[k];
        const PoseSearchResult* search =
            k < result.searched.size() && result.searched[k].has_value() ? &*result.searched[k] : nullptr;
        std::size_t count = 0;
        std::string wrong_landmarks;
        for (const LandmarkResidual& landmark : placement.landmarks) {
            count += landmark.used ? 1 : 0;
            if (!landmark.used && placement.problem.empty() && search == nullptr)
                wrong_landmarks += (wrong_landmarks.empty() ? "" : ", ") + landmark.name;
        }
        report.row("fragments",
                   {names.fragments[k],
                    !placement.problem.empty() ? "left out"
                    : search == nullptr
                        ? "placed"
                        : fmt::format("found, confidence {}{}", number(search->confidence, 3),
                                      search->slippable.kind == SlippableKind::none ? "" : "; open: " + search->slippable.text()),
                    fmt::format("{} of {}", count, placement.landmarks.size()),
                    placement.problem.empty() ? number(placement.residual, 3) : "-",
                    placement.own_scale > 0 ? number(placement.own_scale, 4) : "-", wrong_landmarks});
    }

    /// Reports the joints that decided the rotations, and the fragments without a joint.
    void report_rotations(Report& report, const RotationMatch& rotations) const {
        for (const FractureJoint& joint : rotations.joints)
            report.row("joints", {fmt::format("{} - {}", names.fragments[static_cast<std::size_t>(joint.first)],
                                              names.fragments[static_cast<std::size_t>(joint.second)]),
                                  number(joint.rotation, 4), number(100 * joint.contact, 3), number(100 * joint.rim, 3),
                                  number(joint.residual, 3), joint.carries ? number(joint.confidence, 2) : "-",
                                  !joint.carries  ? "closes a cycle"
                                  : joint.decided ? "decided"
                                                  : "not decided"});
        for (std::size_t k = 0; k < names.fragments.size() && k < rotations.notes.size(); ++k)
            if (!rotations.notes[k].empty())
                report.line(fmt::format("{}: {}", printable(names.fragments[k]), printable(rotations.notes[k])));
    }

    static void report_constraint(Report& report, const Reconstruction& result, const ConstraintReport& constraint) {
        std::vector<std::string> words = deviation_texts(constraint);
        if (!constraint.text.empty()) words.insert(words.begin(), constraint.text);
        const bool objected = std::any_of(result.objections.begin(), result.objections.end(), [&](const Objection& objection) {
            return objection.kind == ObjectionKind::constraint && objection.constraint == constraint.id;
        });
        report.row("constraints", {constraint.id, constraint.type,
                                   !constraint.used                                    ? "left out"
                                   : constraint.verdict == Verdict::fails && !objected ? "holds within --min-tolerance"
                                                                                       : to_string(constraint.verdict),
                                   joined(words, "; ")});
    }

    TemplateInput object_template;
    std::optional<AnnotatedMesh> turned;  ///< the template with its faces turned over, if it is inside out
    FileInput files, class_file;
    JsonInput assembly;
    FolderOutput output;
    bool placed = false, fresh = false;
    ReconstructOptions options;
    FragmentFileOptions reading;
    std::map<std::string, const Option*> thresholds;  ///< thresholds for which the class may give a value

    VocabularyOption vocabulary;
    std::deque<Fragment> renamed;  ///< fragments with the tags of the template
    std::vector<const Fragment*> fragments;
    std::vector<std::vector<Colour>> fragment_colours;  ///< colours of the faces of each fragment; empty: none
    AssemblyNames names;
    std::vector<UsedThreshold> used_thresholds;
};

}  // namespace

std::unique_ptr<Operation> make_fit() { return make<Fit>(); }

}  // namespace ostraka

// template propagate: transfers a template's annotations to members of its class.
#include "operations/operations.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/shape_classes/member_file.h"
#include "ostraka/shape_classes/propagate.h"

#include <fmt/core.h>

#include <deque>

namespace ostraka {

namespace {

struct TemplatePropagate final : Operation {
    void declare(Parameters& p) override {
        p.input("template", Kind::template_package, template_input, "template (.template.json)");
        p.input("members", Kind::mesh, members, "mesh file of each member, with annotations in NAME.ant.json beside it")
            .many()
            .with_annotations_beside();
        vocabulary.declare(p, as_template_words);
        p.output("output", Kind::folder, output,
                 "folder for NAME.ant.json, NAME.fitted.ply and NAME.fitted.ant.json; created if missing")
            .flag();
        p.options("given", given, "same effect as --correspondence given");
        p.options(
            "correspondence", options.correspondence,
            "vertex correspondence between template and members: given (members must have the template's triangles), fitted (the "
            "template is fitted to each member), or auto (given for members with the template's triangles, fitted for others)",
            Choices{"auto", "given", "fitted"});
        options.fit.declare_options(p.options);
        p.report.table("members", text("name", "member"), text("placedBy", "placed by"), number("distance", "distance %"),
                       number("distanceBack"), number("unmatched", "unmatched %"), number("unexplained", "unexplained %"),
                       number("stretch"), number("bend"), integer("annotations", "annotations"), integer("lost", "lost"),
                       texts("notes", "notes"), boolean("liesOn"), text("problem"), text_only("remarks"));
    }

    void check() const override {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < members.size(); ++i) names.push_back(members.file(i));
        check_object_names(names);
    }

    void run(Context&, Report& report) override {
        if (given) options.correspondence = CorrespondenceChoice::given;
        if (is_landmark_file(template_input.file()))
            fail_input(template_input.file(), "is a file of landmarks, and a template with a mesh is needed",
                       "classes of landmarks can only be learnt and used to classify");
        check_usable(*template_input, template_input.file());
        if (!template_input->annotations || template_input->annotations->annotations.empty())
            fail_input(template_input.file(), "has no annotations", "pack them: there is nothing to propagate");
        std::vector<const WholeObject*> objects;
        std::deque<WholeObject> renamed;
        for (std::size_t i = 0; i < members.size(); ++i) {
            objects.push_back(&members.load<WholeObject>(read_member, i));
            if (!vocabulary) continue;
            renamed.push_back(*objects.back());
            vocabulary.words().rename_like(renamed.back().annotations, *template_input->annotations);
            objects.back() = &renamed.back();
        }
        output.open(0, false);  // keeps the files of other members in the folder
        for (const WholeObject* member : objects)
            for (const char* ending : {".ant.json", ".fitted.ply", ".fitted.ant.json"})
                static_cast<void>(output.in(member->name + ending));
        Progress progress("propagating annotations", objects.size());
        for (std::size_t i = 0; i < objects.size(); ++i, progress.advance()) {
            const Propagated result =
                in_file(members.file(i), [&] { return propagate(class_template(*template_input), *objects[i], options); });
            if (result.fit.problem.empty()) write(members.file_name(i), *objects[i], result);
            report_result(report, objects[i]->name, result);
        }
    }

    void write(const std::string& file, const WholeObject& member, const Propagated& result) const {
        const std::string fitted_name = member.name + ".fitted.ply";
        const Mesh fitted = with_points(template_input->mesh->mesh, result.fit.points);
        output.write(fitted_name, fitted);
        output.write(member.name + ".fitted.ant.json", {fitted, result.on_template}, fitted_name);
        output.write(member.name + ".ant.json", {member.mesh, *result.on_member}, file);
    }

    static void report_result(Report& report, const std::string& name, const Propagated& result) {
        const bool fitted = result.fit.problem.empty();
        Report::Row row = report.row("members");
        row("name", name)("lost", result.lost)("notes", result.notes, std::to_string(result.notes.size()));
        row.shown("placedBy", "left out").shown("annotations", "-").shown("remarks", result.lies_on ? "" : "does not fit it");
        if (fitted)
            row("placedBy", result.fit.placed_by)("annotations", result.on_member->annotations.size())("liesOn", result.lies_on);
        else row("problem", result.fit.problem).shown("remarks", result.fit.problem);
        if (result.fit.residuals) {
            const FitResiduals& r = *result.fit.residuals;
            const auto percent = [](double share) { return number(100 * share, 3); };
            row("distance", r.distance, percent(r.distance))("distanceBack", r.back)("stretch", r.stretch)("bend", r.bend);
            row("unmatched", r.unmatched, percent(r.unmatched))("unexplained", r.unexplained, percent(r.unexplained));
        }
        for (const std::string& note : result.notes) report.note(fmt::format("{}: {}", name, note));
        if (!result.complete()) report.answer_no();
    }

    TemplateInput template_input;
    FileInput members;
    FolderOutput output;
    VocabularyOption vocabulary;
    bool given = false;
    PropagateOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_template_propagate() { return make<TemplatePropagate>(); }

}  // namespace ostraka

// template sample: draws new members of a class.
#include "operations/operations.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/shape_classes/member_file.h"
#include "ostraka/shape_classes/sample.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct TemplateSample final : Operation {
    void declare(Parameters& p) override {
        p.input("class", Kind::shape_class, file, "class file (.class.json), as written by 'template learn'");
        p.output("output", Kind::folder, output, "folder for meshes, annotations and NAME.samples.json; created if missing")
            .flag();
        options.declare_options(p.options);
        p.report.schema = "samples";
    }

    void run(Context&, Report& report) override {
        const ClassWithTemplate& class_data = file.load<ClassWithTemplate>(read_class_with_template);
        if (class_data.landmarks)
            fail_input(class_data.learnt.template_file, "is a file of landmarks, and a template with a mesh is needed",
                       "classes of landmarks can only be learnt and used to classify");
        // Keeps the files of other classes in the folder.
        replace_outputs(output.open(0, false), "template-sample-" + class_data.learnt.name);
        const Sampling result = sample_class(class_data.learnt, class_data.known(), options);
        std::vector<std::string> names;
        for (std::size_t i = 0; i < result.samples.size(); ++i)
            names.push_back(fmt::format("{}-{}", class_data.learnt.name, padded(i + 1, result.samples.size())));
        write(class_data, result, names, report);
        report_result(report, class_data.learnt.name, result);
        if (names.size() < static_cast<std::size_t>(options.count)) report.answer_no();
    }

    void write(const ClassWithTemplate& class_data, const Sampling& result, const std::vector<std::string>& names,
               Report& report) const {
        const ClassTemplate template_of_class = class_data.known();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Mesh mesh = with_points(template_of_class.mesh, result.samples[i].points);
            AnnotationSet set = template_of_class.annotations;
            move_extents(template_of_class, mesh, set);
            static_cast<void>(refresh_measures(mesh, set));
            output.write(names[i] + ".ply", mesh);
            output.write(names[i] + ".ant.json", {mesh, set}, names[i] + ".ply");
        }
        const Json document = samples_document(class_data.learnt.name, result, names);
        report.values(document);
        output.write(class_data.learnt.name + ".samples.json", document);
    }

    /// doc/schema/samples.schema.json
    static Json samples_document(const std::string& name, const Sampling& result, const std::vector<std::string>& names) {
        Json document = json_document("samples");
        auto& allocator = document.GetAllocator();
        JsonValue samples(rapidjson::kArrayType);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const ClassSample& sample = result.samples[i];
            JsonValue sample_entry = json_object(allocator, "name", names[i], "moved", sample.moved);
            if (!sample.coefficients.empty()) add_members(sample_entry, allocator, "coefficients", sample.coefficients);
            if (!sample.edits.empty()) add_members(sample_entry, allocator, "edits", sample.edits);
            samples.PushBack(sample_entry, allocator);
        }
        add_members(document, allocator, "class", name, "tried", result.tried, "accepted", result.samples.size(), "acceptance",
                    result.acceptance(), "rejected",
                    json_object(allocator, "constraints", result.by_constraints, "ranges", result.by_ranges, "selfIntersections",
                                result.by_intersections),
                    "examples", result.examples, "diversity", result.diversity, "diversityOfMembers", result.of_members,
                    "samples", std::move(samples));
        return document;
    }

    static void report_result(Report& report, const std::string& name, const Sampling& result) {
        report.line(fmt::format(
            "{} of {} draws of '{}' accepted ({} %); rejected by constraints {}, by learnt ranges {}, by self-intersections {}",
            result.samples.size(), result.tried, printable(name), number(100 * result.acceptance(), 3), result.by_constraints,
            result.by_ranges, result.by_intersections));
        for (const std::string& text : result.examples) report.line("  such as: " + printable(text));
        report.line(fmt::format("{}, that of the members {} %",
                                result.samples.size() < 2 ? "no diversity (mean distance of two)"
                                                          : fmt::format("diversity (mean distance of two) {} % of the mean size",
                                                                        number(100 * result.diversity, 3)),
                                number(100 * result.of_members, 3)));
    }

    FileInput file;
    FolderOutput output;
    SampleOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_template_sample() { return make<TemplateSample>(); }

}  // namespace ostraka

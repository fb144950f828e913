// template sample: new members of a class.
#include "operations.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/shape_classes/member_file.h"
#include "ostraka/shape_classes/sample.h"

namespace ostraka {

namespace {

class TemplateSample final : public Operation {
public:
    void describe(Parameters& p) override {
        p.input("class", Kind::shape_class, file, "class (.class.json), as 'template learn' writes it");
        p.output("output", Kind::folder, output, "folder for meshes, annotations and NAME.samples.json; made if it is missing")
            .flag();
        options.describe(p.options);
        p.report.schema = "samples";
    }

    void run(Context& context, Report& report) override {
        const KnownClass& known = file.load<KnownClass>(read_known_class);
        if (known.landmarks)
            fail_input(known.learnt.template_file, "is a file of landmarks, and a template with a mesh is needed",
                       "classes of landmarks can be learnt and asked, no more");
        // Other classes may have theirs there.
        replace_outputs(output.open(0, false), "template-sample-" + known.learnt.name);
        const Sampling result = sample_class(known.learnt, known.known(), options);
        std::vector<std::string> names;
        for (std::size_t i = 0; i < result.samples.size(); ++i) {
            const std::string last = std::to_string(result.samples.size()), here = std::to_string(i + 1);
            names.push_back(known.learnt.name + "-" + std::string(last.size() - here.size(), '0') + here);
        }
        write(context, known, result, names, report);
        tell(report, known.learnt.name, result);
        if (names.size() < static_cast<std::size_t>(options.count)) report.answer_no();
    }

private:
    void write(Context& context, const KnownClass& known, const Sampling& result, const std::vector<std::string>& names,
               Report& report) const {
        const Provenance provenance = context.provenance();
        WriteOptions how;
        how.comment = provenance.to_line();
        const ClassTemplate of_class = known.known();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Mesh mesh = with_points(of_class.mesh, result.samples[i].points);
            AnnotationSet set = of_class.set;
            static_cast<void>(refresh_measures(mesh, set));
            write_mesh(output.in(names[i] + ".ply"), mesh, {}, how);
            write_annotations(output.in(names[i] + ".ant.json"), set, mesh, names[i] + ".ply", provenance);
        }
        Json document(rapidjson::kObjectType);
        add_samples(document, known.learnt.name, result, names);
        report.values(document);
        add_member(document, "provenance", provenance.to_json(document.GetAllocator()), document.GetAllocator());
        write_json(output.in(known.learnt.name + ".samples.json"), document);
    }

    /// doc/schema/samples.schema.json
    static void add_samples(Json& document, const std::string& name, const Sampling& result,
                            const std::vector<std::string>& names) {
        auto& allocator = document.GetAllocator();
        const auto count = [](std::size_t n) { return JsonValue(static_cast<std::uint64_t>(n)); };
        const auto texts = [&](const std::vector<std::string>& list) {
            JsonValue array(rapidjson::kArrayType);
            for (const std::string& text : list) array.PushBack(json_string(text, allocator), allocator);
            return array;
        };
        JsonValue samples(rapidjson::kArrayType), rejected(rapidjson::kObjectType);
        add_member(rejected, "constraints", count(result.by_constraints), allocator);
        add_member(rejected, "ranges", count(result.by_ranges), allocator);
        add_member(rejected, "selfIntersections", count(result.by_intersections), allocator);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const ClassSample& sample = result.samples[i];
            JsonValue item(rapidjson::kObjectType), coefficients(rapidjson::kArrayType);
            add_member(item, "name", names[i], allocator);
            add_member(item, "moved", JsonValue(sample.moved), allocator);
            for (const double b : sample.coefficients) coefficients.PushBack(b, allocator);
            if (!sample.coefficients.empty()) add_member(item, "coefficients", std::move(coefficients), allocator);
            if (!sample.edits.empty()) add_member(item, "edits", texts(sample.edits), allocator);
            samples.PushBack(item, allocator);
        }
        add_member(document, "format", "ostraka-samples", allocator);
        add_member(document, "version", JsonValue(1), allocator);
        add_member(document, "class", name, allocator);
        add_member(document, "tried", count(result.tried), allocator);
        add_member(document, "accepted", count(result.samples.size()), allocator);
        add_member(document, "acceptance", JsonValue(result.acceptance()), allocator);
        add_member(document, "rejected", std::move(rejected), allocator);
        add_member(document, "examples", texts(result.examples), allocator);
        add_member(document, "diversity", JsonValue(result.diversity), allocator);
        add_member(document, "diversityOfMembers", JsonValue(result.of_members), allocator);
        add_member(document, "samples", std::move(samples), allocator);
    }

    static void tell(Report& report, const std::string& name, const Sampling& result) {
        report.line(std::to_string(result.samples.size()) + " of " + std::to_string(result.tried) + " draws of '" +
                    printable(name) + "' accepted (" + number(100 * result.acceptance(), 3) + " %); rejected by constraints " +
                    std::to_string(result.by_constraints) + ", by learnt ranges " + std::to_string(result.by_ranges) +
                    ", by self-intersections " + std::to_string(result.by_intersections));
        for (const std::string& text : result.examples) report.line("  such as: " + printable(text));
        report.line((result.samples.size() < 2 ? "no diversity: it is the mean distance of two; that of the members "
                                               : "diversity (mean distance of two) " + number(100 * result.diversity, 3) +
                                                     " % of the mean size, that of the members ") +
                    number(100 * result.of_members, 3) + " %");
    }

    FileInput file;
    FolderOutput output;
    SampleOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_template_sample() { return make<TemplateSample>(); }

}  // namespace ostraka

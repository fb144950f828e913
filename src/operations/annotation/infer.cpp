// annotation infer
#include "operations/operations.h"

#include "ostraka/vocabulary/infer.h"

namespace ostraka {

namespace {

struct AnnotationInfer final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.input("vocabulary", Kind::vocabulary, vocabulary, "vocabulary with rules (.vocabulary.json, .ttl, .rdf)");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.report.table("inferred", integer("annotation", "id"), text("tag", "tag"), text("attribute", "attribute"),
                       text("value", "value"), text("rule"), text("why", "why"));
        p.report.values(texts("contradictions"), texts("missing"));
    }

    void run(Context&, Report& report) override {
        const auto& words = vocabulary.load<Vocabulary>(read_vocabulary);
        InferenceResult result = infer(set(), words);
        report.empty_table("inferred", false);
        for (const Inference& inference : result.inferred)
            report.row("inferred")("annotation", inference.annotation)("tag", result.annotations.find(inference.annotation)->tag)(
                "attribute", inference.attribute)("value", inference.value)("rule", inference.rule)("why", inference.why);
        report("contradictions", result.contradictions)("missing", result.missing);
        report.notes(result.missing);
        for (const auto& text : result.contradictions) report.line("contradiction: " + printable(text));
        report.line(counted(result.inferred.size(), "word") + " inferred");
        if (!result.contradictions.empty()) report.answer_no();
        output.write(std::move(result.annotations), mesh->mesh, mesh.file());
    }

    FileInput vocabulary;
    AnnotationsOutput output;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_infer() { return make<AnnotationInfer>(); }

}  // namespace ostraka

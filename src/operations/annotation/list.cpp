// annotation list
#include "operations/annotation/annotation_report.h"
#include "operations/operations.h"

namespace ostraka {

namespace {

struct AnnotationList final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_annotations(p.report);
    }

    void run(Context& context, Report& report) override { report_annotations(context, report, object()); }
};

}  // namespace

std::unique_ptr<Operation> make_annotation_list() { return make<AnnotationList>(); }

}  // namespace ostraka

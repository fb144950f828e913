// measure refresh: recomputes all measures and descriptors.
#include "operations/measure/measured_object.h"

#include "ostraka/measure/measure.h"

namespace ostraka {

namespace {

struct MeasureRefresh final : Operation {
    void declare(Parameters& p) override {
        Slot& annotations = object.declare(p);
        annotations.needed = true;
        annotations.help = "annotations of the mesh (.ant.json)";
        p.options("merge-pickings", merge, "merge measures with the same name into one measure with repeated pickings");
        for (const char* count : {"computed", "stale", "merged"}) p.report.values(integer(count));
        p.report.table("measures", integer("annotation", "id"), text_only("tag"), text("name", "measure"),
                       number("value", "value"), number("uncertainty", "uncertainty"), text_only("unit"),
                       integer("pickings", "pickings"));
    }

    void run(Context&, Report& report) override {
        AnnotationSet set = object.read(report);
        std::size_t merged = 0;
        if (merge)
            for (Annotation& annotation : set.annotations) merged += merge_pickings(annotation);
        const RefreshResult refreshed = refresh_measures(object.mesh->mesh, set, true);
        report.notes(refreshed.notes);
        report("computed", refreshed.computed)("stale", refreshed.stale)("merged", merged);
        report.empty_table("measures");
        for (const Annotation& annotation : set.annotations)
            for (const Attribute& attribute : annotation.attributes) {
                const Measure* m = attribute.measure();
                if (m == nullptr || !m->value || !m->uncertainty) continue;
                report
                    .row("measures")("annotation", annotation.id)("name", attribute.name)(
                        "value", *m->value, number(*m->value, 6))("uncertainty", *m->uncertainty, number(*m->uncertainty, 3))(
                        "pickings", m->repeats.size() + 1)
                    .shown("tag", annotation.tag)
                    .shown("unit", m->unit);
            }
        if (refreshed.stale > 0) report.answer_no();
        object.write(std::move(set));
    }

    MeasuredObject object;
    bool merge = false;
};

}  // namespace

std::unique_ptr<Operation> make_measure_refresh() { return make<MeasureRefresh>(); }

}  // namespace ostraka

// cage check
#include "operations/cage/reach.h"
#include "operations/operations.h"

#include "ostraka/cage/cage.h"
#include "ostraka/semantic/cage_reach.h"

#include <algorithm>

namespace ostraka {

namespace {

struct CheckOfCage final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "cage file");
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json), for --graph");
        p.input_option(
            "graph", Kind::graph, graph,
            "relationships (.graph.json): report which constraints the cage can satisfy and where control points are missing");
        p.input_option("weights", Kind::coordinates, weights,
                       "weights of 'cage weights' (.npy), for --graph; default: mean-value");
        p.input_option("edit", Kind::edit, edit,
                       "edit (.edit.json), for --graph; by default a stretch by a tenth along x, y and z");
        p.report.checks = true;
        declare_reach(p.report);
    }

    void check() const override {
        if (static_cast<bool>(annotations) != static_cast<bool>(graph))
            fail_usage("--annotations and --graph need each other", "give both");
        if (!graph && (weights || edit)) fail_usage("--weights and --edit are for --graph", "add --annotations and --graph");
    }

    void run(Context&, Report& report) override {
        std::vector<Finding> cage_findings = findings(check_cage(cage->mesh, mesh->mesh), "");
        const bool sound =
            std::none_of(cage_findings.begin(), cage_findings.end(), [](const Finding& finding) { return finding.defect; });
        if (graph && sound) {
            for (const ConstraintReach& constraint : reach(report))
                if (!constraint.reached)
                    cage_findings.push_back(
                        {true, "/reach/" + std::to_string(constraint.id), ostraka::describe(constraint, *set_)});
        } else if (graph) {
            report.note("which constraints the cage can satisfy is determined only for a sound cage");
        }
        report.findings(cage_findings);
    }

private:
    [[nodiscard]] std::vector<ConstraintReach> reach(Report& report) {
        set_ = &annotations.on(mesh->mesh);
        report.set_unit(set_->unit);
        const std::string edit_name = edit ? edit.file() : "a stretch by a tenth";
        std::optional<Edit> given;
        if (edit) given = edit_from_json(*edit, edit_name);
        Coordinates mean_value;
        if (!weights) mean_value = compute_coordinates("mean-value", cage->mesh, mesh->mesh);
        const HandleSpace space{{mesh->mesh, *set_}, &cage->mesh, weights ? &weights.of(mesh->mesh, cage->mesh) : &mean_value};
        auto reaches =
            cage_reach(space, graph.on(*set_), given ? &*given : nullptr, edit_name, deform_tolerances(), graph.file());
        report_reach(report, reaches, *set_);
        return reaches;
    }

    MeshInput mesh, cage;
    AnnotationsInput annotations;
    GraphInput graph;
    CoordinatesInput weights;
    JsonInput edit;
    const AnnotationSet* set_ = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_cage_check() { return make<CheckOfCage>(); }

}  // namespace ostraka

// mesh refine
#include "operations/mesh/resizing.h"
#include "operations/operations.h"

#include "ostraka/remesh/refine.h"

namespace ostraka {

namespace {

struct MeshRefine final : MeshResizeBound {
    void declare(Parameters& p) override {
        declare_bound(p);
        options.declare_options(p.options);
        p.report.values(integer("levels"), integer("bisections"));
    }

    void run(Context& context, Report& report) override {
        const RefineResult result = resize(context, report, [&](BoundMesh& bound) { return bound.refine(options); });
        report("levels", result.levels)("bisections", result.bisections);
    }

    RefineOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_refine() { return make<MeshRefine>(); }

}  // namespace ostraka

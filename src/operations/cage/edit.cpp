// cage edit: moves the vertices of a cage by an edit that does not need a mesh.
#include "operations/operations.h"

#include "ostraka/cage/cage.h"
#include "ostraka/semantic/edit.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct CageEdit final : Operation {
    void declare(Parameters& p) override {
        p.input("cage", Kind::cage, cage, "cage file");
        p.input("edit", Kind::edit, edit, "edit of the cage vertices (.edit.json), which selects by cageVertices, box or all");
        p.output("output", Kind::cage, output, "cage to write");
        p.report.values(integer("steps"), integer("moved"), boolean("intersects"));
    }

    void run(Context&, Report& report) override {
        const Mesh& rest = cage->mesh;
        const Edit steps = edit_from_json(*edit, edit.file());
        refuse_annotations(steps);
        const AnnotationSet no_annotations;
        const Coordinates identity{"own", WeightMatrix::Identity(rest.number_of_vertices(), rest.number_of_vertices()), {}};
        const auto states = follow_edit(steps, {{rest, no_annotations}, &rest, &identity}, edit.file());
        Mesh moved = rest;
        std::size_t moved_count = 0;
        if (!states.empty()) {
            for (const Vertex v : moved.vertices()) moved.point(v) = states.back().handles[v];
            moved_count = static_cast<std::size_t>(std::count(states.back().touched.begin(), states.back().touched.end(), true));
        }
        const bool intersects = !check_cage(moved, Mesh()).intersections.empty();
        report("steps", states.size())("moved", moved_count)("intersects", intersects);
        report.line(
            fmt::format("{}, {} of {} vertices moved", counted(states.size(), "step"), moved_count, moved.number_of_vertices()));
        if (intersects) report.note("the moved cage intersects itself: it still deforms a mesh, but may fold it");
        output.write(std::move(moved), cage->extras);
    }

    /// Refuses steps that select by annotation: there are no annotations here.
    void refuse_annotations(const Edit& steps) const {
        for (std::size_t i = 0; i < steps.steps.size(); ++i)
            if (std::holds_alternative<EditStep::Annotations>(steps.steps[i].select))
                fail_input(fmt::format("{}, /steps/{}", edit.file(), i),
                           "selects by annotation, but 'cage edit' reads no annotations",
                           "select cageVertices, box or all, or use 'ostraka deform'");
    }

    MeshInput cage;
    JsonInput edit;
    MeshOutput output;
};

}  // namespace

std::unique_ptr<Operation> make_cage_edit() { return make<CageEdit>(); }

}  // namespace ostraka

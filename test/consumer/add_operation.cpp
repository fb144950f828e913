// How to add an operation: a class that declares its inputs, outputs, options and report, and works on objects. In the library
// the class stands in src/operations/mesh/edges.cpp and its entry in src/operations/table.cpp; the command, its help, the JSON
// schema and the Python function follow from the declaration.
#include <ostraka/core/error.h>
#include <ostraka/execution/parallel.h>
#include <ostraka/framework/inputs.h>
#include <ostraka/framework/operation.h>
#include <ostraka/framework/outputs.h>
#include <ostraka/synthetic/make_mesh.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

namespace {
using namespace ostraka;
using namespace ostraka::fields;

struct MeshEdges final : Operation {
    /// Declares everything that others must know; each name refers to a member that holds the value.
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output_option("lengths-out", Kind::values, lengths_out, "length of each edge");
        p.options("longer-than", longer_than, "count the edges longer than this", Range{0, 1e300}, "length");
        p.report.values(integer("edges", "edges"), integer("long_edges", "long edges"),
                        number("longest", "longest edge", "length"));
    }

    /// Works on objects only, whether they come from files or from memory; throws Error if the input is not usable.
    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        if (surface.number_of_edges() == 0) fail_input(mesh.file(), "the mesh has no edge", "give a mesh with faces");
        std::vector<double> lengths(surface.number_of_edges());
        parallel_for(lengths.size(), [&](std::size_t i) {  // one result per element: the same for any number of threads
            const Halfedge h = surface.halfedge(Edge(static_cast<Index>(i)));
            lengths[i] = std::sqrt(CGAL::squared_distance(surface.point(surface.source(h)), surface.point(surface.target(h))));
        });
        report("edges", lengths.size())("long_edges", std::count_if(lengths.begin(), lengths.end(), [&](double length) {
                                            return length > longer_than;
                                        }))("longest", *std::max_element(lengths.begin(), lengths.end()));
        if (lengths_out) lengths_out.write(std::move(lengths));
    }

    MeshInput mesh;
    ValuesOutput lengths_out;
    double longer_than = 0;
};
std::unique_ptr<Operation> make_mesh_edges() { return std::make_unique<MeshEdges>(); }
constexpr OperationEntry entry{"mesh edges", "count and measure the edges of a mesh", make_mesh_edges};
}  // namespace

/// Calls the operation as every interface does: on a synthetic sphere in memory.
int main() try {
    Context context;
    Call call(entry);
    MeshFile sphere;
    sphere.mesh = make_mesh(synthetic_object("sphere"), {.vertices = 2000}).mesh;
    const std::size_t edges = sphere.mesh.number_of_edges();
    call.set_object("mesh", Object::of(std::move(sphere), "sphere.ply"));
    call.set("longer-than", 1e-3);
    call.want("lengths-out");
    const Report report = call.run(context);
    const auto lengths = call.object("lengths-out").as<std::vector<double>>();
    return lengths->size() == edges && report.holds() ? 0 : 1;
} catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 2;
}

// measure map: curvature, thickness or distance, everywhere.
#include "operations.h"

#include "ostraka/geom/geodesic.h"
#include "ostraka/measure/descriptors.h"

#include <cmath>
#include <limits>

namespace ostraka {

namespace {

struct MeasureMap final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::values, output, "one value a vertex or face (.npy, or text)");
        p.options("of", of, "what", Choices{"mean-curvature", "gaussian-curvature", "thickness", "geodesic"}).required();
        p.options("on", on, "one value a vertex or a face", Choices{"vertex", "face"});
        p.options("from", from, "vertices that geodesic distances are measured from, like 12,88",
                  Range{0, std::numeric_limits<int>::max()});
        options.curvature_options.describe(p.options);
        options.thickness_options.describe(p.options);
        what = p.options.find("of");
        p.report.values(integer("values"), integer("without"));
        for (const char* figure : {"min", "5 %", "median", "mean", "95 %", "max"}) p.report.values(number(figure, figure));
    }

    void check() const override {
        if ((of == Of::geodesic) == from.empty())
            fail_usage(from.empty() ? "a geodesic map without --from" : "--from with a map of " + what->text(),
                       "--from names the vertices that geodesic distances are measured from");
        if (on == On::face && of != Of::thickness)
            fail_usage("a map of " + what->text() + " on faces", "faces have a thickness only");
    }

    void run(Context&, Report& report) override {
        std::vector<double> values = compute(), finite;
        for (double& value : values) {
            if (std::isinf(value)) value = std::numeric_limits<double>::quiet_NaN();
            if (std::isfinite(value)) finite.push_back(value);
        }
        if (finite.empty())
            fail_input(mesh.file(), "has no " + what->text() + " anywhere", "is it empty, or open on the side that rays run to?");
        const Statistics s = statistics(finite, std::vector<double>(finite.size(), 1), what->text());
        report.people(what->text(), std::to_string(finite.size()) + " of " + std::to_string(values.size()) + " values");
        report("values", values.size())("without", values.size() - finite.size())("min", s.min)("5 %", s.percentile_5)(
            "median", s.median)("mean", s.mean)("95 %", s.percentile_95)("max", s.max);
        output.write(std::move(values));
    }

    enum class Of { mean_curvature, gaussian_curvature, thickness, geodesic };
    enum class On { vertex, face };

    [[nodiscard]] std::vector<double> compute() const {
        const Mesh& on_mesh = mesh->mesh;
        DescriptorSearch search(on_mesh, options);
        switch (of) {
            case Of::mean_curvature:
                return search.curvature().mean;
            case Of::gaussian_curvature:
                return search.curvature().gaussian;
            case Of::thickness:
                return on == On::face ? search.thickness() : vertices_from_faces(on_mesh, search.thickness());
            case Of::geodesic:
                break;
        }
        const std::vector<Index> sources(from.begin(), from.end());
        for (const Index source : sources)
            if (source >= on_mesh.number_of_vertices())
                fail_usage("--from names vertex " + std::to_string(source) + ", but " + mesh.file() + " has " +
                               std::to_string(on_mesh.number_of_vertices()) + " vertices",
                           "was it picked on another mesh?");
        return geodesic_distances(on_mesh, sources);
    }

    MeshInput mesh;
    ValuesOutput output;
    Of of = Of::mean_curvature;
    On on = On::vertex;
    std::vector<int> from;
    DescriptorOptions options;
    const Option* what = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_measure_map() { return make<MeasureMap>(); }

}  // namespace ostraka

// measure map: curvature, thickness or distance at every vertex.
#include "file_attribute.h"

#include "ostraka/geom/geodesic.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/render/values.h"

#include <cmath>
#include <limits>

namespace ostraka {

namespace {

struct MeasureMap final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::values, output, "file to write: one value per vertex or face (.npy, or text)");
        p.options("of", of, "quantity to compute", Choices{"mean-curvature", "gaussian-curvature", "thickness", "geodesic"})
            .required();
        p.options("on", on, "whether there is one value per vertex or per face", Choices{"vertex", "face"});
        p.options("from", from, "vertices that geodesic distances are measured from, like 12,88",
                  Range{0, std::numeric_limits<int>::max()});
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the mesh (.ant.json), one of which gets the map as an attribute");
        attribute.describe(p, "NAME of --of");
        p.options("annotation", annotation, "id or tag of the annotation that gets it; the whole object if left out");
        p.options("unit", unit, "unit of the coordinates, where the annotations do not say (any text, such as mm)");
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
        if (!attribute && (annotations || !annotation.empty()))
            fail_usage("annotations are given, but none are written", "add --annotations-out FILE, or leave them out");
        if (!annotations && !annotation.empty())
            fail_usage("--annotation names a part, but no annotation file is given", "add --annotations FILE");
        attribute.check(output, ".npy");
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
        if (attribute) write_attribute(values, report);
        output.write(std::move(values));
    }

    void write_attribute(const std::vector<double>& values, Report& report) const {
        AnnotationSet set;
        if (annotations) set = annotations.on(mesh->mesh);
        if (set.unit.empty()) set.unit = unit;
        const int holder =
            annotation.empty() ? ensure_root(set, mesh->mesh).id : find_annotation(set, annotation, annotations.file()).id;
        std::string in = set.unit;
        if (!in.empty() && of == Of::mean_curvature) in = "1/" + in;
        if (!in.empty() && of == Of::gaussian_curvature) in = "1/" + in + "^2";
        attribute.write(std::move(set), holder, output, {what->text(), in, checksum(values)}, mesh, report);
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

    /// Checksum of the file of values; empty in memory, where no file is written yet.
    [[nodiscard]] std::string checksum(const std::vector<double>& values) const {
        if (output.sources.front().file.empty()) return {};
        Object file = Object::of(values, output.file_name());
        file.write = [&values](const Path& path) { write_values(path, values); };
        return file.checksums().sha256;
    }

    MeshInput mesh;
    ValuesOutput output;
    Of of = Of::mean_curvature;
    On on = On::vertex;
    std::vector<int> from;
    AnnotationsInput annotations;
    FileAttribute attribute;
    std::string annotation, unit;
    DescriptorOptions options;
    const Option* what = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_measure_map() { return make<MeasureMap>(); }

}  // namespace ostraka

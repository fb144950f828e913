// measure map: curvature, thickness, distance, volumes in balls or occlusion at every vertex.
#include "operations/file_attribute.h"

#include "ostraka/fields/ball_volume.h"
#include "ostraka/files/npy.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/render/values.h"
#include "ostraka/texture/vertex_occlusion.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace ostraka {

namespace {

struct MeasureMap final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.output("output", Kind::values, output, "file to write: one value per vertex or face (.npy, or text)");
        p.options("of", quantity, "quantity whose map is computed",
                  Choices{"mean-curvature", "gaussian-curvature", "thickness", "geodesic", "volume", "occlusion", "sky-view"})
            .required();
        p.options("on", element, "whether the map has one value per vertex or one per face", Choices{"vertex", "face"});
        p.options("from", source_vertices, "indices of the vertices from which geodesic distances are measured, like 12,88",
                  Range{0, std::numeric_limits<int>::max()});
        p.options(
            "scales", scales,
            "volume: radii of the balls around each vertex, ascending, such as 0.005,0.01,0.02; the map has the shares of the "
            "first, --features those of all",
            Range{1e-9, 2}, "shares of the diagonal");
        p.output_option("features", Kind::table, features,
                        "volume: file to write (.npy): a row per vertex and a column per radius of --scales");
        p.options("occlusion-rays", occlusion.rays, "occlusion, sky-view: number of rays per vertex", Range{1, 4096});
        p.options("occlusion-distance", occlusion.distance, "occlusion, sky-view: length of the rays", Range{0.0001, 2},
                  "share of the diagonal");
        up.declare(p, "sky-view: upward direction of the relief; by default that of the annotations, or z");
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the mesh (.ant.json); --annotation gets an attribute that refers to the map");
        attribute.declare(p, "NAME of --of");
        p.options("annotation", annotation,
                  "id or tag of the annotation that gets the new attribute; the whole object if left out");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm), if the annotations do not state a unit");
        options.curvature_options.declare_options(p.options);
        options.thickness_options.declare_options(p.options);
        quantity_option = p.options.find("of");
        p.report.values(integer("values"), integer("without"));
        for (const char* figure : {"min", "5 %", "median", "mean", "95 %", "max"}) p.report.values(number(figure, figure));
    }

    void check() const override {
        if ((quantity == MapQuantity::geodesic) == source_vertices.empty())
            fail_usage(
                source_vertices.empty() ? "a geodesic map without --from" : "--from with a map of " + quantity_option->text(),
                "--from names the vertices that geodesic distances are measured from");
        if (element == MapElement::face && quantity != MapQuantity::thickness)
            fail_usage(fmt::format("a map of {} on faces", quantity_option->text()), "only thickness is defined on faces");
        if ((quantity == MapQuantity::volume) == scales.empty())
            fail_usage(scales.empty() ? "a map of volumes without --scales" : "--scales with a map of " + quantity_option->text(),
                       "--scales gives the radii of the balls of a map of volumes, such as 0.005,0.01,0.02");
        if (features && quantity != MapQuantity::volume)
            fail_usage("--features with a map of " + quantity_option->text(), "only volumes have several scales");
        if (features && !features.sources.front().file.empty() && extension(features.file()) != ".npy")
            fail_usage(fmt::format("features cannot be written to '{}'", printable(features.file(), 60)), "end its name in .npy");
        if (up && quantity != MapQuantity::sky_view)
            fail_usage("--up with a map of " + quantity_option->text(), "only the sky view has an upward direction");
        if (!attribute && quantity != MapQuantity::sky_view && (annotations || !annotation.empty()))
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
            fail_input(mesh.file(), fmt::format("has no {} anywhere", quantity_option->text()),
                       "check whether it is empty, or open on the side that the rays go to");
        const Statistics s = statistics(finite, std::vector<double>(finite.size(), 1), quantity_option->text());
        report.text_only(quantity_option->text(), fmt::format("{} of {} values", finite.size(), values.size()));
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
        std::string attribute_unit = set.unit;
        if (!attribute_unit.empty() && quantity == MapQuantity::mean_curvature) attribute_unit = "1/" + attribute_unit;
        if (!attribute_unit.empty() && quantity == MapQuantity::gaussian_curvature)
            attribute_unit = fmt::format("1/{}^2", attribute_unit);
        attribute.write(std::move(set), holder, output, {quantity_option->text(), attribute_unit, checksum(values)}, mesh,
                        report);
    }

    enum class MapQuantity { mean_curvature, gaussian_curvature, thickness, geodesic, volume, occlusion, sky_view };
    enum class MapElement { vertex, face };

    [[nodiscard]] std::vector<double> compute() const {
        const Mesh& surface = mesh->mesh;
        DescriptorSearch search(surface, options);
        switch (quantity) {
            case MapQuantity::mean_curvature:
                return search.curvature().mean;
            case MapQuantity::gaussian_curvature:
                return search.curvature().gaussian;
            case MapQuantity::thickness:
                return element == MapElement::face ? search.thickness() : vertices_from_faces(surface, search.thickness());
            case MapQuantity::volume:
                return volumes();
            case MapQuantity::occlusion:
                return vertex_occlusion(surface, occlusion);
            case MapQuantity::sky_view:
                return sky_view(surface);
            case MapQuantity::geodesic:
                break;
        }
        const std::vector<Index> sources(source_vertices.begin(), source_vertices.end());
        for (const Index source : sources)
            if (source >= surface.number_of_vertices())
                fail_usage(fmt::format("--from names vertex {}, but {} has {} vertices", source, mesh.file(),
                                       surface.number_of_vertices()),
                           "give a vertex of this mesh");
        return geodesic_distances(surface, sources);
    }

    /// Shares of the balls of the first radius; the shares of all radii are written to --features.
    [[nodiscard]] std::vector<double> volumes() const {
        std::vector<double> radii = scales;
        for (double& radius : radii) radius *= box_diagonal(mesh->mesh);
        const BallVolumes result = in_file(mesh.file(), [&] { return ball_volumes(mesh->mesh, radii); });
        if (features) write_npy(features.path(), result.shares, {mesh->mesh.number_of_vertices(), result.scales});
        return result.at_scale(0);
    }

    [[nodiscard]] std::vector<double> sky_view(const Mesh& surface) const {
        std::array<double, 3> direction{0, 0, 1};
        if (up) direction = *up.value();
        else if (annotations && annotations.on(surface).up) direction = *annotations.on(surface).up;
        return vertex_sky_view(surface, Vector(direction[0], direction[1], direction[2]), occlusion);
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
    MapQuantity quantity = MapQuantity::mean_curvature;
    MapElement element = MapElement::vertex;
    std::vector<int> source_vertices;
    AnnotationsInput annotations;
    FileAttribute attribute;
    std::string annotation, unit;
    DescriptorOptions options;
    std::vector<double> scales;
    FileOutput features{".npy"};
    VertexOcclusionOptions occlusion;
    DirectionOption up;
    const Option* quantity_option = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_measure_map() { return make<MeasureMap>(); }

}  // namespace ostraka

// mesh surface: the surface of a point cloud.
#include "operations/operations.h"

#include "ostraka/point_cloud/cloud_surface.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

/// How the surface is reconstructed, in the order of the choices of --method.
enum class SurfaceMethod { advancing_front, poisson };

struct MeshSurface final : Operation {
    MeshSurface() { front.close_holes = 0.02; }

    void declare(Parameters& p) override {
        p.input("cloud", Kind::point_cloud, cloud_file,
                "points to read: .e57, .las, .pts, .ptx, .pcd, .xyz, .asc, .csv, .txt, or .ply, .obj, .off without faces");
        p.output("output", Kind::mesh, output.with_ascii_option(), "mesh to write: .ply, .obj, .off, .stl, .glb");
        p.options("method", method,
                  "advancing-front: triangles between the points; poisson: a smooth surface near the points, for noisy clouds",
                  Choices{"advancing-front", "poisson"});
        p.options("trim", trim,
                  "triangles farther than this from the nearest point are removed, in multiples of the point spacing; 0: none; "
                  "if left out, 4 for poisson, else 0",
                  Range{0, 1e6});
        p.options("trim-length", trim_length, "same effect as --trim, but in the unit of the coordinates", Range{0, 1e60});
        p.options("outliers", outliers,
                  "outliers are removed: points whose mean distance to their neighbours is more than this factor times the "
                  "median; 0: keep all points",
                  Range{0, 1e6});
        p.options("colour-neighbours", colour_neighbours,
                  "number of nearest points from which the colour and intensity of a vertex are interpolated, weighted by the "
                  "inverse distance",
                  Range{1, 1000});
        poisson.declare_options(p.options);
        front.declare_options(p.options);
        p.report.values(integer("points", "points"), integer("outliers", "outliers removed"), text("normals", "normals"),
                        text("method", "method"), number("spacing", "point spacing", "length"), integer("vertices", "vertices"),
                        integer("triangles", "triangles"), number("area", "area", "length^2"),
                        integer("holes", "borders (holes and rims)"), number("border_length", "length of borders", "length"),
                        number("trim_distance", "trimmed beyond", "length"), number("trimmed_area", "area trimmed", "length^2"),
                        texts("carried", "carried to the vertices"));
    }

    void check() const override {
        if (trim && trim_length)
            fail_usage("--trim and --trim-length are both given", "give one of them: --trim counts in multiples of the spacing");
        if (outliers != 0 && outliers < 1)
            fail_usage("--outliers below 1 would remove most points", "give 0 to keep all, or a number such as 3");
    }

    /// A Delaunay triangulation takes about one kilobyte per point.
    [[nodiscard]] double memory_needed(double input_bytes) const override { return 80 * input_bytes; }

    void run(Context& context, Report& report) override {
        PointCloud cloud = read();
        context.notes(cloud_file.file(), cloud.notes);
        report("points", cloud.points.size());
        CloudSurface surface = in_file(cloud_file.file(), [&] { return surface_of(cloud, report); });
        report.notes(surface.notes);
        MeshExtras extras = carried_to_vertices(cloud, surface.mesh, colour_neighbours);
        std::vector<std::string> carried;
        if (!extras.vertex_colours.empty()) carried.emplace_back("colours");
        if (!extras.vertex_values.empty()) carried.emplace_back("intensity");
        report("vertices", surface.mesh.number_of_vertices())("triangles", surface.mesh.number_of_faces())(
            "area", surface_area(surface.mesh))("holes", surface.border_loops)("border_length", surface.border_length)(
            "carried", carried,
            carried.empty() ? std::string("nothing: the points have neither colours nor intensities") : joined(carried));
        output.write(std::move(surface.mesh), std::move(extras));
    }

    [[nodiscard]] PointCloud read() const {
        return cloud_file.load<PointCloud>([](const Path& file) {
            std::optional<PointCloud> points = read_point_cloud(file);
            if (!points)
                fail_input(file.string(), "has faces, so that it has a surface already",
                           "use it as it is, or make an object of it: ostraka import " + file.string() + " OBJECT");
            return std::move(*points);
        });
    }

    /// Removes outliers from the cloud, estimates its normals if there are none, and makes and trims the surface.
    CloudSurface surface_of(PointCloud& cloud, Report& report) const {
        const std::size_t removed = outliers > 0 ? remove_outliers(cloud, outliers) : 0;
        const bool estimated = cloud.normals.empty();
        if (estimated) cloud.normals = estimate_normals(cloud.points, front);
        const double spacing = point_spacing(cloud.points);
        const bool by_poisson = method == SurfaceMethod::poisson;
        report("outliers", removed)("normals", estimated ? "estimated" : "of the file")(
            "method", by_poisson ? "poisson" : "advancing-front")("spacing", spacing);
        CloudSurface surface = by_poisson ? poisson_surface(cloud, poisson, front) : reconstruct_surface(cloud, front);
        constexpr double poisson_trim = 4;
        const double distance = trim_length ? *trim_length : spacing * trim.value_or(by_poisson ? poisson_trim : 0);
        if (!(distance > 0)) return surface;
        const double area = trim_surface(surface, cloud.points, distance);
        report("trim_distance", distance)("trimmed_area", area);
        return surface;
    }

    FileInput cloud_file;
    MeshOutput output;
    SurfaceMethod method = SurfaceMethod::advancing_front;
    std::optional<double> trim, trim_length;
    double outliers = 0;
    int colour_neighbours = 4;
    PoissonOptions poisson;
    CloudOptions front;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_surface() { return make<MeshSurface>(); }

}  // namespace ostraka

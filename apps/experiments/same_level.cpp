// Figures 5.3 and 5.4 of the thesis: the flowered teapot is stretched vertically; its flowers keep their shape and level.
#include "semantics.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"
#include "ostraka/figures/plot.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

constexpr double factor = 1.4;
constexpr double ring_radius = 1.6;  ///< in units of a flower's radius
constexpr double tilt = 20 * M_PI / 180;

/// A row of the table. If the details are those of the edited shape, all other settings are the defaults.
struct Variant {
    std::string name, file, parameters;
    double weight = 1, laplacian = 2;
    std::string details = "rest";
    int iterations = 3;
    bool accelerated = false;
    bool tilted = false;
};

std::vector<Variant> variants() {
    std::vector<Variant> list;
    const std::string thesis = R"("reference": "vertex")";
    const std::string direction =
        R"(, "direction": [)" + std::to_string(std::sin(tilt)) + ", 0, " + std::to_string(std::cos(tilt)) + "]";
    // Figure 5.3b; 5.4a, b, c, d.
    for (const auto& [name, file, parameters, laplacian] : {std::tuple{"thesis, 4 against 4", "thesis", thesis, 4.0},
                                                            {"without Laplacian displacement", "no-laplacian", thesis, 0.0},
                                                            {"Laplacian displacement 2 against 4", "2-against-4", thesis, 2.0},
                                                            {"Laplacian displacement 10 against 4", "10-against-4", thesis, 10.0},
                                                            {"plane tilted by 20 degrees", "tilted", thesis + direction, 4.0}})
        for (const bool converged : {false, true})
            list.push_back({name + std::string(converged ? ", converged" : ", 3 iterations"),
                            file + std::string(converged ? "-converged" : "-3"), "{" + parameters + "}", 4, laplacian, "rest",
                            converged ? 2000 : 3, converged, std::string(file) == "tilted"});
    list.push_back({"defaults, soft", "soft", "{}", 1, 2, "edited", usual.iterations, true});
    list.push_back({"defaults, hard", "hard", R"({"hard": true})", 1, 2, "edited", usual.iterations, true});
    list.push_back({"seated", "seat", R"({"shapes": "seat"})", 1, 2, "edited", usual.iterations, true});
    return list;
}

/// Faces around the flowers: outside all of them, within a multiple of the radius around the centre of one.
struct Ring {
    std::vector<Index> faces, vertices;
};

Ring ring_of(const Subject& pot, const std::vector<int>& flowers) {
    std::vector<bool> inside(pot.mesh.number_of_faces(), false), ring(inside.size(), false);
    for (const int id : flowers)
        for (const Index f : pot.annotations.find(id)->faces) inside[f] = true;
    const std::vector<Point> points = points_of(pot.mesh);
    for (const int id : flowers) {
        const std::vector<Index> vertices = vertices_of(pot.mesh, *pot.annotations.find(id));
        const Vector3d middle = centre_of(points, vertices);
        double radius = 0;
        for (const Index v : vertices) radius = std::max(radius, (eigen(points[v]) - middle).norm());
        for (const Face f : pot.mesh.faces())
            if (!inside[f] && (eigen(centroid(pot.mesh, f)) - middle).norm() <= ring_radius * radius) ring[f] = true;
    }
    Annotation region;
    region.faces = flagged(ring);
    return {region.faces, touched_vertices(pot.mesh, region)};
}

/// The vertex nearest to the mean of a flower's vertices in their plane (section 5.2.1).
Index reference_vertex(const std::vector<Point>& points, const std::vector<Index>& vertices) {
    const Vector3d mean = centre_of(points, vertices);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Index v : vertices) spread += (eigen(points[v]) - mean) * (eigen(points[v]) - mean).transpose();
    const Vector3d normal = SymmetricEigen3(spread).eigenvectors().col(0);
    const auto off = [&](Index v) { return normal.cross(eigen(points[v]) - mean).squaredNorm(); };
    return *std::min_element(vertices.begin(), vertices.end(), [&](Index v, Index w) { return off(v) < off(w); });
}

struct Measures {
    double heights = 0;     ///< difference of the heights of the flowers' means in the constrained direction, mm
    double centroids = 0;   ///< the same for the area centroids
    double references = 0;  ///< the same for the reference vertices (thesis, section 5.2.1)
    double rigid = 0;       ///< rms distance from a rigid copy, of the worst flower, mm
    double stretch = 0;     ///< (a), mean over the ring
    double off = 0;         ///< (b), rms distance of the ring's vertices from the edited surface, % of the diagonal
    double turned = 0;      ///< (b), mean angle between the ring's normals and those of the edited surface, degrees
};

class Teapot {
public:
    explicit Teapot(const SemanticOptions& options)
        : options_(options),
          pot_(synthetic_subject(options.data, "teapot", options.vertices == 0 ? 60000 : options.vertices)),
          rest_(points_of(pot_.mesh)) {
        for (const Annotation& annotation : pot_.annotations.annotations)
            if (annotation.tag.starts_with("flower ")) flowers_.push_back(annotation.id);
        if (flowers_.size() != 5)
            fail_input((Path(options.data) / "teapot.recipe.json").string(), "has not five flowers", "use the project's own");
        for (const int id : flowers_)
            references_[id] = reference_vertex(rest_, vertices_of(pot_.mesh, *pot_.annotations.find(id)));
        edited_ = warped(rest_, [](Vector3d p) { return p.z() *= factor, p; });
        ring_ = ring_of(pot_, flowers_);
        edited_mesh_ = with_points(pot_.mesh, edited_);
    }

    void run() {
        const Path folder(options_.output);
        const std::vector<Variant> list = variants();
        Trials trials{pot_};
        trials.given("rest", "rest", rest_);
        trials.given("stretched, unconstrained", "unconstrained", edited_);
        for (const Variant& variant : list) trials.solved(variant.name, variant.file, method(variant), solving(variant));
        const SurfaceSearch surface(edited_mesh_);
        Plot trade{"Flowers kept against their surroundings",
                   {"rms distance of the worst flower from a rigid copy, mm", true, {}, {}},
                   {"mean stretch of the ring", false, 0.0, {}},
                   {}};
        const auto variant_of = [&](const Outcome& outcome) {
            return std::find_if(list.begin(), list.end(), [&](const Variant& variant) { return variant.name == outcome.name; });
        };
        const auto cells = [&](const Outcome& outcome) -> std::vector<std::string> {
            if (outcome.name == "rest") return {};
            const auto variant = variant_of(outcome);
            const bool solved = variant != list.end();
            const Measures m = measure(outcome.points, surface, solved && variant->tilted);
            // Rows that differ in iterations or in soft and hard constraints form one series.
            const std::string name = outcome.name.substr(0, outcome.name.rfind(", "));
            if (solved && (trade.series.empty() || trade.series.back().name != name)) trade.series.push_back({name, {}});
            if (solved) trade.series.back().points.push_back({m.rigid, m.stretch});
            return {solved ? variant->details : "",
                    fixed(m.heights, 4),
                    fixed(m.centroids, 4),
                    fixed(m.references, 4),
                    fixed(m.rigid, 4),
                    fixed(m.stretch, 4),
                    fixed(m.off, 4),
                    fixed(m.turned, 2)};
        };
        TextTable table =
            trial_table({"details", "difference of heights mm", "of centroids mm", "of reference vertices mm",
                         "from a rigid copy mm", "ring: stretch", "ring: off the surface %", "ring: normals degrees"});
        trials.write(folder, table, cells, [&](const Outcome& outcome) {
            std::vector<double> map(pot_.mesh.number_of_faces(), std::numeric_limits<double>::quiet_NaN());
            const std::vector<double> stretch = distortions(pot_.mesh, edited_, outcome.points);
            for (const Index f : ring_.faces) map[f] = stretch[f];
            return map;
        });
        write_table(table, folder, "table");
        write_plot(folder / "trade-off.svg", trade);
        compare_convergence(folder,
                            {problem_of("thesis", "Same level on the teapot, thesis mode, 4 against 4", method(list.front())),
                             problem_of("defaults", "Same level on the teapot, defaults, soft", method(list[list.size() - 3]))},
                            options_.convergence);
    }

private:
    [[nodiscard]] Method method(const Variant& variant) const {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", flowers_, variant.parameters, variant.weight));
        DeformOptions options;
        set_option(options, "details", variant.details);
        options.laplacian = variant.laplacian;
        options.handles = 0.001;  // the edit moves all vertices
        return deform_method(pot_, edited_, std::move(graph), options);
    }
    static SolveOptions solving(const Variant& variant) {
        SolveOptions options = usual;
        options.iterations = variant.iterations;
        if (!variant.accelerated) options.window = 0;
        return options;
    }

    [[nodiscard]] Measures measure(const std::vector<Point>& points, const SurfaceSearch& surface, bool tilted) const {
        Measures result;
        const Vector3d up = tilted ? Vector3d(std::sin(tilt), 0, std::cos(tilt)) : Vector3d(0, 0, 1);
        const Mesh mesh = with_points(pot_.mesh, points);
        std::vector<double> means, centroids, references;
        for (const int id : flowers_) {
            const auto vertices = vertices_of(pot_.mesh, *pot_.annotations.find(id));
            means.push_back(up.dot(centre_of(points, vertices)));
            centroids.push_back(up.dot(eigen(area_moments(mesh, pot_.annotations.find(id)->faces).centroid)));
            references.push_back(up.dot(eigen(points[references_.at(id)])));
            result.rigid = std::max(result.rigid, rigid_distance(pot_, vertices, points));
        }
        const auto spread = [](const std::vector<double>& heights) {
            const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
            return *high - *low;
        };
        result.heights = spread(means);
        result.centroids = spread(centroids);
        result.references = spread(references);
        std::vector<double> turned(pot_.mesh.number_of_faces(), 0);
        for (const Index f : ring_.faces) {
            const Vector3d n = eigen(area_vector(mesh, Face(f))),
                           m = eigen(surface.normal(surface.closest(centroid(mesh, Face(f))).face));
            turned[f] = std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / M_PI;
        }
        double squares = 0;
        for (const Index v : ring_.vertices) squares += std::pow(surface.closest(points[v]).distance, 2);
        result.stretch = mean_over(pot_.mesh, ring_.faces, distortions(pot_.mesh, edited_, points));
        result.turned = mean_over(pot_.mesh, ring_.faces, turned);
        result.off = 100 * std::sqrt(squares / static_cast<double>(ring_.vertices.size())) / box_diagonal(pot_.mesh);
        return result;
    }

    const SemanticOptions& options_;
    Subject pot_;
    std::vector<Point> rest_;
    std::vector<int> flowers_;
    std::map<int, Index> references_;
    std::vector<Point> edited_;
    Mesh edited_mesh_;
    Ring ring_;
};

const Registration registered(
    "same-level", "flowers of a stretched teapot (thesis, figures 5.3 and 5.4)",
    +[](const SemanticOptions& options) { Teapot(options).run(); });

}  // namespace

}  // namespace ostraka::experiments

#include "ostraka/reconstruction/fit.h"

#include "reconstruction/fitter.h"

#include "ostraka/core/error.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/reconstruction/template_cage.h"
#include "ostraka/remesh/simplify.h"

#include <algorithm>

namespace ostraka {

namespace {

/// The template with fewer vertices, for what is smooth anyway.
struct Coarse {
    Mesh mesh;
    std::vector<Index> vertex_map, face_origin;
};

Coarse coarsened(const Mesh& mesh, std::size_t vertices) {
    Coarse coarse{mesh, {}, {}};
    SimplifyOptions options;
    options.vertices = vertices;
    options.outlines = SimplifyOptions::Outlines::ignore;
    const SimplifyResult simplified = simplify(coarse.mesh, options);
    coarse.vertex_map = simplified.vertex_map;
    coarse.face_origin.resize(coarse.mesh.number_of_faces());
    for (Index f = 0; f < simplified.face_map.size(); ++f)
        if (simplified.face_map[f] != no_index) coarse.face_origin[simplified.face_map[f]] = f;
    return coarse;
}

constexpr std::size_t coarse_vertices = 4000;  // vertices that show every shape of the first levels

}  // namespace

struct TemplateFitter::State : AnnotatedMeshView {
    State(AnnotatedMeshView template_object, const TemplateCage* template_cage)
        : AnnotatedMeshView(template_object),
          cage(template_cage),
          diagonal(box_diagonal(template_object.mesh)),
          fine(template_object.mesh) {}

    /// Simplifies the template if it is large enough.
    void prepare() {
        if (coarse || mesh.number_of_vertices() <= 2 * coarse_vertices) return;
        coarse = std::make_unique<Coarse>(coarsened(mesh, coarse_vertices));
        smooth = std::make_unique<LevelSystem>(coarse->mesh);
        edge = mean_edge_length(coarse->mesh);
        const SurfaceSearch search(coarse->mesh);
        nearest.resize(mesh.number_of_vertices());
        parallel_for(nearest.size(),
                     [&](std::size_t i) { nearest[i] = search.closest(mesh.point(Vertex(static_cast<Index>(i)))); });
    }

    /// Coordinates of the vertices used in cage space levels.
    [[nodiscard]] const CageWeights& weights() {
        if (!coarse) return cage->coordinates.vertex;
        if (coarse_weights.size() == 0)
            coarse_weights = compute_coordinates(cage->coordinates.kind, cage->cage, coarse->mesh).vertex;
        return coarse_weights;
    }

    /// Moves the fine mesh with the neighbourhood of the nearest point of the coarse mesh.
    [[nodiscard]] Points follow(const Fitter& fitter) const {
        const std::vector<Matrix3d> rotations = fitter.rotations();
        Points points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
        parallel_for(nearest.size(), [&](std::size_t i) {
            const Vector3d p = eigen(mesh.point(Vertex(static_cast<Index>(i))));
            const auto c = corners(coarse->mesh, Face(nearest[i].face));
            Vector3d sum = Vector3d::Zero();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto v = static_cast<Eigen::Index>(c[k]);
                sum += nearest[i].barycentric[k] * (rotations[c[k]] * (p - fitter.rest().col(v)) + fitter.current().col(v));
            }
            points.col(static_cast<Eigen::Index>(i)) = sum;
        });
        return points;
    }

    /// On the coarse mesh, or on the template if there is none.
    [[nodiscard]] Fitter smooth_fitter(const MatchSearch& search, const NonRigidOptions& options) {
        std::vector<CorrespondenceConstraint> correspondences = search.correspondences();
        if (!coarse) return {fine, search, search.labels(mesh, {}), std::move(correspondences), diagonal, options};
        for (CorrespondenceConstraint& correspondence : correspondences) {
            const Index coarse_vertex = coarse->vertex_map[correspondence.vertex];
            if (coarse_vertex != no_index)
                correspondence.place +=
                    eigen(coarse->mesh.point(Vertex(coarse_vertex))) - eigen(mesh.point(Vertex(correspondence.vertex)));
            correspondence.vertex = coarse_vertex;
        }
        std::erase_if(correspondences, [&](const CorrespondenceConstraint& correspondence) {
            return correspondence.vertex >= coarse->mesh.number_of_vertices();
        });
        return {
            *smooth,  search, search.labels(coarse->mesh, coarse->face_origin, coarse->vertex_map), std::move(correspondences),
            diagonal, options};
    }

    /// Solves levels in cage space; returns the first level left for the template's vertices.
    int fit_cage(const MatchSearch& search, const NonRigidOptions& options, Fitter& exact, NonRigidFit& fit) {
        if (cage == nullptr) fail_usage("the fit uses a cage, but the template has none", "give the cage of the template");
        const Points at_rest = columns_of(cage->cage);
        Fitter cage_fitter = smooth_fitter(search, options);
        cage_fitter.use_cage(weights(), at_rest);
        const int level = options.space == NonRigidOptions::Space::both ? std::max(1, options.levels - 1) : options.levels;
        cage_fitter.run(0, level, fit);
        exact.start_at(points_of(cage->coordinates.vertex, cage_fitter.cage()));
        if (level == options.levels) {
            exact.use_cage(cage->coordinates.vertex, cage_fitter.cage());
            exact.polish(options.last_search_radius * diagonal, Fitter::smoothing(options, level - 1, diagonal), fit);
        }
        return level;
    }

    /// Solves the levels that are smooth on the coarse mesh; returns the first one that is not.
    int fit_coarse(const MatchSearch& search, const NonRigidOptions& options, Fitter& exact, NonRigidFit& fit) {
        constexpr double edges = 0.8;  // min smoothing length, in edges of the coarse mesh
        int level = 0;
        while (level < options.levels && Fitter::smoothing(options, level, diagonal) >= edges * edge) ++level;
        Fitter coarse_fitter = smooth_fitter(search, options);
        coarse_fitter.run(0, level, fit);
        const ScopedSeconds watch(fit.seconds_coarsening);
        if (level > 0) exact.start_at(follow(coarse_fitter));
        return level;
    }

    const TemplateCage* cage;
    double diagonal;
    LevelSystem fine;
    CageWeights coarse_weights;
    std::unique_ptr<Coarse> coarse;
    std::unique_ptr<LevelSystem> smooth;  ///< of the coarse mesh
    double edge = 0;                      ///< its mean edge length
    std::vector<SurfaceHit> nearest;      ///< per vertex, nearest point on it
};

TemplateFitter::TemplateFitter(AnnotatedMeshView template_object, const TemplateCage* cage) {
    if (template_object.mesh.number_of_faces() == 0) fail_input("template", "has no faces", "check that it is the right file");
    if (cage != nullptr) {
        if (cage->coordinates.has_normals())
            fail_usage(cage->coordinates.kind + " coordinates have a normal term, which a fit cannot use",
                       "use mean-value coordinates");
        if (static_cast<std::size_t>(cage->coordinates.vertex.rows()) != template_object.mesh.number_of_vertices() ||
            static_cast<std::size_t>(cage->coordinates.vertex.cols()) != cage->cage.number_of_vertices())
            fail_usage("the coordinates of the cage do not belong to the template's vertices", "compute them again");
    }
    state_ = std::make_unique<State>(template_object, cage);
}
TemplateFitter::~TemplateFitter() = default;
TemplateFitter::TemplateFitter(TemplateFitter&&) noexcept = default;

NonRigidFit TemplateFitter::fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options) {
    check_options(options, "fit");
    if ((options.counterparts == NonRigidOptions::Counterparts::best ||
         options.counterparts == NonRigidOptions::Counterparts::one_to_one) &&
        !(options.vertices.boundary + options.vertices.distance + options.vertices.outline > 0))
        fail_usage("all three weights of the vertex assignment are zero", "give --distance-weight or another one");
    State& s = *state_;
    NonRigidFit fit;
    const bool slides = options.counterparts == NonRigidOptions::Counterparts::sliding;
    MatchSearch search(s, fragments, scale, options.outlines ? MatchSearch::Guides::paths : MatchSearch::Guides::landmarks);
    if (slides) search.recognise_shared_faces();
    {
        const ScopedSeconds watch(fit.seconds_coarsening);
        s.prepare();
    }
    Fitter fine(s.fine, search, search.labels(s.mesh, {}), search.correspondences(), s.diagonal, options);
    int level = 0;
    if (options.space != NonRigidOptions::Space::mesh) level = s.fit_cage(search, options, fine, fit);
    else if (s.coarse) level = s.fit_coarse(search, options, fine, fit);
    fine.run(level, options.levels, fit);
    fit.matches = fine.match(options.last_search_radius * s.diagonal, fit);
    // Converts from the template's unit.
    for (VertexMatch& match : fit.matches) {
        match.place *= scale;
        match.distance *= scale;
    }
    for (NonRigidFit::Level& record : fit.levels) {
        record.smoothing *= scale;
        record.residual *= scale;
    }
    for (Eigen::Index i = 0; i < fine.current().cols(); ++i) fit.points.push_back(point_of(scale * fine.current().col(i)));
    return fit;
}

NonRigidFit fit_template(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options) {
    return TemplateFitter(scaled).fit(1, fragments, options);
}

void NonRigidOptions::declare_options(OptionList& list) {
    list("space", space,
         "unknowns of the fit. mesh: vertices of the template. cage: vertices of a cage around the template, with fewer degrees "
         "of freedom, so that noise causes no folds. both: the cage first, the template in the last level",
         Choices{"mesh", "cage", "both"});
    list("smoothing", start, "smoothing length of the first level", Range{1e-3, 10}, "share of the template's diagonal");
    list("detail", end, "smoothing length of the last level, as a share of the diagonal: shorter details are not fitted",
         Range{1e-4, 10});
    list("levels", levels, "number of levels of the fit, from stiff to flexible", Range{1, 100});
    list("steps", steps, "maximum number of iterations (matching and solving) in each level", Range{1, 1000});
    list("transition", first_decay_length,
         "first level: distance from observed surface over which the deformation decreases to zero", Range{1e-3, 1e3},
         "share of the diagonal");
    list("fade", later_decay_lengths,
         "later levels: distance from observed surface over which the deformation decreases to zero, in smoothing lengths of the "
         "level",
         Range{0.1, 1e3});
    list("reach", search_radius, "maximum distance between a vertex and its match in the first level", Range{0, 10},
         "share of the diagonal");
    list("last-reach", last_search_radius, "maximum distance between a vertex and its match in the last level", Range{0, 10});
    list("match-angle", angle, "maximum angle between the normals of a vertex and its match", Range{0, 180}, "degrees");
    list("counterparts", counterparts,
         "matches of template vertices: points on the surface along which the vertex may slide, on curves between parts along "
         "the curve (sliding); closest surface points (surface); or vertices of matched annotations with the lowest cost, each "
         "used "
         "any number of times (best) or at most once (one-to-one)",
         Choices{"sliding", "surface", "best", "one-to-one"});
    list("boundary-weight", vertices.boundary,
         "with --counterparts best or one-to-one: weight of vertices on outlines relative to interior vertices", Range{0, 1e6});
    list("distance-weight", vertices.distance,
         "with --counterparts best or one-to-one: weight of the distance between matched vertices", Range{0, 1e6});
    list("outline-weight", vertices.outline,
         "with --counterparts best or one-to-one: weight of the difference of positions along the outline", Range{0, 1e6});
    list("guides", correspondences, "weight of matched outlines and landmarks relative to the weight of the surface",
         Range{0, 1e6});
    list("outlines", outlines,
         "match lines and outlines by the position along the curve between landmarks; with sliding vertices only in the coarse "
         "levels",
         Anything{});
}

}  // namespace ostraka

#include "ostraka/reconstruction/reconstruct.h"

#include "reconstruction/fragment_trees.h"
#include "reconstruction/reconstruction_verdict.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/mesh/orientation.h"
#include "ostraka/transfer/moved_annotations.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// The share of an annotation's vertices that were observed.
double observed_share(AnnotatedMeshView template_object, int id, const std::vector<bool>& observed) {
    const Annotation* annotation = template_object.annotations.find(id);
    std::vector<Index> vertices;
    if (annotation != nullptr && annotation->all)
        for (const Vertex v : template_object.mesh.vertices()) vertices.push_back(v);
    if (annotation != nullptr && !annotation->all) {
        vertices = annotation->points;
        for (const Index f : annotation->faces)
            for (const Vertex v : corners(template_object.mesh, Face(f))) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto count = std::count_if(vertices.begin(), vertices.end(), [&](Index v) { return observed[v]; });
    return vertices.empty() ? 0 : static_cast<double>(count) / static_cast<double>(vertices.size());
}

/// Swaps the parts of proportions whose first part was observed better than the second.
RelationGraph with_observed_as_reference(AnnotatedMeshView template_object, const RelationGraph& stated,
                                         const std::vector<bool>& observed_vertices) {
    RelationGraph graph;
    graph.relationships = stated.relationships;
    const auto observed = [&](int id) { return observed_share(template_object, id, observed_vertices); };
    for (Relationship& relationship : graph.relationships) {
        const RelationType* type = find_relation_type(relationship.type);
        if (!relationship.is_constraint || type == nullptr || type->name != "proportion" || relationship.annotations.size() != 2)
            continue;
        if (!(observed(relationship.annotations[0]) > observed(relationship.annotations[1]))) continue;
        Json parameters = parse_json(relationship.constraint.empty() ? "{}" : relationship.constraint, "constraint");
        if (!parameters.HasMember("minValue") || !parameters.HasMember("maxValue") || !parameters.HasMember("measure1") ||
            !parameters.HasMember("measure2"))
            continue;
        const double minimum = parameters["minValue"].IsNumber() ? parameters["minValue"].GetDouble() : 0,
                     maximum = parameters["maxValue"].IsNumber() ? parameters["maxValue"].GetDouble() : 0;
        if (!(minimum > 0 && maximum >= minimum)) continue;
        parameters["minValue"].SetDouble(1 / maximum);
        parameters["maxValue"].SetDouble(1 / minimum);
        parameters["measure1"].Swap(parameters["measure2"]);
        std::swap(relationship.annotations[0], relationship.annotations[1]);
        relationship.constraint = to_text(parameters);
    }
    return graph;
}

}  // namespace

/// A fragment with its cached results.
struct FragmentState {
    const Fragment* fragment = nullptr;
    std::shared_ptr<const Fragment> turned;  ///< the fragment with its faces turned over, if the given one is inside out
    std::vector<StatedMatch> stated;
    std::vector<LandmarkPair> pairs;  ///< with the template
    std::vector<std::string> notes;
    std::shared_ptr<FragmentTrees> trees;

    /// A refined pose with its inputs.
    struct Refined {
        double scale = 0;
        Motion start;
        std::vector<Anchor> anchors;
        PartAlignment alignment;
    };
    std::optional<Refined> refined;
    /// The matched annotations for a pose.
    struct Matched {
        double scale = 0;
        Motion pose;
        std::vector<AnnotationMatch> matches;
    };
    std::optional<Matched> matched;
};

/// The template and its fragments, with the data kept between reconstructions.
struct ReconstructionState : AnnotatedMeshView {
    ReconstructionState(AnnotatedMeshView template_object, const RelationGraph& relations,
                        const ReconstructOptions& reconstruct_options, const ShapePrior* class_prior, const TemplateCage* cage)
        : AnnotatedMeshView(template_object),
          graph(relations),
          options(reconstruct_options),
          prior(class_prior),
          searches(template_object.mesh, reconstruct_options.search.poses),
          fitter(template_object, cage) {}

    const RelationGraph& graph;
    const ReconstructOptions options;
    const ShapePrior* prior;
    PoseSearches searches;
    TemplateFitter fitter;
    std::optional<std::vector<std::pair<Index, Index>>> crossings;  ///< of the template's faces
    std::vector<FragmentState> fragments;
};

namespace {

/// One reconstruction from the current fragments, phase by phase.
class ReconstructionRun {
public:
    explicit ReconstructionRun(ReconstructionState& object) : prepared_(object) {
        for (const FragmentState& fragment : object.fragments) {
            fragments_.push_back(fragment.fragment);
            pairs_.push_back(fragment.pairs);
        }
    }

    Reconstruction run() {
        timed("placement", [&] { place(); });
        if (result_.placement.any()) {
            pose();
            fit();
            timed("completion", [&] { finish(); });
        }
        judge_reconstruction(result_, pairs_, number_, prepared_.options);
        return std::move(result_);
    }

private:
    template <class Work>
    void timed(const char* phase, Work&& work) {
        const ScopedSeconds watch(result_.seconds[phase]);
        work();
    }

    void place() {
        for (const FragmentState& fragment : prepared_.fragments) result_.notes.push_back(fragment.notes);
        result_.placement = place_by_landmarks(pairs_, prepared_.options.placement);
        for (std::size_t k = 0; k < fragments_.size(); ++k)
            for (const auto& [first, second] : result_.placement.fragments[k].swapped)
                result_.notes[k].push_back(fmt::format(
                    "landmarks '{}' and '{}' would fit better with exchanged tags: are their tags exchanged?", first, second));
        result_.searched = place_by_search(prepared_.searches, fragments_, prepared_.options.search, result_.placement.scale,
                                           result_.placement.fragments);
        for (std::size_t k = 0; k < fragments_.size(); ++k)
            if (result_.searched[k] && result_.searched[k]->decided) use_landmarks(k);
    }

    /// Determines motions that the pose search left open from the available landmarks, and reports landmarks that contradict
    /// the pose.
    void use_landmarks(std::size_t k) {
        constexpr double max_offset = 0.1;  // share of the template's diagonal
        const double scale = result_.placement.scale, limit = max_offset * scale * box_diagonal(prepared_.mesh);
        FragmentPlacement& placed = result_.placement.fragments[k];
        if (resolve_open_motions(pairs_[k], scale, limit, *result_.searched[k], placed)) {
            result_.notes[k].push_back("the motions that the search for its pose left open are decided by its landmarks");
            return;
        }
        for (const LandmarkPair& pair : pairs_[k]) {
            const double distance = (placed.pose(pair.on_fragment) - scale * pair.on_template).norm();
            if (distance > limit)
                result_.notes[k].push_back(
                    fmt::format("landmark '{}' is {} off its position on the template: the searched pose contradicts it",
                                pair.name, digits(distance, 3)));
        }
    }

    /// Registers the fragments to the template and matches their annotations.
    void pose() {
        scaled_ = scaled_by(prepared_.mesh, result_.placement.scale);
        diagonal_ = box_diagonal(scaled_);
        if (prepared_.options.refine) timed("refinement", [&] { refine(); });
        timed("turns", [&] {
            result_.rotations = decide_open_rotations(scaled_, fragments_, result_.searched, result_.placement.fragments,
                                                      prepared_.options.rotations);
        });
        timed("annotations", [&] { match(); });
        if (prepared_.prior != nullptr) timed("class", [&] { fit_class_shape(); });
    }

    /// Deforms the template to the fragments and its constraints.
    void fit() {
        timed("fit", [&] {
            // The shape of the class changes with each reconstruction.
            result_.fit = prepared_.prior != nullptr
                              ? fit_template({scaled_, prepared_.annotations}, placed_, prepared_.options.fit)
                              : prepared_.fitter.fit(result_.placement.scale, placed_, prepared_.options.fit);
        });
        result_.points = result_.fit.points;
        timed("observed", [&] { find_observed(); });
        timed("constraints", [&] { enforce_constraints(); });
    }

    void refine() {
        std::optional<SurfaceSearch> surface;
        result_.alignment.assign(fragments_.size(), {});
        for (std::size_t k = 0; k < fragments_.size(); ++k) {
            FragmentPlacement& placement = result_.placement.fragments[k];
            const Fragment& fragment = *fragments_[k];
            if (!placement.problem.empty()) continue;
            const std::vector<bool> counts = intact_faces(fragment.facets);
            if (!counts.empty() && std::find(counts.begin(), counts.end(), true) == counts.end()) continue;
            std::vector<Anchor> anchors;
            const std::vector<LandmarkPair>& pairs = pairs_[k];
            for (std::size_t i = 0; i < pairs.size(); ++i)
                if (i < placement.landmarks.size() && placement.landmarks[i].used)
                    anchors.push_back({pairs[i].on_fragment, on_scaled(pairs[i])});
            std::optional<FragmentState::Refined>& cached = prepared_.fragments[k].refined;
            const double scale = result_.placement.scale;
            if (!cached || shaped_ || cached->scale != scale || cached->start != placement.pose || cached->anchors != anchors) {
                if (!surface) surface.emplace(scaled_);
                result_.alignment[k] =
                    align_part(fragment.mesh, counts, *surface, placement.pose, anchors, prepared_.options.alignment);
                if (!shaped_) cached = {scale, placement.pose, anchors, result_.alignment[k]};
            } else {
                result_.alignment[k] = cached->alignment;
            }
            placement.pose = result_.alignment[k].pose;
            double squares = 0;
            for (std::size_t i = 0; i < std::min(pairs.size(), placement.landmarks.size()); ++i) {
                LandmarkResidual& landmark = placement.landmarks[i];
                landmark.distance = (placement.pose(pairs[i].on_fragment) - on_scaled(pairs[i])).norm();
                if (landmark.used) squares += landmark.distance * landmark.distance;
            }
            placement.residual =
                anchors.empty() ? result_.alignment[k].residual : std::sqrt(squares / static_cast<double>(anchors.size()));
        }
    }

    /// The current position of a landmark on the template.
    [[nodiscard]] Eigen::Vector3d on_scaled(const LandmarkPair& pair) const { return eigen(scaled_.point(Vertex(pair.vertex))); }

    /// The fragments keep the template's frame: the shape of the class is fitted to them, then they are registered to it.
    void fit_class_shape() {
        constexpr int rounds = 2;
        for (int round = 0; round < rounds; ++round) {
            check_cancelled();
            result_.prior = fit_prior({scaled_, prepared_.annotations}, placed_, *prepared_.prior, prepared_.options.prior);
            scaled_ = result_.prior->mesh;
            shaped_ = true;
            if (!prepared_.options.refine || round + 1 == rounds) continue;
            refine();
            match();
        }
    }

    void match() {
        placed_.clear();
        number_.clear();
        result_.annotations.resize(fragments_.size());
        for (std::size_t k = 0; k < fragments_.size(); ++k) {
            const FragmentPlacement& placement = result_.placement.fragments[k];
            if (!placement.problem.empty()) continue;
            const Fragment& fragment = *fragments_[k];
            std::optional<FragmentState::Matched>& cached = prepared_.fragments[k].matched;
            if (!cached || shaped_ || cached->scale != result_.placement.scale || cached->pose != placement.pose) {
                result_.annotations[k] = match_annotations({scaled_, prepared_.annotations}, fragment, placement.pose,
                                                           prepared_.fragments[k].stated, prepared_.options.annotations);
                if (!shaped_) cached = {result_.placement.scale, placement.pose, result_.annotations[k]};
            } else {
                result_.annotations[k] = cached->matches;
            }
            PlacedFragment placed{moved(fragment.mesh, placement.pose),
                                  &fragment.annotations,
                                  fragment.facets,
                                  result_.annotations[k],
                                  placement.pose,
                                  prepared_.fragments[k].trees};
            // A landmark found to be wrong constrains nothing.
            std::erase_if(placed.matches, [&](const AnnotationMatch& match) {
                const Annotation* a = prepared_.annotations.find(match.template_annotation);
                return a != nullptr && a->type == AnnotationType::point &&
                       std::any_of(placement.landmarks.begin(), placement.landmarks.end(),
                                   [&](const auto& landmark) { return landmark.name == a->tag && !landmark.used; });
            });
            placed_.push_back(std::move(placed));
            number_.push_back(static_cast<int>(k));
        }
    }

    /// Determines the observed vertices: those matched within the tolerance.
    void find_observed() {
        const std::size_t n = prepared_.mesh.number_of_vertices();
        std::vector<bool> within_tolerance(n, false);
        result_.distance.assign(n, -1);
        for (std::size_t i = 0; i < n; ++i) {
            VertexMatch& match = result_.fit.matches[i];
            if (match.fragment < 0) continue;
            match.fragment = number_[static_cast<std::size_t>(match.fragment)];
            within_tolerance[i] = match.distance <= prepared_.options.observed * diagonal_;
            if (within_tolerance[i]) result_.distance[i] = match.distance;
        }
        observed_ = std::move(within_tolerance);
    }

    void finish() {
        Mesh fitted = scaled_;
        for (const Vertex v : fitted.vertices()) fitted.point(v) = result_.points[v];
        CompleteOptions options = prepared_.options.completion;
        options.tolerance = prepared_.options.observed;
        result_.object = complete(fitted, placed_, options);
        CompletedObject& object = result_.object;
        result_.joined.assign(fragments_.size(), 0);
        for (std::size_t i = 0; i < number_.size(); ++i) result_.joined[static_cast<std::size_t>(number_[i])] = object.joined[i];
        double area = 0, observed_area = 0;
        for (const Face face : object.mesh.faces()) {
            if (object.fragment[face] >= 0) object.fragment[face] = number_[static_cast<std::size_t>(object.fragment[face])];
            const double a = face_area(object.mesh, face);
            area += a;
            if (object.origin[face] == Origin::observed) observed_area += a;
        }
        result_.observed_share = area > 0 ? observed_area / area : 0;
        for (CompletionNote& note : object.notes) note.fragment = number_[static_cast<std::size_t>(note.fragment)];
        if (!prepared_.crossings) prepared_.crossings = self_intersections(to_soup(prepared_.mesh)).pairs;
        const auto before = shaped_ ? self_intersections(to_soup(scaled_)).pairs : *prepared_.crossings,
                   after = self_intersections(to_soup(object.mesh)).pairs;
        result_.crossings = static_cast<std::size_t>(std::count_if(after.begin(), after.end(), [&](const auto& pair) {
            const auto [a, b] = pair;
            const Index f = object.template_face[a], g = object.template_face[b];
            if (f != no_index && g != no_index)
                return !std::binary_search(before.begin(), before.end(), std::pair(std::min(f, g), std::max(f, g)));
            return f != no_index || g != no_index || object.fragment[a] != object.fragment[b];
        }));
    }

    void enforce_constraints() {
        const bool has_constraints = std::any_of(prepared_.graph.relationships.begin(), prepared_.graph.relationships.end(),
                                                 [](const Relationship& relationship) { return relationship.is_constraint; });
        if (!has_constraints || !prepared_.options.restore) return;
        DeformOptions options;
        options.handles = 1e5;  // constraints must not move the observed part
        DeformResult restored = restore_constraints({scaled_, prepared_.annotations},
                                                    with_observed_as_reference(prepared_, prepared_.graph, observed_),
                                                    result_.points, observed_, options, {}, "the template's graph");
        result_.points = std::move(restored.points);
        result_.constraints = std::move(restored.constraints);
        result_.conflicts = std::move(restored.conflicts);
    }

    ReconstructionState& prepared_;
    std::vector<const Fragment*> fragments_;
    std::vector<std::vector<LandmarkPair>> pairs_;  ///< per fragment
    Mesh scaled_;
    bool shaped_ = false;  ///< `scaled_` has the shape of the class, no longer that of the template
    double diagonal_ = 0;
    std::vector<PlacedFragment> placed_;
    std::vector<int> number_;  ///< index of each placed fragment
    std::vector<bool> observed_;
    Reconstruction result_;
};

}  // namespace

Reconstructor::Reconstructor(AnnotatedMeshView template_object, const RelationGraph& graph, const ReconstructOptions& options,
                             const ShapePrior* prior, const TemplateCage* cage) {
    check_options(options, "fit");
    if (options.fit.space != NonRigidOptions::Space::mesh && cage == nullptr)
        fail_usage("the fit uses a cage, but the template has none", "give the cage of the template");
    if (options.fit.space != NonRigidOptions::Space::mesh && prior != nullptr)
        fail_usage("a class changes the shape of the template, which its cage does not follow",
                   "fit in mesh space, or without the class");
    if (prior != nullptr) prior->check(template_object.mesh.number_of_vertices());
    if (is_inside_out(template_object.mesh)) fail_input("template", "is inside out", "turn its faces over");
    known_ = std::make_unique<ReconstructionState>(template_object, graph, options, prior, cage);
}
Reconstructor::~Reconstructor() = default;
Reconstructor::Reconstructor(Reconstructor&&) noexcept = default;

void Reconstructor::add(const Fragment& fragment, std::vector<StatedMatch> stated) {
    FragmentState added;
    added.fragment = &fragment;
    if (is_inside_out(fragment.mesh)) {
        added.notes.emplace_back("is inside out: its faces were turned over in memory");
        added.turned =
            std::make_shared<const Fragment>(Fragment{turned_over(AnnotatedMeshView(fragment)), fragment.name, fragment.facets});
        added.fragment = added.turned.get();
    }
    added.stated = std::move(stated);
    added.pairs = common_landmarks(*known_, *added.fragment, &added.notes);
    added.trees = std::make_shared<FragmentTrees>(added.fragment->mesh, fragment.facets);
    known_->fragments.push_back(std::move(added));
}

void Reconstructor::remove(std::size_t position) {
    if (position >= size())
        fail_usage(fmt::format("there is no fragment at position {}", position), fmt::format("give a position below {}", size()));
    known_->fragments.erase(known_->fragments.begin() + static_cast<std::ptrdiff_t>(position));
}

std::size_t Reconstructor::size() const { return known_->fragments.size(); }

PoseSearches& Reconstructor::searches() { return known_->searches; }

Reconstruction Reconstructor::run() {
    if (size() == 0) fail_usage("there are no fragments", "give one or more");
    return ReconstructionRun(*known_).run();
}

Reconstruction reconstruct(AnnotatedMeshView template_object, const RelationGraph& graph,
                           const std::vector<const Fragment*>& fragments, const ReconstructOptions& options,
                           const std::vector<std::vector<StatedMatch>>& stated, const ShapePrior* prior,
                           const TemplateCage* cage) {
    Reconstructor reconstructor(template_object, graph, options, prior, cage);
    for (std::size_t k = 0; k < fragments.size(); ++k)
        reconstructor.add(*fragments[k], k < stated.size() ? stated[k] : std::vector<StatedMatch>());
    return reconstructor.run();
}

void ReconstructOptions::declare_options(OptionList& list) {
    placement.declare_options(list);
    search.declare_options(list);
    list("refine", refine, "refine poses of fragments by iterative closest points, with landmarks as anchors", Anything{});
    alignment.declare_options(list);
    rotations.declare_options(list);
    annotations.declare_options(list);
    prior.declare_options(list);
    fit.declare_options(list);
    completion.declare_options(list);
    list("observed", observed, "maximum distance of an observed template vertex from the fragments, share of the diagonal",
         Range{0, 1});
    list("scale-tolerance", scale_tolerance,
         "maximum difference, in per cent, between the template's scale from one fragment and from the other fragments",
         Range{0, 1000});
    list("min-tolerance", min_tolerance,
         "minimum tolerance of the measures and proportions that constraints fix, in per cent: smaller deviations may be noise",
         Range{0, 1000});
    list("residual", residual,
         "maximum root mean square residual of the landmarks of a fragment; a fragment with a larger residual is incompatible",
         Range{0, 10}, "share of their spread");
    list("min-on-template", min_on_template,
         "minimum share, in per cent, of a fragment's outer surface that lies on the fitted template", Range{0, 100});
    list("overlap", overlap, "maximum share, in per cent, of a fragment's outer surface that overlaps another fragment",
         Range{0, 100});
    list("restore", restore, "enforce the constraints of the template's graph on the unobserved surface", Anything{});
}

}  // namespace ostraka

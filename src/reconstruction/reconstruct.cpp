#include "ostraka/reconstruction/reconstruct.h"

#include "fragment_trees.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/diagnose.h"

#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace ostraka {

std::string to_string(ObjectionKind kind) {
    switch (kind) {
        case ObjectionKind::placement:
            return "placement";
        case ObjectionKind::size:
            return "size";
        case ObjectionKind::landmarks:
            return "landmarks";
        case ObjectionKind::surface:
            return "surface";
        case ObjectionKind::overlap:
            return "overlap";
        default:
            return "constraint";
    }
}

std::string to_string(Compatibility compatibility) {
    switch (compatibility) {
        case Compatibility::compatible:
            return "compatible";
        case Compatibility::incompatible:
            return "incompatible";
        default:
            return "undecided";
    }
}

namespace {

Mesh scaled_by(const Mesh& mesh, double scale) {
    Motion motion;
    motion.scale = scale;
    return moved(mesh, motion);
}

/// Of a closed mesh: its volume is negative.
bool inside_out(const Mesh& mesh) {
    if (mesh.number_of_faces() == 0 || !CGAL::is_closed(mesh)) return false;
    const Point origin = mesh.point(*mesh.vertices().begin());
    double volume = 0;
    for (const Face face : mesh.faces()) volume += (centroid(mesh, face) - origin) * area_vector(mesh, face);
    return volume < 0;
}

bool same(const Motion& a, const Motion& b) { return a.turn == b.turn && a.shift == b.shift && a.scale == b.scale; }
bool same(const std::vector<Anchor>& a, const std::vector<Anchor>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Anchor& x, const Anchor& y) { return x.of_part == y.of_part && x.of_whole == y.of_whole; });
}

/// A fragment, and what is known of it already.
struct Known {
    const Fragment* fragment = nullptr;
    std::vector<StatedMatch> stated;
    std::vector<LandmarkPair> pairs;  ///< with the template
    std::vector<std::string> notes;
    std::shared_ptr<FragmentTrees> trees;

    /// A pose that was refined: from where, to where.
    struct Refined {
        double scale = 0;
        Motion start;
        std::vector<Anchor> anchors;
        PartAlignment alignment;
    };
    std::optional<Refined> refined;
    /// Annotations that were matched in a pose.
    struct Matched {
        double scale = 0;
        Motion pose;
        std::vector<AnnotationMatch> matches;
    };
    std::optional<Matched> matched;
};

}  // namespace

struct Reconstructor::State {
    State(const Mesh& of, const AnnotationSet& with, const RelationGraph& relations, const ReconstructOptions& how,
          const ShapePrior* of_class, const TemplateCage* cage)
        : mesh(of),
          set(with),
          graph(relations),
          options(how),
          prior(of_class),
          searches(of, how.search.poses),
          fitter(of, with, cage) {}

    const Mesh& mesh;
    const AnnotationSet& set;
    const RelationGraph& graph;
    const ReconstructOptions options;
    const ShapePrior* prior;
    PoseSearches searches;
    TemplateFitter fitter;
    std::optional<std::vector<std::pair<Index, Index>>> crossings;  ///< of the template's faces
    std::vector<Known> fragments;
};

namespace {

/// One reconstruction, from the fragments there are.
class Run {
public:
    Run(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph, const ReconstructOptions& options,
        const ShapePrior* prior, PoseSearches& searches, TemplateFitter& fitter,
        std::optional<std::vector<std::pair<Index, Index>>>& crossings, std::vector<Known>& known)
        : mesh_(mesh),
          set_(set),
          graph_(graph),
          options_(options),
          prior_(prior),
          searches_(searches),
          fitter_(fitter),
          crossings_(crossings),
          known_(known) {
        for (const Known& one : known) {
            fragments_.push_back(one.fragment);
            pairs_.push_back(one.pairs);
        }
    }

    Reconstruction run() {
        timed("placement", [&] { place(); });
        if (!result_.placement.any()) {
            result_.undecided = "no fragment could be placed";
            for (std::size_t k = 0; k < fragments_.size(); ++k)
                object(ObjectionKind::placement, static_cast<int>(k), -1, 0, result_.placement.fragments[k].problem);
            return std::move(result_);
        }
        scaled_ = scaled_by(mesh_, result_.placement.scale);
        diagonal_ = box_diagonal(scaled_);
        if (options_.refine) timed("refinement", [&] { refine(); });
        timed("turns", [&] {
            result_.turns = decide_free_turns(scaled_, fragments_, result_.searched, result_.placement.fragments, options_.turns);
        });
        timed("annotations", [&] { match(); });
        if (prior_ != nullptr) timed("class", [&] { take_shape_of_class(); });
        timed("fit", [&] {
            // The shape of the class is another one each time.
            result_.fit = prior_ != nullptr ? fit_template(scaled_, set_, placed_, options_.fit)
                                            : fitter_.fit(result_.placement.scale, placed_, options_.fit);
        });
        result_.points = result_.fit.points;
        timed("observed", [&] { see(); });
        timed("constraints", [&] { restore(); });
        timed("completion", [&] { finish(); });
        judge();
        return std::move(result_);
    }

private:
    template <class Work>
    void timed(const char* phase, Work&& work) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        result_.seconds[phase] += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    void place() {
        for (const Known& one : known_) result_.notes.push_back(one.notes);
        result_.placement = place_by_landmarks(pairs_, options_.placement);
        for (std::size_t k = 0; k < fragments_.size(); ++k)
            for (const auto& [one, other] : result_.placement.fragments[k].swapped)
                result_.notes[k].push_back("landmarks '" + one + "' and '" + other +
                                           "' would fit each other's places: are their tags exchanged?");
        result_.searched =
            place_by_search(searches_, fragments_, options_.search, result_.placement.scale, result_.placement.fragments);
        for (std::size_t k = 0; k < fragments_.size(); ++k)
            if (result_.searched[k] && result_.searched[k]->decided) ask_landmarks(k);
    }

    /// What the search of a pose left open is decided by the landmarks there are; those that contradict it are named.
    void ask_landmarks(std::size_t k) {
        constexpr double far_off = 0.1;  // of the template's diagonal
        const double scale = result_.placement.scale, limit = far_off * scale * box_diagonal(mesh_);
        FragmentPlacement& placed = result_.placement.fragments[k];
        if (close_by_landmarks(pairs_[k], scale, limit, *result_.searched[k], placed)) {
            result_.notes[k].push_back("what the search for its pose left open is decided by its landmarks");
            return;
        }
        for (const LandmarkPair& pair : pairs_[k]) {
            const double off = (placed.pose(pair.on_fragment) - scale * pair.on_template).norm();
            if (off > limit)
                result_.notes[k].push_back("landmark '" + pair.name + "' is " + digits(off, 3) +
                                           " off its place on the template: the pose was searched for and contradicts it");
        }
    }

    void refine() {
        std::optional<SurfaceSearch> whole;
        result_.alignment.assign(fragments_.size(), {});
        for (std::size_t k = 0; k < fragments_.size(); ++k) {
            FragmentPlacement& placement = result_.placement.fragments[k];
            const Fragment& fragment = *fragments_[k];
            if (!placement.problem.empty()) continue;
            std::vector<bool> counts(fragment.facets.size());
            for (std::size_t f = 0; f < counts.size(); ++f) counts[f] = fragment.facets[f] != Facet::fracture;
            if (!counts.empty() && std::find(counts.begin(), counts.end(), true) == counts.end()) continue;
            std::vector<Anchor> anchors;
            const std::vector<LandmarkPair>& pairs = pairs_[k];
            for (std::size_t i = 0; i < pairs.size(); ++i)
                if (i < placement.landmarks.size() && placement.landmarks[i].used)
                    anchors.push_back({pairs[i].on_fragment, on_scaled(pairs[i])});
            std::optional<Known::Refined>& known = known_[k].refined;
            const double scale = result_.placement.scale;
            if (!known || shaped_ || known->scale != scale || !same(known->start, placement.pose) ||
                !same(known->anchors, anchors)) {
                if (!whole) whole.emplace(scaled_);
                result_.alignment[k] = align_part(fragment.mesh, counts, *whole, placement.pose, anchors, options_.alignment);
                if (!shaped_) known = {scale, placement.pose, anchors, result_.alignment[k]};
            } else {
                result_.alignment[k] = known->alignment;
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

    /// The place of a landmark on the template as it is now.
    [[nodiscard]] Eigen::Vector3d on_scaled(const LandmarkPair& pair) const { return eigen(scaled_.point(Vertex(pair.vertex))); }

    /// The fragments stay the template's frame: the shape of the class comes to them, then they are laid onto it.
    void take_shape_of_class() {
        constexpr int rounds = 2;
        for (int round = 0; round < rounds; ++round) {
            result_.prior = fit_prior(scaled_, set_, placed_, *prior_, options_.prior);
            scaled_ = result_.prior->mesh;
            shaped_ = true;
            if (!options_.refine || round + 1 == rounds) continue;
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
            std::optional<Known::Matched>& known = known_[k].matched;
            if (!known || shaped_ || known->scale != result_.placement.scale || !same(known->pose, placement.pose)) {
                result_.annotations[k] = match_annotations(scaled_, set_, fragment.mesh, fragment.annotations, placement.pose,
                                                           known_[k].stated, options_.annotations);
                if (!shaped_) known = {result_.placement.scale, placement.pose, result_.annotations[k]};
            } else {
                result_.annotations[k] = known->matches;
            }
            PlacedFragment placed{moved(fragment.mesh, placement.pose),
                                  &fragment.annotations,
                                  fragment.facets,
                                  result_.annotations[k],
                                  placement.pose,
                                  known_[k].trees};
            // A landmark that was found to be a wrong one guides nothing.
            std::erase_if(placed.matches, [&](const AnnotationMatch& one) {
                const Annotation* a = set_.find(one.of_template);
                return a != nullptr && a->type == AnnotationType::point &&
                       std::any_of(placement.landmarks.begin(), placement.landmarks.end(),
                                   [&](const auto& landmark) { return landmark.name == a->tag && !landmark.used; });
            });
            placed_.push_back(std::move(placed));
            number_.push_back(static_cast<int>(k));
        }
    }

    /// Which vertices were observed: matched within the tolerance.
    void see() {
        const std::size_t n = mesh_.number_of_vertices();
        std::vector<bool> near(n, false);
        result_.distance.assign(n, -1);
        for (std::size_t i = 0; i < n; ++i) {
            VertexMatch& match = result_.fit.matches[i];
            if (match.fragment < 0) continue;
            match.fragment = number_[static_cast<std::size_t>(match.fragment)];
            near[i] = match.distance <= options_.observed * diagonal_;
            if (near[i]) result_.distance[i] = match.distance;
        }
        held_ = std::move(near);
    }

    void finish() {
        Mesh fitted = scaled_;
        for (const Vertex v : fitted.vertices()) fitted.point(v) = result_.points[v];
        CompleteOptions options = options_.completion;
        options.tolerance = options_.observed;
        result_.object = complete(fitted, placed_, options);
        CompletedObject& object = result_.object;
        result_.joined.assign(fragments_.size(), 0);
        for (std::size_t i = 0; i < number_.size(); ++i) result_.joined[static_cast<std::size_t>(number_[i])] = object.joined[i];
        double area = 0, seen = 0;
        for (const Face face : object.mesh.faces()) {
            if (object.fragment[face] >= 0) object.fragment[face] = number_[static_cast<std::size_t>(object.fragment[face])];
            const double a = face_area(object.mesh, face);
            area += a;
            if (object.origin[face] == Origin::observed) seen += a;
        }
        result_.observed_share = area > 0 ? seen / area : 0;
        for (CompletionNote& note : object.notes) note.fragment = number_[static_cast<std::size_t>(note.fragment)];
        if (!crossings_) crossings_ = self_intersections(to_soup(mesh_)).pairs;
        const auto before = shaped_ ? self_intersections(to_soup(scaled_)).pairs : *crossings_,
                   after = self_intersections(to_soup(object.mesh)).pairs;
        result_.crossings = static_cast<std::size_t>(std::count_if(after.begin(), after.end(), [&](const auto& pair) {
            const auto [a, b] = pair;
            const Index f = object.template_face[a], g = object.template_face[b];
            if (f != no_index && g != no_index)
                return !std::binary_search(before.begin(), before.end(), std::pair(std::min(f, g), std::max(f, g)));
            return f != no_index || g != no_index || object.fragment[a] != object.fragment[b];
        }));
    }

    /// The share of an annotation's vertices that were observed.
    [[nodiscard]] double observed(int id) const {
        const Annotation* one = set_.find(id);
        std::vector<Index> vertices;
        if (one != nullptr && one->all)
            for (const Vertex v : mesh_.vertices()) vertices.push_back(v);
        if (one != nullptr && !one->all) {
            vertices = one->points;
            for (const Index f : one->faces)
                for (const Vertex v : corners(mesh_, Face(f))) vertices.push_back(v);
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        const auto seen = std::count_if(vertices.begin(), vertices.end(), [&](Index v) { return held_[v]; });
        return vertices.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(vertices.size());
    }

    /// Proportions whose first part was observed better than the second, the other way round.
    [[nodiscard]] RelationGraph with_observed_as_reference() const {
        RelationGraph graph;
        graph.relationships = graph_.relationships;
        for (Relationship& one : graph.relationships) {
            const RelationType* type = find_relation_type(one.type);
            if (!one.is_constraint || type == nullptr || type->name != "proportion" || one.annotations.size() != 2) continue;
            if (!(observed(one.annotations[0]) > observed(one.annotations[1]))) continue;
            Json parameters = parse_json(one.constraint.empty() ? "{}" : one.constraint, "constraint");
            if (!parameters.HasMember("minValue") || !parameters.HasMember("maxValue") || !parameters.HasMember("measure1") ||
                !parameters.HasMember("measure2"))
                continue;
            const double least = parameters["minValue"].IsNumber() ? parameters["minValue"].GetDouble() : 0,
                         most = parameters["maxValue"].IsNumber() ? parameters["maxValue"].GetDouble() : 0;
            if (!(least > 0 && most >= least)) continue;
            parameters["minValue"].SetDouble(1 / most);
            parameters["maxValue"].SetDouble(1 / least);
            parameters["measure1"].Swap(parameters["measure2"]);
            std::swap(one.annotations[0], one.annotations[1]);
            one.constraint = to_text(parameters);
        }
        return graph;
    }

    void restore() {
        const bool any = std::any_of(graph_.relationships.begin(), graph_.relationships.end(),
                                     [](const Relationship& one) { return one.is_constraint; });
        if (!any || !options_.restore) return;
        DeformOptions options;
        options.handles = 1e5;  // what was observed is not given up for a constraint
        DeformResult restored = restore_constraints(scaled_, set_, with_observed_as_reference(), result_.points, held_, options,
                                                    {}, "the template's graph");
        result_.points = std::move(restored.points);
        result_.constraints = std::move(restored.constraints);
        result_.conflicts = std::move(restored.conflicts);
    }

    /// Sum of squares of the template's landmarks about their mean: what a fragment weighs in the common scale.
    [[nodiscard]] double weight_of(const std::vector<LandmarkPair>& pairs, const FragmentPlacement& placement,
                                   bool on_fragment) const {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        double count = 0, sum = 0;
        const auto place = [&](const LandmarkPair& pair) { return on_fragment ? pair.on_fragment : pair.on_template; };
        const auto used = [&](std::size_t i) { return i >= placement.landmarks.size() || placement.landmarks[i].used; };
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (used(i)) middle += place(pairs[i]), ++count;
        if (!(count > 0)) return 0;
        middle /= count;
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (used(i)) sum += (place(pairs[i]) - middle).squaredNorm();
        return sum;
    }

    void object(ObjectionKind kind, int fragment, int constraint, double strain, const std::string& text) {
        result_.strain = std::max(result_.strain, strain);
        if (kind == ObjectionKind::placement || strain > 1)
            result_.objections.push_back({kind, fragment, constraint, strain, text});
    }

    /// A fragment's size against that of the others, and its landmarks against the template's.
    void judge_fragment(std::size_t k) {
        const FragmentPlacement& one = result_.placement.fragments[k];
        const int number = static_cast<int>(k);
        double sum = 0, weights = 0;
        for (std::size_t j = 0; j < fragments_.size(); ++j) {
            const FragmentPlacement& other = result_.placement.fragments[j];
            if (j == k || !other.problem.empty() || !(other.own_scale > 0)) continue;
            const double weight = weight_of(pairs_[j], other, false);
            sum += weight * other.own_scale;
            weights += weight;
        }
        if (weights > 0 && one.own_scale > 0) {
            const double others = sum / weights,
                         off = 100 * (std::max(one.own_scale, others) / std::min(one.own_scale, others) - 1);
            object(ObjectionKind::size, number, -1, off / std::max(options_.scale_tolerance, 1e-9),
                   "alone it would have the template " + digits(one.own_scale, 4) + " times as large, and the others " +
                       digits(others, 4) + " times: its size is off by " + digits(off, 3) + " %");
        }
        const double count = static_cast<double>(
            std::count_if(one.landmarks.begin(), one.landmarks.end(), [](const LandmarkResidual& mark) { return mark.used; }));
        const double spread = count > 0 ? std::sqrt(weight_of(pairs_[k], one, true) / count) : 0;
        if (spread > 0)
            object(ObjectionKind::landmarks, number, -1, one.residual / (std::max(options_.residual, 1e-9) * spread),
                   "its landmarks are " + digits(one.residual, 3) + " off those of the template (root mean square), " +
                       digits(100 * one.residual / spread, 3) + " % of their spread");
    }

    void judge() {
        std::size_t placed = 0;
        for (std::size_t k = 0; k < fragments_.size(); ++k) {
            const FragmentPlacement& one = result_.placement.fragments[k];
            if (!one.problem.empty()) {
                object(ObjectionKind::placement, static_cast<int>(k), -1, 0, "not placed: " + one.problem);
                continue;
            }
            ++placed;
            judge_fragment(k);
        }
        for (std::size_t i = 0; i < number_.size(); ++i) {
            const double lying = 100 * result_.object.lying[i], shared = 100 * result_.object.shared[i];
            const int k = number_[i];
            object(ObjectionKind::surface, k, -1, (100 - lying) / std::max(100 - options_.lying, 1e-9),
                   digits(lying, 3) + " % of its outer surface lies on the fitted template, at least " +
                       digits(options_.lying, 3) +
                       " %: another shape, a wrong place, or faces that are inside out or of its break");
            object(ObjectionKind::overlap, k, -1, shared / std::max(options_.overlap, 1e-9),
                   digits(shared, 3) + " % of its outer surface lies where fragments before it are seen, at most " +
                       digits(options_.overlap, 3) + " %: two fragments of one object have none in common");
        }
        bool tested = false;
        for (const ConstraintReport& constraint : result_.constraints) {
            tested = tested || constraint.used;
            if (!constraint.used) continue;
            std::string words;
            double strain = 0;
            for (const Deviation& d : constraint.deviations) {
                if (!d.value || !d.tolerance) continue;
                const double allowed = d.unit == "%" ? std::max(options_.slack, *d.tolerance) : *d.tolerance;
                strain = std::max(strain, *d.value / std::max(allowed, 1e-12));
                if (*d.value > allowed)
                    words += (words.empty() ? "" : "; ") + d.quantity + " " + digits(*d.value, 4) + ", at most " +
                             digits(allowed, 4) + (d.unit.empty() ? "" : " " + d.unit);
            }
            strain = constraint.verdict == Verdict::fails ? strain : std::min(strain, 1.0);
            object(ObjectionKind::constraint, -1, constraint.id, strain,
                   constraint.type + " does not hold" + (words.empty() ? "" : ": " + words));
        }
        const bool against = std::any_of(result_.objections.begin(), result_.objections.end(),
                                         [](const Objection& one) { return one.kind != ObjectionKind::placement; });
        if (against) {
            result_.verdict = Compatibility::incompatible;
        } else if (placed < fragments_.size()) {
            result_.undecided = "not all fragments could be placed";
        } else if (result_.turns && std::any_of(result_.turns->notes.begin(), result_.turns->notes.end(),
                                                [](const std::string& note) { return !note.empty(); })) {
            result_.undecided = "the turns of some fragments about the axis are not decided";
        } else if (placed == 1 && !tested) {
            result_.undecided = "one fragment and no constraint: nothing can contradict it";
        } else {
            result_.verdict = Compatibility::compatible;
        }
    }

    const Mesh& mesh_;
    const AnnotationSet& set_;
    const RelationGraph& graph_;
    const ReconstructOptions& options_;
    const ShapePrior* prior_;
    PoseSearches& searches_;
    TemplateFitter& fitter_;
    std::optional<std::vector<std::pair<Index, Index>>>& crossings_;
    std::vector<Known>& known_;
    std::vector<const Fragment*> fragments_;
    std::vector<std::vector<LandmarkPair>> pairs_;  ///< of each fragment
    Mesh scaled_;
    bool shaped_ = false;  ///< `scaled_` is no longer the template's shape, but that of its class
    double diagonal_ = 0;
    std::vector<PlacedFragment> placed_;
    std::vector<int> number_;  ///< of each placed fragment
    std::vector<bool> held_;
    Reconstruction result_;
};

}  // namespace

Reconstructor::Reconstructor(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                             const ReconstructOptions& options, const ShapePrior* prior, const TemplateCage* cage) {
    check_options(options, "fit");
    if (options.fit.space != "mesh" && cage == nullptr)
        fail_usage("the fit is to go through a cage, and there is none", "give the cage of the template");
    if (options.fit.space != "mesh" && prior != nullptr)
        fail_usage("a class changes the template's shape, and its cage does not follow",
                   "fit in mesh space, or without the class");
    if (prior != nullptr) prior->check(mesh.number_of_vertices());
    if (inside_out(mesh)) fail_input("template", "is inside out", "run: ostraka mesh repair");
    state_ = std::make_unique<State>(mesh, set, graph, options, prior, cage);
}
Reconstructor::~Reconstructor() = default;
Reconstructor::Reconstructor(Reconstructor&&) noexcept = default;

void Reconstructor::add(const Fragment& fragment, std::vector<StatedMatch> stated) {
    if (inside_out(fragment.mesh)) fail_input("fragment '" + fragment.name + "'", "is inside out", "run: ostraka mesh repair");
    Known known;
    known.fragment = &fragment;
    known.stated = std::move(stated);
    known.pairs = common_landmarks(state_->mesh, state_->set, fragment.mesh, fragment.annotations, &known.notes);
    known.trees = std::make_shared<FragmentTrees>(fragment.mesh, fragment.facets);
    state_->fragments.push_back(std::move(known));
}

void Reconstructor::remove(std::size_t position) {
    if (position >= size())
        fail_usage("there is no fragment at position " + std::to_string(position),
                   "give a position below " + std::to_string(size()));
    state_->fragments.erase(state_->fragments.begin() + static_cast<std::ptrdiff_t>(position));
}

std::size_t Reconstructor::size() const { return state_->fragments.size(); }

PoseSearches& Reconstructor::searches() { return state_->searches; }

Reconstruction Reconstructor::run() {
    if (size() == 0) fail_usage("there is no fragment", "give one or more");
    State& s = *state_;
    return Run(s.mesh, s.set, s.graph, s.options, s.prior, s.searches, s.fitter, s.crossings, s.fragments).run();
}

Reconstruction reconstruct(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                           const std::vector<const Fragment*>& fragments, const ReconstructOptions& options,
                           const std::vector<std::vector<StatedMatch>>& stated, const ShapePrior* prior,
                           const TemplateCage* cage) {
    Reconstructor all(mesh, set, graph, options, prior, cage);
    for (std::size_t k = 0; k < fragments.size(); ++k)
        all.add(*fragments[k], k < stated.size() ? stated[k] : std::vector<StatedMatch>());
    return all.run();
}

void ReconstructOptions::describe(OptionList& visit) {
    placement.describe(visit);
    search.describe(visit);
    visit("refine", refine, "poses are refined by closest points of the surface, landmarks as anchors", Anything{});
    alignment.describe(visit);
    turns.describe(visit);
    annotations.describe(visit);
    prior.describe(visit);
    fit.describe(visit);
    completion.describe(visit);
    visit("observed", observed, "vertices farther from the fragments than this share of the diagonal are not observed",
          Range{0, 1});
    visit("scale-tolerance", scale_tolerance,
          "per cent by which the template's scale as one fragment alone has it may differ from that of the others",
          Range{0, 1000});
    visit("slack", slack,
          "per cent that a constraint in per cent may be off before it speaks against the fragments: what scans and "
          "measuring leave",
          Range{0, 1000});
    visit("residual", residual, "root mean square of a fragment's landmarks above which it does not fit", Range{0, 10},
          "share of their spread");
    visit("lying", lying, "per cent of a fragment's outer surface that lies on the fitted template, at least", Range{0, 100});
    visit("overlap", overlap, "per cent of a fragment's outer surface that lies where another one is seen, at most",
          Range{0, 100});
    visit("restore", restore, "constraints of the graph are solved for what was not observed", Anything{});
}

}  // namespace ostraka

#include "ostraka/semantic/cage_reach.h"

#include "semantic/deformer.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/files/json_build.h"
#include "ostraka/semantic/cage_density.h"

namespace ostraka {

namespace {

using semantic::Deformer;

/// An edit that stretches the object by a tenth along one axis.
Edit stretched_along(int axis) {
    EditStep step;
    step.select = EditStep::All();
    step.operation = EditStep::Stretch{Eigen::Vector3d::Unit(axis), 1.1};
    return {{step}};
}

/// A graph of this constraint only, hard if it can be.
RelationGraph alone(const Relationship& relationship) {
    RelationGraph graph;
    graph.relationships.push_back(relationship);
    Relationship& only = graph.relationships.front();
    Json parameters = only.constraint.empty() ? Json(rapidjson::kObjectType) : parse_json(only.constraint, "a constraint");
    if (!parameters.IsObject()) return graph;
    parameters.RemoveMember("hard");
    add_members(parameters, parameters.GetAllocator(), "hard", true);
    only.constraint = to_compact_text(parameters);
    return graph;
}

/// Adds M^T M for the rows M = B W of a constraint, without observed rows.
void add_products(const Constraint& constraint, const WeightMatrix& weights, Eigen::MatrixXd& sum) {
    const Constraint::Map& map = constraint.map();
    const Eigen::Index count = map.rows - map.observed;
    CageWeights rows = CageWeights::Zero(count, weights.cols());
    for (Eigen::Index r = 0; r < std::min(count, map.direct); ++r)
        rows.row(r) = weights.row(constraint.ids()[static_cast<std::size_t>(r)]);
    if (map.centred && map.direct > 0) {
        const Eigen::RowVectorXd mean = rows.topRows(map.direct).colwise().mean();
        rows.topRows(map.direct).rowwise() -= mean;
    }
    for (const Constraint::Entry& entry : map.entries)
        if (map.direct + entry.row < count)
            rows.row(map.direct + entry.row) +=
                entry.value * weights.row(constraint.ids()[static_cast<std::size_t>(entry.position)]);
    sum.noalias() += rows.transpose() * rows;
}

/// The rank; the squares of the singular values are the eigenvalues of `products`.
std::size_t rank_of(const Eigen::MatrixXd& products) {
    constexpr double negligible = 1e-6;  // square of a thousandth
    const SymmetricEigenX eigen(products);
    const double largest = eigen.eigenvalues().maxCoeff();
    return static_cast<std::size_t>((eigen.eigenvalues().array() > negligible * largest).count());
}

double rms_distance(const Constraint& constraint, const Points& points) {
    const auto rows = static_cast<double>(std::max<Eigen::Index>(1, constraint.map().rows - constraint.map().observed));
    return std::sqrt(constraint.squared_distance(points) / rows);
}

/// Diagonal of the constraint's points; for a single point that of the object.
double diagonal_of(const Constraint& constraint, const Points& points) {
    if (constraint.ids().size() == 1) return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
    Eigen::Vector3d low = points.col(constraint.ids().front()), high = low;
    for (const int id : constraint.ids()) low = low.cwiseMin(points.col(id)), high = high.cwiseMax(points.col(id));
    return (high - low).norm();
}

/// The member that contains all points of the constraint, if any.
std::optional<int> owner_of(const Constraint& constraint, const HandleSpace& space, const Relationship& relationship) {
    for (const int id : relationship.annotations) {
        const std::vector<Index> vertices = vertices_of(space.mesh, *space.annotations.find(id));
        if (std::all_of(constraint.ids().begin(), constraint.ids().end(),
                        [&](int v) { return std::binary_search(vertices.begin(), vertices.end(), static_cast<Index>(v)); }))
            return id;
    }
    return {};
}

/// Result after one edit; nothing if there is nothing to solve through the cage.
std::optional<ConstraintReach> reach_after(const HandleSpace& space, const Relationship& relationship, const Edit& edit,
                                           const std::string& edit_name, const RelationOptions& tolerances,
                                           const std::string& graph_name) {
    const RelationGraph graph = alone(relationship);
    DeformOptions options;
    options.space = DeformOptions::Space::cage;
    Deformer deformer(space, graph, options, tolerances, edit_name, graph_name);
    const Deformer::Solved solved = deformer.solve_only(edit);
    const semantic::Statement& statement = deformer.statements().front();
    if (!statement.unknown.empty()) return {};
    const Mesh edited_mesh = with_points(space.mesh, semantic::list_of(solved.edited)),
               mesh = with_points(space.mesh, semantic::list_of(solved.points));
    const semantic::State edited(edited_mesh), now(mesh);
    const auto lowered = statement.lower(edited, now);
    if (lowered.empty()) return {};
    ConstraintReach reach;
    reach.id = relationship.id;
    reach.type = relationship.type;
    reach.annotations = relationship.annotations;
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(space.coordinates->vertex.cols(), space.coordinates->vertex.cols());
    double worst = -1;
    const Points rest = columns_of(space.mesh);
    for (const auto& constraint : lowered) {
        reach.rows += static_cast<std::size_t>(constraint->map().rows - constraint->map().observed);
        add_products(*constraint, space.coordinates->vertex, products);
        const double left = rms_distance(*constraint, solved.points),
                     tolerance = tolerances.distance * diagonal_of(*constraint, rest);
        if (!(left > worst * tolerance)) continue;
        worst = tolerance > 0 ? left / tolerance : 0;
        reach.distance_after_edit = rms_distance(*constraint, solved.edited);
        reach.remaining_distance = left;
        reach.tolerance = tolerance;
        reach.lacking = owner_of(*constraint, space, relationship);
    }
    reach.rank = rank_of(products);
    const semantic::Measured measured = statement.measure(now);
    reach.verdict = measured.verdict;
    reach.deviations = measured.deviations;
    reach.reached =
        reach.rank == reach.rows || (measured.verdict == Verdict::holds && reach.remaining_distance <= reach.tolerance);
    return reach;
}

/// True if the first is farther from its tolerance.
bool is_worse(const ConstraintReach& one, const ConstraintReach& other) {
    if ((one.verdict == Verdict::holds) != (other.verdict == Verdict::holds)) return one.verdict != Verdict::holds;
    return one.remaining_distance * other.tolerance > other.remaining_distance * one.tolerance;
}

}  // namespace

std::vector<ConstraintReach> cage_reach(const HandleSpace& space, const RelationGraph& graph, const Edit* edit,
                                        const std::string& edit_name, const RelationOptions& tolerances,
                                        const std::string& graph_name) {
    if (space.cage == nullptr || space.coordinates == nullptr)
        fail_usage("there is no cage whose reach could be computed", "give a cage and its coordinates");
    check_options(tolerances, "cage reach");
    std::vector<Edit> probes;
    if (edit == nullptr)
        for (int axis = 0; axis < 3; ++axis) probes.push_back(stretched_along(axis));
    std::vector<ConstraintReach> list;
    for (const Relationship& relationship : graph.relationships) {
        if (!relationship.is_constraint || !(relationship.weight > 0)) continue;
        std::optional<ConstraintReach> worst;
        const auto add = [&](const Edit& one) {
            const auto reach = reach_after(space, relationship, one, edit_name, tolerances, graph_name);
            if (reach && (!worst || is_worse(*reach, *worst))) worst = reach;
        };
        if (edit != nullptr) add(*edit);
        for (const Edit& probe : probes) add(probe);
        if (worst) list.push_back(std::move(*worst));
    }
    return list;
}

ConstraintCage make_cage_for_constraints(AnnotatedMeshView object, const RelationGraph& graph, const CageOptions& options,
                                         const std::optional<MirrorPlane>& mirror, const RelationOptions& tolerances,
                                         const std::string& graph_name) {
    struct Try {
        double density, vertices, offset;  ///< factors of the options
    };
    constexpr std::array<Try, 5> tries{{{1, 1, 1}, {4, 1, 1}, {8, 1, 0.5}, {16, 1.5, 0.5}, {30, 2, 0.25}}};
    std::set<int> parts;
    for (const Relationship& relationship : graph.relationships)
        if (relationship.is_constraint && relationship.weight > 0)
            for (const int id : relationship.annotations)
                if (const Annotation* part = object.annotations.find(id); part != nullptr && !is_whole(object.mesh, *part))
                    parts.insert(id);
    const auto distance = [](const std::vector<ConstraintReach>& list) {
        std::pair<std::size_t, double> off{0, 0};
        for (const ConstraintReach& one : list) {
            off.first += one.reached ? 0 : 1;
            if (one.tolerance > 0) off.second = std::max(off.second, one.remaining_distance / one.tolerance);
        }
        return off;
    };
    std::optional<ConstraintCage> best;
    for (const auto& [density, vertices, offset] : tries) {
        std::vector<std::pair<int, double>> factors;
        for (const int id : parts) factors.emplace_back(id, density);
        CageOptions how = options;
        how.offset *= offset;
        how.vertices = static_cast<std::uint64_t>(vertices * static_cast<double>(options.vertices));
        ConstraintCage one{
            make_cage(object.mesh, how, factors.empty() ? CageDensity() : annotation_density(object, factors), mirror), {}};
        const Coordinates coordinates = compute_coordinates("mean-value", one.made.cage, object.mesh);
        one.reach =
            cage_reach({object, &one.made.cage, &coordinates}, graph, nullptr, "a stretch by a tenth", tolerances, graph_name);
        const auto off = distance(one.reach);
        if (!best || off < distance(best->reach)) best = std::move(one);
        if (off.first == 0) break;
    }
    return std::move(*best);
}

std::string describe(const ConstraintReach& reach, const AnnotationSet& set) {
    if (reach.reached) return {};
    const std::string unit = set.unit.empty() ? "" : " " + set.unit;
    std::string text = "constraint " + std::to_string(reach.id) + " (" + reach.type + "): the cage ";
    if (reach.remaining_distance > reach.tolerance)
        text += "leaves " + digits(reach.remaining_distance, 3) + unit + " of " + digits(reach.distance_after_edit, 3) + unit +
                " (root mean square; tolerance " + digits(reach.tolerance, 3) + unit + ")";
    else text += "leaves it unmet";
    std::vector<std::string> off;
    if (reach.verdict != Verdict::holds)
        for (const Deviation& d : reach.deviations)
            if (d.value && d.tolerance && *d.value > *d.tolerance)
                off.push_back(d.quantity + " " + digits(*d.value, 3) + " " + d.unit + " (tolerance " + digits(*d.tolerance, 3) +
                              ")");
    if (!off.empty()) text += ", " + joined(off);
    if (const Annotation* part = reach.lacking ? set.find(*reach.lacking) : nullptr)
        text += ", most at '" + printable(part->tag, 60) + "': control points are missing there";
    return text;
}

}  // namespace ostraka

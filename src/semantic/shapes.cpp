// Constraints on parts that keep their shape, and on features on one level.
#include "ostraka/algebra/dense.h"
#include "semantic/statements.h"

namespace ostraka::semantic {

Vector3d mean_of(const std::vector<Index>& vertices, const Points& points) {
    Vector3d sum = Vector3d::Zero();
    for (const Index v : vertices) sum += points.col(v) - points.col(vertices.front());
    return points.col(vertices.front()) + sum / static_cast<double>(vertices.size());
}

Vector3d normal_of(const Points& points, const std::vector<Index>& vertices) {
    const Vector3d mean = mean_of(vertices, points);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Index v : vertices) spread += (points.col(v) - mean) * (points.col(v) - mean).transpose();
    return SymmetricEigen3(spread).eigenvectors().col(0);
}

namespace {

/// The vertex that represents the position of an annotation: on its fitted plane closest to the mean of its vertices (section
/// 5.2.1).
Index reference_vertex(const Points& rest, const std::vector<Index>& vertices) {
    const Vector3d mean = mean_of(vertices, rest), normal = normal_of(rest, vertices);
    Index best = vertices.front();
    double minimum = std::numeric_limits<double>::infinity();
    for (const Index v : vertices) {
        const Vector3d d = rest.col(v) - mean;
        const double off = (d - normal * normal.dot(d)).squaredNorm();
        if (off < minimum) minimum = off, best = v;
    }
    return best;
}

/// The kind that preserves shape, with size or up to a factor.
ConstraintKind keeping(bool similar) {
    if (similar) return kinds::Similarity{};
    return kinds::Rigid{};
}

/// Constraints of this kind for all members.
Statement::Constraints kept(const ConstraintMembers& members, const ConstraintKind& kind) {
    Statement::Constraints list;
    for (std::size_t i = 0; i < members.count(); ++i) list.push_back(members.make(kind, ids_of(members.vertices(i))));
    return list;
}

/// The vertices in the lowest twentieth of a part's height.
std::vector<Index> base_of(const Points& rest, const std::vector<Index>& vertices, const Vector3d& up) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index v : vertices) low = std::min(low, up.dot(rest.col(v))), high = std::max(high, up.dot(rest.col(v)));
    std::vector<Index> base;
    for (const Index v : vertices)
        if (up.dot(rest.col(v)) <= low + 0.05 * (high - low)) base.push_back(v);
    return base;
}

/// Reference for the height of a part, used for solving, seating and measuring: the centroid of its area (for lines of the
/// length, for points of the points), or the mean of some of its vertices. The vertices of a base change when the part rotates.
struct LevelReference {
    const Annotation* part;
    std::vector<Index> vertices;
    bool centroid;
    bool base = false;

    /// The reference on another state of the shape.
    [[nodiscard]] LevelReference on(const Mesh& mesh, const Points& points, const Vector3d& up) const {
        LevelReference now = *this;
        if (base) now.vertices = base_of(points, vertices_of(mesh, *part), up);
        return now;
    }

    /// The weight of each vertex in the mean.
    [[nodiscard]] std::vector<double> weights(const Mesh& mesh) const {
        std::vector<double> list(vertices.size(), centroid ? 0 : 1);
        const auto add = [&](Index v, double weight) {
            list[static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin())] += weight;
        };
        if (!centroid) return list;
        for (const Index f : part->faces)
            for (const Index v : corners(mesh, Face(f))) add(v, face_area(mesh, Face(f)) / 3);
        for (const auto& line : part->polylines)
            for (std::size_t i = 1; i < line.size(); ++i) {
                const double length = (eigen(mesh.point(Vertex(line[i]))) - eigen(mesh.point(Vertex(line[i - 1])))).norm();
                add(line[i - 1], length / 2), add(line[i], length / 2);
            }
        for (const Index v : part->points) add(v, 1);
        if (std::all_of(list.begin(), list.end(), [](double weight) { return !(weight > 0); })) list.assign(list.size(), 1);
        return list;
    }
    [[nodiscard]] Vector3d place(const Mesh& mesh, const Points& points) const {
        const std::vector<double> weight = weights(mesh);
        Vector3d sum = Vector3d::Zero();
        double whole = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            sum += weight[i] * (points.col(vertices[i]) - points.col(vertices.front())), whole += weight[i];
        return points.col(vertices.front()) + sum / whole;
    }
};

std::vector<LevelReference> level_references(const ConstraintMembers& members, spec::SameLevel::Reference reference,
                                             const Vector3d& up) {
    using Reference = spec::SameLevel::Reference;
    std::vector<LevelReference> list;
    for (std::size_t i = 0; i < members.count(); ++i) {
        std::vector<Index> vertices = members.vertices(i);
        if (reference == Reference::base) vertices = base_of(members.shape().rest, vertices, up);
        if (reference == Reference::vertex) vertices = {reference_vertex(members.shape().rest, vertices)};
        list.push_back({&members.member(i), std::move(vertices), reference == Reference::mean, reference == Reference::base});
    }
    return list;
}

/// Range of the heights of the references, relative to the given positions at rest.
double apart(const std::vector<LevelReference>& references, const Vector3d& up, const State& state,
             const std::vector<Vector3d>& rest = {}) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < references.size(); ++i) {
        const Vector3d place = references[i].on(state.mesh, state.points, up).place(state.mesh, state.points);
        const double height = up.dot(rest.empty() ? place : Vector3d(place - rest[i]));
        low = std::min(low, height), high = std::max(high, height);
    }
    return high - low;
}

/// A constraint on the heights of references; with positions at rest their height differences are preserved.
std::unique_ptr<Constraint> level_of(const ConstraintMembers& members, const std::vector<LevelReference>& references,
                                     const Vector3d& up, const Mesh& weighted_on, const State& now,
                                     const std::vector<Vector3d>& rest) {
    kinds::MeansOnLevel level{up};
    std::vector<int> ids;
    for (std::size_t i = 0; i < references.size(); ++i) {
        const LevelReference reference = references[i].on(now.mesh, now.points, up);
        const std::vector<double> weights = reference.weights(weighted_on);
        for (std::size_t k = 0; k < weights.size(); ++k) {
            if (!(weights[k] > 0)) continue;
            ids.push_back(static_cast<int>(reference.vertices[k]));
            level.groups.push_back(static_cast<int>(i));
            level.weights.push_back(weights[k]);
        }
    }
    if (!rest.empty()) {
        level.places.emplace(3, static_cast<Eigen::Index>(rest.size()));
        for (std::size_t i = 0; i < rest.size(); ++i) level.places->col(static_cast<Eigen::Index>(i)) = rest[i];
    }
    return members.make(level, std::move(ids));
}

Reattachment reattachment_of(const ConstraintMembers& members, std::optional<Vector3d> up, double bend) {
    Reattachment reattachment;
    std::vector<bool> taken(members.shape().mesh.number_of_vertices(), false);
    for (std::size_t i = 0; i < members.count(); ++i) {
        const Annotation& feature = members.member(i);
        members.need_region(i);
        if (!has_outline(members.shape().mesh, feature))
            members.fail("annotation " + std::to_string(feature.id) + " is a whole piece of the object and sits on nothing",
                         "seat parts of it");
        for (const Index v : members.vertices(i)) {
            if (taken[v])
                members.fail(
                    "annotation " + std::to_string(feature.id) + " touches another feature, so that neither can move alone",
                    "make one annotation of both, or keep their shapes without seating");
            taken[v] = true;
        }
        reattachment.features.push_back(&feature);
    }
    reattachment.up = up;
    reattachment.bend = bend;
    return reattachment;
}

}  // namespace

Statement keep_shape(const MembersPtr& members, const spec::KeepShape& spec, const RelationOptions& tolerances) {
    members->need(1, 0);
    using Mode = spec::KeepShape::Mode;
    const ConstraintKind kind = keeping(spec.mode == Mode::similar);
    Statement statement;
    statement.keeps = "its shape";
    if (spec.mode == Mode::seat) statement.reattachment = reattachment_of(*members, {}, spec.bend);
    const auto parts = std::make_shared<const Statement::Constraints>(kept(*members, kind));
    statement.lower = [members, kind, reattached = spec.mode == Mode::seat](const State&, const State&) {
        return reattached ? Statement::Constraints() : kept(*members, kind);
    };
    // Tolerances are relative to the size of each part, since parts are small compared to the object.
    std::vector<double> tolerance;
    for (const auto& part : *parts) tolerance.push_back(tolerances.distance * members->size_at_rest(*part));
    statement.measure = [=, unit = members->shape().annotations.unit](const State& deformed) {
        Deviation worst{"rms distance from its shape", 0.0, tolerance.front(), unit};
        for (std::size_t i = 0; i < parts->size(); ++i) {
            const Constraint& part = *(*parts)[i];
            const double off = std::sqrt(part.squared_distance(deformed.points) / static_cast<double>(part.ids().size()));
            if (off * *worst.tolerance > *worst.value * tolerance[i]) worst.value = off, worst.tolerance = tolerance[i];
        }
        return verdict_of({worst});
    };
    return statement;
}

Statement same_level(const MembersPtr& members, const spec::SameLevel& spec, const RelationOptions& tolerances) {
    members->need(2, 0);
    using Shapes = spec::SameLevel::Shapes;
    using Reference = spec::SameLevel::Reference;
    using Heights = spec::SameLevel::Heights;
    const Vector3d up = members->up(spec.up);
    // The thesis uses a reference vertex of each part. Its position depends on the mesh, so that such vertices are not on one
    // level even at rest; centroids of parts are.
    const auto references = std::make_shared<const std::vector<LevelReference>>(level_references(*members, spec.reference, up));
    const Mesh& mesh = members->shape().mesh;
    const double tolerance = members->tolerance("height", length_tolerance(*members, tolerances));
    // Parts on one level at rest keep their small height differences; others are moved to one level.
    const bool keeps =
        spec.reference != Reference::vertex && !members->shape().alone && apart(*references, up, State(mesh)) <= tolerance;
    const bool as_at_rest =
        spec.shapes != Shapes::seat && spec.heights.value_or(keeps ? Heights::rest : Heights::equal) == Heights::rest;
    std::vector<Vector3d> places;
    if (as_at_rest)
        for (const LevelReference& one : *references) places.push_back(one.place(mesh, members->shape().rest));
    Statement statement;
    if (as_at_rest) statement.keeps = "the differences of height";
    if (spec.shapes == Shapes::seat) {
        statement.reattachment = reattachment_of(*members, up, spec.bend);
        for (const LevelReference& one : *references)
            if (!one.centroid) statement.reattachment->references.push_back(one.vertices);
        statement.lower = [](const State&, const State&) { return Statement::Constraints(); };
    } else {
        members->check_leader(spec.leader);
        // For rigid parts the centroid has the vertex weights at rest; for others the weights are updated.
        const bool rigid = spec.shapes != Shapes::free;
        const ConstraintKind kind = keeping(spec.shapes == Shapes::similar);
        statement.follows = (!rigid && spec.reference == Reference::mean) || spec.reference == Reference::base;
        statement.lower = [=](const State& edited, const State& now) {
            const auto leader = members->leader(spec.leader, edited);
            Statement::Constraints list;
            if (leader) list.push_back(members->as_edited(*leader, edited));
            if (rigid)
                for (std::size_t i = 0; i < members->count(); ++i)
                    if (const auto ids = ids_of(members->vertices(i)); i != leader && ids.size() > 1)
                        list.push_back(members->make(kind, ids));
            list.push_back(level_of(*members, *references, up, rigid ? members->shape().mesh : now.mesh, now, places));
            return list;
        };
    }
    const Deviation height{as_at_rest ? "change of the heights against each other" : "height", 0.0, tolerance,
                           members->shape().annotations.unit};
    statement.measure = [=](const State& deformed) {
        Deviation worst = height;
        worst.value = apart(*references, up, deformed, places);
        return verdict_of({worst});
    };
    return statement;
}

}  // namespace ostraka::semantic

// Parts that keep their shape, and features that stand on one level.
#include "ostraka/core/dense.h"
#include "reader.h"

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

/// The vertex of an annotation that stands for its place: nearest to the mean of its vertices on its plane (section 5.2.1).
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

/// All members, with the kind that keeps their shape.
Statement::Constraints kept(const Reader& read, const char* kind) {
    Statement::Constraints list;
    for (std::size_t i = 0; i < read.members(); ++i) list.push_back(read.make(kind, ids_of(read.vertices(i)), {}));
    return list;
}

/// The mean of each group of vertices.
std::vector<Vector3d> means_of(const std::vector<std::vector<Index>>& groups, const Points& points) {
    std::vector<Vector3d> means;
    for (const auto& vertices : groups) means.push_back(mean_of(vertices, points));
    return means;
}

/// The lowest twentieth of a part's height.
std::vector<Index> base_of(const Points& rest, const std::vector<Index>& vertices, const Vector3d& up) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index v : vertices) low = std::min(low, up.dot(rest.col(v))), high = std::max(high, up.dot(rest.col(v)));
    std::vector<Index> base;
    for (const Index v : vertices)
        if (up.dot(rest.col(v)) <= low + 0.05 * (high - low)) base.push_back(v);
    return base;
}

Reattachment reattachment_of(const Reader& read, std::optional<Vector3d> up) {
    Reattachment reattachment;
    std::vector<bool> taken(read.shape().mesh.number_of_vertices(), false);
    for (std::size_t i = 0; i < read.members(); ++i) {
        const Annotation& feature = read.member(i);
        read.need_region(i);
        if (!has_outline(read.shape().mesh, feature))
            read.fail("annotation " + std::to_string(feature.id) + " is a whole piece of the object and sits on nothing",
                      "seat parts of it");
        for (const Index v : read.vertices(i)) {
            if (taken[v])
                read.fail("annotation " + std::to_string(feature.id) + " touches another feature, so that neither can move alone",
                          "make one annotation of both, or keep their shapes without seating");
            taken[v] = true;
        }
        reattachment.features.push_back(&feature);
    }
    reattachment.up = up;
    reattachment.bend = read.number("bend", 7.5e-4, 0, 1);
    return reattachment;
}

}  // namespace

Statement keep_shape(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(1, 0);
    const std::string mode = read->word("mode", "rigid", {"rigid", "similar", "seat"});
    const char* const kind = mode == "similar" ? "Similarity" : "Rigid";
    Statement statement;
    if (mode == "seat") statement.reattachment = reattachment_of(*read, {});
    const auto parts = std::make_shared<const Statement::Constraints>(kept(*read, kind));
    statement.lower = [read, kind, reattached = mode == "seat"](const State&, const State&) {
        return reattached ? Statement::Constraints() : kept(*read, kind);
    };
    // A part is small against the object: its own size tells what matters.
    std::vector<double> tolerance;
    for (const auto& part : *parts) tolerance.push_back(tolerances.distance * read->size_at_rest(*part));
    statement.measure = [=, unit = read->shape().set.unit](const State& deformed) {
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

Statement same_level(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    ConstraintParameters level;
    level.direction = read->up();
    const std::string shapes = read->word("shapes", "keep", {"keep", "free", "seat"});
    Relationship stated = read->relationship();
    stated.parameters.up = {(*level.direction)[0], (*level.direction)[1], (*level.direction)[2]};
    const auto related = as_related(read, stated, tolerances);
    const Mesh& mesh = read->shape().mesh;
    // Parts that stand on one level keep what they are off at rest; others are brought to one.
    const bool is_level = related(State(mesh)).verdict == Verdict::holds;
    const bool as_at_rest = shapes != "seat" && read->word("heights", is_level ? "rest" : "equal", {"rest", "equal"}) == "rest";
    // The thesis takes a reference vertex of each part, whose place on the part is as fine as the mesh: at rest such vertices are
    // not on one level themselves. Means of parts are.
    const std::string reference = read->word("reference", "mean", {"mean", "vertex", "base"});
    const bool means = reference != "vertex";
    std::vector<std::vector<Index>> groups;
    for (std::size_t i = 0; i < read->members(); ++i)
        groups.push_back(reference == "base" ? base_of(read->shape().rest, read->vertices(i), *level.direction)
                                             : read->vertices(i));
    std::vector<int> references;
    for (std::size_t i = 0; i < read->members(); ++i) {
        const auto& vertices = groups[i];
        if (means) {
            for (const Index v : vertices) {
                references.push_back(static_cast<int>(v));
                level.stations.push_back(static_cast<int>(i));
            }
        } else {
            references.push_back(static_cast<int>(reference_vertex(read->shape().rest, vertices)));
        }
    }
    const std::vector<Vector3d> places = means_of(groups, read->shape().rest);
    if (as_at_rest && means) {
        level.target.emplace(3, static_cast<Eigen::Index>(places.size()));
        for (std::size_t i = 0; i < places.size(); ++i) level.target->col(static_cast<Eigen::Index>(i)) = places[i];
    }
    Statement statement;
    if (shapes == "seat") {
        statement.reattachment = reattachment_of(*read, level.direction);
        statement.lower = [](const State&, const State&) { return Statement::Constraints(); };
    } else {
        read->read_leader();
        statement.lower = [=](const State& edited, const State&) {
            const auto leader = read->leader(edited);
            Statement::Constraints list;
            if (leader) list.push_back(read->as_edited(*leader, edited));
            if (shapes == "keep")
                for (std::size_t i = 0; i < read->members(); ++i)
                    if (const auto ids = ids_of(read->vertices(i)); i != leader && ids.size() > 1)
                        list.push_back(read->make("Rigid", ids, {}));
            list.push_back(read->make(means ? "MeansOnLevel" : "Orientation", references, level));
            return list;
        };
    }
    if (!level.target) {
        statement.measure = related;
        return statement;
    }
    const Deviation change{"change of the heights against each other", 0.0, length_tolerance(*read, tolerances),
                           read->shape().set.unit};
    statement.measure = [groups, places, change, up = *level.direction](const State& deformed) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        const std::vector<Vector3d> now = means_of(groups, deformed.points);
        for (std::size_t i = 0; i < now.size(); ++i) {
            const double risen = up.dot(now[i] - places[i]);
            low = std::min(low, risen), high = std::max(high, risen);
        }
        Deviation worst = change;
        worst.value = high - low;
        return verdict_of({worst});
    };
    return statement;
}

}  // namespace ostraka::semantic

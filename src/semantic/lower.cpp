#include "lower.h"

#include "continuity.h"

#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/measure/measure.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/semantic/deform.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::semantic {

namespace {

using Eigen::Vector3d;

std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }

class Reader {
public:
    Reader(const Shape& shape, const Relationship& relationship, const std::string& where)
        : shape_(shape),
          relationship_(relationship),
          where_(where + ", constraint " + std::to_string(relationship.id) + " (" + relationship.type + ")") {
        if (!relationship.constraint.empty()) parameters_ = parse_json(relationship.constraint, where_);
        else parameters_.SetObject();
    }

    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const { fail_input(where_, what, remedy); }

    [[nodiscard]] const Annotation& member(std::size_t i) const {
        const Annotation* annotation = shape_.set.find(relationship_.annotations.at(i));
        if (annotation == nullptr)
            fail("there is no annotation " + std::to_string(relationship_.annotations[i]), "see 'annotation list'");
        return *annotation;
    }
    void need(std::size_t least, std::size_t most) const {
        const std::size_t n = relationship_.annotations.size();
        if (n < least || (most > 0 && n > most))
            fail("has " + std::to_string(n) + " annotations",
                 "give " + std::to_string(least) + (most == least ? "" : " or more"));
    }
    [[nodiscard]] std::vector<Index> vertices(std::size_t i) const {
        const auto list = vertices_of(shape_.mesh, member(i));
        if (list.empty())
            fail("annotation " + std::to_string(member(i).id) + " selects nothing", "select a part, or leave it out");
        return list;
    }
    [[nodiscard]] std::string word(const char* name, const std::string& otherwise,
                                   std::initializer_list<const char*> known) const {
        const JsonValue* value = find_member(parameters_, name);
        const std::string text = value == nullptr ? otherwise : value->IsString() ? value->GetString() : "?";
        if (std::none_of(known.begin(), known.end(), [&](const char* k) { return text == k; })) {
            std::string list;
            for (const char* k : known) list += (list.empty() ? "" : ", ") + std::string(k);
            fail(std::string(name) + " is '" + text + "'", "use one of: " + list);
        }
        return text;
    }
    [[nodiscard]] std::optional<Vector3d> direction(const char* name) const {
        const JsonValue* value = find_member(parameters_, name);
        if (value == nullptr) return {};
        if (!value->IsArray() || value->Size() != 3) fail(std::string(name) + " is not three numbers", "give x, y, z");
        Vector3d d;
        for (int k = 0; k < 3; ++k) {
            const JsonValue& x = (*value)[static_cast<rapidjson::SizeType>(k)];
            if (!x.IsNumber() || !std::isfinite(x.GetDouble())) fail(std::string(name) + " is not three numbers", "give x, y, z");
            d[k] = x.GetDouble();
        }
        const double largest = d.cwiseAbs().maxCoeff();
        if (!(largest > 0)) fail(std::string(name) + " is zero", "give a direction");
        return Vector3d((d / largest).normalized());
    }
    [[nodiscard]] Vector3d up() const {
        if (const auto d = direction("direction")) return *d;
        if (!shape_.set.up) fail("no direction is up", "give direction in the constraint, or up in the annotations");
        return Vector3d((*shape_.set.up)[0], (*shape_.set.up)[1], (*shape_.set.up)[2]).normalized();
    }
    [[nodiscard]] double number(const char* name, double otherwise, double least, double most) const {
        const JsonValue* value = find_member(parameters_, name);
        if (value == nullptr) return otherwise;
        if (!value->IsNumber() || !(value->GetDouble() >= least && value->GetDouble() <= most))
            fail(std::string(name) + " is not a number from " + std::to_string(least) + " to " + std::to_string(most), "mend it");
        return value->GetDouble();
    }
    /// minValue and maxValue (Appendix B.2), positive.
    [[nodiscard]] Range range() const {
        const auto number = [&](const char* name) {
            const JsonValue* value = find_member(parameters_, name);
            if (value == nullptr || !value->IsNumber() || !(value->GetDouble() > 0 && value->GetDouble() < 1e60))
                fail(std::string(name) + (value == nullptr ? " is missing" : " is not a positive number"),
                     "give minValue and maxValue");
            return value->GetDouble();
        };
        const Range r{number("minValue"), number("maxValue")};
        if (r.min > r.max) fail("minValue is greater than maxValue", "exchange them");
        return r;
    }
    /// The measure that `name` names by id or name in the annotation; the only one if it is left out.
    [[nodiscard]] const Measure& measure(const char* name, const Annotation& annotation) const {
        const JsonValue* value = find_member(parameters_, name);
        const Measure* found = nullptr;
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.type != AttributeType::measure) continue;
            const bool here = value == nullptr || (value->IsInt() && value->GetInt() == attribute.id) ||
                              (value->IsString() && attribute.name == value->GetString());
            if (!here) continue;
            if (found != nullptr)
                fail("annotation " + std::to_string(annotation.id) + " has several measures that " + name + " may mean",
                     "give its id");
            found = &attribute.measure;
        }
        if (found == nullptr)
            fail("annotation " + std::to_string(annotation.id) + " has no measure that " + name + " names",
                 "take one with 'measure take', or mend " + std::string(name));
        return *found;
    }

    const Shape& shape() const { return shape_; }
    const Relationship& relationship() const { return relationship_; }
    [[nodiscard]] std::unique_ptr<Constraint> make(const char* kind, std::vector<int> ids, const ConstraintParameters& parameters,
                                                   double share = 1) const {
        try {
            return make_constraint(kind, std::move(ids), relationship_.weight * share, parameters, shape_.rest);
        } catch (const Error& error) {
            fail(error.problem(), error.remedy());
        }
    }

private:
    const Shape& shape_;
    const Relationship& relationship_;
    std::string where_;
    Json parameters_;
};

/// The vertex of an annotation that stands for its place: nearest to the mean of its vertices on its plane (section 5.2.1).
Index reference_vertex(const Points& rest, const std::vector<Index>& vertices) {
    Vector3d mean = Vector3d::Zero();
    for (const Index v : vertices) mean += rest.col(v);
    mean /= static_cast<double>(vertices.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Index v : vertices) spread += (rest.col(v) - mean) * (rest.col(v) - mean).transpose();
    const Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    Index best = vertices.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Index v : vertices) {
        const Vector3d d = rest.col(v) - mean;
        const double off = (d - normal * normal.dot(d)).squaredNorm();
        if (off < least) least = off, best = v;
    }
    return best;
}

/// Vertices of a region that other faces use as well: where it joins the rest.
std::vector<Index> joint(const Mesh& mesh, const Annotation& annotation) {
    std::vector<bool> inside(mesh.number_of_faces(), false);
    for (const Index f : annotation.faces) inside[f] = true;
    std::set<Index> list;
    for (const Index f : annotation.faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(f)))) {
            const Face other = mesh.face(mesh.opposite(h));
            if (other != Mesh::null_face() && !inside[other]) list.insert({mesh.target(h).idx(), mesh.source(h).idx()});
        }
    return {list.begin(), list.end()};
}

Lowered keep_shape(const Reader& read) {
    read.need(1, 0);
    const bool similar = read.word("mode", "rigid", {"rigid", "similar"}) == "similar";
    Lowered result;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        result.constraints.push_back(read.make(similar ? "Similarity" : "Rigid", ids_of(read.vertices(i)), {}));
    return result;
}

Lowered same_level(const Reader& read) {
    read.need(2, 0);
    Lowered result;
    ConstraintParameters level;
    level.direction = read.up();
    const bool shapes = read.word("shapes", "keep", {"keep", "free"}) == "keep";
    // The thesis takes a reference vertex of each part, whose place on the part is as fine as the mesh: at rest such vertices are
    // not on one level themselves. Means of parts are.
    const bool means = read.word("reference", "mean", {"mean", "vertex"}) == "mean";
    std::vector<int> references;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i) {
        const auto vertices = read.vertices(i);
        if (means) {
            for (const Index v : vertices) {
                references.push_back(static_cast<int>(v));
                level.stations.push_back(static_cast<int>(i));
            }
        } else {
            references.push_back(static_cast<int>(reference_vertex(read.shape().rest, vertices)));
        }
        if (shapes && vertices.size() > 1) result.constraints.push_back(read.make("Rigid", ids_of(vertices), {}));
    }
    result.constraints.push_back(read.make(means ? "MeansOnLevel" : "Orientation", references, level));
    return result;
}

Lowered co_planarity(const Reader& read) {
    read.need(1, 0);
    std::set<Index> all;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        for (const Index v : read.vertices(i)) all.insert(v);
    Lowered result;
    result.constraints.push_back(read.make("Plane", {all.begin(), all.end()}, {}));
    return result;
}

Lowered co_linearity(const Reader& read) {
    read.need(1, 0);
    std::set<Index> all;
    for (std::size_t i = 0; i < read.relationship().annotations.size(); ++i)
        for (const Index v : read.vertices(i)) all.insert(v);
    Lowered result;
    result.constraints.push_back(read.make("Line", {all.begin(), all.end()}, {}));
    return result;
}

/// The two pins between which a ruler or bounding measure is taken, and the direction of the latter.
struct Pins {
    Index from, to;
    std::optional<Vector3d> direction;
};

Pins pins_of(const Reader& read, const Measure& measure) {
    if (measure.tool != "ruler" && measure.tool != "bounding")
        read.fail("a " + measure.tool + " cannot be constrained", "take a ruler or a bounding measure");
    Pins pins{measure.points.front(), measure.points.back(), {}};
    if (measure.direction) {
        pins.direction = Vector3d((*measure.direction)[0], (*measure.direction)[1], (*measure.direction)[2]).normalized();
        // Its extremes on the shape as it is.
        const auto height = [&](Index v) { return pins.direction->dot(read.shape().rest.col(v)); };
        for (const Index v : measure.points) {
            if (height(v) < height(pins.from)) pins.from = v;
            if (height(v) > height(pins.to)) pins.to = v;
        }
    }
    return pins;
}

double length_of(const Pins& pins, const Points& points) {
    const Vector3d d = points.col(pins.to) - points.col(pins.from);
    return pins.direction ? std::abs(pins.direction->dot(d)) : d.norm();
}

Lowered proportion(const Reader& read) {
    read.need(2, 2);
    const Range range = read.range();
    const Pins first = pins_of(read, read.measure("measure1", read.member(0)));
    const Pins second = pins_of(read, read.measure("measure2", read.member(1)));
    std::vector<Index> part = read.vertices(0);
    ConstraintParameters parameters;
    const auto place = [&](Index v, std::size_t end) {
        const auto found = std::find(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(end), v);
        if (found != part.begin() + static_cast<std::ptrdiff_t>(end)) return static_cast<int>(found - part.begin());
        part.push_back(v);
        return static_cast<int>(part.size() - 1);
    };
    for (const Index v : {first.from, first.to})
        if (std::find(part.begin(), part.end(), v) == part.end()) part.push_back(v);
    parameters.split = static_cast<int>(part.size());
    parameters.min = range.min;
    parameters.max = range.max;
    parameters.direction = first.direction;
    parameters.second_direction = second.direction;
    parameters.pins = {place(first.from, part.size()), place(first.to, part.size())};
    // It stretches from where it joins the rest.
    Lowered result;
    result.anchors = joint(read.shape().mesh, read.member(0));
    for (const Index v : result.anchors) parameters.anchors.push_back(place(v, part.size()));
    parameters.pins.push_back(place(second.from, part.size()));
    parameters.pins.push_back(place(second.to, part.size()));
    result.constraints.push_back(read.make("Proportion", ids_of(part), parameters));
    return result;
}

Lowered keep_measure(const Reader& read) {
    read.need(1, 1);
    const Range range = read.range();
    const Pins pins = pins_of(read, read.measure("measure", read.member(0)));
    if (pins.direction) read.fail("a bounding measure cannot be kept by itself", "take a ruler, or state a proportion");
    ConstraintParameters parameters;
    parameters.min = range.min;
    parameters.max = range.max;
    parameters.absolute = true;
    Lowered result;
    result.constraints.push_back(read.make("EdgeStrain", {static_cast<int>(pins.from), static_cast<int>(pins.to)}, parameters));
    return result;
}

Lowered co_axiality(const Reader& read) {
    read.need(2, 2);
    Lowered result;
    const auto axis = [&](std::size_t i) {
        if (read.member(i).faces.empty())
            read.fail("annotation " + std::to_string(read.member(i).id) + " is no region", "use regions");
        const Axis found = find_axis(read.shape().mesh, read.member(i).faces);
        if (!found.found)
            read.fail("annotation " + std::to_string(read.member(i).id) + " has no axis: " + found.reason,
                      "use another relation");
        return found;
    };
    const Axis moved = axis(0), reference = axis(1);
    ConstraintParameters parameters;
    parameters.direction = eigen(reference.direction);
    parameters.point = eigen(reference.point);
    parameters.rest_direction = eigen(moved.direction);
    parameters.rest_point = eigen(moved.point);
    result.constraints.push_back(read.make("CoAxiality", ids_of(read.vertices(0)), parameters));
    return result;
}

/// The segment of the first member that continues the second, and the axis of the second on a mesh.
AxisSegment segment_of(const Reader& read) {
    read.need(2, 2);
    for (const std::size_t i : {0, 1})
        if (read.member(i).faces.empty())
            read.fail("annotation " + std::to_string(read.member(i).id) + " is no region", "use regions");
    const Axis reference = find_axis(read.shape().mesh, read.member(1).faces);
    if (!reference.found)
        read.fail("annotation " + std::to_string(read.member(1).id) + " has no axis: " + reference.reason, "use another part");
    const AxisSegment segment = continuing_segment(read.shape().mesh, read.member(0), read.member(1), reference.direction,
                                                   read.number("angle", 10, 0.1, 90));
    if (!segment.reason.empty())
        read.fail("annotation " + std::to_string(read.member(0).id) + " " + segment.reason, "raise angle, or state co-axiality");
    return segment;
}

Lowered structural_continuity(const Reader& read) {
    const AxisSegment segment = segment_of(read);
    const Axis reference = find_axis(read.shape().mesh, read.member(1).faces);
    ConstraintParameters parameters;
    parameters.direction = eigen(reference.direction);
    parameters.point = eigen(reference.point);
    parameters.stations = segment.stations;
    Lowered result;
    result.constraints.push_back(read.make("AxisOnLine", segment.vertices, parameters));
    return result;
}

/// Means of the stations on deformed points.
std::vector<Vector3d> station_means(const AxisSegment& segment, const Points& points) {
    std::vector<Vector3d> means(static_cast<std::size_t>(segment.count), Vector3d::Zero());
    std::vector<double> sizes(means.size(), 0);
    for (std::size_t i = 0; i < segment.vertices.size(); ++i) {
        const auto s = static_cast<std::size_t>(segment.stations[i]);
        means[s] += points.col(segment.vertices[i]);
        sizes[s] += 1;
    }
    for (std::size_t s = 0; s < means.size(); ++s) means[s] /= sizes[s];
    return means;
}

using Lowering = Lowered (*)(const Reader&);
const std::map<std::string, Lowering>& table() {
    static const std::map<std::string, Lowering> rows{
        {"keep shape", keep_shape},     {"same level", same_level},
        {"co-planarity", co_planarity}, {"co-linearity", co_linearity},
        {"proportion", proportion},     {"keep measure", keep_measure},
        {"co-axiality", co_axiality},   {"structural continuity", structural_continuity},
    };
    return rows;
}

double percent_out(double value, const Range& range) {
    if (value < range.min) return 100 * (range.min - value) / range.min;
    return value > range.max ? 100 * (value - range.max) / range.max : 0;
}

Measured verdict_of(std::vector<Deviation> deviations) {
    Measured result;
    result.verdict =
        std::all_of(deviations.begin(), deviations.end(), [](const Deviation& d) { return *d.value <= *d.tolerance; })
            ? Verdict::holds
            : Verdict::fails;
    result.deviations = std::move(deviations);
    return result;
}

}  // namespace

Points columns_of(const Mesh& mesh) {
    Points points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
    for (const Vertex v : mesh.vertices()) points.col(v.idx()) = eigen(mesh.point(v));
    return points;
}

Lowered lower(const Shape& shape, const Relationship& relationship, const std::string& where) {
    const auto row = table().find(relationship.type);
    if (row == table().end()) return {};
    return row->second(Reader(shape, relationship, where));
}

Measured measure(const Shape& shape, const Mesh& deformed, const Relationship& relationship, const RelationOptions& tolerances,
                 const std::string& where) {
    const Reader read(shape, relationship, where);
    const Points points = columns_of(deformed);
    const double length = tolerances.distance * box_diagonal(shape.mesh);
    if (relationship.type == "keep shape") {
        double worst = 0;
        for (const auto& constraint : lower(shape, relationship, where).constraints) {
            Points rows;
            worst =
                std::max(worst, std::sqrt(constraint->squared_distance(points) / static_cast<double>(constraint->ids().size())));
        }
        return verdict_of({{"rms distance from its shape", worst, length, shape.set.unit}});
    }
    if (relationship.type == "proportion" || relationship.type == "keep measure") {
        const Range range = read.range();
        const bool two = relationship.type == "proportion";
        const double first = length_of(pins_of(read, read.measure(two ? "measure1" : "measure", read.member(0))), points);
        const double second = two ? length_of(pins_of(read, read.measure("measure2", read.member(1))), points) : 1;
        const double value = first / second;
        Measured result = verdict_of({{"out of range", std::isfinite(value) ? percent_out(value, range) : 1e9, 0.1, "%"}});
        result.text = std::to_string(value) + " in " + std::to_string(range.min) + " to " + std::to_string(range.max);
        return result;
    }
    if (relationship.type == "structural continuity") {
        const AxisSegment segment = segment_of(read);
        const Axis reference = find_axis(deformed, read.member(1).faces);
        if (!reference.found) return {Verdict::unknown, {}, "the reference has no axis any more: " + reference.reason};
        const auto means = station_means(segment, points);
        const Vector3d direction = eigen(reference.direction), along = means.back() - means.front();
        double off = 0;
        for (const Vector3d& mean : means) off = std::max(off, direction.cross(mean - eigen(reference.point)).norm());
        const double turned = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) * 180 / M_PI;
        return verdict_of({{"angle", turned, tolerances.angle, "degree"}, {"distance", off, length, shape.set.unit}});
    }
    // What relations measure holds for constraints of the same name.
    RelationMeter meter(deformed, shape.set, tolerances);
    Relationship stated = relationship;
    stated.is_constraint = false;
    const RelationCheck check = meter.measure(stated);
    return {check.verdict, check.parameters.deviations, check.text};
}

}  // namespace ostraka::semantic

namespace ostraka {

const std::vector<std::string>& semantic_constraint_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> list;
        for (const auto& [name, lowering] : semantic::table()) list.push_back(name);
        return list;
    }();
    return types;
}

}  // namespace ostraka

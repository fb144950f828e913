// Constraints on measures: of one part, of a part against another, of parts among each other.
#include "reader.h"

#include "ostraka/geom/shortest_path.h"
#include "ostraka/measure/measure.h"

#include <unordered_map>

namespace ostraka::semantic {

namespace {

/// minValue to maxValue.
double percent_out(double value, const Range& range) {
    if (value < range.min) return 100 * (range.min - value) / range.min;
    return value > range.max ? 100 * (value - range.max) / range.max : 0;
}

/// A measure by the vertices it depends on: two pins, or the way of a tape over the shape at rest.
struct Gauge {
    std::vector<int> way;
    std::optional<Vector3d> direction;  ///< of a bounding measure
    std::vector<int> pins;              ///< of a bounding measure: all of them
    bool tape = false;
    double factor = 1;  ///< the measure / the length of its way, at rest: an exact tape is shorter than edges

    [[nodiscard]] double value(const Points& points) const {
        if (direction) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const int v : pins) {
                low = std::min(low, direction->dot(points.col(v)));
                high = std::max(high, direction->dot(points.col(v)));
            }
            return high - low;
        }
        double length = 0;
        for (std::size_t i = 1; i < way.size(); ++i) length += (points.col(way[i]) - points.col(way[i - 1])).norm();
        return factor * length;
    }
};

Gauge gauge_of(const Reader& read, const char* name, std::size_t member) {
    const Annotation& annotation = read.member(member);
    const Measure& measure = read.measure(name, annotation);
    const Mesh& mesh = read.shape().mesh;
    Gauge gauge;
    // A ruler over several pins is a line of its own, as a tape is.
    gauge.tape = measure.tool == "tape" || (!measure.direction && measure.points.size() > 2);
    if (measure.points.size() < 2)
        read.fail("annotation " + std::to_string(annotation.id) + " has a measure with fewer than two pins", "take it again");
    for (const Index v : measure.points)
        if (v >= mesh.number_of_vertices())
            read.fail("annotation " + std::to_string(annotation.id) + " has a measure with pin " + std::to_string(v) +
                          ", which the mesh does not have",
                      "take it again");
    if (measure.direction) {
        const Vector3d given((*measure.direction)[0], (*measure.direction)[1], (*measure.direction)[2]);
        gauge.direction = Vector3d((given / given.cwiseAbs().maxCoeff()).normalized());
        gauge.pins.assign(measure.points.begin(), measure.points.end());
        // Its extremes on the shape as it is.
        const auto height = [&](Index v) { return gauge.direction->dot(read.shape().rest.col(v)); };
        const auto [low, high] = std::minmax_element(measure.points.begin(), measure.points.end(),
                                                     [&](Index a, Index b) { return height(a) < height(b); });
        gauge.way = {static_cast<int>(*low), static_cast<int>(*high)};
    } else if (measure.tool == "ruler") {
        gauge.way.assign(measure.points.begin(), measure.points.end());
    } else {
        PathSearch search(mesh);
        gauge.way = {static_cast<int>(measure.points.front())};
        for (std::size_t i = 1; i < measure.points.size(); ++i) {
            const auto path = search.find(Vertex(measure.points[i - 1]), Vertex(measure.points[i]), {});
            for (std::size_t k = 1; k < path.size(); ++k) gauge.way.push_back(static_cast<int>(path[k]));
        }
    }
    const double length = gauge.value(read.shape().rest);
    if (!(length > 0))
        read.fail("the measure of annotation " + std::to_string(annotation.id) + " has no length", "move its pins apart");
    if (measure.tool == "tape") gauge.factor = evaluate(mesh, annotation, measure) / length;
    return gauge;
}

/// Vertices of a region that other faces use as well: where it joins the rest.
std::vector<Index> joint(const Mesh& mesh, const Annotation& annotation) {
    const std::vector<bool> inside = face_flags(mesh, annotation.faces);
    std::set<Index> list;
    for (const Index f : annotation.faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(f)))) {
            const Face other = mesh.face(mesh.opposite(h));
            if (other != Mesh::null_face() && !inside[other]) list.insert({mesh.target(h).idx(), mesh.source(h).idx()});
        }
    return {list.begin(), list.end()};
}

/// A part with its measure: how it is made longer or shorter, stretched along the measure or scaled as a whole.
class Stretch {
public:
    Stretch(const ReaderPtr& read, std::size_t member, Gauge gauge)
        : read_(read), gauge_(std::move(gauge)), uniform_(read->word("mode", "stretch", {"stretch", "scale"}) == "scale") {
        const Points& rest = read->shape().rest;
        const std::vector<Index> joined = joint(read->shape().mesh, read->member(member)), own = read->vertices(member);
        if (!gauge_.tape) {
            for (const Index v : own) place(static_cast<int>(v));
            parameters_.pins = {place(gauge_.way.front()), place(gauge_.way.back())};
            parameters_.split = static_cast<int>(ids_.size());
            parameters_.direction = gauge_.direction;
            parameters_.uniform = uniform_;
        }
        // The joint stays in its place, if it is at one end of the part. A part between others moves them on all sides.
        const Vector3d edge = rest.col(gauge_.way.back()) - rest.col(gauge_.way.front());
        const Vector3d axis = gauge_.direction ? *gauge_.direction : Vector3d(edge.normalized());
        const auto extent = [&](const std::vector<Index>& vertices) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const Index v : vertices)
                low = std::min(low, axis.dot(rest.col(v))), high = std::max(high, axis.dot(rest.col(v)));
            return high - low;
        };
        constexpr double one_end = 0.4;
        if (!joined.empty() && extent(joined) <= one_end * extent(own)) anchors_ = joined;
    }
    [[nodiscard]] const std::vector<Index>& anchors() const { return anchors_; }
    [[nodiscard]] const Gauge& gauge() const { return gauge_; }

    /// The measure within a range, in the mesh's unit. A tape's line changes and the surface follows.
    [[nodiscard]] std::unique_ptr<Constraint> to(const Range& range, const State& edited) const {
        ConstraintParameters parameters = gauge_.tape ? ConstraintParameters() : parameters_;
        parameters.min = range.min / gauge_.factor;
        parameters.max = range.max / gauge_.factor;
        parameters.absolute = true;
        if (gauge_.tape) return read_->make("PolylineLength", gauge_.way, parameters);
        parameters.target = shape(edited);
        return read_->make("Proportion", ids_, parameters);
    }

    /// The measure against another one, which is free to change as well. Neither is a tape.
    [[nodiscard]] std::unique_ptr<Constraint> against(const Gauge& other, const Range& ratio, const State& edited) const {
        ConstraintParameters parameters = parameters_;
        std::vector<int> ids = ids_;
        parameters.min = ratio.min;
        parameters.max = ratio.max;
        parameters.target = shape(edited);
        parameters.second_direction = other.direction;
        for (const int v : {other.way.front(), other.way.back()}) {
            const auto known = places_.find(v);
            parameters.pins.push_back(known != places_.end() ? known->second : static_cast<int>(ids.size()));
            if (known == places_.end()) ids.push_back(v);
        }
        return read_->make("Proportion", ids, parameters);
    }

private:
    int place(int v) {
        const auto [entry, fresh] = places_.try_emplace(v, static_cast<int>(ids_.size()));
        if (fresh) ids_.push_back(v);
        return entry->second;
    }
    [[nodiscard]] Points shape(const State& edited) const {
        Points points(3, static_cast<Eigen::Index>(ids_.size()));
        for (std::size_t i = 0; i < ids_.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = edited.points.col(ids_[i]);
        return points;
    }

    ReaderPtr read_;
    Gauge gauge_;
    bool uniform_;
    std::vector<Index> anchors_;
    std::vector<int> ids_;
    std::unordered_map<int, int> places_;
    ConstraintParameters parameters_;
};

std::function<Measured(const State&)> within(const Range& range, std::function<double(const Points&)> value) {
    return [=](const State& deformed) {
        const double now = value(deformed.points);
        Measured result = verdict_of({{"out of range", std::isfinite(now) ? percent_out(now, range) : 1e9, 0.1, "%"}});
        result.text = std::to_string(now) + " in " + std::to_string(range.min) + " to " + std::to_string(range.max);
        return result;
    };
}

}  // namespace

Statement proportion(const ReaderPtr& read, const RelationOptions&) {
    read->need(2, 2);
    const Range range = read->range();
    const auto part = std::make_shared<const Stretch>(read, 0, gauge_of(*read, "measure1", 0));
    const Gauge other = gauge_of(*read, "measure2", 1);
    const bool tapes = part->gauge().tape || other.tape;
    Statement statement;
    statement.anchors = part->anchors();
    statement.follows = tapes;
    statement.lower = [=](const State& edited, const State& now) {
        const double size = other.value(now.points);
        return only(tapes ? part->to({range.min * size, range.max * size}, edited) : part->against(other, range, edited));
    };
    statement.measure = within(range, [=](const Points& p) { return part->gauge().value(p) / other.value(p); });
    return statement;
}

Statement keep_measure(const ReaderPtr& read, const RelationOptions&) {
    read->need(1, 1);
    const Range range = read->range();
    const auto part = std::make_shared<const Stretch>(read, 0, gauge_of(*read, "measure", 0));
    Statement statement;
    statement.anchors = part->anchors();
    statement.lower = [=](const State& edited, const State&) { return only(part->to(range, edited)); };
    statement.measure = within(range, [=](const Points& p) { return part->gauge().value(p); });
    return statement;
}

Statement same_measure(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    std::vector<std::shared_ptr<const Stretch>> parts;
    Statement statement;
    statement.follows = true;
    for (std::size_t i = 0; i < read->members(); ++i) {
        parts.push_back(std::make_shared<const Stretch>(read, i, gauge_of(*read, "measure", i)));
        statement.anchors.insert(statement.anchors.end(), parts.back()->anchors().begin(), parts.back()->anchors().end());
    }
    const auto mean = [parts](const Points& points) {
        double sum = 0;
        for (const auto& part : parts) sum += part->gauge().value(points);
        return sum / static_cast<double>(parts.size());
    };
    statement.lower = [=](const State& edited, const State& now) {
        const double size = mean(now.points);
        Statement::Constraints list;
        for (const auto& part : parts) list.push_back(part->to({size, size}, edited));
        return list;
    };
    const Deviation tolerance{"difference from their mean", 0.0, tolerances.ratio, "%"};
    statement.measure = [=](const State& deformed) {
        Deviation worst = tolerance;
        const double size = mean(deformed.points);
        for (const auto& part : parts)
            worst.value =
                std::max(*worst.value, size > 0 ? 100 * std::abs(part->gauge().value(deformed.points) / size - 1) : 1e9);
        return verdict_of({worst});
    };
    return statement;
}

}  // namespace ostraka::semantic

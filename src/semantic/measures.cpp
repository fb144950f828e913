// Constraints on measures: of one part, of a part relative to another, of parts among each other.
#include "semantic/statements.h"

#include "ostraka/geom/shortest_path.h"
#include "ostraka/measure/measure.h"

#include <unordered_map>

namespace ostraka::semantic {

namespace {

/// Deviation of a value from a range in percent.
double percent_out(double value, const Interval& range) {
    if (value < range.min) return 100 * (range.min - value) / range.min;
    return value > range.max ? 100 * (value - range.max) / range.max : 0;
}

/// A measure of a part, evaluated on a shape as `measure take` does.
class Gauge {
public:
    Gauge(const ConstraintMembers& members, const MeasureName& name, std::size_t member)
        : annotation_(&members.member(member)), measure_(members.measure(name, member)) {
        const Mesh& mesh = members.shape().mesh;
        const std::string who = "annotation " + std::to_string(annotation_->id);
        if (measure_.points.size() < 2) members.fail(who + " has a measure with fewer than two pins", "take it again");
        for (const Index v : measure_.points)
            if (v >= mesh.number_of_vertices())
                members.fail(who + " has a measure with pin " + std::to_string(v) + ", which the mesh does not have",
                             "take it again");
        if (measure_.direction) {
            const Vector3d given((*measure_.direction)[0], (*measure_.direction)[1], (*measure_.direction)[2]);
            direction_ = Vector3d((given / given.cwiseAbs().maxCoeff()).normalized());
        }
        extent_ = is_extent(mesh, *annotation_, measure_);
        at_rest_ = evaluate(mesh, *annotation_, measure_);
        if (!(at_rest_ > 0)) members.fail("the measure of " + who + " has no length", "move its pins apart");
    }

    [[nodiscard]] double at_rest() const { return at_rest_; }
    /// A ruler over several pins is measured along a line, as a tape is.
    [[nodiscard]] bool is_extent_of_part() const { return extent_; }
    [[nodiscard]] bool is_tape() const { return measure_.tool == "tape" || (!direction_ && measure_.points.size() > 2); }
    [[nodiscard]] const std::optional<Vector3d>& direction() const { return direction_; }
    [[nodiscard]] double value(const State& state) const {
        Measure now = measure_;
        if (extent_) now.points = extent_pins(state), now.locations.clear();
        return evaluate(state.mesh, *annotation_, now);
    }
    /// The vertices that the measure depends on: the two outermost of a bounding measure, the path of a tape.
    [[nodiscard]] std::vector<int> way(const State& state) const {
        if (direction_) {
            const auto pins = extent_ ? extent_pins(state) : measure_.points;
            const auto height = [&](Index v) { return direction_->dot(state.points.col(v)); };
            const auto [low, high] =
                std::minmax_element(pins.begin(), pins.end(), [&](Index a, Index b) { return height(a) < height(b); });
            return {static_cast<int>(*low), static_cast<int>(*high)};
        }
        if (measure_.tool == "ruler") return ids_of(measure_.points);
        PathSearch search(state.mesh);
        std::vector<int> way{static_cast<int>(measure_.points.front())};
        for (std::size_t i = 1; i < measure_.points.size(); ++i) {
            const auto path = search.find(Vertex(measure_.points[i - 1]), Vertex(measure_.points[i]), {});
            for (std::size_t k = 1; k < path.size(); ++k) way.push_back(static_cast<int>(path[k]));
        }
        return way;
    }

private:
    [[nodiscard]] std::vector<Index> extent_pins(const State& state) const {
        const auto pins = extremes(state.mesh, *annotation_, *measure_.direction);
        return {pins.begin(), pins.end()};
    }

    const Annotation* annotation_;
    Measure measure_;
    std::optional<Vector3d> direction_;  ///< direction of a bounding measure
    bool extent_ = false;                ///< extent of the whole part: its pins are determined again on every shape
    double at_rest_ = 0;
};

/// Vertices of a region that other faces use as well: where the region is joined to the rest.
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

/// A part with its measure, which changes by stretching the part along the measure or scaling it.
class Stretch {
public:
    Stretch(const MembersPtr& members, std::size_t member, Gauge gauge, spec::SizeMode mode)
        : members_(members), gauge_(std::move(gauge)), uniform_(mode == spec::SizeMode::scale) {
        const Points& rest = members->shape().rest;
        const std::vector<Index> joined = joint(members->shape().mesh, members->member(member)), own = members->vertices(member);
        if (!gauge_.is_tape())
            for (const Index v : own) place(static_cast<int>(v), ids_, places_);
        // The joint is fixed if it is at one end of the part. A part between others moves them on all sides.
        const std::vector<int> way = gauge_.way(State(members->shape().mesh));
        const Vector3d edge = rest.col(way.back()) - rest.col(way.front());
        const Vector3d axis = gauge_.direction() ? *gauge_.direction() : Vector3d(edge.normalized());
        const auto extent = [&](const std::vector<Index>& vertices) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const Index v : vertices)
                low = std::min(low, axis.dot(rest.col(v))), high = std::max(high, axis.dot(rest.col(v)));
            return high - low;
        };
        axis_ = axis;
        constexpr double one_end = 0.4;
        if (!joined.empty() && extent(joined) <= one_end * extent(own)) anchors_ = joined;
    }
    [[nodiscard]] const std::vector<Index>& anchors() const { return anchors_; }
    [[nodiscard]] const Gauge& gauge() const { return gauge_; }

    /// Not for a tape: no stretch of the part changes the tape's length in proportion.
    [[nodiscard]] Sized sized() const {
        Sized part;
        part.vertices = {ids_.begin(), ids_.end()};
        std::sort(part.vertices.begin(), part.vertices.end());
        part.anchors = anchors_;
        part.axis = axis_;
        part.along = uniform_ ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : Eigen::Matrix3d(axis_ * axis_.transpose());
        return part;
    }

    /// Text with the end vertices of the measure and their distance from `factor` times the measure.
    [[nodiscard]] std::string where(const State& now, double factor) const {
        const std::vector<int> way = gauge_.way(now);
        const double length = gauge_.value(now), off = length * (factor - 1);
        const std::string& unit = members_->shape().annotations.unit;
        return "vertices " + std::to_string(way.front()) + " and " + std::to_string(way.back()) + " are " + digits(length, 6) +
               " apart, " + digits(std::abs(off), 3) + (unit.empty() ? "" : " ") + unit + (off > 0 ? " too near" : " too far");
    }

    /// Constrains the measure to a range, in the mesh's unit. For a tape its path is constrained and the surface follows.
    [[nodiscard]] std::unique_ptr<Constraint> to(const Interval& range, const State& edited, const State& now) const {
        if (!gauge_.is_tape()) {
            auto [ids, proportion] = placed(range, edited, now);
            return members_->make(proportion, ids);
        }
        // Ratio of the measure to the length of the edges along its path, which an exact tape shortens.
        const std::vector<int> way = gauge_.way(now);
        double length = 0;
        for (std::size_t i = 1; i < way.size(); ++i) length += (now.points.col(way[i]) - now.points.col(way[i - 1])).norm();
        const double factor = gauge_.value(now) / length;
        return members_->make(kinds::PolylineLength{{range.min / factor, range.max / factor}, true}, way);
    }

    /// Constrains the ratio to another measure, which may change as well. Neither is a tape.
    [[nodiscard]] std::unique_ptr<Constraint> against(const Gauge& other, const Interval& ratio, const State& edited,
                                                      const State& now) const {
        auto [ids, proportion] = placed(ratio, edited, now);
        std::unordered_map<int, int> places = places_;
        for (std::size_t i = places_.size(); i < ids.size(); ++i) places.emplace(ids[i], static_cast<int>(i));
        const std::vector<int> way = other.way(now);
        const int first = place(way.front(), ids, places), last = place(way.back(), ids, places);
        proportion.second = kinds::PinnedMeasure{{first, last}, other.direction()};
        return members_->make(proportion, ids);
    }

private:
    static int place(int v, std::vector<int>& ids, std::unordered_map<int, int>& places) {
        const auto [entry, fresh] = places.try_emplace(v, static_cast<int>(ids.size()));
        if (fresh) ids.push_back(v);
        return entry->second;
    }
    /// Ids of the part and its current pins, and the constraint of its measure; its shape is that of the part.
    [[nodiscard]] std::pair<std::vector<int>, kinds::Proportion> placed(const Interval& range, const State& edited,
                                                                        const State& now) const {
        std::vector<int> ids = ids_;
        std::unordered_map<int, int> places = places_;
        const std::vector<int> way = gauge_.way(now);
        const int first = place(way.front(), ids, places), last = place(way.back(), ids, places);
        kinds::Proportion proportion{range, {{first, last}, gauge_.direction()}};
        proportion.part = static_cast<int>(ids.size());
        proportion.uniform = uniform_;
        // A part that was only moved by its neighbours keeps its shape at rest.
        std::size_t asked = 0;
        for (const int v : ids_) asked += edited.asked.empty() || edited.asked[static_cast<std::size_t>(v)] ? 1 : 0;
        const Points& shape = 2 * asked >= ids_.size() ? edited.points : members_->shape().rest;
        proportion.shape.emplace(3, static_cast<Eigen::Index>(ids.size()));
        for (std::size_t i = 0; i < ids.size(); ++i) proportion.shape->col(static_cast<Eigen::Index>(i)) = shape.col(ids[i]);
        return {std::move(ids), std::move(proportion)};
    }

    MembersPtr members_;
    Gauge gauge_;
    bool uniform_;
    Vector3d axis_;  ///< direction of the measure at rest
    std::vector<Index> anchors_;
    std::vector<int> ids_;
    std::unordered_map<int, int> places_;
};

std::function<Measured(const State&)> within(const Interval& range, std::function<double(const State&)> value,
                                             std::shared_ptr<const Stretch> part) {
    return [=](const State& deformed) {
        const double now = value(deformed), out = percent_out(now, range);
        Measured result = verdict_of({{"out of range", std::isfinite(now) ? out : 1e9, 0.1, "%"}});
        result.text = std::to_string(now) + " in " + std::to_string(range.min) + " to " + std::to_string(range.max);
        if (result.verdict == Verdict::fails && now > 0)
            result.text += ": " + part->where(deformed, std::clamp(now, range.min, range.max) / now);
        return result;
    };
}

}  // namespace

Statement proportion(const MembersPtr& members, const spec::Proportion& spec, const RelationOptions&) {
    members->need(2, 2);
    const auto part = std::make_shared<const Stretch>(members, 0, Gauge(*members, spec.first, 0), spec.mode);
    const Gauge other(*members, spec.second, 1);
    const double at_rest = part->gauge().at_rest() / other.at_rest();
    const Interval range = spec.range.value_or(Interval{at_rest, at_rest});
    const bool tapes = part->gauge().is_tape() || other.is_tape();
    members->check_leader(spec.leader);
    Statement statement;
    if (!spec.range) statement.keeps = "the ratio of its measures";
    statement.anchors = part->anchors();
    statement.follows = statement.until_it_holds = statement.resizes = true;
    statement.lower = [=](const State& edited, const State& now) {
        if (const auto leader = members->leader(spec.leader, edited)) {
            Statement::Constraints list = only(members->as_edited(*leader, edited));
            const double led = (*leader == 0 ? part->gauge() : other).value(edited);
            list.push_back(*leader == 0
                               ? Stretch(members, 1, other, spec.mode).to({led / range.max, led / range.min}, edited, now)
                               : part->to({range.min * led, range.max * led}, edited, now));
            return list;
        }
        const double size = other.value(now);
        return only(tapes ? part->to({range.min * size, range.max * size}, edited, now)
                          : part->against(other, range, edited, now));
    };
    const auto ratio = [=](const State& s) { return part->gauge().value(s) / other.value(s); };
    statement.measure = within(range, ratio, part);
    if (tapes) return statement;
    if (spec.leader.any) {
        // Each part is constrained by its own measure: the leader keeps its own, and that of the other is a multiple of it.
        const auto reference = std::make_shared<const Stretch>(members, 1, other, spec.mode);
        for (const std::size_t i : {0U, 1U}) {
            const Stretch& one = i == 0 ? *part : *reference;
            const Gauge gauge = one.gauge(), partner = i == 0 ? other : part->gauge();
            statement.sized.push_back(one.sized());
            Sized& sized = statement.sized.back();
            sized.value = [=](const State& s) { return gauge.value(s); };
            const auto from = [=](double led) {
                return i == 0 ? std::pair(range.min * led, range.max * led) : std::pair(led / range.max, led / range.min);
            };
            sized.range = [=](const State& s) {
                const double own = gauge.value(s);
                return i == 0 ? from(partner.value(s)) : std::pair(own, own);
            };
            sized.led = [=](const State& edited) -> std::optional<std::pair<double, double>> {
                const auto leader = members->leader(spec.leader, edited);
                if (!leader) return {};
                return *leader == i ? std::pair(gauge.value(edited), gauge.value(edited)) : from(partner.value(edited));
            };
        }
        return statement;
    }
    statement.sized.push_back(part->sized());
    statement.sized.back().value = ratio;
    statement.sized.back().range = [=](const State&) { return std::pair(range.min, range.max); };
    return statement;
}

Statement keep_measure(const MembersPtr& members, const spec::KeepMeasure& spec, const RelationOptions&) {
    members->need(1, 1);
    const auto part = std::make_shared<const Stretch>(members, 0, Gauge(*members, spec.measure, 0), spec.mode);
    const double at_rest = part->gauge().at_rest();
    const Interval range = spec.range.value_or(Interval{at_rest, at_rest});
    Statement statement;
    if (!spec.range) statement.keeps = "its measure";
    statement.anchors = part->anchors();
    statement.follows = statement.until_it_holds = statement.resizes = true;
    statement.lower = [=](const State& edited, const State& now) { return only(part->to(range, edited, now)); };
    const auto value = [=](const State& s) { return part->gauge().value(s); };
    statement.measure = within(range, value, part);
    if (part->gauge().is_tape()) return statement;
    statement.sized.push_back(part->sized());
    statement.sized.back().extent = part->gauge().is_extent_of_part();
    statement.sized.back().value = value;
    statement.sized.back().range = [=](const State&) { return std::pair(range.min, range.max); };
    return statement;
}

Statement same_measure(const MembersPtr& members, const spec::SameMeasure& spec, const RelationOptions& tolerances) {
    members->need(2, 0);
    std::vector<std::shared_ptr<const Stretch>> parts;
    Statement statement;
    statement.follows = statement.until_it_holds = statement.resizes = true;
    for (std::size_t i = 0; i < members->count(); ++i) {
        parts.push_back(std::make_shared<const Stretch>(members, i, Gauge(*members, spec.measure, i), spec.mode));
        statement.anchors.insert(statement.anchors.end(), parts.back()->anchors().begin(), parts.back()->anchors().end());
    }
    const auto mean = [parts](const State& state) {
        double sum = 0;
        for (const auto& part : parts) sum += part->gauge().value(state);
        return sum / static_cast<double>(parts.size());
    };
    members->check_leader(spec.leader);
    statement.lower = [=](const State& edited, const State& now) {
        const auto leader = members->leader(spec.leader, edited);
        const double size = leader ? parts[*leader]->gauge().value(edited) : mean(now);
        Statement::Constraints list;
        for (std::size_t i = 0; i < parts.size(); ++i)
            list.push_back(i == leader ? members->as_edited(i, edited) : parts[i]->to({size, size}, edited, now));
        return list;
    };
    const Deviation tolerance{"difference from their mean", 0.0, tolerances.max_difference, "%"};
    statement.measure = [=](const State& deformed) {
        Deviation worst = tolerance;
        const double size = mean(deformed);
        for (const auto& part : parts)
            worst.value = std::max(*worst.value, size > 0 ? 100 * std::abs(part->gauge().value(deformed) / size - 1) : 1e9);
        return verdict_of({worst});
    };
    const bool tapes = std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part->gauge().is_tape(); });
    if (tapes) return statement;
    for (const auto& part : parts) {
        statement.sized.push_back(part->sized());
        statement.sized.back().led = [=](const State& edited) -> std::optional<std::pair<double, double>> {
            const auto leader = members->leader(spec.leader, edited);
            if (!leader) return {};
            const double size = parts[*leader]->gauge().value(edited);
            return std::pair(size, size);
        };
        statement.sized.back().value = [part](const State& s) { return part->gauge().value(s); };
        statement.sized.back().range = [mean](const State& s) { return std::pair(mean(s), mean(s)); };
    }
    return statement;
}

}  // namespace ostraka::semantic

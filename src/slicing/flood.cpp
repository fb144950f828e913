// Pools of liquid below a plane: union of the sides of the surface and the regions of the plane.
#include "slicing/flood.h"

#include "ostraka/core/progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka::detail {

namespace {

using Outline = std::vector<Eigen::Vector2d>;

double signed_area(const Outline& outline) {
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d a = outline[i] - outline[0], b = outline[(i + 1) % outline.size()] - outline[0];
        sum += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
    return sum;
}

bool contains(const Outline& outline, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
        if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
        if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
}

struct Box {
    Eigen::Vector2d low, high;
    explicit Box(const Outline& outline) : low(outline.front()), high(outline.front()) {
        for (const auto& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    [[nodiscard]] bool meets(const Box& other) const {
        return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
    }
};

/// How many of five points of `inner` lie in `outer`.
int points_inside(const Outline& inner, const Outline& outer) {
    int count = 0;
    for (std::size_t k = 0; k < 5; ++k) count += contains(outer, inner[k * inner.size() / 5]) ? 1 : 0;
    return count;
}

/// Components beyond this number are not linked: scraps of a scan inside a vessel.
constexpr std::size_t max_floating = 30;

}  // namespace

Flood::Flood(const Mesh& mesh, const SliceFrame& frame)
    : mesh_(mesh), up_(frame.normal.x(), frame.normal.y(), frame.normal.z()), places_(mesh.num_vertices()) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vertex v : mesh.vertices()) {
        const Eigen::Vector2d place = frame.place(mesh.point(v));
        places_[v] = Eigen::Vector3d(place.x(), place.y(), frame.height(mesh.point(v)));
        if (mesh.is_isolated(v)) continue;
        heights_.push_back(places_[v].z());
        low = low.cwiseMin(places_[v]), high = high.cwiseMax(places_[v]);
    }
    std::sort(heights_.begin(), heights_.end());
    heights_.erase(std::unique(heights_.begin(), heights_.end()), heights_.end());
    if (heights_.empty()) return;
    box_volume_ = (high - low).prod();
    for (auto& p : places_) p.head<2>() -= (low + high).head<2>() / 2;
    DisjointSets sets(places_.size());
    for (const Face f : mesh.faces()) {
        const auto c = ostraka::corners(mesh, f);
        corners_.push_back({c[0].idx(), c[1].idx(), c[2].idx()});
        sets.unite(c[0], c[1]), sets.unite(c[0], c[2]);
    }
    component_.resize(places_.size());
    closed_.assign(places_.size(), 1);
    std::vector<Index> top(places_.size(), no_index);
    for (const Vertex v : mesh.vertices()) {
        const Index root = component_[v] = sets.find(v);
        if (mesh.is_isolated(v)) continue;
        if (mesh.is_border(v)) closed_[root] = 0;
        if (top[root] == no_index || height(v) > height(top[root])) top[root] = v;
    }
    for (Index root = 0; root < top.size(); ++root)
        if (top[root] != no_index) tops_.push_back(top[root]);
    if (tops_.size() > max_floating) {
        std::stable_sort(tops_.begin(), tops_.end(), [&](Index a, Index b) { return height(a) > height(b); });
        tops_.resize(max_floating);
    }
}

Eigen::Vector2d Flood::crossing(Halfedge h, double level) const {
    // From the end below, so that both faces of an edge give the same point.
    Eigen::Vector3d a = places_[mesh_.source(h)], b = places_[mesh_.target(h)];
    if (a.z() > b.z()) std::swap(a, b);
    return (a + (level - a.z()) / (b.z() - a.z()) * (b - a)).head<2>();
}

Waterline Flood::at(double level) const {
    check_cancelled();
    Waterline line;
    line.level = level;
    line.piece.assign(places_.size(), no_index);
    DisjointSets joined(places_.size());
    const auto below = [&](Index v) { return places_[v].z() < level; };
    for (const auto& c : corners_)
        for (std::size_t k = 0; k < 3; ++k)
            if (const Index a = c[k], b = c[(k + 1) % 3]; below(a) && below(b)) joined.unite(a, b);
    for (Index v = 0; v < places_.size(); ++v) {
        if (!below(v) || mesh_.is_isolated(Vertex(v))) continue;
        const Index root = joined.find(v);
        line.piece[v] = root == v ? line.pieces++ : line.piece[root];
    }
    line.open.assign(line.pieces, 0);
    for (Index v = 0; v < places_.size(); ++v)
        if (line.piece[v] != no_index && closed_[component_[v]] == 0 && mesh_.is_border(Vertex(v))) line.open[line.piece[v]] = 1;
    trace_loops(line);
    return line;
}

void Flood::trace_loops(Waterline& line) const {
    const double level = line.level;
    const auto below = [&](Vertex v) { return places_[v].z() < level; };
    /// The halfedge of a face from below to above the plane, or the reverse; null if the face does not cross the plane.
    const auto rising = [&](Face f, bool up) {
        Halfedge h = mesh_.halfedge(f);
        for (int k = 0; k < 3; ++k, h = mesh_.next(h))
            if (below(mesh_.source(h)) == up && below(mesh_.target(h)) != up) return h;
        return Mesh::null_halfedge();
    };
    std::vector<Face> crossed;
    for (Index f = 0; f < corners_.size(); ++f) {
        int count = 0;
        for (const Index v : corners_[f]) count += places_[v].z() < level ? 1 : 0;
        if (count == 1 || count == 2) crossed.emplace_back(f);
    }
    std::vector<std::uint8_t> visited(corners_.size(), 0);
    const auto walk = [&](Face start, std::vector<Eigen::Vector2d>* outline) {
        for (Face f = start; f != Mesh::null_face() && visited[f] == 0;) {
            visited[f] = 1;
            if (outline != nullptr) outline->push_back(crossing(rising(f, true), level));
            f = mesh_.face(mesh_.opposite(rising(f, false)));
        }
    };
    // Contours that end at a border separate nothing, because the piece is open; their pieces are linked to a region by a point.
    std::vector<std::pair<Index, Eigen::Vector2d>> ends;
    for (const Face f : crossed) {
        const Halfedge h = rising(f, true);
        if (!mesh_.is_border(mesh_.opposite(h))) continue;
        ends.emplace_back(line.piece[mesh_.source(h)], crossing(h, level));
        walk(f, nullptr);
    }
    std::vector<Outline> outlines;
    for (const Face f : crossed) {
        if (visited[f] != 0) continue;
        Outline outline;
        walk(f, &outline);
        Waterline::Loop loop;
        loop.area = signed_area(outline);
        const Vertex foot = mesh_.source(rising(f, true));
        // Seen from above, the normals point to the left of a contour that runs from rising to falling edges.
        const Index normal_side = 2 * line.piece[foot], back = normal_side + 1;
        loop.inside = loop.area > 0 ? normal_side : back, loop.outside = loop.area > 0 ? back : normal_side;
        loop.component = component_[foot];
        loop.clay = closed_[loop.component] != 0;  // completed by nest_loops
        line.loops.push_back(loop);
        outlines.push_back(std::move(outline));
    }
    join_sides(line, std::move(outlines), ends);
}

/// Sorts and nests the loops, and joins sides and regions that touch. `ends`: pieces of open contours with a point of each.
void Flood::join_sides(Waterline& line, std::vector<Outline> outlines,
                       const std::vector<std::pair<Index, Eigen::Vector2d>>& ends) const {
    std::vector<std::size_t> order(line.loops.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(line.loops[a].area) > std::abs(line.loops[b].area); });
    std::vector<Waterline::Loop> sorted_loops;
    std::vector<Outline> sorted_outlines;
    for (const std::size_t i : order) sorted_loops.push_back(line.loops[i]), sorted_outlines.push_back(std::move(outlines[i]));
    line.loops = std::move(sorted_loops);
    nest_loops(line, sorted_outlines);
    line.sets = DisjointSets(2 * line.pieces + 1 + line.loops.size());
    for (Index p = 0; p < line.pieces; ++p)
        if (line.open[p] != 0) line.sets.unite(2 * p, 2 * p + 1);
    for (std::size_t i = 0; i < line.loops.size(); ++i) {
        line.sets.unite(line.region(i), line.loops[i].inside);
        line.sets.unite(2 * line.pieces + line.loops[i].parent, line.loops[i].outside);
    }
    for (const auto& [piece, place] : ends) line.sets.unite(2 * piece, region_at(line, sorted_outlines, place));
    link_floating(line, sorted_outlines);
}

/// The region of a point of the plane.
Index Flood::region_at(const Waterline& line, const std::vector<Outline>& outlines, const Eigen::Vector2d& place) {
    Index region = line.unbounded();
    for (std::size_t i = 0; i < outlines.size(); ++i)  // by decreasing area: the last is the smallest
        if (contains(outlines[i], place)) region = line.region(i);
    return region;
}

/// Parents and clay of loops sorted by decreasing area.
void Flood::nest_loops(Waterline& line, const std::vector<Outline>& outlines) const {
    std::vector<Box> boxes;
    for (const Outline& outline : outlines) boxes.emplace_back(outline);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        bool crosses = false;
        for (std::size_t k = i; k-- > 0 && line.loops[i].parent == 0;) {
            if (!boxes[k].meets(boxes[i])) continue;
            const int inside = points_inside(outlines[i], outlines[k]);
            crosses = crosses || (inside > 0 && inside < 5);
            if (inside > 2) line.loops[i].parent = static_cast<Index>(k) + 1;
        }
        line.crossing += crosses ? 1 : 0;
        const Index parent = line.loops[i].parent;
        if (parent > 0) line.loops[i].clay = line.loops[i].clay != line.loops[parent - 1].clay;
    }
}

/// Links the outside of components entirely below the plane with what is above them.
void Flood::link_floating(Waterline& line, const std::vector<Outline>& outlines) const {
    for (const Index top : tops_) {
        if (height(top) >= line.level) continue;
        const Eigen::Vector3d& from = places_[top];
        double best = line.level;
        Index hit = no_index;
        for (Index f = 0; f < corners_.size() && tops_.size() > 1; ++f) {
            const auto& c = corners_[f];
            if (component_[c[0]] == component_[top]) continue;
            const Eigen::Vector3d &p = places_[c[0]], &q = places_[c[1]], &r = places_[c[2]];
            if (std::max({p.z(), q.z(), r.z()}) <= from.z() || std::min({p.z(), q.z(), r.z()}) >= best) continue;
            const auto cross = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                return (a.x() - from.x()) * (b.y() - from.y()) - (a.y() - from.y()) * (b.x() - from.x());
            };
            const double u = cross(q, r), v = cross(r, p), w = cross(p, q), sum = u + v + w;
            if (sum == 0 || !((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
            const double z = (u * p.z() + v * q.z() + w * r.z()) / sum;
            if (z > from.z() && z < best) best = z, hit = sum > 0 ? 2 * f + 1 : 2 * f;  // seen from below
        }
        // The outside of the component is the side that its topmost vertex shows upwards.
        const Vector normal = vertex_normal(mesh_, Vertex(top));
        const auto n = Eigen::Vector3d(normal.x(), normal.y(), normal.z());
        const Index own = 2 * line.piece[top] + (n.dot(up_) >= 0 ? 0 : 1);
        Index above = no_index;
        if (hit != no_index)
            for (const Index v : corners_[hit / 2])
                if (line.piece[v] != no_index) above = 2 * line.piece[v] + hit % 2;
        line.sets.unite(own, above == no_index ? region_at(line, outlines, from.head<2>()) : above);
    }
}

std::optional<double> Flood::overflow(const WetPlace& place, double level) const {
    if (!at(heights_.back() + 1 + std::abs(heights_.back())).spilled(place)) return std::nullopt;
    auto low = static_cast<std::size_t>(std::upper_bound(heights_.begin(), heights_.end(), level) - heights_.begin());
    low = low > 0 ? low - 1 : 0;  // separate at this height
    std::size_t high = heights_.size();
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (at(heights_[middle]).spilled(place) ? high : low) = middle;
    }
    return heights_[low];
}

/// Calls visit(face, piece, a, b, c) for triangles that fill the part of each face below the plane; coordinates are relative to
/// a point of the plane.
template <class Visit>
void Flood::clipped_triangles(const Waterline& line, const Visit& visit) const {
    const Eigen::Vector3d shift(0, 0, line.level);
    for (Index f = 0; f < corners_.size(); ++f) {
        const auto& c = corners_[f];
        Index piece = no_index;
        std::array<Eigen::Vector3d, 4> part;
        std::size_t count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = c[k], b = c[(k + 1) % 3];
            const bool a_below = line.piece[a] != no_index, b_below = line.piece[b] != no_index;
            if (a_below) piece = line.piece[a], part[count++] = places_[a] - shift;
            if (a_below == b_below) continue;
            const Eigen::Vector3d &low = a_below ? places_[a] : places_[b], &high = a_below ? places_[b] : places_[a];
            const double t = (line.level - low.z()) / (high.z() - low.z());
            part[count] = low + t * (high - low) - shift;
            part[count++].z() = 0;
        }
        for (std::size_t k = 2; k < count; ++k) visit(f, piece, part[0], part[k - 1], part[k]);
    }
}

std::vector<double> Flood::side_volumes(const Waterline& line) const {
    std::vector<double> volumes(2 * line.pieces, 0);
    clipped_triangles(line, [&](Index, Index piece, const auto& a, const auto& b, const auto& c) {
        const double volume = a.dot(b.cross(c)) / 6;
        volumes[2 * piece] -= volume;  // a pool at the normals' side lies outside the surface
        volumes[2 * piece + 1] += volume;
    });
    return volumes;
}

PoolSize Flood::size(const Waterline& line, const std::vector<std::uint8_t>& selected) const {
    PoolSize result;
    std::vector<double> areas(places_.size(), 0);
    clipped_triangles(line, [&](Index f, Index piece, const auto& a, const auto& b, const auto& c) {
        const int sides = int(selected[2 * piece]) + int(selected[2 * piece + 1]);
        if (sides == 0) return;
        const double area = (b - a).cross(c - a).norm() / 2;
        result.wetted += sides * area;
        if (sides == 2) return;  // both sides: no volume, and noise cancels
        const double volume = a.dot(b.cross(c)) / 6;
        result.volume += selected[2 * piece] != 0 ? -volume : volume;
        for (const Index v : corners_[f]) areas[v] += area / 3;
    });
    for (const double area : areas) result.squared_areas += area * area;
    for (const Waterline::Loop& loop : line.loops) {
        if (selected[loop.inside] != 0) result.surface += std::abs(loop.area);
        if (selected[loop.outside] != 0) result.surface -= std::abs(loop.area);
    }
    for (Index v = 0; v < places_.size(); ++v) {
        const Index piece = line.piece[v];
        if (piece == no_index || (selected[2 * piece] == 0 && selected[2 * piece + 1] == 0)) continue;
        if (result.lowest == no_index || height(v) < height(result.lowest)) result.lowest = v;
        result.open = result.open || line.open[piece] != 0;
    }
    return result;
}

}  // namespace ostraka::detail

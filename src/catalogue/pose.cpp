#include "catalogue/pose.h"

#include "ostraka/slicing/slice.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

constexpr std::size_t grid_rows = 240;

/// What the surface near one end of an object looks like.
struct EndShape {
    bool base = false;      ///< the wall closes towards the axis
    double flat_share = 0;  ///< share of the area near the very end that is perpendicular to the axis
    double radius = 0;      ///< median distance from the axis near the end
};

EndShape shape_of(const Pose& pose, bool top) {
    const WallGrid& grid = pose.grid;
    const double size = grid.high() - grid.low();
    double largest = 0, nearest_of_all = std::numeric_limits<double>::infinity(), floor_near = nearest_of_all, floor_far = 0;
    double flat = 0, total = 0;
    std::vector<double> radii;
    for (const Vertex v : pose.mesh.vertices())
        if (const Point& p = pose.mesh.point(v); !pose.mesh.is_isolated(v)) largest = std::max(largest, std::hypot(p.x(), p.y()));
    for (const Face face : pose.mesh.faces()) {
        const Point p = centroid(pose.mesh, face);
        const double from_end = top ? grid.high() - p.z() : p.z() - grid.low();
        if (from_end > 0.3 * size) continue;
        const double radius = std::hypot(p.x(), p.y());
        nearest_of_all = std::min(nearest_of_all, radius);
        const Vector area = area_vector(pose.mesh, face);
        const double weight = std::sqrt(area.squared_length());
        if (weight == 0) continue;
        const bool across = std::abs(area.z()) > 0.85 * weight;
        if (across) floor_near = std::min(floor_near, radius), floor_far = std::max(floor_far, radius);
        if (from_end > 0.06 * size) continue;
        radii.push_back(radius);
        total += weight;
        if (std::abs(area.z()) > 0.985 * weight) flat += weight;
    }
    EndShape shape;
    shape.base = nearest_of_all < 0.12 * largest || (floor_near < 0.6 * floor_far && floor_far - floor_near > 0.2 * largest);
    shape.flat_share = total > 0 ? flat / total : 0;
    if (!radii.empty()) {
        std::nth_element(radii.begin(), radii.begin() + static_cast<long>(radii.size() / 2), radii.end());
        shape.radius = radii[radii.size() / 2];
    }
    return shape;
}

/// Number of successive rows from an end that are hollow.
std::size_t hollow_rows(const WallGrid& grid, bool top) {
    std::size_t count = 0;
    while (count < grid.rows() && grid.hollow(top ? grid.rows() - 1 - count : count) > 0.5) ++count;
    return count;
}

Pose placed_pose(const TriangleSoup& soup, const CatalogueAxis& axis, double factor, const Vector& up) {
    SliceFrame frame = slice_frame(axis.point, up);
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : soup.triangles)
        for (const Index i : triangle)
            lowest = std::min(lowest, frame.height(Point(soup.points[i][0], soup.points[i][1], soup.points[i][2])));
    frame.origin = frame.origin + lowest * frame.normal;
    TriangleSoup moved = placed(soup, frame.origin, {frame.u, frame.v, frame.normal}, factor);
    Mesh mesh = build_mesh(moved);
    WallGrid grid(mesh, grid_rows);
    const AngularRange range = occupied(grid);
    Pose pose{std::move(moved), std::move(mesh), std::move(grid), range, CatalogueKind::wall, {}, {}, false, {}};
    pose.top = level_end(pose.grid, true);
    pose.bottom = level_end(pose.grid, false);
    return pose;
}

bool goes_all_around(const WallGrid& grid) {
    std::size_t closed = 0;
    for (std::size_t row = 0; row < grid.rows(); ++row) closed += grid.coverage(row) > 0.9 ? 1 : 0;
    return closed >= 0.7 * double(grid.rows());
}

/// Whether the object stands upside down, and whether that is certain.
struct Turn {
    bool over = false;
    std::string doubt;
};

/// `rim_above`: whether the rim found with the axis is at the top; empty without a rim.
Turn turn_of_sherd(const Pose& pose, std::optional<bool> rim_above) {
    const EndShape top = shape_of(pose, true), bottom = shape_of(pose, false);
    if (top.base != bottom.base) return {top.base, ""};
    if (rim_above) return {!*rim_above, ""};
    if (pose.top.is_level() != pose.bottom.is_level()) return {pose.bottom.is_level(), ""};
    if (!pose.top.is_level()) return {false, "neither end of the wall is level or closes: which end is up is not known"};
    // Two level ends: a break cut straight is flat, a lip is not; else the wider end is taken for the rim.
    if (std::abs(top.flat_share - bottom.flat_share) > 0.3)
        return {top.flat_share > bottom.flat_share, "both ends of the wall are level: the rounded end is taken for the rim"};
    return {bottom.radius > top.radius, "both ends of the wall are level: the wider end is taken for the rim"};
}

void classify_whole(Pose& pose) {
    const std::size_t hollow = hollow_rows(pose.grid, true);
    if (double(hollow) < 0.2 * double(pose.grid.rows())) pose.kind = CatalogueKind::turned;
    else pose.kind = pose.top.share > 0.5 ? CatalogueKind::vessel : CatalogueKind::base;
}

}  // namespace

LevelEnd level_end(const WallGrid& grid, bool top) {
    LevelEnd end;
    end.bins.assign(WallGrid::bins, false);
    const std::vector<long> rows = grid.ends(top);
    std::vector<std::pair<double, std::size_t>> ends;  // distance from the extreme end, direction
    double reach = 0;
    for (std::size_t bin = 0; bin < WallGrid::bins; ++bin) {
        if (rows[bin] < 0) continue;
        const auto row = static_cast<std::size_t>(rows[bin]);
        const double height = grid.height(row);
        ends.emplace_back(top ? grid.high() - height : height - grid.low(), bin);
        reach = std::max(reach, grid.outer(row, bin) > 0 ? grid.outer(row, bin) : grid.inner(row, bin));
    }
    if (ends.empty()) return end;
    std::sort(ends.begin(), ends.end());
    const double window = 2 * std::max(1.5 * grid.step(), 0.01 * std::hypot(grid.high() - grid.low(), reach));
    std::size_t best = 0, best_begin = 0;  // the window with the most directions, the outermost of equal ones
    for (std::size_t begin = 0, stop = 0; begin < ends.size(); ++begin) {
        while (stop < ends.size() && ends[stop].first <= ends[begin].first + window) ++stop;
        if (stop - begin > best) best = stop - begin, best_begin = begin;
    }
    const double inward = ends[best_begin + best / 2].first;
    end.height = top ? grid.high() - inward : grid.low() + inward;
    const bool protrudes = double(best_begin) > 0.25 * double(ends.size());  // much of the wall goes beyond
    end.level = protrudes ? 0 : double(best) / double(ends.size());
    end.share = protrudes ? 0 : double(best) / double(WallGrid::bins);
    for (std::size_t k = best_begin; k < best_begin + best; ++k) end.bins[ends[k].second] = true;
    return end;
}

TriangleSoup placed(const TriangleSoup& soup, const Point& origin, const std::array<Vector, 3>& axes, double factor) {
    TriangleSoup result;
    result.triangles = soup.triangles;
    result.points.reserve(soup.points.size());
    for (const auto& [x, y, z] : soup.points) {
        const Vector p = Point(x, y, z) - origin;
        result.points.push_back({factor * (axes[0] * p), factor * (axes[1] * p), factor * (axes[2] * p)});
    }
    return result;
}

Pose pose_of(const TriangleSoup& soup, const CatalogueAxis& axis, double factor, const Vector& hint, bool hint_known) {
    const Vector up = axis.direction * hint < 0 ? -axis.direction : axis.direction;
    Pose pose = placed_pose(soup, axis, factor, up);
    pose.all_around = goes_all_around(pose.grid);
    Turn turn;
    if (hint_known) {
        // A stated direction is not doubted.
    } else if (!pose.all_around) {
        const auto rim_above = axis.rim_direction ? std::optional<bool>(*axis.rim_direction * up > 0) : std::nullopt;
        turn = turn_of_sherd(pose, rim_above);
    } else if (const std::size_t top = hollow_rows(pose.grid, true), bottom = hollow_rows(pose.grid, false); top != bottom) {
        turn.over = bottom > top;
    } else {
        turn.doubt = "both ends are alike: which end is up is not known";
    }
    if (turn.over) {
        pose = placed_pose(soup, axis, factor, -up);
        pose.all_around = goes_all_around(pose.grid);
    }
    pose.doubt = turn.doubt;
    if (pose.all_around) classify_whole(pose);
    else if (pose.top.is_level()) pose.kind = CatalogueKind::rim;
    else if (shape_of(pose, false).base) pose.kind = CatalogueKind::base;
    return pose;
}

}  // namespace ostraka::detail

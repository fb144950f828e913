#include "revolution/stages.h"

#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

void WallSection::drop_rare(const RevolutionOptions& options) {
    const double minimum = options.presence / 360 * 2 * std::max(4, options.columns / 2);
    for (std::size_t row = 0; row < image.rows; ++row)
        if (image.present[row] < std::max(1.0, minimum)) image.clear(row);
}

bool WallSection::has_rim(const RevolutionOptions& options) const {
    const double highest = *std::max_element(tops.begin(), tops.end());
    double near_count = 0, at_count = 0;
    for (const double top : tops) {
        if (top < highest - 30 * image.step) continue;
        ++near_count;
        if (top > highest - 4 * image.step) ++at_count;
    }
    return at_count > 0.8 * near_count && near_count > options.presence / 360 * static_cast<double>(tops.size());
}

namespace {

/// Max sine of the angle between a wall's normal and the plane through the axis.
constexpr double max_around = 0.6;

/// A gap at a fracture that is narrower than this share of the largest radius counts as abraded material.
constexpr double wear_gap = 0.02;

struct RayHit {
    double radius;
    bool leaving, broken;
};

/// Follows one ray from the axis outwards: records where it is inside the wall, and where it shows that there is none. Sherds
/// of a layout may overlap: the ray is inside while it is in any of them. Returns whether it hit any sherd.
bool follow(const std::vector<RayHit>& hits, detail::ProfileImage& image, std::size_t row, double max_radius) {
    int depth = 0, min_depth = 0;
    for (const RayHit& hit : hits) {
        depth += hit.leaving ? -1 : 1;
        min_depth = std::min(min_depth, depth);
    }
    depth = -min_depth;  // number of sherds around the axis
    bool has_wall = false, gap_known = false;
    double begin = 0;  // start of the current interval, wall or gap
    const auto add_wall = [&](double from, double to) {
        image.add(image.wall_share, row, from, to);
        image.add(image.informative, row, from, to);
        has_wall = true;
    };
    for (const RayHit& hit : hits) {
        const int before = depth;
        depth += hit.leaving ? -1 : 1;
        if (before == 1 && depth == 0) {
            add_wall(begin, hit.radius);
            begin = hit.radius;
            gap_known = !hit.broken;
        } else if (before == 0 && depth == 1) {
            if (has_wall && (!gap_known || hit.broken) && hit.radius - begin < wear_gap * max_radius) add_wall(begin, hit.radius);
            else if (gap_known || !hit.broken) image.add(image.informative, row, begin, hit.radius);
            begin = hit.radius;
        }
    }
    if (has_wall && depth == 0 && gap_known)
        image.add(image.informative, row, begin, static_cast<double>(image.columns) * image.step);
    return has_wall;
}

}  // namespace

WallSection wall_section(const SurfaceSearch& search, const std::vector<bool>& broken, const AxisFrame& frame, double low,
                         double high, double max_radius, const RevolutionOptions& options) {
    WallSection section;
    detail::ProfileImage& image = section.image;
    image.step = (high - low) / options.rows;
    image.rows = static_cast<std::size_t>(options.rows);
    image.columns = static_cast<std::size_t>(std::ceil(max_radius / image.step)) + 2;
    image.wall_share.assign(image.rows * image.columns, 0);
    image.informative = image.wall_share;
    image.present.assign(image.rows, 0);
    const int half = std::max(4, options.columns / 2);
    std::vector<std::vector<bool>> has_hit(image.rows, std::vector<bool>(2 * static_cast<std::size_t>(half), false));
    parallel_for(image.rows, 4, [&](std::size_t row) {
        const Vector3d origin = frame.foot + (low + (static_cast<double>(row) + 0.5) * image.step) * frame.up;
        for (int k = 0; k < half; ++k) {
            // Avoids symmetric directions, along which synthetic meshes often have edges.
            const Vector3d direction = frame.direction(pi * (k + 0.37) / half);
            const auto hits = search.line_hits(point_of(origin), vector_of(direction), 1.01 * max_radius);
            const Vector3d around = frame.up.cross(direction);
            for (const double side : {1.0, -1.0}) {
                std::vector<RayHit> ray_hits;
                for (const SurfaceHit& hit : hits) {
                    const double radius = side * hit.distance;
                    if (radius < 0) continue;
                    const Vector3d normal = eigen(search.normal(hit.face));
                    ray_hits.push_back({radius, side * normal.dot(direction) > 0,
                                        broken[hit.face] || std::abs(normal.dot(around)) > max_around});
                }
                if (!follow(ray_hits, image, row, max_radius)) continue;
                has_hit[row][static_cast<std::size_t>(side > 0 ? k : half + k)] = true;
                ++image.present[row];
            }
        }
    });
    const double min_rays = std::max(1.0, options.presence / 360 * 2 * half);
    for (std::size_t cell = 0; cell < image.wall_share.size(); ++cell)
        image.wall_share[cell] /= std::max(min_rays, image.informative[cell]);
    std::vector<double>& tops = section.tops;
    tops.assign(2 * static_cast<std::size_t>(half), -1);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t k = 0; k < tops.size(); ++k)
            if (has_hit[row][k]) tops[k] = static_cast<double>(row) * image.step;
    return section;
}

}  // namespace ostraka

#include "stages.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Vector3d;

void WallSection::drop_rare(const RevolutionOptions& options) {
    const double minimum = options.presence / 360 * 2 * std::max(4, options.columns / 2);
    for (std::size_t row = 0; row < image.rows; ++row)
        if (image.present[row] < std::max(1.0, minimum)) image.clear(row);
}

bool WallSection::has_rim(const RevolutionOptions& options) const {
    const double highest = *std::max_element(tops.begin(), tops.end());
    double near = 0, at = 0;
    for (const double top : tops) {
        if (top < highest - 30 * image.step) continue;
        ++near;
        if (top > highest - 4 * image.step) ++at;
    }
    return at > 0.8 * near && near > options.presence / 360 * static_cast<double>(tops.size());
}

WallSection wall_section(const SurfaceSearch& search, const AxisFrame& frame, double low, double high, double far,
                         const RevolutionOptions& options) {
    WallSection section;
    detail::ProfileImage& image = section.image;
    image.step = (high - low) / options.rows;
    image.rows = static_cast<std::size_t>(options.rows);
    image.columns = static_cast<std::size_t>(std::ceil(far / image.step)) + 2;
    image.wall_share.assign(image.rows * image.columns, 0);
    image.present.assign(image.rows, 0);
    const int half = std::max(4, options.columns / 2);
    std::vector<std::vector<bool>> met(image.rows, std::vector<bool>(2 * static_cast<std::size_t>(half), false));
    parallel_for(
        image.rows,
        [&](std::size_t row) {
            const Vector3d origin = frame.foot + (low + (static_cast<double>(row) + 0.5) * image.step) * frame.up;
            for (int k = 0; k < half; ++k) {
                // Not along symmetric directions, which edges of synthetic meshes like.
                const Vector3d direction = frame.direction(pi * (k + 0.37) / half);
                const auto hits = search.line_hits(point_of(origin), vector_of(direction), 1.01 * far);
                for (const double side : {1.0, -1.0}) {
                    double begin = 0;
                    bool inside = false, first = true, any = false;
                    const auto visit = [&](const SurfaceHit& hit) {
                        const double radius = side * hit.distance;
                        if (radius < 0) return;
                        const bool leaving = side * eigen(search.normal(hit.face)).dot(direction) > 0;
                        if (first && leaving) inside = true, begin = 0;
                        first = false;
                        if (leaving && inside) {
                            image.add(row, begin, radius);
                            any = true;
                            inside = false;
                        } else if (!leaving && !inside) {
                            begin = radius;
                            inside = true;
                        }
                    };
                    // Outwards from the axis on either side of it.
                    for (const SurfaceHit& hit : hits) visit(hit);
                    if (!any) continue;
                    met[row][static_cast<std::size_t>(side > 0 ? k : half + k)] = true;
                    ++image.present[row];
                }
            }
        },
        4);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t c = 0; c < image.columns; ++c)
            if (image.present[row] > 0) image.wall_share[row * image.columns + c] /= image.present[row];
    std::vector<double>& tops = section.tops;
    tops.assign(2 * static_cast<std::size_t>(half), -1);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t k = 0; k < tops.size(); ++k)
            if (met[row][k]) tops[k] = static_cast<double>(row) * image.step;
    return section;
}

}  // namespace ostraka

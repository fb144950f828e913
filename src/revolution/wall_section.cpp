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

namespace {

/// Sine of the angle between a wall's normal and the plane through the axis, at most.
constexpr double most_around = 0.6;

/// One ray from the axis outwards: where it is inside the clay, and where it tells that there is none.
class Ray {
public:
    Ray(detail::ProfileImage& image, std::size_t row) : image_(image), row_(row) {}

    void meet(double radius, bool leaving, bool broken) {
        if (first_ && leaving) inside_ = true;
        first_ = false;
        if (leaving && inside_) {
            image_.add(image_.wall_share, row_, begin_, radius);
            image_.add(image_.telling, row_, begin_, radius);
            any_ = true;
            inside_ = false;
            begin_ = radius;
            known_ = !broken;
        } else if (!leaving && !inside_) {
            if (known_ || !broken) image_.add(image_.telling, row_, begin_, radius);
            inside_ = true;
            begin_ = radius;
        }
    }
    /// Whether it met any wall.
    bool end(double far) {
        if (any_ && !inside_ && known_) image_.add(image_.telling, row_, begin_, far);
        return any_;
    }

private:
    detail::ProfileImage& image_;
    std::size_t row_;
    double begin_ = 0;  ///< of the clay it is in, or of the space it is in
    bool inside_ = false, first_ = true, any_ = false;
    bool known_ = false;  ///< the space began behind a wall's own surface
};

}  // namespace

WallSection wall_section(const SurfaceSearch& search, const std::vector<bool>& broken, const AxisFrame& frame, double low,
                         double high, double far, const RevolutionOptions& options) {
    WallSection section;
    detail::ProfileImage& image = section.image;
    image.step = (high - low) / options.rows;
    image.rows = static_cast<std::size_t>(options.rows);
    image.columns = static_cast<std::size_t>(std::ceil(far / image.step)) + 2;
    image.wall_share.assign(image.rows * image.columns, 0);
    image.telling = image.wall_share;
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
                const Vector3d around = frame.up.cross(direction);
                for (const double side : {1.0, -1.0}) {
                    Ray ray(image, row);
                    for (const SurfaceHit& hit : hits) {
                        const double radius = side * hit.distance;
                        if (radius < 0) continue;
                        const Vector3d normal = eigen(search.normal(hit.face));
                        ray.meet(radius, side * normal.dot(direction) > 0,
                                 broken[hit.face] || std::abs(normal.dot(around)) > most_around);
                    }
                    const bool any = ray.end(static_cast<double>(image.columns) * image.step);
                    if (!any) continue;
                    met[row][static_cast<std::size_t>(side > 0 ? k : half + k)] = true;
                    ++image.present[row];
                }
            }
        },
        4);
    const double least = std::max(1.0, options.presence / 360 * 2 * half);
    for (std::size_t cell = 0; cell < image.wall_share.size(); ++cell)
        image.wall_share[cell] /= std::max(least, image.telling[cell]);
    std::vector<double>& tops = section.tops;
    tops.assign(2 * static_cast<std::size_t>(half), -1);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t k = 0; k < tops.size(); ++k)
            if (met[row][k]) tops[k] = static_cast<double>(row) * image.step;
    return section;
}

}  // namespace ostraka

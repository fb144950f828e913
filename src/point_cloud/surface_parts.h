// Shared by the reconstructions of surfaces.
#pragma once

#include "ostraka/io/diagnose.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ostraka::clouds {

/// A vertex or cell of the triangulation that is ordered by its creation where the library otherwise orders by address.
template <class Base>
class Stamped : public Base {
public:
    template <class Triangulation>
    struct Rebind_TDS {
        using Other = Stamped<typename Base::template Rebind_TDS<Triangulation>::Other>;
    };
    using Base::Base;

    using Has_timestamp = CGAL::Tag_true;
    [[nodiscard]] std::size_t time_stamp() const { return time_stamp_; }
    void set_time_stamp(std::size_t stamp) { time_stamp_ = stamp; }

private:
    std::size_t time_stamp_ = static_cast<std::size_t>(-1);
};

/// The map to centre 0 and size 1, and back.
class Normalised {
public:
    explicit Normalised(const std::vector<Point>& points) : original_(points) {
        CGAL::Bbox_3 box;
        for (const Point& p : points) box += p.bbox();
        middle_ = Point((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
        size_ = std::max({box.x_span(), box.y_span(), box.z_span()});
    }
    /// The points in the normalised frame.
    [[nodiscard]] std::vector<Point> points() const {
        std::vector<Point> result;
        result.reserve(original_.size());
        for (const Point& p : original_) result.push_back(CGAL::ORIGIN + (p - middle_) / size_);
        return result;
    }
    /// A point of the normalised frame in the frame of the cloud.
    [[nodiscard]] Point back(const Point& p) const { return middle_ + size_ * (p - CGAL::ORIGIN); }
    [[nodiscard]] double size() const { return size_; }  ///< largest extent of the cloud

private:
    const std::vector<Point>& original_;
    Point middle_{0, 0, 0};
    double size_ = 1;
};

/// Sets number and length of the border loops of a surface.
inline void count_borders(const MeshDiagnosis& diagnosis, CloudSurface& surface) {
    surface.border_loops = diagnosis.border_loops.size();
    surface.border_length = 0;
    for (const BorderLoop& loop : diagnosis.border_loops) surface.border_length += loop.length;
}

}  // namespace ostraka::clouds

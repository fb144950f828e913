#include "point_cloud/cloud_builder.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::clouds {

CloudBuilder::CloudBuilder(std::string file, std::size_t file_size) : file_(std::move(file)), file_size_(file_size) {}

void CloudBuilder::begin_scan(std::size_t count, CloudContents contents) {
    check_cancelled();
    scan_ = contents;
    any_ = {any_.normals || contents.normals, any_.colours || contents.colours, any_.intensities || contents.intensities};
    const double point_bytes = static_cast<double>(sizeof(Point) + (any_.normals ? sizeof(Vector) : 0) +
                                                   (any_.colours ? sizeof(Colour) : 0) + (any_.intensities ? sizeof(double) : 0));
    const double bytes = (static_cast<double>(size()) + static_cast<double>(count)) * point_bytes;
    if (bytes > 12 * static_cast<double>(file_size_) + 192e6)
        fail_input(file_, fmt::format("claims {} points, far more than a file of {} bytes can hold", count, file_size_),
                   "the file is damaged; export it again");
    if (size() + count >= no_index) fail_input(file_, "has more than four thousand million points", "split it");
    const std::size_t total = size() + count;
    cloud_.points.reserve(total);
    if (any_.normals) cloud_.normals.reserve(total);
    if (any_.colours) cloud_.colours.reserve(total);
    if (any_.intensities) cloud_.intensities.reserve(total);
    complete_lists();
}

void CloudBuilder::complete_lists() {
    const CloudPoint nothing;
    if (any_.normals) cloud_.normals.resize(size(), nothing.normal);
    if (any_.colours) cloud_.colours.resize(size(), nothing.colour);
    if (any_.intensities) cloud_.intensities.resize(size(), nothing.intensity);
}

void CloudBuilder::add(const CloudPoint& point) {
    if (!is_place(point.place)) {
        ++unplaced_;
        return;
    }
    cloud_.points.push_back(point.place);
    if (any_.normals) cloud_.normals.push_back(unit_vector(point.normal));
    if (any_.colours) cloud_.colours.push_back(point.colour);
    if (any_.intensities) cloud_.intensities.push_back(std::isfinite(point.intensity) ? point.intensity : CloudPoint().intensity);
}

PointCloud CloudBuilder::finish() {
    complete_lists();
    if (empty_ > 0)
        note(counted(empty_, "place") + " of the file without a valid point (0 0 0, or marked as invalid) " +
             (empty_ == 1 ? "was" : "were") + " dropped");
    if (unplaced_ > 0)
        note(counted(unplaced_, "point") + " with coordinates that are not finite or beyond the supported range " +
             (unplaced_ == 1 ? "was" : "were") + " dropped");
    if (cloud_.points.empty()) {
        const bool dropped = empty_ + unplaced_ > 0;
        fail_input(file_,
                   dropped ? "has no valid point: all of its points are empty or not finite" : "has neither faces nor points",
                   "export it again");
    }
    if (std::any_of(cloud_.normals.begin(), cloud_.normals.end(), [](const Vector& n) { return n == CGAL::NULL_VECTOR; })) {
        note("some normals have no length, so that none is kept");
        cloud_.normals.clear();
    }
    const auto without = [](const auto& list, const auto& is_absent) {
        return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is_absent));
    };
    const auto no_colour = [](const Colour& colour) { return colour[3] == 0; };
    if (const std::size_t count = without(cloud_.colours, no_colour); count > 0) {
        note(counted(count, "point") + (count == 1 ? " has" : " have") + " no colour");
        if (count == size()) cloud_.colours.clear();
    }
    const auto no_intensity = [](double intensity) { return std::isnan(intensity); };
    if (const std::size_t count = without(cloud_.intensities, no_intensity); count > 0) {
        note(counted(count, "point") + (count == 1 ? " has" : " have") + " no intensity");
        if (count == size()) cloud_.intensities.clear();
    }
    return std::move(cloud_);
}

std::uint8_t cloud_channel(double value) {
    if (!(value > 0)) return 0;
    return static_cast<std::uint8_t>(std::lround(std::min(value, 255.0)));
}

}  // namespace ostraka::clouds

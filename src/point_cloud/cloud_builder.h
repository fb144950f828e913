// Collects the points of one file from its scans: memory is checked before it is taken, points without a place are dropped.
#pragma once

#include "ostraka/point_cloud/point_cloud.h"

#include <limits>
#include <string>
#include <vector>

namespace ostraka::clouds {

/// A point as a reader hands it over.
struct CloudPoint {
    Point place{0, 0, 0};
    Vector normal{0, 0, 0};                                       ///< of any length; null: none
    Colour colour{0, 0, 0, 0};                                    ///< alpha 0: none
    double intensity = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none
};

/// What the points of a scan have besides coordinates.
struct CloudContents {
    bool normals = false, colours = false, intensities = false;
};

/// The cloud of one file while it is read.
class CloudBuilder {
public:
    /// `file`: the file name for messages; `file_size`: bytes of the file, which bound the memory of the cloud.
    CloudBuilder(std::string file, std::size_t file_size);

    /// Begins a scan of at most `count` points. Throws Error (input) if they would take more memory than a file of this size may
    /// (twelve times the file and 192 MB), so that counts in a header cost nothing.
    void begin_scan(std::size_t count, CloudContents contents);
    void add(const CloudPoint& point);  ///< adds a point to the scan; a point that is not finite is dropped and counted
    void drop_empty() { ++empty_; }     ///< counts a place of the file without a measured point
    [[nodiscard]] std::size_t size() const { return cloud_.points.size(); }  ///< number of points so far
    [[nodiscard]] const std::string& file() const { return file_; }
    void note(std::string text) { cloud_.notes.push_back(std::move(text)); }  ///< adds a note about the file

    /// The cloud, with notes about everything that was dropped. Throws Error (input) if no point is left.
    PointCloud finish();

private:
    void complete_lists();

    std::string file_;
    std::size_t file_size_, empty_ = 0, unplaced_ = 0;
    CloudContents scan_, any_;
    PointCloud cloud_;
};

/// The colour channel of a value between 0 and 255; values out of range are clamped, NaN is 0.
std::uint8_t cloud_channel(double value);

}  // namespace ostraka::clouds

// The readers behind read_point_cloud, one per format.
#pragma once

#include "point_cloud/cloud_builder.h"

#include <string>
#include <string_view>
#include <vector>

namespace ostraka::clouds {

// `bytes` is the content of the whole file and may be modified; `file` is the file name for messages. Each reader throws Error
// (input) with the place, the problem and a remedy; memory is bounded by the size of the file.
PointCloud read_e57(std::string& bytes, const std::string& file);      ///< ASTM E2807
PointCloud read_las(std::string_view bytes, const std::string& file);  ///< LAS 1.0 to 1.4; LAZ is refused
PointCloud read_pcd(std::string_view bytes, const std::string& file);  ///< the format of the Point Cloud Library
PointCloud read_ptx(std::string_view bytes, const std::string& file);  ///< Leica's scans with poses
/// Lines of numbers: XYZ, ASC, CSV, TXT, and PTS with `is_pts`.
PointCloud read_text_points(std::string_view bytes, const std::string& file, bool is_pts);
/// Unpacks data of the LZF compression (liblzf) into exactly `size` bytes; false if the data are damaged.
bool unpack_lzf(std::string_view packed, std::size_t size, std::string& unpacked);

/// Lines of a text, with their numbers for messages. Blank lines are skipped.
class CloudLines {
public:
    CloudLines(std::string_view text, std::string file);
    bool next();                                                   ///< moves to the next line that is not blank; false at the end
    [[nodiscard]] std::string_view text() const { return line_; }  ///< the current line, without blanks at its ends
    [[nodiscard]] std::string place() const;                       ///< "FILE, line N"
    [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }  ///< bytes after the current line
    /// Parses the numbers of the current line, separated by blanks, tabs, commas and semicolons; false for any other content.
    bool numbers(std::vector<double>& values, bool decimal_comma = false);

private:
    std::string_view text_, line_;
    std::string file_;
    std::size_t position_ = 0, number_ = 0;
};

}  // namespace ostraka::clouds

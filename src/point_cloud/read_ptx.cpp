// PTX of Leica Cyclone: scans as grids of rows and columns, each with the matrix that places it.
#include "point_cloud/cloud_formats.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka::clouds {

namespace {

/// Rows 1 to 3: images of the axes; row 4: the translation (points are row vectors).
using PtxMatrix = std::array<Vector, 4>;

class PtxReader {
public:
    PtxReader(std::string_view bytes, const std::string& file) : lines_(bytes, file), builder_(file, bytes.size()) {}

    PointCloud read() {
        has_line_ = lines_.next();
        while (has_line_) read_scan();
        return builder_.finish();
    }

private:
    /// The numbers of the current line; moves to the next line. Throws Error unless there are `count` numbers.
    const std::vector<double>& expect(std::size_t count, const char* content) {
        if (!has_line_) fail_input(builder_.file(), fmt::format("ends where {} is expected", content), "the file is cut off");
        if (!lines_.numbers(numbers_) || numbers_.size() != count)
            fail_input(lines_.place(), fmt::format("is not {} of scan {}", content, scan_ + 1), "export the scans again as PTX");
        has_line_ = lines_.next();
        return numbers_;
    }

    double count_line(const char* content) {
        const std::string place = lines_.place();
        const double count = expect(1, content)[0];
        if (!(count >= 0 && count <= 4294967295.0) || count != std::floor(count))
            fail_input(place, fmt::format("is not {} of scan {}", content, scan_ + 1), "export the scans again as PTX");
        return count;
    }

    PtxMatrix matrix() {
        for (int line = 0; line < 4; ++line) expect(3, "a line of the scanner's position and axes");
        PtxMatrix rows{};
        for (std::size_t k = 0; k < 4; ++k) {
            const std::string place = lines_.place();
            const auto& row = expect(4, "a line of the matrix");
            if (!std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); }) || row[3] != (k < 3 ? 0 : 1))
                fail_input(place, "is no row of a matrix that places a scan: its last column must be 0 0 0 1",
                           "export the scans again as PTX");
            rows[k] = Vector(row[0], row[1], row[2]);
        }
        return rows;
    }

    void read_scan() {
        const double columns = count_line("the number of columns"), rows = count_line("the number of rows");
        const PtxMatrix placing = matrix();
        const double stated = columns * rows;
        std::size_t count = 0, width = 0;
        for (; has_line_ && static_cast<double>(count) < stated; ++count) {
            check_();
            if (!lines_.numbers(numbers_))
                fail_input(lines_.place(), "is not a list of numbers", "give x y z intensity, or x y z intensity red green blue");
            if (numbers_.size() == 1 && count > 0) break;  // the next scan
            if (count == 0) width = begin(std::min(stated, static_cast<double>(lines_.remaining()) / 6 + 1));
            if (numbers_.size() != width)
                fail_input(lines_.place(), fmt::format("has {} numbers, the first point of the scan {}", numbers_.size(), width),
                           "the file may be cut off; export the scans again as PTX");
            add(placing);
            has_line_ = lines_.next();
        }
        ++scan_;
        if (static_cast<double>(count) < stated)
            builder_.note(fmt::format("scan {} states {:.0f} x {:.0f} points and has {}", scan_, columns, rows, count));
    }

    /// Begins the points of a scan by its first line; returns the number of columns.
    std::size_t begin(double most) {
        const std::size_t width = numbers_.size();
        if (width != 3 && width != 4 && width != 6 && width != 7)
            fail_input(lines_.place(), fmt::format("has {} numbers", width),
                       "give x y z, x y z intensity, x y z red green blue, or x y z intensity red green blue");
        builder_.begin_scan(static_cast<std::size_t>(most), {false, width >= 6, width == 4 || width == 7});
        return width;
    }

    void add(const PtxMatrix& placing) {
        const double x = numbers_[0], y = numbers_[1], z = numbers_[2];
        if (x == 0 && y == 0 && z == 0) {
            builder_.drop_empty();
            return;
        }
        CloudPoint point;
        point.place = CGAL::ORIGIN + (x * placing[0] + y * placing[1] + z * placing[2] + placing[3]);
        const std::size_t width = numbers_.size();
        if (width == 4 || width == 7) point.intensity = numbers_[3];
        if (width >= 6) {
            for (std::size_t k = 0; k < 3; ++k) point.colour[k] = cloud_channel(numbers_[width - 3 + k]);
            point.colour[3] = 255;
        }
        builder_.add(point);
    }

    CloudLines lines_;
    CloudBuilder builder_;
    std::vector<double> numbers_;
    std::size_t scan_ = 0;
    bool has_line_ = false;
    CancelCheck check_;
};

}  // namespace

PointCloud read_ptx(std::string_view bytes, const std::string& file) {
    if (bytes.find('\0') != std::string_view::npos)
        fail_input(file, "is not text: it has bytes of zero", "export it again as PTX");
    return PtxReader(bytes, file).read();
}

}  // namespace ostraka::clouds

// LAS 1.0 to 1.4, point formats 0 to 10 (ASPRS, LAS Specification 1.4 R15).
#include "point_cloud/cloud_formats.h"
#include "point_cloud/little_endian.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka::clouds {

namespace {

/// The public header block, as far as points need it.
struct LasHeader {
    unsigned minor = 0, format = 0;
    std::size_t data = 0, record = 0, count = 0;
    std::array<double, 3> scale{}, offset{};
};

/// Smallest record of each point format, and the place of its colours (0: none).
struct LasFormat {
    std::size_t record, colours;
};
constexpr std::array<LasFormat, 11> las_formats{
    {{20, 0}, {28, 0}, {26, 20}, {34, 28}, {57, 0}, {63, 28}, {30, 0}, {36, 30}, {38, 30}, {59, 0}, {67, 30}}};

[[noreturn]] void refuse_laz(const std::string& file) {
    fail_input(file, "is LAZ, that is compressed LAS, which is not read",
               fmt::format("unpack it, for example: laszip -i {0} -o NAME.las, or: pdal translate {0} NAME.las", file));
}

LasHeader las_header(std::string_view bytes, const std::string& file) {
    constexpr std::size_t smallest_header = 227, header_of_1_4 = 375;
    if (bytes.size() < smallest_header) fail_input(file, "ends inside the header of LAS", "the file is cut off");
    const char* data = bytes.data();
    LasHeader header;
    const unsigned major = static_cast<unsigned char>(data[24]);
    header.minor = static_cast<unsigned char>(data[25]);
    if (major != 1 || header.minor > 4)
        fail_input(file, fmt::format("is LAS {}.{}", major, header.minor), "versions 1.0 to 1.4 are read");
    const auto format = static_cast<unsigned char>(data[104]);
    if ((format & 0xC0U) != 0) refuse_laz(file);
    if (format >= las_formats.size())
        fail_input(file, fmt::format("has point format {}", format), "point formats 0 to 10 are read");
    header.format = format;
    header.data = little_endian<std::uint32_t>(data + 96);
    header.record = little_endian<std::uint16_t>(data + 105);
    std::uint64_t count = little_endian<std::uint32_t>(data + 107);
    if (header.minor == 4) {
        if (bytes.size() < header_of_1_4) fail_input(file, "ends inside the header of LAS", "the file is cut off");
        if (const auto wide = little_endian<std::uint64_t>(data + 247); wide > 0) count = wide;
    }
    if (header.record < las_formats[format].record)
        fail_input(file,
                   fmt::format("has records of {} bytes, but point format {} needs {}", header.record, format,
                               las_formats[format].record),
                   "the header is damaged; export it again");
    if (header.data < smallest_header || header.data > bytes.size())
        fail_input(file, fmt::format("its points are said to begin at byte {} of {}", header.data, bytes.size()),
                   "the file is cut off or its header is damaged");
    const std::size_t available = (bytes.size() - header.data) / header.record;
    if (count > available)
        fail_input(file, fmt::format("promises {} points, but holds only {}", count, available), "the file is cut off");
    header.count = static_cast<std::size_t>(count);
    for (std::size_t k = 0; k < 3; ++k) {
        header.scale[k] = little_endian<double>(data + 131 + 8 * k);
        header.offset[k] = little_endian<double>(data + 155 + 8 * k);
        if (!std::isfinite(header.scale[k]) || !std::isfinite(header.offset[k]) || header.scale[k] == 0)
            fail_input(file, "has a scale or offset of coordinates that is zero or not finite", "export it again");
    }
    return header;
}

/// Which values the points of the file really have: writers fill unused fields with zeros.
struct LasContents {
    bool colours = false, wide_colours = false, intensities = false;
    std::size_t withheld = 0;
};

LasContents las_contents(const char* records, const LasHeader& header) {
    LasContents contents;
    const std::size_t colours = las_formats[header.format].colours;
    CancelCheck check;
    for (std::size_t i = 0; i < header.count; ++i) {
        check();
        const char* record = records + i * header.record;
        if (little_endian<std::uint16_t>(record + 12) != 0) contents.intensities = true;
        const auto flags = static_cast<unsigned char>(record[15]);
        if ((flags & (header.format < 6 ? 0x80U : 0x04U)) != 0) ++contents.withheld;
        if (colours == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto value = little_endian<std::uint16_t>(record + colours + 2 * k);
            contents.colours = contents.colours || value > 0;
            contents.wide_colours = contents.wide_colours || value > 255;
        }
    }
    return contents;
}

}  // namespace

PointCloud read_las(std::string_view bytes, const std::string& file) {
    const LasHeader header = las_header(bytes, file);
    CloudBuilder builder(file, bytes.size());
    const char* records = bytes.data() + header.data;
    const LasContents contents = las_contents(records, header);
    builder.begin_scan(header.count, {false, contents.colours, contents.intensities});
    const std::size_t colours = las_formats[header.format].colours;
    CancelCheck check;
    for (std::size_t i = 0; i < header.count; ++i) {
        check();
        const char* record = records + i * header.record;
        CloudPoint point;
        const auto coordinate = [&](std::size_t k) {
            return little_endian<std::int32_t>(record + 4 * k) * header.scale[k] + header.offset[k];
        };
        point.place = Point(coordinate(0), coordinate(1), coordinate(2));
        if (contents.intensities) point.intensity = little_endian<std::uint16_t>(record + 12);
        if (contents.colours) {
            for (std::size_t k = 0; k < 3; ++k) {
                const unsigned value = little_endian<std::uint16_t>(record + colours + 2 * k);
                point.colour[k] = static_cast<std::uint8_t>(contents.wide_colours ? value >> 8U : value);
            }
            point.colour[3] = 255;
        }
        builder.add(point);
    }
    if (colours != 0 && !contents.colours) builder.note("all colours are 0, that is, the points have none");
    if (contents.withheld > 0)
        builder.note(counted(contents.withheld, "point") + " marked as withheld " + (contents.withheld == 1 ? "is" : "are") +
                     " kept");
    builder.note("classes, returns, times and further values of the points are not kept");
    return builder.finish();
}

}  // namespace ostraka::clouds

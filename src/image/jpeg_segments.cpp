#include "image/jpeg_segments.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::images {

namespace {

constexpr int end_of_image = 0xD9, start_of_scan = 0xDA;

/// Markers without a segment: TEM and the restart markers.
bool stands_alone(int marker) { return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8); }
/// Frame headers: SOF0 to SOF15 without DHT, JPG and DAC.
bool is_frame(int marker) { return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC; }

std::uint8_t jpeg_byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

}  // namespace

double JpegFrame::blocks(const JpegComponent& component) const {
    int horizontal = 1, vertical = 1;
    for (const JpegComponent& other : components) {
        horizontal = std::max<int>(horizontal, other.horizontal);
        vertical = std::max<int>(vertical, other.vertical);
    }
    const auto along = [](int samples, int factor, int max_factor) {
        return std::ceil(std::ceil(double(samples) * factor / max_factor) / 8);
    };
    return along(width, component.horizontal, horizontal) * along(height, component.vertical, vertical);
}

/// Moves to the next marker with a segment. Bytes between segments are skipped, as decoders do.
bool JpegSegments::next_segment() {
    for (;;) {
        position_ = bytes_.find('\xff', position_);
        if (position_ == std::string_view::npos) break;
        while (position_ < bytes_.size() && bytes_[position_] == '\xff') ++position_;
        if (position_ == bytes_.size()) break;
        marker_ = jpeg_byte(bytes_, position_++);
        if (marker_ == 0 || stands_alone(marker_)) continue;
        if (marker_ == end_of_image || bytes_.size() - position_ < 2) break;
        const std::size_t length = big_endian(bytes_, position_, 2);
        if (length < 2) refuse_damaged(place_, "a segment of the JPEG has no length");
        segment_ = bytes_.substr(position_ + 2, length - 2);
        if (segment_.size() < length - 2) break;
        position_ += length;
        return true;
    }
    position_ = bytes_.size();
    return false;
}

void JpegSegments::parse_frame() {
    static constexpr int readable[] = {0xC0, 0xC1, 0xC2, 0xC9, 0xCA};
    if (std::find(std::begin(readable), std::end(readable), marker_) == std::end(readable))
        refuse(place_, "is a lossless or hierarchical JPEG, which is not read",
               "convert it to PNG, for example with GDAL or DCMTK");
    if (segment_.size() < 6) refuse_damaged(place_, "the frame header of the JPEG is too short");
    frame_ = {marker_,
              jpeg_byte(segment_, 0),
              static_cast<int>(big_endian(segment_, 3, 2)),
              static_cast<int>(big_endian(segment_, 1, 2)),
              {}};
    if (frame_.precision != 8)
        refuse(place_, fmt::format("is a JPEG with {} bits a channel, which is not read", frame_.precision),
               "convert it to PNG, for example with GDAL or DCMTK");
    const std::size_t count = jpeg_byte(segment_, 5);
    if (count != 1 && count != 3 && count != 4)
        refuse(place_, fmt::format("is a JPEG with {} channels", count), "save it as PNG");
    if (segment_.size() < 6 + 3 * count) refuse_damaged(place_, "the frame header of the JPEG is too short");
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint8_t sampling = jpeg_byte(segment_, 7 + 3 * k);
        const JpegComponent component{jpeg_byte(segment_, 6 + 3 * k), static_cast<std::uint8_t>(sampling >> 4U),
                                      static_cast<std::uint8_t>(sampling & 15U)};
        if (component.horizontal < 1 || component.horizontal > 4 || component.vertical < 1 || component.vertical > 4)
            refuse_damaged(place_, "a sampling factor of the JPEG is not 1 to 4");
        frame_.components.push_back(component);
    }
}

JpegFrame JpegSegments::frame() {
    while (next_segment()) {
        if (marker_ == start_of_scan) refuse_damaged(place_, "the JPEG has no frame header");
        if (!is_frame(marker_)) continue;
        parse_frame();
        return frame_;
    }
    refuse_damaged(place_, "the file ends before the size of the JPEG");
}

std::optional<JpegScan> JpegSegments::next_scan() {
    while (next_segment()) {
        if (marker_ != start_of_scan) continue;
        const std::size_t count = segment_.empty() ? 0 : jpeg_byte(segment_, 0);
        if (count < 1 || count > 4 || segment_.size() < 4 + 2 * count) refuse_damaged(place_, "a scan of the JPEG has no header");
        JpegScan scan;
        for (std::size_t k = 0; k < count; ++k) scan.components.push_back(jpeg_byte(segment_, 1 + 2 * k));
        scan.has_first_bits = segment_[1 + 2 * count] == 0 && (jpeg_byte(segment_, 3 + 2 * count) & 0xF0U) == 0;
        // The data end at the first marker but stuffed zeros and restarts.
        std::size_t end = position_;
        for (;;) {
            end = std::min(bytes_.find('\xff', end), bytes_.size());
            if (end + 1 >= bytes_.size()) break;
            const std::uint8_t following = jpeg_byte(bytes_, end + 1);
            if (following != 0 && (following < 0xD0 || following > 0xD7)) break;
            end += 2;
        }
        scan.bytes = end - position_;
        position_ = end;
        return scan;
    }
    return std::nullopt;
}

Header jpeg_header(std::string_view bytes, const Place& place) {
    const JpegFrame frame = JpegSegments(bytes, place).frame();
    return {ImageFormat::jpeg, frame.width, frame.height};
}

}  // namespace ostraka::images

// The structure of a JPEG file (ITU-T T.81, annex B): its frame and its scans, without decoding.
#pragma once

#include "image/header.h"

#include <vector>

namespace ostraka::images {

/// A component of the frame: its number and its sampling factors.
struct JpegComponent {
    std::uint8_t number = 0, horizontal = 1, vertical = 1;
};

struct JpegFrame {
    int marker = 0;  ///< second byte of the SOF marker; 0: no frame was found
    int precision = 8, width = 0, height = 0;
    std::vector<JpegComponent> components;  ///< at most 4
    /// Blocks of 8 x 8 samples of a component, without padding.
    [[nodiscard]] double blocks(const JpegComponent& component) const;
    [[nodiscard]] bool progressive() const { return marker == 0xC2 || marker == 0xCA; }
    [[nodiscard]] bool arithmetic() const { return marker >= 0xC9; }
};

/// A scan that begins with the first coefficients of its blocks.
struct JpegScan {
    std::vector<std::uint8_t> components;  ///< their numbers
    bool has_first_bits = false;           ///< true: the scan has the first bits of the first coefficients
    std::size_t bytes = 0;                 ///< entropy-coded data
};

/// Walks through the segments of a JPEG file.
class JpegSegments {
public:
    JpegSegments(std::string_view bytes, const Place& place) : bytes_(bytes), place_(place) {}

    /// Reads up to the frame header. Throws Error (input) if there is none, or if it is damaged or of a kind that is not read.
    JpegFrame frame();
    /// The first scan after the frame or after the previous scan; nullopt at the end of the file.
    std::optional<JpegScan> next_scan();

private:
    bool next_segment();
    void parse_frame();

    std::string_view bytes_, segment_;
    Place place_;
    std::size_t position_ = 2;  ///< behind the start of the image
    int marker_ = 0;
    JpegFrame frame_;
};

}  // namespace ostraka::images

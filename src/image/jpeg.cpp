// JPEG (ITU-T T.81) with libjpeg-turbo. Errors of the library leave its functions by longjmp: the functions that call the library
// run in `guarded`, and have no objects with destructors.
#include "image/codecs.h"
#include "image/jpeg_segments.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <jpeglib.h>  // after cstdio

#include <jerror.h>

namespace ostraka::images {

namespace {

/// Files of the field have about 10 scans; each scan of a bomb takes time for all pixels.
constexpr int max_scans = 100;

struct JpegErrors {
    jpeg_error_mgr manager{};
    std::jmp_buf failed{};
    std::array<char, JMSG_LENGTH_MAX> message{};
    bool file_ended = false;  ///< the library asked for bytes behind the end of the file
    bool data_ended = false;  ///< ... and missed data of pixels there
};

JpegErrors& errors_of(j_common_ptr codec) { return *static_cast<JpegErrors*>(codec->client_data); }

/// Runs a step; false if the library reported an error.
template <class Step>
bool guarded(JpegErrors& errors, const Step& step) {
    if (setjmp(errors.failed) != 0) return false;
    step();
    return true;
}

void jpeg_failed(j_common_ptr codec) {
    JpegErrors& errors = errors_of(codec);
    codec->err->format_message(codec, errors.message.data());
    std::longjmp(errors.failed, 1);
}

/// Warnings are silent, but data that are missing at the end of the file are noted.
void jpeg_message(j_common_ptr codec, int level) {
    JpegErrors& errors = errors_of(codec);
    if (level < 0 && codec->err->msg_code == JWRN_HIT_MARKER && errors.file_ended) errors.data_ended = true;
}

void jpeg_no_output(j_common_ptr /*codec*/) {}

void set_errors(JpegErrors& errors) {
    jpeg_std_error(&errors.manager);
    errors.manager.error_exit = jpeg_failed;
    errors.manager.emit_message = jpeg_message;
    errors.manager.output_message = jpeg_no_output;
}

struct JpegReader {
    JpegReader() {
        set_errors(errors);
        codec.err = &errors.manager;
        codec.client_data = &errors;
    }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
    ~JpegReader() { jpeg_destroy_decompress(&codec); }

    JpegErrors errors;
    jpeg_decompress_struct codec{};
    jpeg_source_mgr source{};
    jpeg_progress_mgr progress{};
};

void source_nothing(j_decompress_ptr /*codec*/) {}

/// Behind the end of the file, decoders find an end of the image, so that files without one are read.
boolean source_end(j_decompress_ptr codec) {
    static constexpr JOCTET end[] = {0xFF, JPEG_EOI};
    errors_of(reinterpret_cast<j_common_ptr>(codec)).file_ended = true;
    codec->src->next_input_byte = end;
    codec->src->bytes_in_buffer = sizeof end;
    return TRUE;
}

void source_skip(j_decompress_ptr codec, long count) {
    if (count <= 0) return;
    const auto step = std::min(static_cast<std::size_t>(count), codec->src->bytes_in_buffer);
    codec->src->next_input_byte += step;
    codec->src->bytes_in_buffer -= step;
}

void count_scans(j_common_ptr codec) {
    auto* reader = reinterpret_cast<j_decompress_ptr>(codec);
    if (reader->input_scan_number <= max_scans) return;
    JpegErrors& errors = errors_of(codec);
    std::snprintf(errors.message.data(), errors.message.size(), "it has more than %d scans", max_scans);
    std::longjmp(errors.failed, 1);
}

void start_jpeg(JpegReader& reader, std::string_view bytes) {
    auto& codec = reader.codec;
    jpeg_create_decompress(&codec);
    reader.source.next_input_byte = reinterpret_cast<const JOCTET*>(bytes.data());
    reader.source.bytes_in_buffer = bytes.size();
    reader.source.init_source = source_nothing;
    reader.source.fill_input_buffer = source_end;
    reader.source.skip_input_data = source_skip;
    reader.source.resync_to_restart = jpeg_resync_to_restart;
    reader.source.term_source = source_nothing;
    codec.src = &reader.source;
    reader.progress.progress_monitor = count_scans;
    codec.progress = &reader.progress;
    jpeg_read_header(&codec, TRUE);
    const bool inks = codec.jpeg_color_space == JCS_CMYK || codec.jpeg_color_space == JCS_YCCK;
    codec.out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
    codec.dct_method = JDCT_ISLOW;
    jpeg_calc_output_dimensions(&codec);
}

/// Inks as colours. Adobe's programs store inks inverted: 255 is no ink (as all readers take it, though no standard says so).
void convert_inks(Pixels& pixels, bool inverted) {
    for (auto& pixel : pixels.rgba) {
        if (!inverted)
            for (auto& ink : pixel) ink = static_cast<std::uint8_t>(255 - ink);
        for (std::size_t k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>((pixel[k] * pixel[3] + 127) / 255);
        pixel[3] = 255;
    }
}

/// Checks that the first scans have at least one bit for each block, and the memory for the coefficients of files with several
/// scans. Files in arithmetic coding may have less than one bit for a block.
void check_jpeg_data(std::string_view bytes, const Header& header, const Place& place) {
    JpegSegments segments(bytes, place);
    const JpegFrame frame = segments.frame();
    double coefficient_bytes = 0;
    bool several_scans = frame.progressive();
    while (const auto scan = segments.next_scan()) {
        several_scans = several_scans || scan->components.size() < frame.components.size();
        if (!scan->has_first_bits || frame.arithmetic()) continue;
        double blocks = 0;
        for (const JpegComponent& component : frame.components)
            if (std::find(scan->components.begin(), scan->components.end(), component.number) != scan->components.end())
                blocks += frame.blocks(component);
        if (blocks > 8 * static_cast<double>(scan->bytes))
            refuse_damaged(place, fmt::format("the file has too little data for {} x {} pixels", header.width, header.height));
    }
    if (several_scans)
        for (const JpegComponent& component : frame.components) coefficient_bytes += 128 * frame.blocks(component);
    require_proportion(header, bytes.size(), coefficient_bytes, place);
}

}  // namespace

Pixels decode_jpeg(std::string_view bytes, const Header& header, const Place& place) {
    check_jpeg_data(bytes, header, place);
    JpegReader reader;
    const auto refuse_jpeg = [&] { refuse_damaged(place, reader.errors.message.data()); };
    if (!guarded(reader.errors, [&] { start_jpeg(reader, bytes); })) refuse_jpeg();
    if (reader.codec.output_width != static_cast<JDIMENSION>(header.width) ||
        reader.codec.output_height != static_cast<JDIMENSION>(header.height) || reader.codec.out_color_components != 4)
        refuse_damaged(place, "the JPEG has several frame headers");
    const bool inks = reader.codec.out_color_space == JCS_CMYK, inverted = reader.codec.saw_Adobe_marker != 0;
    Pixels pixels = blank_pixels(header.width, header.height);
    const bool done = guarded(reader.errors, [&] {
        auto& codec = reader.codec;
        jpeg_start_decompress(&codec);
        while (codec.output_scanline < codec.output_height) {
            const std::size_t first = static_cast<std::size_t>(codec.output_scanline) * codec.output_width;
            JSAMPROW row = pixels.rgba[first].data();
            if (jpeg_read_scanlines(&codec, &row, 1) != 1) return;
        }
    });
    if (!done) refuse_jpeg();
    // Without an end of the image, a file with several scans may lack some of them.
    const bool lacks_scans = reader.errors.file_ended && jpeg_has_multiple_scans(&reader.codec) != 0;
    if (reader.errors.data_ended || lacks_scans || reader.codec.output_scanline < reader.codec.output_height)
        refuse_damaged(place, "the file ends before its pixels do");
    if (inks) convert_inks(pixels, inverted);
    return pixels;
}

namespace {

struct JpegWriter {
    JpegWriter() {
        set_errors(errors);
        codec.err = &errors.manager;
        codec.client_data = &errors;
    }
    JpegWriter(const JpegWriter&) = delete;
    JpegWriter& operator=(const JpegWriter&) = delete;
    ~JpegWriter() {
        jpeg_destroy_compress(&codec);
        std::free(bytes);  // NOLINT: allocated by the library
    }

    JpegErrors errors;
    jpeg_compress_struct codec{};
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
};

void write_jpeg(JpegWriter& writer, const Pixels& pixels, int quality) {
    auto& codec = writer.codec;
    jpeg_create_compress(&codec);
    jpeg_mem_dest(&codec, &writer.bytes, &writer.size);
    codec.image_width = static_cast<JDIMENSION>(pixels.width);
    codec.image_height = static_cast<JDIMENSION>(pixels.height);
    codec.input_components = 4;
    codec.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&codec);
    jpeg_set_quality(&codec, quality, TRUE);
    codec.optimize_coding = TRUE;
    codec.dct_method = JDCT_ISLOW;
    if (quality >= 90) codec.comp_info[0].h_samp_factor = codec.comp_info[0].v_samp_factor = 1;  // colours at full resolution
    jpeg_start_compress(&codec, TRUE);
    while (codec.next_scanline < codec.image_height) {
        const std::size_t first = static_cast<std::size_t>(codec.next_scanline) * codec.image_width;
        auto* row = const_cast<JSAMPROW>(pixels.rgba[first].data());  // NOLINT: the library does not write to it
        jpeg_write_scanlines(&codec, &row, 1);
    }
    jpeg_finish_compress(&codec);
}

}  // namespace

std::string encode_jpeg(const Pixels& pixels, int quality) {
    JpegWriter writer;
    if (!guarded(writer.errors, [&] { write_jpeg(writer, pixels, quality); }))
        fail_work("", fmt::format("an image could not be written as JPEG: {}", writer.errors.message.data()));
    return {reinterpret_cast<const char*>(writer.bytes), writer.size};
}

}  // namespace ostraka::images

// GIF (CompuServe, version 89a): the first picture, with giflib.
#include "image/codecs.h"

#include <fmt/core.h>
#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace ostraka::images {

namespace {

struct GifBytes {
    std::string_view bytes;
    std::size_t position = 0;
};

int gif_take(GifFileType* file, GifByteType* target, int length) {
    auto& source = *static_cast<GifBytes*>(file->UserData);
    const std::size_t count = std::min(static_cast<std::size_t>(std::max(length, 0)), source.bytes.size() - source.position);
    std::memcpy(target, source.bytes.data() + source.position, count);
    source.position += count;
    return static_cast<int>(count);
}

struct CloseGif {
    void operator()(GifFileType* file) const { DGifCloseFile(file, nullptr); }
};
using GifFile = std::unique_ptr<GifFileType, CloseGif>;

[[noreturn]] void refuse_gif(const Place& place, int error) {
    const char* text = GifErrorString(error);
    const bool cut = error == D_GIF_ERR_EOF_TOO_SOON || error == D_GIF_ERR_READ_FAILED;
    refuse_damaged(place, cut               ? "the file ends before its pixels do"
                          : text != nullptr ? text
                                            : "its data are not those of a GIF");
}

/// Reads up to the first picture; returns its transparent colour, or -1.
int find_picture(GifFileType& file, const Place& place) {
    int transparent = NO_TRANSPARENT_COLOR;
    for (;;) {
        GifRecordType kind = UNDEFINED_RECORD_TYPE;
        if (DGifGetRecordType(&file, &kind) == GIF_ERROR) refuse_gif(place, file.Error);
        if (kind == TERMINATE_RECORD_TYPE) refuse_damaged(place, "the GIF has no picture");
        if (kind == IMAGE_DESC_RECORD_TYPE) return transparent;
        if (kind != EXTENSION_RECORD_TYPE) continue;
        int code = 0;
        GifByteType* block = nullptr;
        if (DGifGetExtension(&file, &code, &block) == GIF_ERROR) refuse_gif(place, file.Error);
        while (block != nullptr) {
            GraphicsControlBlock control{};
            if (code == GRAPHICS_EXT_FUNC_CODE && DGifExtensionToGCB(block[0], block + 1, &control) == GIF_OK)
                transparent = control.TransparentColor;
            if (DGifGetExtensionNext(&file, &block) == GIF_ERROR) refuse_gif(place, file.Error);
        }
    }
}

/// Row of the picture that line number `line` of an interlaced file has: every eighth row, then those between.
int interlaced_row(int line, int height) {
    static constexpr int starts[] = {0, 4, 2, 1}, steps[] = {8, 8, 4, 2};
    for (int pass = 0; pass < 4; ++pass) {
        const int rows = (height - starts[pass] + steps[pass] - 1) / steps[pass];
        if (line < rows) return starts[pass] + line * steps[pass];
        line -= std::max(rows, 0);
    }
    return height - 1;
}

}  // namespace

Pixels decode_gif(std::string_view bytes, const Header& header, const Place& place) {
    require_proportion(header, bytes.size(), 0, place);
    GifBytes source{bytes};
    int error = 0;
    const GifFile file(DGifOpen(&source, gif_take, &error));
    if (!file) refuse_gif(place, error);
    const int transparent = find_picture(*file, place);
    if (DGifGetImageDesc(file.get()) == GIF_ERROR) refuse_gif(place, file->Error);
    const GifImageDesc picture = file->Image;
    if (picture.Left < 0 || picture.Top < 0 || picture.Width < 1 || picture.Height < 1 ||
        picture.Width > header.width - picture.Left || picture.Height > header.height - picture.Top)
        refuse_damaged(place, "the first picture of the GIF leaves the screen of the GIF");
    const ColorMapObject* colours = picture.ColorMap != nullptr ? picture.ColorMap : file->SColorMap;
    if (colours == nullptr) refuse_damaged(place, "the GIF has no table of colours");
    Pixels pixels = blank_pixels(header.width, header.height);
    std::vector<GifPixelType> line(static_cast<std::size_t>(picture.Width));
    for (int i = 0; i < picture.Height; ++i) {
        if (DGifGetLine(file.get(), line.data(), picture.Width) == GIF_ERROR) refuse_gif(place, file->Error);
        const int row = picture.Top + (picture.Interlace ? interlaced_row(i, picture.Height) : i);
        auto* target = pixels.rgba.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(header.width) + picture.Left;
        for (const GifPixelType index : line) {
            if (index >= colours->ColorCount) refuse_damaged(place, "a pixel of the GIF has a colour that is not in its table");
            const GifColorType& colour = colours->Colors[index];
            if (index != transparent) *target = {colour.Red, colour.Green, colour.Blue, 255};
            ++target;
        }
    }
    return pixels;
}

}  // namespace ostraka::images

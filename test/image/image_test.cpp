// Headers, limits, messages, encoding.
#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/image/image.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace ostraka {
namespace {

using test::painted;
using Rgba = std::array<std::uint8_t, 4>;

std::string big_endian_text(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 255U);
    return text;
}

/// A PNG with another size in its header, whose checksum is right.
std::string png_with_size(std::string bytes, std::uint32_t width, std::uint32_t height) {
    bytes.replace(16, 8, big_endian_text(width) + big_endian_text(height));
    const auto* chunk = reinterpret_cast<const Bytef*>(bytes.data() + 12);
    return bytes.replace(29, 4, big_endian_text(static_cast<std::uint32_t>(::crc32(0, chunk, 17))));
}

/// A JPEG with another size in its frame header.
std::string jpeg_with_size(std::string bytes, int width, int height) {
    std::size_t frame = bytes.find("\xff\xc0");
    if (frame == std::string::npos) frame = bytes.find("\xff\xc2");
    for (const auto& [at, side] : {std::pair(frame + 5, height), std::pair(frame + 7, width)}) {
        bytes[at] = static_cast<char>(side >> 8);
        bytes[at + 1] = static_cast<char>(side & 255);
    }
    return bytes;
}

std::string refusal(const std::string& bytes, bool decoding = false) {
    try {
        const Image image = parse_image(bytes, "stain.png", "pot.glb");
        if (decoding) decode(image, "pot.glb");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        EXPECT_EQ(error.where(), "pot.glb");
        EXPECT_FALSE(error.remedy().empty()) << error.what();
        EXPECT_NE(error.problem().find("'stain.png'"), std::string::npos) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Image, HeadersOfAllFormats) {
    const Pixels pixels = test::gradient(37, 21);
    for (const auto format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::webp}) {
        const Image image = parse_image(encode(pixels, format, {}).bytes, "wrong.gif", "test");
        EXPECT_EQ(image.format, format);
        EXPECT_EQ(image.width, 37);
        EXPECT_EQ(image.height, 21);
        EXPECT_EQ(image.name, "wrong.gif");
    }
    test::GifSample sample;
    sample.indices.assign(64, 3);
    sample.screen_width = 300;
    const Image gif = parse_image(test::gif_bytes(sample), {}, "test");
    EXPECT_EQ(gif.format, ImageFormat::gif);
    EXPECT_EQ(gif.width, 300);
    EXPECT_EQ(gif.height, 8);
    EXPECT_EQ(media_type(ImageFormat::jpeg), "image/jpeg");
    EXPECT_EQ(extension_of(ImageFormat::jpeg), ".jpg");
    EXPECT_EQ(media_type(gif.format), "image/gif");
    EXPECT_EQ(extension_of(ImageFormat::webp), ".webp");
}

TEST(Image, ReadFromAFile) {
    const test::Scratch scratch;
    const Image written = encode(test::gradient(5, 4), ImageFormat::png, "a.png");
    write_file(scratch / "a.jpg", written.bytes);
    const Image image = read_image(scratch / "a.jpg");
    EXPECT_EQ(image.name, "a.jpg");
    EXPECT_EQ(image.format, ImageFormat::png);
    EXPECT_EQ(image.bytes, written.bytes);
    EXPECT_THROW(read_image(scratch / "missing.png"), Error);
}

TEST(Image, OtherFormatsAreNamed) {
    using namespace std::string_literals;
    const auto padded_to = [](std::string bytes) { return bytes + std::string(100, '\0'); };
    EXPECT_TRUE(contains(refusal(padded_to("\xABKTX 20\xBB\r\n\x1A\n")), "is a KTX2 texture"));
    EXPECT_TRUE(contains(refusal(padded_to("\xABKTX 20\xBB\r\n\x1A\n")), "ktx extract"));
    EXPECT_TRUE(contains(refusal(padded_to("II*\0"s)), "is a TIFF image"));
    EXPECT_TRUE(contains(refusal(padded_to("MM\0*"s)), "convert IMAGE IMAGE.png"));
    EXPECT_TRUE(contains(refusal(padded_to("BM\x10\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0"s)), "is a BMP image"));
    EXPECT_TRUE(contains(refusal(padded_to("DDS |")), "is a DDS texture"));
    EXPECT_TRUE(contains(refusal(padded_to("sB\x13\0"s)), "is a Basis Universal texture"));
    const std::string tga = "\0\0\x02\0\0\0\0\0\0\0\0\0\x40\0\x40\0\x18\x20"s;
    EXPECT_TRUE(contains(refusal(padded_to(tga)), "is a TGA image"));
    EXPECT_TRUE(contains(refusal(padded_to("?") + "TRUEVISION-XFILE.\0"s), "is a TGA image"));
    EXPECT_TRUE(contains(refusal("version https://git-lfs.github.com/spec/v1\noid"), "git lfs pull"));
    EXPECT_TRUE(contains(refusal("no image"), "is no JPEG, PNG, WebP or GIF image"));
    EXPECT_TRUE(contains(refusal(""), "is empty"));
    EXPECT_TRUE(contains(refusal("\xff\xd8\xff\xc3\0\x0b\x08\0\x10\0\x10\x01\0\x11\0"s), "lossless"));
    EXPECT_TRUE(contains(refusal("\xff\xd8\xff\xc1\0\x0b\x0c\0\x10\0\x10\x01\0\x11\0"s), "12 bits a channel"));
}

TEST(Image, LargeImagesAreRefusedBeforeTheyAreDecoded) {
    const std::string png = encode(test::gradient(8, 8), ImageFormat::png, {}).bytes;
    EXPECT_TRUE(contains(refusal(png_with_size(png, 65000, 65000)), "65000 x 65000"));
    EXPECT_TRUE(contains(refusal(png_with_size(png, 4000000000U, 8)), "the limit"));
    EXPECT_TRUE(contains(refusal(png_with_size(png, 32768, 32768)), "million pixels"));
    EXPECT_TRUE(contains(refusal(png_with_size(png, 0, 8)), "0 x 8"));
    const std::string jpeg = encode(test::gradient(8, 8), ImageFormat::jpeg, {}).bytes;
    EXPECT_TRUE(contains(refusal(jpeg_with_size(jpeg, 65000, 65000)), "65000 x 65000"));
    EXPECT_TRUE(contains(refusal(jpeg_with_size(jpeg, 8, 0)), "8 x 0"));
    // Within the limits, but too large for the file.
    EXPECT_TRUE(contains(refusal(png_with_size(png, 16000, 16000), true), "too small for 16000 x 16000"));
    EXPECT_TRUE(contains(refusal(jpeg_with_size(jpeg, 16000, 16000), true), "too little data"));
    const std::string with_rest = png_with_size(png, 16000, 16000) + std::string(1000000, '\0');
    EXPECT_TRUE(contains(refusal(with_rest, true), "need 1024 MB of memory; a file of 2 MB may use 285 MB"));
    std::string webp = encode(test::gradient(8, 8), ImageFormat::webp, {}).bytes;
    const std::size_t key_frame = webp.find("\x9d\x01\x2a");  // width and height follow, 14 bits each, the lower byte first
    webp.replace(key_frame + 3, 4, "\x80\x3e\x80\x3e");
    EXPECT_TRUE(contains(refusal(webp, true), "too small for 16000 x 16000"));
    test::GifSample gif;
    gif.screen_width = gif.screen_height = 16000;
    gif.indices.assign(64, 3);
    EXPECT_TRUE(contains(refusal(test::gif_bytes(gif), true), "claims 16000 x 16000"));
}

TEST(Image, DamagedHeaders) {
    std::string png = encode(test::gradient(8, 8), ImageFormat::png, {}).bytes;
    png[18] = 1;
    EXPECT_TRUE(contains(refusal(png), "checksum"));
    EXPECT_TRUE(contains(refusal(png.substr(0, 20)), "ends within the header"));
}

TEST(Image, EncodedAndDecoded) {
    const Pixels colours = test::gradient(23, 40);
    const Pixels translucent = painted(9, 7, [](int i, int j) {
        return Rgba{static_cast<std::uint8_t>(20 * i), static_cast<std::uint8_t>(30 * j), 3, static_cast<std::uint8_t>(28 * i)};
    });
    EXPECT_EQ(decode(encode(colours, ImageFormat::png, "a.png"), "test").rgba, colours.rgba);
    EXPECT_EQ(decode(encode(translucent, ImageFormat::png, "a.png"), "test").rgba, translucent.rgba);
    EXPECT_LE(test::largest_difference(decode(encode(colours, ImageFormat::jpeg, "a.jpg", 95), "test"), colours), 8);
    for (const auto& pixel : decode(encode(translucent, ImageFormat::jpeg, "a.jpg"), "test").rgba) EXPECT_EQ(pixel[3], 255);
    const Image image = encode(colours, ImageFormat::jpeg, "b.jpg", 50);
    EXPECT_EQ(image.name, "b.jpg");
    EXPECT_EQ(image.width, 23);
    EXPECT_LT(image.bytes.size(), encode(colours, ImageFormat::jpeg, "b.jpg", 95).bytes.size());
}

TEST(Image, EncodeRefusesWhatItCannotWrite) {
    const Pixels pixels = test::gradient(4, 4);
    EXPECT_THROW(encode(pixels, ImageFormat::gif, {}), Error);
    EXPECT_THROW(encode(pixels, ImageFormat::jpeg, {}, 0), Error);
    EXPECT_THROW(encode(pixels, ImageFormat::jpeg, {}, 101), Error);
    EXPECT_THROW(encode({4, 3, pixels.rgba}, ImageFormat::png, {}), Error);
    EXPECT_THROW(encode({-4, -4, pixels.rgba}, ImageFormat::png, {}), Error);
    EXPECT_THROW(encode({}, ImageFormat::png, {}), Error);
    EXPECT_THROW(encode(painted(16384, 1, [](int, int) { return Rgba{}; }), ImageFormat::webp, {}), Error);
}

}  // namespace
}  // namespace ostraka

// Images of real scans and of other test suites.
#include "samples.h"

#include "ostraka/image/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace ostraka {
namespace {

const Path textured_folder = Path(OSTRAKA_SHARED_DATA) / "textured";
#define NEEDS_TEXTURED_FOLDER() \
    if (!std::filesystem::exists(textured_folder)) GTEST_SKIP() << "THE REAL IMAGES ARE NOT HERE: " << textured_folder

Pixels decoded_file(const Path& file) { return decode(read_image(file), file.string()); }

TEST(RealImages, JpegsAgreeWithTheirPngs) {
    NEEDS_TEXTURED_FOLDER();
    const Path folder = textured_folder / "odd-images" / "jpg";
    for (const std::string name : {"jpg-cmyk-1", "jpg-gray", "jpg-progressive"})
        EXPECT_LE(test::largest_difference(decoded_file(folder / (name + ".jpg")), decoded_file(folder / (name + ".png"))), 3)
            << name;
}

TEST(RealImages, AllKindsOfPng) {
    NEEDS_TEXTURED_FOLDER();
    const Path folder = textured_folder / "odd-images" / "png";
    for (const std::string& name : files_in(folder)) {
        const Image image = read_image(folder / name);
        EXPECT_EQ(image.format, ImageFormat::png) << name;
        EXPECT_EQ(image.width, name == "this_is_png.jpg" ? 256 : 32) << name;
        const Pixels pixels = decode(image, name);
        const bool translucent =
            std::any_of(pixels.rgba.begin(), pixels.rgba.end(), [](const auto& pixel) { return pixel[3] < 255; });
        EXPECT_EQ(translucent,
                  name.find("6a") != std::string::npos || name.find("4a") != std::string::npos || name.starts_with("tb"))
            << name;
    }
}

/// Every image of the folders, with the size that an independent reader found.
TEST(RealImages, AllAreDecoded) {
    NEEDS_TEXTURED_FOLDER();
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(textured_folder)) {
        static const std::vector<std::string> endings{".png", ".jpg", ".jpeg", ".gif", ".webp"};
        const Path& file = entry.path();
        if (!entry.is_regular_file() || std::find(endings.begin(), endings.end(), extension(file)) == endings.end()) continue;
        const Image image = read_image(file);
        const Pixels pixels = decode(image, file.string());
        EXPECT_EQ(pixels.width, image.width);
        EXPECT_EQ(pixels.height, image.height);
        const Path folder = textured_folder / *file.lexically_relative(textured_folder).begin();
        const std::string notes = read_file(folder / "SOURCE.txt"), name = file.lexically_relative(folder).generic_string();
        const std::string size = std::to_string(image.width) + "x" + std::to_string(image.height);
        bool agrees = false;
        for (std::size_t at = notes.find(name); at != std::string::npos; at = notes.find(name, at + 1))
            agrees = agrees || notes.substr(at, notes.find('\n', at) - at).find(size) != std::string::npos;
        EXPECT_TRUE(agrees) << file << " is " << size;
        ++count;
    }
    EXPECT_GE(count, 60U);
}

}  // namespace
}  // namespace ostraka

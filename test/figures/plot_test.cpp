#include "ostraka/figures/plot.h"

#include "ostraka/core/error.h"
#include "ostraka/figures/dendrogram.h"
#include "ostraka/figures/heat_map.h"
#include "ostraka/render/colour_scale.h"
#include "read_png.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <thread>

namespace ostraka {
namespace {

using test::Scratch;

Plot simple() {
    Plot plot{"title", {"x"}, {"y"}, {{"line", {{0, 0}, {1, 2}, {2, 1}}}}};
    PlotSeries points{"points", {{0.5, 0.5}, {1.5, 1.5}}};
    points.joined = false;
    points.labels = {"one", "two"};
    points.intervals = {{{0.2, 0.9}}, std::nullopt};
    plot.series.push_back(points);
    return plot;
}

std::size_t count(const Picture& picture, const Rgb& colour) {
    std::size_t result = 0;
    for (const std::uint32_t pixel : picture.argb)
        if (Rgb{static_cast<std::uint8_t>(pixel >> 16), static_cast<std::uint8_t>(pixel >> 8),
                static_cast<std::uint8_t>(pixel)} == colour)
            ++result;
    return result;
}

template <class Drawing>
Picture picture_of(const Drawing& drawing) {
    const Scratch scratch;
    write_plot(scratch / "plot.png", drawing);
    return test::read_png(scratch / "plot.png");
}

template <class Drawing>
std::string svg_bytes(const Drawing& drawing) {
    write_plot("memory:plot.svg", drawing);
    return read_file("memory:plot.svg");
}

TEST(Plot, GivesTheSameBytesInEveryRun) {
    const std::string first = svg_bytes(simple());
    EXPECT_EQ(svg_bytes(simple()), first) << "also where other surfaces were made before";
    std::string other;
    std::thread([&] { other = svg_bytes(simple()); }).join();
    EXPECT_EQ(other, first);
    EXPECT_NE(first.find("<svg"), std::string::npos);
    const Scratch scratch;
    write_plot(scratch / "folder" / "plot.svg", simple());
    EXPECT_EQ(read_file(scratch / "folder" / "plot.svg"), first);
}

TEST(Plot, BarsAreAsHighAsTheirValues) {
    Plot plot{"", {"x"}, {"y"}, {}};
    for (const double value : {1.0, 3.0}) {
        PlotSeries bar{"", {{value, value}}};
        bar.mark = Mark::bars;
        plot.series.push_back(bar);
    }
    const Picture picture = picture_of(plot);
    const double first_series = static_cast<double>(count(picture, {0, 114, 178})),
                 three = static_cast<double>(count(picture, {213, 94, 0}));
    ASSERT_GT(first_series, 1000);
    EXPECT_NEAR(three / first_series, 3, 0.1);
}

TEST(Plot, ShowsPointsOfEachClassInItsColour) {
    Plot plot{"", {"x"}, {"y"}, {}};
    for (std::size_t k = 0; k < 9; ++k) {
        PlotSeries series{"class " + std::to_string(k), {{static_cast<double>(k), 1}}};
        series.joined = false;
        plot.series.push_back(series);
    }
    plot.series[8].colour = 2;
    const Picture picture = picture_of(plot);
    EXPECT_GT(count(picture, {0, 114, 178}), 20u);
    EXPECT_GT(count(picture, {0, 158, 115}), 2 * 20u) << "two series have this colour";
}

TEST(Plot, HandlesSinglePointsHugeAndMissingNumbers) {
    EXPECT_NO_THROW(svg_bytes(Plot{"", {"x"}, {"y"}, {{"", {{3, 3}}}}}));
    EXPECT_NO_THROW(svg_bytes(Plot{"", {"x"}, {"y"}, {{"", {{-1e300, 1e-300}, {1e300, 2e-300}}}}}));
    const double none = std::nan("");
    EXPECT_NO_THROW(svg_bytes(Plot{"", {"x"}, {"y"}, {{"", {{0, none}, {1, 1}, {2, std::numeric_limits<double>::infinity()}}}}}));
    EXPECT_THROW(svg_bytes(Plot{"", {"x"}, {"y"}, {{"", {{none, 1}}}}}), Error);
    EXPECT_THROW(svg_bytes(Plot{"", {"x"}, {"y"}, {}}), Error);
    EXPECT_THROW(svg_bytes(Plot{"", {"x", true}, {"y"}, {{"", {{-1, 1}}}}}), Error) << "nothing below 0 on a logarithmic axis";
}

TEST(Plot, LabelsAndIntervalsAreOnePerPoint) {
    Plot plot = simple();
    plot.series[1].labels.pop_back();
    EXPECT_THROW(svg_bytes(plot), Error);
    plot = simple();
    plot.series[1].intervals.pop_back();
    EXPECT_THROW(svg_bytes(plot), Error);
}

/// A plot of the unit square with white points and labels, so that only names leave ink in its area.
Plot labelled(const std::vector<std::array<double, 2>>& points, const std::string& words) {
    Plot plot{"", {"x", false, 0.0, 1.0}, {"y", false, 0.0, 1.0}, {{"", points}}};
    plot.series[0].joined = false;
    plot.series[0].labels.assign(points.size(), words);
    return plot;
}

TEST(Plot, LabelsAreNeitherClippedNorOverlapping) {
    const auto dark = [](const Picture& picture) {
        double sum = 0;
        for (const std::uint32_t pixel : picture.argb) {
            const int red = pixel >> 16 & 0xff, green = pixel >> 8 & 0xff, blue = pixel & 0xff;
            if (std::max({red, green, blue}) - std::min({red, green, blue}) < 20) sum += 255 - red;
        }
        return sum;
    };
    const std::array<double, 2> middle{0.55, 0.55};
    const auto ink_of = [&](const std::vector<std::array<double, 2>>& points) {
        return dark(picture_of(labelled(points, "a long name of it"))) - dark(picture_of(labelled(points, "")));
    };
    const double single_ink = ink_of({middle});
    ASSERT_GT(single_ink, 1000);
    for (const auto& corner : {std::array{0.0, 0.0}, std::array{0.0, 1.0}, std::array{1.0, 0.0}, std::array{1.0, 1.0}})
        EXPECT_NEAR(ink_of({corner}) / single_ink, 1, 0.1) << corner[0] << " " << corner[1];
    EXPECT_NEAR(ink_of({middle, {0.55, 0.551}}) / single_ink, 2, 0.2);
    // Of a thousand names at one point a few are drawn, and a line gives the number of the others.
    const double repeated_ink = ink_of(std::vector<std::array<double, 2>>(1000, middle));
    EXPECT_GT(repeated_ink, 3 * single_ink);
    EXPECT_LT(repeated_ink, 60 * single_ink);
}

TEST(Plot, EscapesMarkupInNames) {
    Plot plot = simple();
    plot.title = "</svg><script>alert(1)</script> \xff\xfe \x01 \n";
    plot.series[1].labels[0] = std::string(10000, 'x') + "\xc3";
    std::string svg;
    ASSERT_NO_THROW(svg = svg_bytes(plot));
    EXPECT_EQ(svg.find("script"), std::string::npos);
}

TEST(Plot, FormatFollowsTheFileEnding) {
    const Scratch scratch;
    EXPECT_THROW(write_plot(scratch / "plot.gif", simple()), Error);
    write_plot(scratch / "plot.png", simple());
    EXPECT_EQ(test::read_png(scratch / "plot.png").width, 2 * 760);
}

TEST(Plot, RateAgainstRateIsSquare) {
    Plot plot{
        "", {"false positive rate", false, 0.0, 1.0}, {"true positive rate", false, 0.0, 1.0}, {{"", {{0, 0}, {1, 1}}, false}}};
    plot.square = true;
    const Picture picture = picture_of(plot);
    // The diagonal is as wide as high.
    int left = picture.width, right = 0, top = picture.height, bottom = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            if ((picture.at(x, y) & 0xffffff) == 0x0072b2)
                left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    EXPECT_GT(right - left, 400);
    EXPECT_NEAR(right - left, bottom - top, 6);
}

TEST(HeatMap, CellsHaveTheColoursOfTheirValues) {
    HeatMap map{"", Eigen::MatrixXd(2, 2), {"a", "b"}, {"c", "d"}, "distance"};
    map.values << 0, 1, 0.25, 0.5;
    const Picture picture = picture_of(map);
    for (const double value : {0.0, 0.25, 0.5, 1.0}) {
        const double pixel_count = static_cast<double>(count(picture, colour_of({0, 1, false, ""}, value)));
        EXPECT_GT(pixel_count, 0.9 * 52 * 52) << value << ": a field of 26 points";
    }
    map.values(1, 1) = std::nan("");
    EXPECT_NO_THROW(svg_bytes(map));
    EXPECT_EQ(svg_bytes(map), svg_bytes(map));
}

TEST(HeatMap, RefusesMismatchedSizes) {
    HeatMap map{"", Eigen::MatrixXd::Zero(2, 2), {"a", "b"}, {"c"}, ""};
    EXPECT_THROW(svg_bytes(map), Error);
    map.columns = {"c", "d"};
    EXPECT_NO_THROW(svg_bytes(map)) << "all the same";
    map.groups = {1};
    EXPECT_THROW(svg_bytes(map), Error);
    map.groups = {};
    map.values.setConstant(std::nan(""));
    EXPECT_THROW(svg_bytes(map), Error);
    EXPECT_THROW(svg_bytes(HeatMap{}), Error);
}

TEST(DendrogramPicture, HandlesTreesOfAnySize) {
    Eigen::MatrixXd places(4, 1);
    places << 0, 5, 1, 7;
    Dendrogram tree{"tree", linkage(distance_matrix(places)), {"a", "b", "c", "d"}};
    EXPECT_EQ(svg_bytes(tree), svg_bytes(tree));
    tree.cut = 2.5;
    for (const std::size_t colour : {0u, 1u}) EXPECT_GT(count(picture_of(tree), category_colour(colour)), 100u);
    tree.cut_label = "epsilon 2.5";
    tree.classes = {"one", "two", "one", ""};
    for (const std::size_t colour : {0u, 1u})
        EXPECT_EQ(count(picture_of(tree), category_colour(colour)), 0u) << "the colours are those of the classes alone";
    tree.classes.clear();
    tree.groups = {1, 0, 1, 0};
    const Picture picture = picture_of(tree);
    EXPECT_GT(count(picture, category_colour(1)), 100u);
    EXPECT_GT(count(picture, category_colour(0)), 100u);
    tree.groups = {1, 0};
    EXPECT_THROW(svg_bytes(tree), Error);
    EXPECT_NO_THROW(svg_bytes(Dendrogram{"", linkage(Eigen::MatrixXd::Zero(1, 1)), {"alone"}}));
    EXPECT_NO_THROW(svg_bytes(Dendrogram{"", linkage(Eigen::MatrixXd::Zero(3, 3)), {"a", "a", "a"}}));
}

TEST(DendrogramPicture, RefusesInvalidTrees) {
    EXPECT_THROW(svg_bytes(Dendrogram{}), Error);
    Dendrogram tree{"", linkage(Eigen::MatrixXd::Zero(3, 3)), {"a", "b"}};
    EXPECT_THROW(svg_bytes(tree), Error) << "a name is missing";
    tree.names.push_back("c");
    tree.tree.merges[1] = tree.tree.merges[0];
    EXPECT_THROW(svg_bytes(tree), Error) << "a cluster merged twice";
    tree.tree.merges.pop_back();
    EXPECT_THROW(svg_bytes(tree), Error);
}

}  // namespace
}  // namespace ostraka

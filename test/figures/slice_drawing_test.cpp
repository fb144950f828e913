// Drawings are complete files at the stated scale, with the same bytes in every run.
#include "ostraka/figures/slice_drawing.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/render/picture.h"
#include "ostraka/slicing/silhouette.h"
#include "read_png.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

struct Cut {
    Mesh mesh = build_mesh(torus(60, 40));
    SliceStack stack = slice_mesh(mesh, slice_frame({0, 0, -1}, {0, 0, 1}), slice_heights(0, 2, 30));
    std::vector<SliceDescriptors> descriptors = describe_slices(stack.slices);

    [[nodiscard]] SliceSheet sheet(std::size_t count) const {
        SliceSheet sheet;
        sheet.title = "a ring <of> \"clay\" & more";
        sheet.unit = "cm";
        for (std::size_t i = 0; i < count; ++i) sheet.slices.push_back({&stack.slices[i], &descriptors[i], {{{2, 0}, {0, 2}}}});
        SliceFrame view = stack.frame;
        view.v = view.normal, view.normal = CGAL::cross_product(view.u, view.v);
        sheet.view = silhouette(mesh, view, 100);
        return sheet;
    }
};

double width_of(const std::string& svg) {
    const auto at = svg.find("width=\"");
    return std::stod(svg.substr(at + 7));
}

}  // namespace

TEST(SliceSheet, HandlesOneAndManySlices) {
    const Scratch scratch;
    const Cut cut;
    for (const std::size_t count : {1UL, 7UL, 30UL}) {
        write_slice_sheet(scratch / "a.svg", cut.sheet(count));
        write_slice_sheet(scratch / "b.svg", cut.sheet(count));
        const std::string svg = read_file(scratch / "a.svg");
        EXPECT_TRUE(svg == read_file(scratch / "b.svg"));
        EXPECT_NE(svg.find("</svg>"), std::string::npos);
        write_slice_sheet(scratch / "a.png", cut.sheet(count));
        const Picture picture = test::read_png(scratch / "a.png");
        EXPECT_NEAR(picture.width, 2 * width_of(svg), 2);
        // There are clay pixels and paper pixels.
        std::size_t clay = 0, white = 0;
        for (const auto pixel : picture.argb) clay += pixel == 0xffdec4a6U, white += pixel == 0xffffffffU;
        EXPECT_GT(clay, 100U);
        EXPECT_GT(white, picture.argb.size() / 4);
    }
}

TEST(SliceSheet, KeepsTheNumbersOfItsSlices) {
    const Scratch scratch;
    const Cut cut;
    SliceSheet own_sheet = cut.sheet(3), others = cut.sheet(3);
    write_slice_sheet(scratch / "place.svg", own_sheet);
    for (std::size_t i = 0; i < 3; ++i) own_sheet.slices[i].number = i + 1, others.slices[i].number = 10 * (i + 1);
    write_slice_sheet(scratch / "own.svg", own_sheet);
    write_slice_sheet(scratch / "others.svg", others);
    EXPECT_TRUE(read_file(scratch / "place.svg") == read_file(scratch / "own.svg"));
    EXPECT_FALSE(read_file(scratch / "others.svg") == read_file(scratch / "own.svg"));
}

TEST(SliceSheet, RefusesEmptySheets) {
    const Scratch scratch;
    const Cut cut;
    EXPECT_THROW(write_slice_sheet(scratch / "a.gif", cut.sheet(2)), Error);
    EXPECT_THROW(write_slice_sheet(scratch / "a.svg", SliceSheet{}), Error);
    const Slice empty;
    SliceSheet none;
    none.slices.push_back({&empty, nullptr, {}});
    EXPECT_THROW(write_slice_sheet(scratch / "a.svg", none), Error);
    EXPECT_EQ(count_files(scratch.path()), 0U);
}

TEST(ProfileDrawing, IsDrawnAtTheStatedScale) {
    const Scratch scratch;
    const Cut cut;
    const Profile profile = find_profile(cut.mesh, slice_frame({0, 0, -1}, {0, 0, 1}));
    // 6 units wide: 60 mm in cm, at 2 : 1 or 2.5 : 1 within 430 points; the width of the sheet determines it.
    write_profile_drawing(scratch / "cm.svg", profile, "ring", "cm");
    write_profile_drawing(scratch / "mm.svg", profile, "ring", "mm");
    write_profile_drawing(scratch / "none.svg", profile, "ring", "");
    const double cm = width_of(read_file(scratch / "cm.svg")), mm = width_of(read_file(scratch / "mm.svg"));
    // The same size on paper means ten times the scale.
    EXPECT_NEAR(cm, mm, 1e-6);
    const double natural = 60 * 72 / 25.4, share = (cm - 128) / natural;
    EXPECT_NEAR(share, 2.5, 0.01);
    EXPECT_GT(width_of(read_file(scratch / "none.svg")), cm - 1);
    Profile flat;
    EXPECT_THROW(write_profile_drawing(scratch / "x.svg", flat, "", ""), Error);
}

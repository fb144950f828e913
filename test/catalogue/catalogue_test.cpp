// Catalogue entries: kinds, drawings and measures of objects whose answers are known; pages of exact size.
#include "ostraka/figures/catalogue.h"
#include "ostraka/catalogue/catalogue_axis.h"
#include "ostraka/catalogue/entry.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include "calls.h"
#include "meshes.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"
#include "sherds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

constexpr double wall = 5, height = 80, top_radius = 100;

/// Middle of the wall of a flaring bowl.
double radius_at(double v) { return 60 + 40 * v * v; }

/// A closed bowl of revolution about z, with a flat floor: a torus-like grid around its profile, closed by its floor.
TriangleSoup bowl(Index columns = 120, Index rows = 160) {
    // The profile runs up the inside from the axis, over the lip, and down the outside to the axis.
    std::vector<std::array<double, 2>> profile;
    const auto at = [&](double v, double side) { profile.push_back({radius_at(v) + side * wall / 2, height * v}); };
    const Index half = rows / 2;
    profile.push_back({0, wall});
    for (Index i = 2; i <= half; ++i) at(double(i) / half, -1);
    for (Index i = 0; i <= half; ++i) at(1 - double(i) / half, 1);
    profile.push_back({0, 0});
    TriangleSoup soup;
    const auto n = static_cast<Index>(profile.size());
    soup.points.push_back({0, 0, profile.front()[1]});
    for (Index i = 1; i + 1 < n; ++i)
        for (Index k = 0; k < columns; ++k) {
            const double angle = 2 * M_PI * k / columns;
            soup.points.push_back({profile[i][0] * std::cos(angle), profile[i][0] * std::sin(angle), profile[i][1]});
        }
    soup.points.push_back({0, 0, profile.back()[1]});
    const auto vertex = [&](Index row, Index column) { return 1 + (row - 1) * columns + column % columns; };
    const auto last = static_cast<Index>(soup.points.size() - 1);
    for (Index k = 0; k < columns; ++k) {
        soup.triangles.push_back({0, vertex(1, k), vertex(1, k + 1)});
        for (Index i = 1; i + 2 < n; ++i) {
            soup.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
            soup.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
        }
        soup.triangles.push_back({last, vertex(n - 2, k + 1), vertex(n - 2, k)});
    }
    return soup;
}

/// A closed rim sherd of the bowl: `degrees` of its circumference; the lower fracture is jagged.
TriangleSoup rim_sherd(double degrees, int fineness = 1) {
    std::vector<int> side;
    const auto at = [&](double u, double v, double w) -> std::array<double, 3> {
        const double low = 0.35 + 0.1 * std::sin(9 * u) + 0.03 * std::sin(31 * u), height_share = low + (1 - low) * v;
        const double angle = (u - 0.5) * degrees * M_PI / 180, radius = radius_at(height_share) + (w - 0.5) * wall;
        return {radius * std::cos(angle), radius * std::sin(angle), height * height_share};
    };
    return box_grid({40 * fineness, 40 * fineness, 4}, at, side);
}

/// The soup rotated about an oblique line and moved.
TriangleSoup elsewhere(TriangleSoup soup) {
    const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, 2, -0.5).normalized());
    for (auto& p : soup.points) {
        const Eigen::Vector3d q = turn * Eigen::Vector3d(p[0], p[1], p[2]) + Eigen::Vector3d(300, -200, 1000);
        p = {q.x(), q.y(), q.z()};
    }
    return soup;
}

CatalogueEntry entry_of(TriangleSoup soup, CatalogueOptions options = {}, const std::string& unit = "mm") {
    options.pixels = 200;
    CatalogueSubject subject;
    subject.name = "object";
    subject.soup = std::move(soup);
    subject.unit = unit;
    return catalogue_entry(subject, options);
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace

TEST(CatalogueEntry, MeasuresAWholeBowlInAnyPose) {
    for (const bool is_moved : {false, true}) {
        const CatalogueEntry entry = entry_of(is_moved ? elsewhere(bowl()) : bowl());
        EXPECT_EQ(entry.kind, CatalogueKind::vessel);
        EXPECT_EQ(entry.diameter.name, "rim diameter");
        EXPECT_TRUE(entry.diameter.known);
        EXPECT_TRUE(entry.diameter.is_range);
        EXPECT_NEAR(entry.diameter.value, 2 * top_radius + wall, 1.5);
        EXPECT_NEAR(entry.diameter.share, 1, 0.01);
        EXPECT_NEAR(entry.height, height, 0.2);
        EXPECT_NEAR(entry.thickness, wall * std::cos(std::atan(0.5)), 0.9);  // between foot (vertical wall) and rim
        EXPECT_TRUE(entry.drawing.reconstructed.empty());
        EXPECT_EQ(entry.views.size(), 3U);
        // The mouth is at the top, whatever the pose: the rim is the highest line, and wider than the foot.
        ASSERT_FALSE(entry.drawing.lines.empty());
        for (const auto& line : entry.drawing.lines)
            if (line.type == CatalogueDrawing::Line::Type::rim) {
                EXPECT_NEAR(line.height, height, 1.5);
                EXPECT_NEAR(line.radius, top_radius + wall / 2, 2.5);
            }
    }
}

TEST(CatalogueEntry, DrawsAClosedSherdAsASherd) {
    for (const double degrees : {50.0, 110.0}) {
        const CatalogueEntry entry = entry_of(elsewhere(rim_sherd(degrees)));
        SCOPED_TRACE(degrees);
        EXPECT_EQ(entry.kind, CatalogueKind::rim);
        EXPECT_NEAR(entry.diameter.share, degrees / 360, 0.02);  // of the arc, although all contours are closed
        ASSERT_TRUE(entry.diameter.known);
        EXPECT_FALSE(entry.diameter.is_range);
        EXPECT_NEAR(entry.diameter.value, 2 * top_radius + wall, 0.05 * 2 * top_radius);
        EXPECT_LE(entry.diameter.low, entry.diameter.value);
        EXPECT_GE(entry.diameter.high, entry.diameter.value);
        EXPECT_FALSE(entry.drawing.reconstructed.empty());
        EXPECT_EQ(entry.drawing.section.size(), 1U);
        EXPECT_FALSE(entry.drawing.breaks.empty());
        // The rim is drawn where it is preserved only.
        bool has_rim = false;
        for (const auto& line : entry.drawing.lines) {
            has_rim = has_rim || line.type == CatalogueDrawing::Line::Type::rim;
            EXPECT_LE(line.to, line.radius + 1e-9);
            EXPECT_LE(line.from, line.to);
        }
        EXPECT_TRUE(has_rim);
        EXPECT_GT(entry.drawing.section_reach, top_radius - wall);
    }
}

TEST(CatalogueEntry, SaysWhatCannotBeTold) {
    CatalogueOptions strict;
    strict.max_error = 0.001;
    const CatalogueEntry entry = entry_of(rim_sherd(20), strict);
    EXPECT_FALSE(entry.diameter.known);
    ASSERT_FALSE(entry.unknown.empty());
    EXPECT_NE(entry.unknown.front().find("cannot be told"), std::string::npos);
    // A cube has no axis; its diameter is not made up.
    const CatalogueEntry cube = entry_of(box(4));
    EXPECT_EQ(cube.kind, CatalogueKind::object);
    EXPECT_TRUE(cube.diameter.name.empty());
    EXPECT_FALSE(cube.unknown.empty());
    EXPECT_EQ(cube.views.size(), 6U);
    EXPECT_NEAR(cube.volume, 1e-3 * volume(build_mesh(box(4))), 1e-9);
}

TEST(CatalogueAxis, IsThatOfTheWallsWithoutFractures) {
    const Mesh sherd = build_mesh(rim_sherd(50));
    const CatalogueAxis axis = catalogue_axis(sherd);
    ASSERT_TRUE(axis.found) << axis.reason;
    EXPECT_TRUE(axis.is_sherd());
    EXPECT_LT(axis.diameter_low, 0);
    EXPECT_GT(axis.diameter_high, 0);
    std::vector<Index> all(sherd.number_of_faces());
    std::iota(all.begin(), all.end(), Index{0});
    const CatalogueAxis none = catalogue_axis(sherd, all);
    EXPECT_FALSE(none.found);
    EXPECT_NE(none.reason.find("fracture"), std::string::npos);
    // A whole vessel has no posterior of a sherd.
    EXPECT_FALSE(catalogue_axis(build_mesh(bowl())).is_sherd());
}

TEST(CatalogueEntry, ConvertsUnits) {
    const CatalogueEntry mm = entry_of(bowl()), cm = entry_of(bowl(), {}, "cm");
    EXPECT_NEAR(cm.height, 10 * mm.height, 1e-6 * cm.height);
    EXPECT_NEAR(cm.diameter.value, 10 * mm.diameter.value, 1e-6 * cm.diameter.value);
    const CatalogueEntry none = entry_of(bowl(), {}, "");
    EXPECT_TRUE(none.unit_assumed);
    EXPECT_FALSE(none.notes.empty());
    EXPECT_THROW(entry_of(bowl(), {}, "cubits"), Error);
}

TEST(CatalogueEntry, ShowsLandmarksThatAreVisible) {
    CatalogueSubject subject;
    subject.name = "ball";
    subject.soup = octahedron_sphere(4);
    subject.unit = "mm";
    subject.landmarks = {{"front", {0, -1, 0}}, {"back", {0, 1, 0}}, {"top", {0, 0, 1}}};
    CatalogueOptions options;
    options.pixels = 100;
    const CatalogueEntry entry = catalogue_entry(subject, options);
    EXPECT_EQ(entry.kind, CatalogueKind::landmarks);
    EXPECT_EQ(entry.landmarks.size(), 3U);
    ASSERT_EQ(entry.views.size(), 6U);
    std::set<std::size_t> front;
    for (const auto& mark : entry.views[0].marks) front.insert(mark.number);
    EXPECT_TRUE(front.contains(1));
    EXPECT_FALSE(front.contains(2));
}

TEST(CatalogueEntry, AcceptsDegenerateSurfaces) {
    EXPECT_THROW(entry_of(TriangleSoup()), Error);
    TriangleSoup triangle{{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(entry_of(triangle).kind, CatalogueKind::object);
    TriangleSoup twice = triangle;  // three faces at one edge: no manifold
    twice.points.push_back({0, 0, 10});
    twice.triangles.push_back({0, 1, 3});
    twice.triangles.push_back({1, 0, 2});
    const CatalogueEntry entry = entry_of(twice);
    EXPECT_EQ(entry.kind, CatalogueKind::object);
    EXPECT_FALSE(entry.notes.empty());
    TriangleSoup inside_out = bowl();
    for (auto& corners_of_triangle : inside_out.triangles) std::swap(corners_of_triangle[1], corners_of_triangle[2]);
    EXPECT_EQ(entry_of(inside_out).kind, CatalogueKind::vessel);
}

TEST(CatalogueEntry, IsTheSameForAnyNumberOfThreadsAndFromJson) {
    set_threads(1);
    const std::string one = to_text(to_json(entry_of(rim_sherd(60))));
    set_threads(4);
    const std::string four = to_text(to_json(entry_of(rim_sherd(60))));
    set_threads(0);
    EXPECT_TRUE(one == four);
    EXPECT_TRUE(to_text(to_json(entry_from_json(parse_json(one, "entry")))) == one);
}

TEST(Catalogue, HasPagesOfExactSize) {
    std::vector<CatalogueEntry> entries{entry_of(rim_sherd(60)), entry_of(bowl()), entry_of(box(4))};
    CatalogueEntry bad;
    bad.name = "bad <b>";
    bad.kind = CatalogueKind::unreadable;
    bad.problem = "bad.ply: is not a mesh";
    entries.push_back(bad);
    const Catalogue catalogue(entries, CatalogueStyle(), "made by a test");
    EXPECT_EQ(catalogue.pages(), 5U);  // four objects and the table
    EXPECT_EQ(catalogue.places()[1].first, 2U);
    EXPECT_EQ(catalogue.places()[1].second, "1:2");  // 205 mm do not fit a page of 210 mm at 1:1
    const std::string pdf = catalogue.pdf();
    EXPECT_TRUE(pdf.starts_with("%PDF"));
    EXPECT_TRUE(pdf == catalogue.pdf());
    EXPECT_NE(pdf.find("/Count 5"), std::string::npos);
    EXPECT_NE(pdf.find("595.27"), std::string::npos);  // 210 mm
    const std::string svg = catalogue.svg(1);
    EXPECT_NE(svg.find("width=\"210mm\" height=\"297mm\""), std::string::npos);
    const std::string html = catalogue.html();
    EXPECT_EQ(count(html, "<section "), 4U);
    EXPECT_EQ(html.find("bad <b>"), std::string::npos);  // escaped
    EXPECT_NE(html.find("bad &lt;b&gt;"), std::string::npos);
    // No name of an element occurs on two pages.
    std::set<std::string> names;
    for (std::size_t at = html.find(" id=\""); at != std::string::npos; at = html.find(" id=\"", at + 1)) {
        const std::size_t begin = at + 5;
        EXPECT_TRUE(names.insert(html.substr(begin, html.find('"', begin) - begin)).second);
    }
}

TEST(Catalogue, PutsManyOnASheetAtOneScale) {
    std::vector<CatalogueEntry> entries;
    for (const double degrees : {30.0, 40.0, 50.0, 60.0, 70.0}) entries.push_back(entry_of(rim_sherd(degrees)));
    CatalogueStyle style;
    style.several_per_page = true;
    for (const auto convention :
         {CatalogueStyle::Convention::english, CatalogueStyle::Convention::continental, CatalogueStyle::Convention::american}) {
        style.convention = convention;
        const Catalogue catalogue(entries, style, "");
        EXPECT_LT(catalogue.pages(), 6U);
        for (const auto& [page, scale] : catalogue.places()) {
            EXPECT_GT(page, 0U);
            EXPECT_EQ(scale, catalogue.places()[0].second);
        }
    }
    style.scale = "1:5";
    EXPECT_EQ(Catalogue(entries, style, "").places()[0].second, "1:5");
    EXPECT_EQ(CatalogueStyle().section_right(), false);
}

TEST(CatalogueCommand, OneBadFileStopsNothingAndFinishedObjectsAreKept) {
    const Scratch scratch;
    make_folder(scratch / "scans");
    write_triangles(scratch / "scans" / "sherd.ply", rim_sherd(60));
    write_triangles(scratch / "scans" / "bowl.ply", bowl());
    write_file(scratch / "scans" / "bad.ply", "ply\nformat nonsense\n");
    write_file(scratch / "scans" / "bowl.dc.json", R"({"title": "A bowl", "dc:creator": ["Potter"], "date": 1200})");
    const auto run = [&](const std::string& pdf) {
        Context context;
        Call call = call_in(scratch.path(), "catalogue",
                            R"({"collection": "scans", "output": ")" + pdf +
                                R"(", "html": "all.html", "table": "all.csv", "pixels": 200, "density": 1.8, "unit": "mm"})");
        return call.run(context);
    };
    const Report first = run("all.pdf");
    EXPECT_TRUE(first.holds());
    EXPECT_EQ(number_or(first.result(), "objects", 0), 3);
    EXPECT_EQ(number_or(first.result(), "unreadable", 0), 1);
    EXPECT_EQ(number_or(first.result(), "resumed", -1), 0);
    const std::string pdf = read_file(scratch / "all.pdf"), csv = read_file(scratch / "all.csv");
    EXPECT_EQ(count(csv, "\n"), 4U);
    EXPECT_NE(read_file(scratch / "all.html").find("<svg"), std::string::npos);
    const Report second = run("all.pdf");
    EXPECT_EQ(number_or(second.result(), "resumed", -1), 2);
    EXPECT_TRUE(read_file(scratch / "all.pdf") == pdf);
    EXPECT_TRUE(read_file(scratch / "all.csv") == csv);
    EXPECT_THROW(run("all.txt"), Error);
}

TEST(CatalogueCommand, DrawsASingleMeshAsSvg) {
    const Scratch scratch;
    write_triangles(scratch / "sherd.ply", rim_sherd(60));
    Context context;
    Call call = call_in(scratch.path(), "catalogue",
                        R"({"collection": "sherd.ply", "output": "sherd.svg", "unit": "mm", "pixels": 200})");
    EXPECT_TRUE(call.run(context).holds());
    EXPECT_NE(read_file(scratch / "sherd.svg").find("210mm"), std::string::npos);
}

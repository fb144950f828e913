// Landmark files: each format read back and compared, spaces, tolerance, damage.
#include "ostraka/interchange/landmarks.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;

namespace {

const std::vector<LandmarkFormat> all_formats{LandmarkFormat::csv, LandmarkFormat::tps, LandmarkFormat::pp, LandmarkFormat::mrk,
                                              LandmarkFormat::fcsv};

LandmarkSet wild_landmarks() {
    LandmarkSet set;
    set.unit = "mm";
    double x = 0.1;
    for (const std::string& text : wild_texts()) {
        set.landmarks.push_back({text, {x, -x / 3, 1e-17 * x}, {}});
        x *= -1.7;
    }
    return set;
}

/// A name after the format's own restrictions.
std::string kept_name(const std::string& name, LandmarkFormat format) {
    std::string result;
    for (std::size_t i = 0; i < name.size();) {
        const auto [code, length] = character_at(name, i);
        const bool control = is_control(code), blank = code == '\t' || code == '\n' || code == '\r';
        if (format == LandmarkFormat::fcsv && control) result += ' ';
        else if (format == LandmarkFormat::pp && control && !blank) result += "\xEF\xBF\xBD";
        else result += name.substr(i, length);
        i += length;
    }
    return result;
}

std::string written(const LandmarkSet& set, LandmarkFormat format, const LandmarkFileOptions& options = {}) {
    std::vector<std::string> notes;
    return landmarks_to_text(set, format, "mesh <&>.ply", {}, notes, options);
}

std::string message(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST(Landmarks, EveryFormatRoundTripsExactly) {
    const LandmarkSet set = wild_landmarks();
    for (const LandmarkFormat format : all_formats) {
        const std::string text = written(set, format);
        const LandmarkSet read = landmarks_from_text(text, format, "file");
        ASSERT_EQ(read.landmarks.size(), set.landmarks.size()) << text;
        for (std::size_t i = 0; i < set.landmarks.size(); ++i) {
            EXPECT_EQ(read.landmarks[i].position, set.landmarks[i].position);
            std::string expected = kept_name(set.landmarks[i].name, format);
            if (expected.empty() && format == LandmarkFormat::mrk) expected = std::to_string(i + 1);
            EXPECT_EQ(read.landmarks[i].name, expected) << int(format);
        }
        EXPECT_EQ(written(set, format), text) << "the same bytes again";
    }
}

TEST(Landmarks, TextIsNeverExecutable) {
    const LandmarkSet set = wild_landmarks();
    EXPECT_EQ(occurrences(written(set, LandmarkFormat::mrk), "<"), 0U);
    EXPECT_EQ(occurrences(written(set, LandmarkFormat::tps), "<script"), 0U);
    const std::string pp = written(set, LandmarkFormat::pp);
    EXPECT_EQ(occurrences(pp, "<script"), 0U);
    EXPECT_EQ(occurrences(pp, "<point"), set.landmarks.size());
    for (const LandmarkFormat format : {LandmarkFormat::csv, LandmarkFormat::fcsv}) {
        // No cell, quoted or not, begins like a formula unless it is a number.
        const std::string text = written(set, format);
        for (const std::string start : {",=", ",\"=", ",@", ",\"@", ",+", ",\"+", ",\"\t", ",\"\n", ",-2+", ",\"-"})
            EXPECT_EQ(occurrences(text, start), 0U) << start;
        EXPECT_NE(text.find("'=1+1"), std::string::npos);
    }
}

TEST(Landmarks, AnatomicalSpacesAreConverted) {
    LandmarkSet set;
    set.landmarks = {{"a", {1, 2, 3}, {}}};
    for (const LandmarkFormat format : {LandmarkFormat::mrk, LandmarkFormat::fcsv}) {
        LandmarkFileOptions ras;
        ras.mesh_space = AnatomicalSpace::ras;
        EXPECT_EQ(landmarks_from_text(written(set, format, ras), format, "f").landmarks[0].position,
                  (std::array<double, 3>{-1, -2, 3}));
        EXPECT_EQ(landmarks_from_text(written(set, format, ras), format, "f", ras).landmarks[0].position,
                  set.landmarks[0].position);
    }
    // Old tables: a number for the space, or none, which means RAS.
    const std::string row = "\nvtkMRML_0,1,2,3,0,0,0,1,1,1,0,a,,\n";
    const auto first = [](const std::string& text) {
        return landmarks_from_text(text, LandmarkFormat::fcsv, "f").landmarks.at(0).position[0];
    };
    EXPECT_EQ(first("# Markups fiducial file version = 4.6\n# CoordinateSystem = 0" + row), -1);
    EXPECT_EQ(first("# CoordinateSystem = 1" + row), 1);
    EXPECT_EQ(first("# CoordinateSystem = LPS" + row), 1);
    EXPECT_EQ(first(row), -1);
    EXPECT_NE(message([&] { first("# CoordinateSystem = IJK" + row); }).find("unknown coordinate system"), std::string::npos);
    // Tables that 3D Slicer exports.
    const std::string table = "label,r,a,s,defined\nF-1,1,2,3,1\nF-2,4,5,6,0\n";
    const LandmarkSet read = landmarks_from_text(table, LandmarkFormat::csv, "f");
    ASSERT_EQ(read.landmarks.size(), 1U);
    EXPECT_EQ(read.landmarks[0].position, (std::array<double, 3>{-1, -2, 3}));
    EXPECT_EQ(read.notes.size(), 1U);
}

TEST(Landmarks, FilesOfOtherToolsAreRead) {
    const auto csv = [](const std::string& text) { return landmarks_from_text(text, LandmarkFormat::csv, "f"); };
    EXPECT_EQ(csv("1.5,2,3\n4,5,6\n").landmarks.at(1).position, (std::array<double, 3>{4, 5, 6}));
    EXPECT_EQ(csv("nasion;1.5;2;3\n").landmarks.at(0).name, "nasion");
    EXPECT_EQ(csv("\xEF\xBB\xBFX\tY\tZ\tName\r\n1\t2\t3\ttip\r\n").landmarks.at(0).name, "tip");
    const auto tps = [](const std::string& text, const std::string& specimen = {}) {
        LandmarkFileOptions options;
        options.specimen = specimen;
        return landmarks_from_text(text, LandmarkFormat::tps, "f", options);
    };
    const std::string two = "LM3=2\n1 2 3\nNA NA NA\nID=first\nSCALE=2\n\nLM3=1\r\n-4 5e-1 6\r\nIMAGE=x.jpg\r\nID=second\r\n";
    EXPECT_EQ(tps(two, "first").landmarks.at(0).position, (std::array<double, 3>{2, 4, 6}));
    EXPECT_EQ(tps(two, "first").landmarks.size(), 1U);
    EXPECT_EQ(tps(two, "2").landmarks.at(0).position, (std::array<double, 3>{-4, 0.5, 6}));
    EXPECT_NE(message([&] { tps(two); }).find("2 specimens"), std::string::npos);
    EXPECT_NE(message([&] { tps("LM=1\n1 2\n"); }).find("two-dimensional"), std::string::npos);
    EXPECT_NE(message([&] { tps("LM3=3\n1 2 3\n"); }).find("fewer"), std::string::npos);
    const auto pp = landmarks_from_text(
        "<!DOCTYPE PickedPoints>\n<PickedPoints><DocumentData><User name=\"u\"/></DocumentData>"
        "<point x=\"1\" y=\"2\" z=\"3e0\" name=\"a &lt;b&gt;\" active=\"1\"/><point x=\"0\" y=\"0\" z=\"0\" active=\"0\" "
        "name=\"c\"/>"
        "</PickedPoints>",
        LandmarkFormat::pp, "f");
    ASSERT_EQ(pp.landmarks.size(), 1U);
    EXPECT_EQ(pp.landmarks[0].name, "a <b>");
    // An external entity is not looked up.
    const auto hostile = landmarks_from_text(
        "<!DOCTYPE PickedPoints [<!ENTITY e SYSTEM \"file:///etc/passwd\">]><PickedPoints><point x=\"1\" y=\"2\" z=\"3\" "
        "name=\"&e;\"/></PickedPoints>",
        LandmarkFormat::pp, "f");
    EXPECT_EQ(hostile.landmarks.at(0).name, "&e;");
}

TEST(Landmarks, PointsAndLinesRoundTrip) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    for (const LandmarkFormat format : all_formats) {
        std::vector<std::string> notes;
        const LandmarkSet places = landmarks_of({mesh, set});
        EXPECT_EQ(places.notes.size(), 2U);
        const std::string text = landmarks_to_text(places, format, "m.ply", {}, notes, {});
        const auto placed = place_landmarks(mesh, landmarks_from_text(text, format, "f"), "f");
        std::vector<Index> before, after;
        for (const auto& a : set.annotations) before.insert(before.end(), a.points.begin(), a.points.end());
        for (const auto& a : placed.set.annotations) after.insert(after.end(), a.points.begin(), a.points.end());
        EXPECT_EQ(after, before);
        for (const PlacedAnnotation& placement : placed.placements) EXPECT_EQ(placement.to_vertex, 0);
        if (format == LandmarkFormat::csv) {  // keeps ids, so that points of one annotation stay together
            ASSERT_NE(placed.set.find(3), nullptr);
            const auto several = std::find_if(set.annotations.begin(), set.annotations.end(),
                                              [](const Annotation& a) { return a.tag == "several"; });
            EXPECT_EQ(placed.set.find(several->id)->points, several->points);
        }
        if (format == LandmarkFormat::mrk) {
            std::vector<std::vector<Index>> lines, expected;
            for (const auto& a : set.annotations) expected.insert(expected.end(), a.polylines.begin(), a.polylines.end());
            for (const auto& a : placed.set.annotations) lines.insert(lines.end(), a.polylines.begin(), a.polylines.end());
            EXPECT_EQ(lines, expected);
        }
    }
}

TEST(Landmarks, FarPointsAreRefusedOrSkipped) {
    const Mesh mesh = spheres(3, {{100, 200, 0}});
    LandmarkSet set;
    set.landmarks = {{"near", {101.001, 200, 0}, {}}, {"far", {101, 203, 0}, {}}};
    const std::string refusal = message([&] { place_landmarks(mesh, set, "file"); });
    EXPECT_NE(refusal.find("1 point of 2"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("'far'"), std::string::npos) << refusal;
    PlaceOptions skip;
    skip.skip_far = true;
    const auto placed = place_landmarks(mesh, set, "file", skip);
    ASSERT_EQ(placed.set.annotations.size(), 1U);
    EXPECT_NEAR(placed.placements[0].to_surface, 0.001, 1e-9);
    EXPECT_EQ(placed.set.notes.size(), 1U);
    // The other space would fit, which the message reports.
    for (Landmark& landmark : set.landmarks) landmark.position = {-101, -200, 0};
    EXPECT_NE(message([&] { place_landmarks(mesh, set, "file"); }).find("--mesh-space"), std::string::npos);
    // In case of a tie, the lower index.
    const Mesh tile = grid(2);
    LandmarkSet middle;
    middle.landmarks = {{"m", {0.5, 0.5, 0}, {}}};
    EXPECT_EQ(place_landmarks(tile, middle, "f").set.annotations[0].points, std::vector<Index>{0});
}

TEST(Landmarks, NearestVertexEqualsBruteForce) {
    const Mesh mesh = spheres(4, {{0, 0, 0}, {1.5, 0, 0}});
    LandmarkSet set;
    for (int i = 0; i < 500; ++i)
        set.landmarks.push_back({"p", {std::sin(i * 0.7) * 2, std::cos(i * 1.3), std::sin(i * 2.1 + 1)}, {}});
    PlaceOptions wide;
    wide.tolerance = 1;
    const auto placed = place_landmarks(mesh, set, "f", wide);
    for (std::size_t i = 0; i < set.landmarks.size(); ++i) {
        const auto& p = set.landmarks[i].position;
        Index best = 0;
        for (const Vertex v : mesh.vertices())
            if (CGAL::squared_distance(mesh.point(v), Point(p[0], p[1], p[2])) <
                CGAL::squared_distance(mesh.point(Vertex(best)), Point(p[0], p[1], p[2])))
                best = v;
        EXPECT_EQ(placed.set.annotations[i].points, std::vector<Index>{best});
    }
}

TEST(Landmarks, DegenerateInput) {
    const Mesh mesh = spheres(1);
    EXPECT_TRUE(place_landmarks(mesh, {}, "f").set.annotations.empty());
    EXPECT_NE(message([&] { place_landmarks(Mesh(), {}, "f"); }), "");
    for (const LandmarkFormat format : all_formats) {
        EXPECT_EQ(landmarks_from_text(written({}, format), format, "f").landmarks.size(), 0U);
        EXPECT_EQ(message([&] { landmarks_from_text("", format, "f"); }).empty(), format == LandmarkFormat::fcsv);
    }
    EXPECT_NE(message([] { landmarks_from_text("a,b\n\"x", LandmarkFormat::csv, "f"); }).find("line 2"), std::string::npos);
    for (const double scale : {1e-9, 1e9}) {
        const Mesh scaled = spheres(2, {{0, 0, 0}}, scale);
        LandmarkSet set;
        set.landmarks = {{"top", {0, 0, scale}, {}}};
        EXPECT_EQ(place_landmarks(scaled, set, "f").placements[0].to_vertex, 0);
    }
}

TEST(Landmarks, DamagedFilesAreRefusedWithAMessage) {
    const Mesh mesh = spheres(2);
    LandmarkSet set = landmarks_of({spheres(3), wild_set(spheres(3))});
    for (const LandmarkFormat format : all_formats) {
        const std::string text = written(set, format);
        std::size_t successes = 0;
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            try {
                PlaceOptions skip;
                skip.skip_far = true;
                place_landmarks(mesh, landmarks_from_text(test::mutate(text, seed), format, "f"), "f", skip);
                ++successes;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
                EXPECT_FALSE(error.problem().empty());
            }
        }
        EXPECT_LT(successes, 200U);
    }
}

TEST(Landmarks, FormulasAreEscapedWhereverACellMayBegin) {
    const auto marked = [](const std::string& name) {
        LandmarkSet set;
        set.landmarks.push_back({name, {}, {}});
        const std::string text = written(set, LandmarkFormat::csv);
        EXPECT_EQ(landmarks_from_text(text, LandmarkFormat::csv, "file").landmarks.at(0).name, name);
        return text.find(",\"'" + name) != std::string::npos;
    };
    for (const std::string blank : {"", " ", ";", "a;", "a; ", "a\t", "\xC2\xA0", "a\xC2\xA0 ", "\xE3\x80\x80", "\xE2\x80\x8B",
                                    "\xEF\xBB\xBF", "b\xE2\x80\xA8", "\xC2\x85", "''"})
        for (const std::string sign :
             {"=", "+", "-", "@", "\xEF\xB9\xA3", "\xE2\x88\x92", "\xEF\xBC\x9D", "\xEF\xBC\x8B", "\xEF\xBC\x8D", "\xEF\xBC\xA0"})
            EXPECT_TRUE(marked(blank + sign + "x")) << blank << sign;
    for (const std::string plain : {"a", "a - b", "a=b", "half-way", "o'clock", "'a'", "a;b", "\xC2\xA0 a", "3 + 4"})
        EXPECT_FALSE(marked(plain)) << plain;
}

TEST(Landmarks, PositionsOutOfRangeAreRefusedWithTheirLine) {
    const auto refused = [](const std::string& text, LandmarkFormat format, const std::string& location) {
        const std::string text_of_error = message([&] { (void)landmarks_from_text(text, format, "file"); });
        EXPECT_NE(text_of_error.find("file, " + location), std::string::npos) << text_of_error;
        EXPECT_NE(text_of_error.find("1e+60"), std::string::npos) << text_of_error;
    };
    for (const std::string huge : {"2e307", "-1.7e308", "1.1e60"}) {
        refused("name,x,y,z\na,0,0,0\nb,0," + huge + ",0\n", LandmarkFormat::csv, "line 3");
        refused("# CoordinateSystem = LPS\n# columns = id,x,y,z\n1," + huge + ",0,0\n", LandmarkFormat::fcsv, "line 3");
        refused("<PickedPoints><point x=\"0\" y=\"0\" z=\"" + huge + "\" name=\"a\"/></PickedPoints>", LandmarkFormat::pp,
                "point 1");
        refused(R"({"markups": [{"type": "Fiducial", "controlPoints": [{"label": "a", "position": [0, 0, )" + huge + "]}]}]}",
                LandmarkFormat::mrk, "at /markups/0/controlPoints/0/position");
        refused("LM3=2\n0 0 0\n" + huge + " 0 0\n", LandmarkFormat::tps, "line 3");
    }
    refused("LM3=1\n1e200 0 0\nSCALE=1e200\n", LandmarkFormat::tps, "line 2");
    EXPECT_EQ(landmarks_from_text("LM3=1\n1e200 0 0\nSCALE=1e-200\n", LandmarkFormat::tps, "file").landmarks[0].position[0], 1);
    LandmarkSet set;
    set.landmarks.push_back({"a", {1e300, 0, 0}, {}});
    EXPECT_NE(message([&] { (void)place_landmarks(spheres(2), set, "file"); }).find("1e+60"), std::string::npos);
}

#include "ostraka/shape_classes/landmark_class.h"
#include "ostraka/files/json.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/shape_classes/class_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

Landmarks read_rows(const Path& file) {
    const LandmarkSet set = read_landmarks(file, LandmarkFormat::mrk);
    Landmarks rows(static_cast<Eigen::Index>(set.landmarks.size()), 3);
    for (std::size_t i = 0; i < set.landmarks.size(); ++i)
        rows.row(static_cast<Eigen::Index>(i)) << set.landmarks[i].position[0], set.landmarks[i].position[1],
            set.landmarks[i].position[2];
    return rows;
}

/// The eight corners of a box of given width, with its landmarks listed from `first`.
void write_box(const Path& file, double width, const Motion& motion = {}, int first = 0, int count = 8) {
    LandmarkSet set;
    set.unit = "mm";
    for (int k = 0; k < count; ++k) {
        const int i = (k + first) % 8;
        const Eigen::Vector3d p = motion(Eigen::Vector3d(i & 1 ? width : 0, i & 2 ? 1 : 0, i & 4 ? 3 : 0));
        set.landmarks.push_back({"corner " + std::to_string(i), {p.x(), p.y(), p.z()}, {}});
    }
    std::vector<std::string> notes;
    write_file(file, landmarks_to_text(set, LandmarkFormat::mrk, "", Provenance{"test", {}, {}}, notes));
}

Motion far_away() {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 1, -2).normalized()).toRotationMatrix();
    motion.translation = Eigen::Vector3d(1e4, 0, -3e3);
    motion.scale = 7;
    return motion;
}

TEST(LandmarkClass, IsLearntAndQueriedWithoutASurface) {
    const Scratch scratch;
    write_box(scratch / "a.mrk.json", 1.9);
    write_box(scratch / "b.mrk.json", 2.0, far_away(), 3);  // other order, place, size
    write_box(scratch / "c.mrk.json", 2.1);
    write_box(scratch / "d.mrk.json", 2.05);
    const auto learnt = run_command("template learn " + quoted(scratch / "a.mrk.json") + " " + quoted(scratch / "b.mrk.json") +
                                    " " + quoted(scratch / "c.mrk.json") + " " + quoted(scratch / "d.mrk.json") +
                                    " --name box --output " + quoted(scratch / "class"));
    ASSERT_EQ(learnt.code, 0) << learnt.err;
    validate(read_json(scratch / "class" / "box.class.json"), "class", "class");
    const ShapeClass box = read_class(scratch / "class" / "box.class.json");
    EXPECT_EQ(box.members.size(), 4U) << "the first file is a member, too";
    EXPECT_LT(box.modes.variances.size(), 4U);
    EXPECT_GT(box.modes.variances[0] / box.modes.total, 0.999) << "they differ in width alone";
    const Landmarks mean = read_rows(scratch / "class" / "box.mean.mrk.json");
    EXPECT_NEAR((mean - box.modes.mean).norm(), 0, 1e-6 * box.modes.mean.norm()) << "the mean stands in both files";

    write_box(scratch / "good.mrk.json", 1.95, far_away());
    write_box(scratch / "bad.mrk.json", 6);
    const std::string ask = "template classify " + quoted(scratch / "class" / "box.class.json") + " ";
    EXPECT_EQ(run_command(ask + quoted(scratch / "good.mrk.json")).code, 0);
    const auto bad = run_command(ask + quoted(scratch / "bad.mrk.json"));
    EXPECT_EQ(bad.code, 3);
    EXPECT_NE(bad.out.find("from the mean shape"), std::string::npos) << bad.out;

    // Unusual files are named, and an unreadable one does not stop the others.
    LearntMember object = read_landmark_member(scratch / "good.mrk.json", read_landmark_template(scratch / "good.mrk.json"));
    EXPECT_TRUE(compare_with(box, object).unusual_findings.empty());
    for (::ostraka::Point& p : object.fit.points) p = ::ostraka::Point(10 * p.x(), 10 * p.y(), 10 * p.z());
    ASSERT_EQ(compare_with(box, object).unusual_findings.size(), 1U);
    EXPECT_NE(compare_with(box, object).unusual_findings[0].find("times as large"), std::string::npos);
    for (::ostraka::Point& p : object.fit.points) p = ::ostraka::Point(-p.x() / 10, p.y() / 10, p.z() / 10);
    ASSERT_EQ(compare_with(box, object).unusual_findings.size(), 1U);
    EXPECT_NE(compare_with(box, object).unusual_findings[0].find("mirror image"), std::string::npos);
    write_box(scratch / "short.mrk.json", 2, {}, 0, 7);
    const auto several = run_command(ask + quoted(scratch / "short.mrk.json") + " " + quoted(scratch / "good.mrk.json"));
    EXPECT_EQ(several.code, 3);
    EXPECT_NE(several.err.find("corner 7"), std::string::npos) << several.err;
    EXPECT_NE(several.out.find("good belongs to 'box'"), std::string::npos) << several.out;
}

TEST(LandmarkClass, MissingLandmarksAreNamed) {
    const Scratch scratch;
    write_box(scratch / "a.mrk.json", 2);
    write_box(scratch / "short.mrk.json", 2, {}, 0, 7);
    const std::string out = " --output " + quoted(scratch / "class");
    const auto missing =
        run_command("template learn " + quoted(scratch / "a.mrk.json") + " " + quoted(scratch / "short.mrk.json") + out);
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find("short.mrk.json"), std::string::npos) << missing.err;
    EXPECT_NE(missing.err.find("corner 7"), std::string::npos) << missing.err;
    const auto mixed =
        run_command("template learn " + quoted(scratch / "a.mrk.json") + " " OSTRAKA_SOURCE_DIR "/data/vase.ply" + out);
    EXPECT_EQ(mixed.code, 1);
    EXPECT_NE(mixed.err.find("vase.ply"), std::string::npos) << mixed.err;
    const auto out_of_class = run_command("template learn " + quoted(scratch / "a.mrk.json") + " --out-of-class " +
                                          quoted(scratch / "short.mrk.json") + out);
    EXPECT_EQ(out_of_class.code, 2);
    EXPECT_NE(out_of_class.err.find("classes of meshes"), std::string::npos) << out_of_class.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "class")) << "nothing is written by what fails";
    // With one member nothing can be refused or sampled.
    ASSERT_EQ(run_command("template learn " + quoted(scratch / "a.mrk.json") + out).code, 0);
    const Path alone = scratch / "class" / "landmarks.class.json";
    const auto classified = run_command("template classify " + quoted(alone) + " " + quoted(scratch / "a.mrk.json"));
    EXPECT_EQ(classified.code, 3);
    EXPECT_NE(classified.out.find("cannot decide, because"), std::string::npos) << classified.out;
    const auto drawn = run_command("template sample " + quoted(alone) + " --output " + quoted(scratch / "drawn"));
    EXPECT_EQ(drawn.code, 1);
    EXPECT_NE(drawn.err.find("landmarks"), std::string::npos) << drawn.err;
}

TEST(LandmarkClass, MeanOfTheMouseSkullsMatchesThePublishedMean) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "landmarks-mouse-skulls" / "LMs";
    if (!std::filesystem::is_directory(folder)) {
        std::cerr << "SKIPPED: " << folder << " is not there, the mean of the mouse skulls is not compared\n";
        GTEST_SKIP();
    }
    const Scratch scratch;
    std::string files;
    std::vector<Path> skull_files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) skull_files.push_back(entry.path());
    std::sort(skull_files.begin(), skull_files.end());
    std::vector<Landmarks> skulls;
    for (const Path& file : skull_files) {
        files += " " + quoted(file);
        skulls.push_back(read_rows(file));
    }
    ASSERT_EQ(skulls.size(), 31U);
    for (const bool sizes : {true, false}) {
        const auto learnt = run_command("template learn" + files + " --name mouse --output " + quoted(scratch / "class") +
                                        (sizes ? " --sizes" : "") + " --quiet");
        ASSERT_EQ(learnt.code, 0) << learnt.err;
        const ShapeModes modes = read_class(scratch / "class" / "mouse.class.json").modes;
        const GeneralisedProcrustes expected = generalised_procrustes(skulls, {.scaling = !sizes});
        EXPECT_NEAR(modes.mean_size, 43.93584448, 1e-8 * 43.93584448);
        // The mean of the class has the orientation of the first file.
        const double norm = modes.mean.norm(), goal = expected.mean.norm();
        EXPECT_NEAR(procrustes(modes.mean / norm, expected.mean / goal).sum_of_squares, 0, 1e-16);
        const double remaining_variance = 30 * modes.total;
        if (sizes) {
            EXPECT_NEAR(norm, 43.9042953, 1e-8 * 43.9042953);
            EXPECT_NEAR(remaining_variance, 233.5286065, 1e-8 * 233.5286065);
        } else {
            // Squares are taken about the mean of the members there, about the mean brought to size 1 in the published figure.
            const double short_of_one = 1 - norm / modes.mean_size;
            EXPECT_NEAR(remaining_variance / (modes.mean_size * modes.mean_size) + 31 * short_of_one * short_of_one,
                        0.04497425199, 1e-8 * 0.04497425199);
        }
    }
}

}  // namespace
}  // namespace ostraka

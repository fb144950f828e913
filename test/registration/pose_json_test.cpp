// Motions read from files.
#include "ostraka/registration/pose_json.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "scratch.h"

#include <Eigen/Geometry>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Motion some_motion(double scale) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
    motion.translation = {512345.25, -7, 0.125};
    motion.scale = scale;
    return motion;
}

Eigen::Matrix4d matrix_of(const Motion& motion) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = motion.scale * motion.rotation;
    matrix.topRightCorner<3, 1>() = motion.translation;
    return matrix;
}

std::string refusal(const Eigen::Matrix4d& matrix) {
    try {
        (void)motion_of_matrix(matrix, "m");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

std::string refusal_of_file(const Path& file, const std::string& name = {}) {
    try {
        (void)read_motion(file, name);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return {};
}

std::string json_of(const Motion& motion) {
    Json document;
    return to_text(pose_to_json(motion, document.GetAllocator()));
}

}  // namespace

TEST(StoredMotion, EveryFormOfFileGivesTheSameMotion) {
    const Scratch scratch;
    for (const double scale : {1.0, 0.001, 25.4}) {
        const Motion motion = some_motion(scale);
        const Eigen::Matrix4d m = matrix_of(motion);
        std::string text, flat = "[";
        for (int i = 0; i < 16; ++i) {
            const std::string number = digits(m(i / 4, i % 4));
            text += number + (i % 4 == 3 ? "\n" : i % 2 == 0 ? " " : ",\t");
            flat += (i == 0 ? "" : ",") + number;
        }
        const std::string rows = json_of(motion);
        for (const std::string& content :
             {text, flat + "]", rows, R"({"matrix": )" + rows + "}", R"({"result": {"pose": )" + rows + "}}",
              R"({"fragments": [{"name": "other"}, {"name": "rim", "pose": )" + rows + "}]}"}) {
            const StoredMotion read = read_motion(scratch.file("m", content), "rim");
            EXPECT_NEAR(read.motion.scale / scale, 1, 1e-15);
            EXPECT_LT((read.motion.rotation - motion.rotation).cwiseAbs().maxCoeff(), 1e-15);
            EXPECT_EQ(read.motion.translation, motion.translation);
            EXPECT_TRUE(read.notes.empty());
        }
    }
    const StoredMotion units =
        read_motion(scratch.file("u", R"({"matrix": )" + json_of(Motion()) + R"(, "unitBefore": "mm", "unitAfter": "m"})"));
    EXPECT_EQ(units.unit_before + units.unit_after, "mmm");
}

TEST(StoredMotion, ExchangesOfAxesAndReflectionsAreExact) {
    for (const double scale : {1.0, 25.4, 1e-3, 0.1})
        for (int k = 0; k < 48; ++k) {
            std::array<int, 3> order{0, 1, 2};
            for (int i = 0; i < k / 8; ++i) std::next_permutation(order.begin(), order.end());
            Motion motion;
            motion.scale = scale;
            motion.rotation.setZero();
            for (int row = 0; row < 3; ++row) motion.rotation(row, order[row]) = (k >> row & 1) != 0 ? -1 : 1;
            motion.translation = {1, 2, 3};
            EXPECT_EQ(motion_of_matrix(matrix_of(motion), "m").motion, motion);
        }
    const Eigen::Matrix3d mirror = some_motion(1).rotation * Eigen::Vector3d(1, 1, -1).asDiagonal();
    EXPECT_TRUE(motion_of_matrix(matrix_of({mirror, {0, 0, 0}, 2}), "m").motion.mirrors());
}

TEST(StoredMotion, MatricesWithFewDigitsBecomeTheNearestRotation) {
    Motion motion = some_motion(1);
    Eigen::Matrix4d rounded = matrix_of(motion);
    rounded.topLeftCorner<3, 3>() = (1e6 * rounded.topLeftCorner<3, 3>()).array().round() / 1e6;
    const StoredMotion read = motion_of_matrix(rounded, "m");
    EXPECT_EQ(read.motion.scale, 1) << "the rounding of a rotation is no change of size";
    EXPECT_LT((read.motion.rotation * read.motion.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((read.motion.rotation - motion.rotation).norm(), 3e-6);
    EXPECT_EQ(read.notes.size(), 1U);
}

TEST(StoredMotion, RefusesWhatIsNoMotion) {
    Eigen::Matrix4d m = matrix_of(some_motion(1));
    EXPECT_EQ(refusal(m), "");
    m.row(0) *= 1.01;
    EXPECT_NE(refusal(m).find("unequally"), std::string::npos) << refusal(m);
    m = Eigen::Matrix4d::Identity();
    m(0, 1) = 0.5;
    EXPECT_NE(refusal(m).find("shears"), std::string::npos);
    m = matrix_of(some_motion(1)).transpose();
    EXPECT_NE(refusal(m).find("last row"), std::string::npos);
    for (const double last : {0.0, 1e-200}) {
        m = Eigen::Matrix4d::Identity();
        m(2, 2) = last;
        EXPECT_NE(refusal(m).find("no inverse"), std::string::npos) << last;
    }
    m.topLeftCorner<3, 3>().setZero();
    EXPECT_NE(refusal(m).find("no inverse"), std::string::npos);
    m(1, 1) = std::numeric_limits<double>::infinity();
    EXPECT_NE(refusal(m).find("not finite"), std::string::npos);
    const Scratch scratch;
    const std::string rows = json_of(Motion());
    for (const auto& [content, words] : std::vector<std::pair<std::string, std::string>>{
             {"", "0 numbers"},
             {"1 2 3", "3 numbers"},
             {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 x", "'x' is not a number"},
             {"[1, 2, 3]", "no 4 x 4 matrix"},
             {"{}", "no 4 x 4 matrix"},
             {R"({"matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,"1"]]})", "no 4 x 4 matrix"},
             {R"({"fragments": [{"name": "rim", "problem": "flat"}]})", "has no pose"},
             {R"({"fragments": [{"name": "foot", "pose": )" + rows + "}]}", "foot"},
             {"[[", "line 1"}})
        EXPECT_NE(refusal_of_file(scratch.file("m", content), "rim").find(words), std::string::npos)
            << content << ": " << refusal_of_file(scratch.file("m", content), "rim");
    // Cut off anywhere, a matrix is refused, or (text) has as many numbers as a whole one.
    for (std::size_t length = 0; length + 1 < rows.size() - 2; ++length)
        EXPECT_NE(refusal_of_file(scratch.file("m", rows.substr(0, length))), "") << length;
}

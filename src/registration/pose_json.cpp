#include "ostraka/registration/pose_json.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr const char* matrix_remedy =
    "give 16 numbers, row by row, or JSON as 'ostraka mesh register --matrix' and 'mesh move --transform' write it";

/// If each row has exactly one entry other than zero, and all these have the same absolute value: this value and the signs. Such
/// a matrix needs no rounding.
std::optional<Motion> exchange_of_axes(const Eigen::Matrix3d& linear) {
    Motion motion;
    motion.rotation.setZero();
    motion.scale = linear.cwiseAbs().maxCoeff();
    for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) {
            if (linear(row, k) == 0) continue;
            if (std::abs(linear(row, k)) != motion.scale) return std::nullopt;
            motion.rotation(row, k) = linear(row, k) > 0 ? 1 : -1;
        }
    if (motion.rotation * motion.rotation.transpose() != Eigen::Matrix3d::Identity()) return std::nullopt;
    return motion;
}

/// The 16 numbers of a JSON array of 16 numbers, or of four arrays of four numbers; none for any other value.
std::optional<std::vector<double>> matrix_numbers(const JsonValue& value) {
    std::vector<double> numbers;
    if (!value.IsArray() || (value.Size() != 4 && value.Size() != 16)) return std::nullopt;
    for (const auto& row : value.GetArray()) {
        if (value.Size() == 16 ? !row.IsNumber() : !row.IsArray() || row.Size() != 4) return std::nullopt;
        if (row.IsNumber()) numbers.push_back(row.GetDouble());
        else
            for (const auto& entry : row.GetArray()) {
                if (!entry.IsNumber()) return std::nullopt;
                numbers.push_back(entry.GetDouble());
            }
    }
    return numbers;
}

/// The pose of one fragment in an assembly.
const JsonValue& pose_in_assembly(const JsonValue& fragments, const std::string& name, const std::string& file) {
    std::vector<std::string> names;
    for (const auto& fragment : fragments.GetArray()) {
        if (!fragment.IsObject()) continue;
        names.push_back(text_in(fragment, "name"));
        if (names.back() != name) continue;
        if (const JsonValue* pose = find_member(fragment, "pose")) return *pose;
        fail_input(file, fmt::format("has no pose of the fragment '{}'", printable(name, 60)), "it was not placed");
    }
    fail_input(file, fmt::format("has no fragment '{}'", printable(name, 60)),
               "name the mesh file as the fragment: " + printable(joined(names), 200));
}

/// The value that holds the matrix: the document itself, or a member.
const JsonValue& matrix_in(const JsonValue& document, const std::string& name, const std::string& file) {
    if (!document.IsObject()) return document;
    for (const char* member : {"matrix", "pose"})
        if (const JsonValue* matrix = find_member(document, member)) return *matrix;
    if (const JsonValue* fragments = find_member(document, "fragments"); fragments != nullptr && fragments->IsArray())
        return pose_in_assembly(*fragments, name, file);
    if (const JsonValue* result = find_member(document, "result"); result != nullptr && result->IsObject())
        for (const char* member : {"matrix", "pose"})
            if (const JsonValue* matrix = find_member(*result, member)) return *matrix;
    return document;
}

std::vector<double> numbers_of_text(const std::string& text, const std::string& file) {
    const auto words = split_words(text, " \t\r\n,;");
    if (words.size() != 16) fail_input(file, fmt::format("has {} numbers instead of 16", words.size()), matrix_remedy);
    std::vector<double> numbers;
    for (const std::string_view word : words) {
        const auto number = number_of(word);
        if (!number) fail_input(file, fmt::format("'{}' is not a number", printable(std::string(word), 40)), matrix_remedy);
        numbers.push_back(*number);
    }
    return numbers;
}

Eigen::Matrix4d matrix_of(const std::vector<double>& numbers) {
    return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
}

}  // namespace

JsonValue pose_to_json(const Motion& pose, JsonAllocator& allocator) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = pose.scale * pose.rotation;
    matrix.topRightCorner<3, 1>() = pose.translation;
    return json_list(matrix.rowwise(), allocator, [&](const auto& row) { return json_value(row, allocator); });
}

StoredMotion motion_of_matrix(const Eigen::Matrix4d& matrix, const std::string& where) {
    if (!matrix.allFinite()) fail_input(where, "has a number that is not finite", matrix_remedy);
    if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-12)
        fail_input(where, "the last row of the matrix is not 0 0 0 1",
                   "give the matrix row by row: its last column is the translation");
    const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
    StoredMotion stored;
    const double largest = linear.cwiseAbs().maxCoeff();
    if (const auto exchange = largest > 0 ? exchange_of_axes(linear) : std::nullopt) {
        stored.motion = *exchange;
    } else {
        const Svd3 svd(largest > 0 ? Eigen::Matrix3d(linear / largest) : linear);
        const Eigen::Vector3d stretches = svd.singularValues();
        if (!(largest > 0) || !(stretches[2] > 1e-12 * stretches[0]))
            fail_input(where, "the matrix has no inverse: it makes the object flat",
                       "give a rotation, a scale and a translation");
        const double deviation = (stretches[0] - stretches[2]) / stretches[0];
        if (deviation > 1e-5)
            fail_input(where,
                       fmt::format("the matrix shears the object, or scales it unequally: by factors from {} to {}",
                                   digits(largest * stretches[2], 6), digits(largest * stretches[0], 6)),
                       "give a rotation, one scale for all directions and a translation: measures would have no meaning");
        stored.motion.rotation = svd.matrixU() * svd.matrixV().transpose();
        stored.motion.scale = largest * stretches.mean();
        // The rounding of a rotation matrix is no change of size.
        if (std::abs(stored.motion.scale - 1) < std::max(1e-14, 2 * deviation)) stored.motion.scale = 1;
        if (deviation > 1e-9)
            stored.notes.push_back(
                fmt::format("the matrix is a rotation and a scale up to {}: the nearest one is used", digits(deviation, 2)));
    }
    stored.motion.translation = matrix.topRightCorner<3, 1>();
    return stored;
}

StoredMotion read_motion(const Path& file, const std::string& name) {
    const std::string path = file.string(), bytes = read_file(file);
    const std::string_view text = trimmed(bytes);
    if (text.empty() || (text.front() != '[' && text.front() != '{'))
        return motion_of_matrix(matrix_of(numbers_of_text(bytes, path)), path);
    const Json document = parse_json(bytes, path);
    const auto numbers = matrix_numbers(matrix_in(document, name, path));
    if (!numbers) fail_input(path, "has no 4 x 4 matrix", matrix_remedy);
    StoredMotion stored = motion_of_matrix(matrix_of(*numbers), path);
    if (document.IsObject()) {
        stored.unit_before = text_in(document, "unitBefore");
        stored.unit_after = text_in(document, "unitAfter");
    }
    return stored;
}

}  // namespace ostraka

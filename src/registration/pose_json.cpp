#include "ostraka/registration/pose_json.h"

#include "ostraka/files/json_build.h"

namespace ostraka {

JsonValue pose_to_json(const Motion& pose, JsonAllocator& allocator) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = pose.scale * pose.rotation;
    matrix.topRightCorner<3, 1>() = pose.translation;
    return json_list(matrix.rowwise(), allocator, [&](const auto& row) { return json_value(row, allocator); });
}

}  // namespace ostraka

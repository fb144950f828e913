#include "ostraka/registration/pose_json.h"

namespace ostraka {

JsonValue pose_to_json(const Motion& pose, JsonAllocator& allocator) {
    JsonValue rows(rapidjson::kArrayType);
    for (int i = 0; i < 4; ++i) {
        JsonValue row(rapidjson::kArrayType);
        for (int j = 0; j < 4; ++j)
            row.PushBack(i == 3   ? (j == 3 ? 1.0 : 0.0)
                         : j == 3 ? pose.translation[i]
                                  : pose.scale * pose.rotation(i, j),
                         allocator);
        rows.PushBack(row, allocator);
    }
    return rows;
}

}  // namespace ostraka

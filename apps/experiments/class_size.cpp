// Number of members a class needs: synthetic classes learnt from increasing numbers.
#include "class_leave_one_out.h"

#include <filesystem>
#include <iostream>

namespace ostraka::experiments {

void class_size(const ClassSizeOptions& options) {
    constexpr std::size_t most = 20, asked = 5;
    std::vector<ClassObject> objects = made_classes(most + 1, asked, options.seed, options.vertices);
    for (ClassObject& object : objects) object.whole = measure_whole_shape(object.member.mesh);
    ClassMembershipOptions how;
    how.output = options.output;
    std::filesystem::create_directories(how.output);
    LeaveOneOut membership(objects, how);
    membership.fit(how);
    for (const bool shared : {true, false}) membership.ask_at_rates(0, shared, {3, 5, 10, most}, {0.02, 0.05, 0.1, 0.2, 0.5});
}

}  // namespace ostraka::experiments

// Classification of the objects of a benchmark.
#include "class_leave_one_out.h"

#include <filesystem>

namespace ostraka::experiments {

void class_membership(const ClassMembershipOptions& options) {
    std::vector<ClassObject> objects = read_class_objects(options.models, options.members);
    for (ClassObject& object : objects) {
        object.whole = measure_whole_shape(object.member.mesh);
        object.original = object.member.mesh;
        object.member.mesh = of_vertices(object.original, options.object_vertices);
        if (options.labels.empty()) continue;
        const std::string number = object.member.name.substr(object.class_name.size() + 1);
        object.labels = typical_labels(Path(options.labels) / object.class_name / number, object.original);
        object.member.annotations = parts_on(object.member.mesh, object.original, object.labels);
    }
    std::filesystem::create_directories(options.output);
    LeaveOneOut membership(objects, options);
    membership.fit(options);
    const std::vector<ClassObject> made = made_strangers();
    for (std::size_t arm = 0; arm < (options.labels.empty() ? 1 : 3); ++arm) {
        for (const Way& way :
             {Way{}, Way{true, false}, Way{false, true}, Way{false, false}, Way{true, true, true}, Way{true, true, false, 3}})
            membership.ask(arm, way, options);
        membership.ask_made(made, arm);
        if (arm == 0) membership.ask_at_rates(arm, true, {3, every}, {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5});
    }
}

}  // namespace ostraka::experiments

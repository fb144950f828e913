// Classification of the objects of a benchmark, and the number of members that a class needs.
#include "class_leave_one_out.h"

namespace ostraka::experiments {

namespace {

struct ClassMembershipOptions : FitSettings {
    std::string models, labels;
    std::uint64_t members = 1000;
    void list_options(OptionList& list) {
        list("models", models, "folder with <class>/<number>.off").positional().required();
        FitSettings::list_options(list);
        list("labels", labels, "folder with <class>/<number>/*.seg");
        list("members", members, "max number of members of each class");
        list("vertices", template_vertices, "number of vertices of the templates");
        list("object-vertices", object_vertices, "max number of vertices of the objects");
        list("tries", tries, "number of placements that are fitted", Range{1, 5});
        list("search-radius", search_radius, "search radius of the first level, as a share of the diagonal");
    }
};

/// Templates are fitted to the models of a benchmark, and each model is left out when its class is learnt.
void class_membership(const ClassMembershipOptions& options) {
    std::vector<ClassObject> objects = read_class_objects(options.models, options.members);
    for (ClassObject& object : objects) {
        object.whole = measure_whole_shape(object.member.mesh);
        object.original = object.member.mesh;
        object.member.mesh = simplified(object.original, options.object_vertices);
        if (options.labels.empty()) continue;
        const std::string number = object.member.name.substr(object.class_name.size() + 1);
        object.labels = typical_labels(Path(options.labels) / object.class_name / number, object.original);
        object.member.annotations = parts_on(object.member.mesh, object.original, object.labels);
    }
    LeaveOneOut membership(objects, options);
    const std::vector<ClassObject> made = made_strangers();
    for (std::size_t arm = 0; arm < (options.labels.empty() ? 1 : 3); ++arm) {
        for (const Way& way :
             {Way{}, Way{true, false}, Way{false, true}, Way{false, false}, Way{true, true, true}, Way{true, true, false, 3}})
            membership.ask(arm, way);
        membership.ask_made(made, arm);
        if (arm == 0) membership.ask_at_rates(arm, true, {3, every}, {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5});
    }
}

struct ClassSizeOptions {
    std::string output = "experiments-output/class-size";
    std::uint64_t vertices = 4000, seed = 1;
    void list_options(OptionList& list) {
        list("output", output, "output folder");
        list("vertices", vertices, "number of vertices of each object; thin handles need about 4000");
        list("seed", seed, "random seed of the variation between members");
    }
};

/// Eight synthetic classes whose members differ in proportions, taper and bend, learnt from increasing numbers of members.
void class_size(const ClassSizeOptions& options) {
    constexpr std::size_t most = 20, asked = 5;
    std::vector<ClassObject> objects = made_classes(most + 1, asked, options.seed, options.vertices);
    for (ClassObject& object : objects) object.whole = measure_whole_shape(object.member.mesh);
    FitSettings settings;
    settings.output = options.output;
    LeaveOneOut membership(objects, settings);
    for (const bool shared : {true, false}) membership.ask_at_rates(0, shared, {3, 5, 10, most}, {0.02, 0.05, 0.1, 0.2, 0.5});
}

const Registration registered_classes("classes", "which class an object belongs to, leave one out", class_membership);
const Registration registered_size("class-size", "how many members a class needs, of made ones", class_size);

}  // namespace

}  // namespace ostraka::experiments

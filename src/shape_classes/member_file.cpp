#include "ostraka/shape_classes/member_file.h"

#include "ostraka/core/error.h"
#include "ostraka/shape_classes/fragment_thresholds.h"

#include <fmt/core.h>

#include <set>

namespace ostraka {

std::string object_name(const Path& file) {
    const std::string name = file.filename().string(), double_ending = ".mrk.json";
    if (name.ends_with(double_ending)) return name.substr(0, name.size() - double_ending.size());
    return file.stem().string();
}

void check_object_names(const std::vector<std::string>& files) {
    std::set<std::string> names_found;
    for (const std::string& file : files)
        if (!names_found.insert(object_name(file)).second)
            fail_usage(fmt::format("two objects are called '{}'", object_name(file)), "rename one of the files");
}

WholeObject read_member(const Path& file) {
    if (is_folder(file)) fail_input(file.string(), "is a folder", "name the mesh files in it");
    WholeObject member;
    member.name = object_name(file);
    member.mesh = read_mesh(file).mesh;
    const Path annotations = file.parent_path() / (member.name + ".ant.json");
    if (file_exists(annotations)) member.annotations = read_annotations(annotations, member.mesh);
    return member;
}

ClassTemplate class_template(const Template& package) {
    static const AnnotationSet no_annotations;
    static const RelationGraph no_relations;
    return {{package.mesh->mesh, package.annotations ? *package.annotations : no_annotations},
            package.graph ? *package.graph : no_relations};
}

ClassWithTemplate read_class_with_template(const Path& file) {
    ClassWithTemplate result;
    result.learnt = read_class(file);
    const std::string& template_file = result.learnt.template_file;
    if (is_landmark_file(template_file)) {
        result.landmarks = read_landmark_template(template_file);
    } else {
        result.package = load_template(read_template(template_file));
        check_usable(result.package, template_file);
    }
    check_topology(result.learnt, file.string(), result.known().mesh, template_file);
    return result;
}

}  // namespace ostraka

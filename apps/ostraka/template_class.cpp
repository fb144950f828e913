#include "template_class.h"

#include "template_landmarks.h"

#include <set>

namespace ostraka::app {

LoadedTemplate load_class_template(const std::string& file, Provenance& provenance) {
    if (is_landmark_file(file))
        fail_input(file, "is a file of landmarks, and a template with a mesh is needed",
                   "classes of landmarks can be learnt and asked, no more");
    LoadedTemplate result;
    result.file = read_template(file);
    provenance.add_input(file);
    for (const TemplatePart& part : result.file.parts) provenance.add_input(part.file);
    Template loaded = load_template(result.file);
    for (const Finding& finding : loaded.findings)
        if (finding.defect) fail_input(file + ", " + finding.where, finding.text, "mend it: 'template check' tells all");
    if (!loaded.mesh) fail_input(file, "has no mesh", "pack one");
    result.mesh = std::move(loaded.mesh->mesh);
    if (loaded.annotations) result.set = std::move(*loaded.annotations);
    if (loaded.graph) result.graph = std::move(*loaded.graph);
    return result;
}

WholeObject read_member(const std::string& file, Provenance& provenance) {
    if (std::filesystem::is_directory(file)) fail_input(file, "is a folder", "name the mesh files in it");
    WholeObject member;
    member.name = object_name(file);
    member.mesh = read_mesh(file).mesh;
    provenance.add_input(file);
    const Path annotations = Path(file).parent_path() / (member.name + ".ant.json");
    if (!std::filesystem::exists(annotations)) return member;
    member.annotations = read_annotations(annotations, member.mesh);
    provenance.add_input(annotations);
    return member;
}

std::string object_name(const std::string& file) {
    const std::string name = Path(file).filename().string(), double_ending = ".mrk.json";
    if (name.ends_with(double_ending)) return name.substr(0, name.size() - double_ending.size());
    return Path(file).stem().string();
}

void check_folder(const std::string& folder) {
    if (folder.empty()) fail_usage("there is no folder to write to", "give --output FOLDER");
    std::error_code code;
    Path known = std::filesystem::absolute(folder, code);
    while (known.has_relative_path() && !std::filesystem::exists(known, code)) known = known.parent_path();
    if (!std::filesystem::is_directory(known, code))
        throw Error(ErrorKind::failure, folder, "the folder cannot be made: '" + known.string() + "' is no folder",
                    "name another one");
}

void make_folder(const std::string& folder) {
    check_folder(folder);
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) throw Error(ErrorKind::failure, folder, "the folder cannot be made: " + code.message(), "name another one");
}

void check_names(const std::vector<std::string>& files) {
    std::set<std::string> taken;
    for (const std::string& file : files)
        if (!taken.insert(object_name(file)).second)
            fail_usage("two objects are called '" + printable(object_name(file)) + "'", "rename one of the files");
}

}  // namespace ostraka::app

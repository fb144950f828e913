#include "template_class.h"

#include <set>

namespace ostraka::app {

LoadedTemplate load_class_template(const std::string& file, Provenance& provenance) {
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
    WholeObject member;
    member.name = Path(file).stem().string();
    member.mesh = read_mesh(file).mesh;
    provenance.add_input(file);
    const Path annotations = Path(file).parent_path() / (member.name + ".ant.json");
    if (!std::filesystem::exists(annotations)) return member;
    member.annotations = read_annotations(annotations, member.mesh);
    provenance.add_input(annotations);
    return member;
}

void make_folder(const std::string& folder) {
    if (folder.empty()) fail_usage("there is no folder to write to", "give --output FOLDER");
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) throw Error(ErrorKind::failure, folder, "the folder cannot be made: " + code.message(), "name another one");
}

void check_names(const std::vector<std::string>& files) {
    std::set<std::string> taken;
    for (const std::string& file : files)
        if (!taken.insert(Path(file).stem().string()).second)
            fail_usage("two objects are called '" + printable(Path(file).stem().string()) + "'", "rename one of the files");
}

}  // namespace ostraka::app

// What the commands on classes share: the template of a class, and its members.
#pragma once

#include "command.h"

#include "ostraka/family/class_file.h"
#include "ostraka/family/fragment_thresholds.h"

namespace ostraka::app {

/// A template loaded for use: sound, with a mesh. What it lacks is empty.
struct LoadedTemplate {
    TemplateFile file;
    Mesh mesh;
    AnnotationSet set;
    RelationGraph graph;
    [[nodiscard]] ClassTemplate known() const { return {mesh, set, graph}; }
};
/// Throws Error (input) that names the file for a template with a defect; adds the files read to the provenance.
LoadedTemplate load_class_template(const std::string& file, Provenance& provenance);

/// A mesh file and the annotations beside it (NAME.ant.json), if there are.
WholeObject read_member(const std::string& file, Provenance& provenance);

/// The name of an object: its file's without folder and ending (".mrk.json" is one ending).
std::string object_name(const std::string& file);

/// Throws Error (usage) where none is named, (failure) where a file is in its place: told before the work, which makes it.
void check_folder(const std::string& folder);
/// Makes the folder. Throws Error as check_folder, and (failure) where it cannot be made.
void make_folder(const std::string& folder);
/// Throws Error (usage) where two files have one name without folder and ending.
void check_names(const std::vector<std::string>& files);

}  // namespace ostraka::app

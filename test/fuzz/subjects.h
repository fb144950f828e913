// What is mutated: files of the project and what the toolkit made of them, each with what is done with it.
#pragma once

#include "child.h"
#include "mutations.h"

#include <string>
#include <vector>

namespace ostraka::fuzz {

/// A file that a run begins with.
struct SubjectFile {
    std::string name;  ///< in the folder of the run
    Path from;         ///< empty: it holds the text
    std::string text = {};
};

/// A file that may be mutated, and which kind of file it is.
struct Target {
    std::string kind, file;
    bool by_caller = false;  ///< the call names it: it may be whatever its caller wants
};

struct Subject {
    std::string name;
    std::vector<SubjectFile> files;
    std::vector<std::string> folders;  ///< empty ones
    std::vector<Target> targets;
    bool keeps_inside = false;  ///< files name other files: nothing outside the folder may be reached, over links neither
    std::vector<Plant> plants;
    std::vector<std::string> options = {};  ///< members of "with" that are no files, in call.json
    Act act;
};

/// Files that no other file of the project is like: meshes of all formats, exchange formats, a session, runs of studies, a kit.
/// Written into the current folder; takes some seconds.
void make_seeds(const Path& project);

/// All subjects, in an order that does not change. `seeds`: where make_seeds was called.
std::vector<Subject> list_subjects(const Path& project, const Path& seeds);

// ---- the parts of the list ----

void add_cases(const Path& project, std::vector<Subject>& subjects);
void add_formats(const Path& project, const Path& seeds, std::vector<Subject>& subjects);
void add_studies(const Path& project, const Path& seeds, std::vector<Subject>& subjects);
void add_sessions(const Path& seeds, std::vector<Subject>& subjects);
void add_kits(const Path& seeds, std::vector<Subject>& subjects);
/// What does wrong all that can be found, as the file what.txt says: a test of the finding.
void add_wrongdoer(std::vector<Subject>& subjects);

void make_formats(const Path& project);
void make_studies(const Path& project);
void make_session(const Path& project);
void make_kit(const Path& project);

// ---- what they share ----

/// Calls an operation with settings as JSON; returns its report.
std::string call_operation(const std::string& operation, const JsonValue& with, Stopper& stopper);
std::string call_operation(const std::string& operation, const std::string& with, Stopper& stopper);
/// The call that stands in call.json: {"operation", "with"}.
std::string call_of_file(Stopper& stopper);

/// All files below a folder, each under its name in it behind `before`.
std::vector<SubjectFile> files_below(const Path& folder, const std::string& before = {});
/// The text of a call, and a subject that makes it of these files, of which the targets are the named ones.
std::string call_text(const std::string& operation, const std::string& with);

}  // namespace ostraka::fuzz

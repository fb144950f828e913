// The subjects of mutation: files of the project and results of the toolkit, each with the operations applied to them.
#pragma once

#include "child.h"
#include "mutations.h"

#include <string>
#include <vector>

namespace ostraka::fuzz {

/// An initial file of a run.
struct SubjectFile {
    std::string name;  ///< path in the folder of the run
    Path from;         ///< source; empty: the content is the text
    std::string text = {};
};

/// A file that may be mutated, and its kind.
struct Target {
    std::string kind, file;
    bool by_caller = false;  ///< named by the call, so its content is unrestricted
};

struct Subject {
    std::string name;
    std::vector<SubjectFile> files;
    std::vector<std::string> folders;  ///< empty folders
    std::vector<Target> targets;
    bool keeps_inside = false;  ///< files may name others; nothing outside the folder may be reached, also by links
    std::vector<Plant> plants;
    std::vector<std::string> options = {};  ///< members of "with" in call.json that are not files
    Act act;
};

/// Files of kinds that the project does not contain: meshes of all formats, exchange formats, a session, runs of studies, a
/// kit. Written into the current folder within some seconds.
void make_seeds(const Path& project);

/// All subjects, in a fixed order. `seeds`: folder in which make_seeds was called.
std::vector<Subject> list_subjects(const Path& project, const Path& seeds);

// ---- sections of the list ----

void add_cases(const Path& project, std::vector<Subject>& subjects);
void add_formats(const Path& project, const Path& seeds, std::vector<Subject>& subjects);
void add_studies(const Path& project, const Path& seeds, std::vector<Subject>& subjects);
void add_sessions(const Path& seeds, std::vector<Subject>& subjects);
void add_kits(const Path& seeds, std::vector<Subject>& subjects);
/// A subject that misbehaves in all detectable ways, as selected by the file what.txt: tests the detection.
void add_wrongdoer(std::vector<Subject>& subjects);

void make_formats(const Path& project);
void make_studies(const Path& project);
void make_session(const Path& project);
void make_kit(const Path& project);

// ---- shared ----

/// Calls an operation with settings in JSON; returns its report.
std::string call_operation(const std::string& operation, const JsonValue& with, Stopper& stopper);
std::string call_operation(const std::string& operation, const std::string& with, Stopper& stopper);
/// The call in call.json: {"operation", "with"}.
std::string call_of_file(Stopper& stopper);

/// All files below a folder, with paths relative to it, prefixed by `before`.
std::vector<SubjectFile> files_below(const Path& folder, const std::string& before = {});
/// The text of a call, and a subject that runs it on these files; the named ones are the targets.
std::string call_text(const std::string& operation, const std::string& with);

}  // namespace ostraka::fuzz

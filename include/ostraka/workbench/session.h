// The history of a workbench session. Each step is an operation or a choice of the user. All steps are stored in a folder and
// can be undone. Together they form a study file, with which the command `ostraka run` can repeat the session
// (doc/workbench.md).
#pragma once

#include "ostraka/operations/table.h"

#include <functional>
#include <optional>

namespace ostraka {

/// An object of the session: a mesh with its associated files. File names are relative to the session's folder, with '/'.
struct SessionObject {
    std::string name;  ///< name of the object
    /// Files of the object by kind of part: "mesh", "annotations", "graph", "cage", "coordinates", "recipe"; during a
    /// deformation also "edit", "deformed", "deformed cage" and "... annotations".
    std::map<std::string, std::string> parts;
    /// File of a part; empty if the object has no such part.
    [[nodiscard]] std::string part(const std::string& which) const;
};

/// A file written by a step that is not part of an object: a table, a drawing, a map.
struct SessionFile {
    std::string name, kind, file;  ///< display name, kind of content, and file name
    std::string object;            ///< name of the object that the file describes; empty: none
};

/// The state of a session after a step. Files are never modified: each step writes new files.
struct SessionState {
    std::vector<SessionObject> objects;  ///< objects that are open
    std::size_t active = 0;              ///< index of the active object
    std::vector<SessionFile> files;      ///< other files written by the steps
    /// The active object; null: there is none.
    [[nodiscard]] const SessionObject* object() const { return active < objects.size() ? &objects[active] : nullptr; }
};
JsonValue to_json(const SessionState& state, JsonAllocator& allocator);  ///< JSON of a state, as the page receives it

/// A step of a session.
struct SessionStep {
    std::string name;       ///< name of the step, such as "s012"; for an operation also the name of its folder in "steps"
    std::string title;      ///< description as text
    std::string operation;  ///< name of the operation; empty for a choice, which writes no file
    Json with, keep;        ///< inputs and options (with), and outputs with their file names (keep), as in study files
    std::map<std::string, std::string> sha256;  ///< SHA-256 of each output, by name
    bool holds = true;                          ///< false: the answer of the operation was "no"
    SessionState state;                         ///< state after the step
};

/// A session with its steps and files.
class Session {
public:
    /// Resumes the session in `folder`, or starts a new session. Files are opened from `root` and its subfolders, and saved
    /// there. A new folder and the session file are accessible only to their owner. Throws Error (input) if the folder holds
    /// other data; if the session is damaged, lacks files, names files or holds links outside `folder` and `root`; or if
    /// another process uses the session.
    Session(Path folder, Path root);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// State after the last step in effect.
    [[nodiscard]] const SessionState& state() const;
    [[nodiscard]] const std::vector<SessionStep>& steps() const { return steps_; }  ///< all steps, including undone ones
    /// Number of steps in effect; later steps in `steps` have been undone.
    [[nodiscard]] std::size_t place() const { return place_; }
    [[nodiscard]] const Path& folder() const { return folder_; }  ///< folder of the session
    [[nodiscard]] const Path& root() const { return root_; }  ///< folder from which files are opened, and to which they are saved

    /// Names of the meshes and templates that can be opened, relative to the root.
    [[nodiscard]] std::vector<std::string> openable() const;
    /// Opens a template, or a mesh with the files of the same name beside it (.ant.json, .graph.json, .cage.ply with .npy).
    /// Throws Error (input) if `name` is not among `openable`. `inspect` may reject the object by throwing before the session
    /// changes.
    void open(const std::string& name, const std::function<void(const SessionObject&)>& inspect = {});

    /// Runs an operation as a new step. Request: {"operation", "title", "with": {NAME: VALUE}, "keep": [OUTPUT, ...], "as":
    /// "deformed"}. The value of an input is {"part": PART, "object": INDEX} (default: the active object), {"file": FILE of the
    /// state}, {"document": JSON}, {"upload": FOLDER of uploads, "name": FILE in it} or a list of such values. Outputs that the
    /// operation requires, and outputs in "keep", become parts of their object, new objects, or files. With "as": "deformed" a
    /// resulting mesh is the deformed state of the object, not a new object. Returns the report of the operation. If the
    /// operation fails, the session is unchanged.
    Report run(const JsonValue& request, Context& context);

    /// Adds a choice as a new step: {"do": "activate" or "close", "object": INDEX}; {"do": "accept" or "withdraw"} for a
    /// deformation.
    void change(const JsonValue& request);

    /// Undoes or redoes until `place` steps are in effect. Throws Error (usage) if there are fewer steps.
    void go_to(std::size_t place);

    /// Copies the active object into the folder NAME of the root, as a template that passes all checks. Returns the path of the
    /// template's file. Throws Error (usage) for an invalid name, (input) if there are no annotations or the folder holds other
    /// data.
    Path save(const std::string& name, Context& context) const;

    /// Path of a file that the state names. Throws Error (usage) if the state does not name this file.
    [[nodiscard]] Path path_of(const std::string& file) const;

    /// The steps in effect as a study file for 'ostraka run'. The study file is written beside the session after each step.
    [[nodiscard]] Json study() const;

private:
    struct Settings;
    [[nodiscard]] std::string relative(const Path& file) const;  ///< path relative to the session's folder
    /// How a study refers to a file: as the output of the step that wrote it, or by its name.
    [[nodiscard]] std::string reference(const std::string& file) const;
    /// File for an input of a request.
    [[nodiscard]] Path resolved(const JsonValue& value, const Slot& input, const std::string& step, Settings& settings) const;
    /// Provides a mesh and its annotations under matching names, so that both are read together.
    [[nodiscard]] Path with_beside(const SessionObject& object, const std::string& step, Settings& settings) const;
    /// Chooses the file names of the requested outputs.
    void name_outputs(Call& call, const JsonValue& request, const std::string& step, Settings& settings) const;
    /// Adds the outputs of a call to the state after the step.
    void take_outputs(const Call& call, const JsonValue& request, const Settings& settings, SessionStep& step) const;
    /// Adds the meshes in an output folder as objects, with their annotations.
    void take_folder(const std::string& folder, SessionState& state) const;
    [[nodiscard]] std::string next_name() const;  ///< name of the next step
    void add(SessionStep step);                   ///< appends a step after the steps in effect, and writes the session
    void write() const;                           ///< writes the session file and the study file
    void read();                                  ///< reads the session file
    /// Throws Error (input) unless the numbers of the steps ascend.
    void check_numbers() const;
    /// Throws Error (input) if a file named by the step lies outside the session and the root.
    void check_files(const SessionStep& step) const;
    /// Throws Error (input) if the file does not exist.
    void check_file(const std::string& file) const;
    /// Throws Error (input) if a file or folder to be written leads out of the session's folder.
    void check_folders() const;
    /// Removes files of steps that were not recorded because the process was killed, and uploads that no step reads.
    void sweep() const;
    void lock();  ///< locks the folder; throws Error (input) if another process uses it

    Path folder_, root_;
    std::vector<SessionStep> steps_;
    std::size_t place_ = 0, counter_ = 0;  ///< number of steps in effect; number of the last step ever made
    SessionState begin_;                   ///< state before the first step
    int lock_ = -1;                        ///< file descriptor that holds the lock on the folder
};

}  // namespace ostraka

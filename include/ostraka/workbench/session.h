// What a person did in the workbench, step by step: each step is an operation of the table or a choice, and all of it is kept in
// a folder, can be undone as far back as it goes, and is a study file that the command repeats (doc/workbench.md).
#pragma once

#include "ostraka/operations/table.h"

#include <functional>
#include <optional>

namespace ostraka {

/// What one sees as one thing: a mesh with what belongs to it. Files are named relative to the session's folder, with '/'.
struct SessionObject {
    std::string name;
    std::map<std::string, std::string> parts;  ///< "mesh", "annotations", "graph", "cage", "coordinates", "recipe",
                                               ///< and of a deformation "edit", "deformed", "deformed cage" and "... annotations"
    [[nodiscard]] std::string part(const std::string& which) const;
};

/// A file that a step made and that is no part of an object: a table, a drawing, a map.
struct SessionFile {
    std::string name, kind, file;
    std::string of;  ///< the object that it says something of, by its name; empty: of none
};

/// What there is after a step. Files never change: a step makes new ones.
struct SessionState {
    std::vector<SessionObject> objects;
    std::size_t active = 0;  ///< the object that is worked on
    std::vector<SessionFile> files;
    [[nodiscard]] const SessionObject* object() const { return active < objects.size() ? &objects[active] : nullptr; }
};
JsonValue to_json(const SessionState& state, JsonAllocator& allocator);

struct SessionStep {
    std::string name;       ///< "s012"; its folder in "steps" if it is an operation
    std::string title;      ///< what was done, for people
    std::string operation;  ///< of the table; empty: a choice, which makes no file
    Json with, keep;        ///< as study files say it: inputs and options; outputs with the names of their files
    std::map<std::string, std::string> sha256;  ///< of the outputs, by their names
    bool holds = true;
    SessionState state;  ///< after it
};

class Session {
public:
    /// Goes on with the session in `folder`, or begins one there. Files are opened from `root` and the folders in it, and saved
    /// there. A new folder and the session's file are for their owner only. Throws Error (input) for a folder that holds
    /// something else, a session that is damaged, whose files are gone or that names files or holds links outside of `folder` and
    /// `root`, and one that another process is at work on.
    Session(Path folder, Path root);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    [[nodiscard]] const SessionState& state() const;
    [[nodiscard]] const std::vector<SessionStep>& steps() const { return steps_; }
    /// How many of the steps count: those behind were undone.
    [[nodiscard]] std::size_t place() const { return place_; }
    [[nodiscard]] const Path& folder() const { return folder_; }
    [[nodiscard]] const Path& root() const { return root_; }

    /// Meshes and templates that can be opened, by their names relative to the root.
    [[nodiscard]] std::vector<std::string> openable() const;
    /// A mesh with what lies beside it under its name (.ant.json, .graph.json, .cage.ply with .npy), or a template. Throws Error
    /// (input) for a name that is none of `openable`. `look` may refuse the object, before anything has changed.
    void open(const std::string& name, const std::function<void(const SessionObject&)>& look = {});

    /// {"operation", "title", "with": {NAME: VALUE}, "keep": [OUTPUT, ...], "as": "deformed"}: runs an operation. A value of an
    /// input is {"part": PART, "object": INDEX} (INDEX: else the active one), {"file": FILE of the state}, {"document": JSON} or
    /// a list of these. Outputs that the operation needs, and those of "keep", become parts of the object they are of, new
    /// objects, or files. "as": "deformed": a mesh that is made is the object's under deformation, not a new one. The report is
    /// handed over. Where it fails nothing has changed.
    Report run(const JsonValue& request, Context& context);

    /// {"do": "activate" or "close", "object": INDEX}; {"do": "accept" or "withdraw"} a deformation.
    void change(const JsonValue& request);

    /// Undoes or repeats steps until so many count. Throws Error (usage) where there are fewer.
    void go_to(std::size_t place);

    /// Copies the active object into the folder NAME of the root, as a template that is checked as a whole. Returns the
    /// template's file. Throws Error (usage) for a name that is no plain one, (input) where there are no annotations or something
    /// else is there.
    Path save(const std::string& name, Context& context) const;

    /// The file that the state names. Throws Error (usage) where it names none such.
    [[nodiscard]] Path path_of(const std::string& file) const;

    /// The steps that count as a study file: 'ostraka run' repeats them. It is written beside the session after each step.
    [[nodiscard]] Json study() const;

private:
    struct Settings;
    [[nodiscard]] std::string relative(const Path& file) const;
    [[nodiscard]] std::string reference(const std::string& file) const;
    [[nodiscard]] Path resolved(const JsonValue& value, const Slot& input, const std::string& step, Settings& settings) const;
    [[nodiscard]] Path with_beside(const SessionObject& object, const std::string& step, Settings& settings) const;
    void name_outputs(Call& call, const JsonValue& request, const std::string& step, Settings& settings) const;
    void take_outputs(const Call& call, const JsonValue& request, const Settings& settings, SessionStep& step) const;
    void take_folder(const std::string& folder, SessionState& state) const;
    [[nodiscard]] std::string next_name() const;
    void add(SessionStep step);
    void write() const;
    void read();
    void check_numbers() const;
    void check_files(const SessionStep& step) const;
    void check_file(const std::string& file) const;
    void check_folders() const;
    void sweep() const;
    void lock();

    Path folder_, root_;
    std::vector<SessionStep> steps_;
    std::size_t place_ = 0, counter_ = 0;
    SessionState begin_;
    int lock_ = -1;  ///< a descriptor that holds the folder
};

}  // namespace ostraka

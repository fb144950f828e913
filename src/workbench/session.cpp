#include "ostraka/workbench/session.h"
#include "ostraka/coords/coordinate_file.h"

#include "workbench/session_names.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/operations/page_results.h"
#include "ostraka/template_package/template.h"
#include "ostraka/workbench/uploads.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace ostraka {

using workbench::fail_request;
using workbench::free_name;
using workbench::stem_of;

namespace {

constexpr const char* file_name = "session.json";

SessionState state_from(const JsonValue& value) {
    SessionState state;
    for (const JsonValue& record : list_in(value, "objects")) {
        SessionObject object{text_in(record, "name"), {}};
        for (const auto& part : record["parts"].GetObject()) object.parts[text_of(part.name)] = text_of(part.value);
        state.objects.push_back(std::move(object));
    }
    for (const JsonValue& record : list_in(value, "files"))
        state.files.push_back({text_in(record, "name"), text_in(record, "kind"), text_in(record, "file"), text_in(record, "of")});
    state.active = static_cast<std::size_t>(number_or(value, "active", 0));
    return state;
}

Json copy_of(const JsonValue& value) {
    Json copy;
    copy.CopyFrom(value, copy.GetAllocator());
    return copy;
}

}  // namespace

std::string SessionObject::part(const std::string& which) const {
    const auto part_file = parts.find(which);
    return part_file == parts.end() ? std::string() : part_file->second;
}

JsonValue to_json(const SessionState& state, JsonAllocator& allocator) {
    return json_object(allocator, "objects",
                       json_list(state.objects, allocator,
                                 [&](const SessionObject& object) {
                                     JsonValue parts(rapidjson::kObjectType);
                                     for (const auto& [part, file] : object.parts) add_members(parts, allocator, part, file);
                                     return json_object(allocator, "name", object.name, "parts", std::move(parts));
                                 }),
                       "active", state.active, "files", json_list(state.files, allocator, [&](const SessionFile& file) {
                           return json_object(allocator, "name", file.name, "kind", file.kind, "file", file.file, "of",
                                              file.object);
                       }));
}

// ---- the folder ----

Session::Session(Path folder, Path root)
    : folder_(std::filesystem::weakly_canonical(std::filesystem::absolute(folder))),
      root_(std::filesystem::weakly_canonical(std::filesystem::absolute(root))) {
    if (is_folder(folder_)) {
        if (file_exists(folder_ / file_name)) {
            lock();
            read();
            return;
        }
        if (!std::filesystem::is_empty(folder_))
            fail_input(folder_.string(), "is not empty and holds no session", "name another folder for the session (--session)");
    }
    make_folder(folder_);
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    lock();
    write();
}

Session::~Session() {
    if (lock_ >= 0) ::close(lock_);
}

/// Locks the folder itself, so that no lock file remains if the process is killed.
void Session::lock() {
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(std::exchange(lock_, -1));
    fail_input(folder_.string(), "another workbench uses this session",
               "use the one that is open, or name another folder (--session)");
}

void Session::read() {
    const Path file = folder_ / file_name;
    check_folders();
    const Json document = read_json(file);
    validate(document, "session", file.string());
    for (const JsonValue& record : list_in(document, "steps")) {
        SessionStep step{text_in(record, "name"), text_in(record, "title"),   text_in(record, "operation"), {}, {}, {},
                         !flag_in(record, "no"),  state_from(record["state"])};
        const auto settings = [&](const char* name) {
            const JsonValue* value = find_member(record, name);
            return value == nullptr ? Json(rapidjson::kObjectType) : copy_of(*value);
        };
        step.with = settings("with");
        step.keep = settings("keep");
        if (const JsonValue* checksums = find_member(record, "sha256"))
            for (const auto& member : checksums->GetObject()) step.sha256[text_of(member.name)] = text_of(member.value);
        steps_.push_back(std::move(step));
    }
    place_ = std::min(steps_.size(), static_cast<std::size_t>(number_or(document, "place", 0)));
    counter_ = static_cast<std::size_t>(number_or(document, "counter", 0));
    check_numbers();
    for (const SessionStep& step : steps_) check_files(step);
    for (const SessionObject& object : state().objects)
        for (const auto& [part, name] : object.parts) check_file(name);
    sweep();
}

/// Checks that step numbers increase and do not exceed the counter, so that new steps get unused numbers.
void Session::check_numbers() const {
    std::size_t last = 0;
    for (const SessionStep& step : steps_) {
        const std::size_t number = std::stoul(step.name.substr(1));  // the schema ensures the format of names
        if (number <= last || number > counter_)
            fail_input((folder_ / file_name).string(), fmt::format("step {} is out of order", step.name),
                       "begin another session (--session)");
        last = number;
    }
}

/// Checks that the files of a step lie in the session's folder or in the root.
void Session::check_files(const SessionStep& step) const {
    const std::string where = fmt::format("{}, step {}", (folder_ / file_name).string(), step.name);
    const auto check = [&](const std::string& file) {
        require_file_name(file, where, "state");
        if (!file.empty() && !is_inside_any((folder_ / file).lexically_normal(), {folder_, root_}))
            fail_input(
                where,
                fmt::format("names '{}', which lies neither in the session nor in {}", printable(file, 200), root_.string()),
                "open the folder that it lies in, or begin another session (--session)");
    };
    for (const SessionObject& object : step.state.objects)
        for (const auto& [part, file] : object.parts) check(file);
    for (const SessionFile& file : step.state.files) check(file.file);
    require_writable_inside(folder_ / "steps" / step.name / "report.json", folder_);
}

void Session::check_file(const std::string& file) const {
    const Path path = (folder_ / file).lexically_normal();
    if (file_exists(path)) return;
    fail_input((folder_ / file_name).string(), fmt::format("needs '{}', which does not exist any more", path.string()),
               "put it back, or begin another session (--session)");
}

/// Checks that nothing that will be written or emptied leads out of the folder.
void Session::check_folders() const {
    for (const char* name : {file_name, "session.study.json", "steps", "documents", "uploads"})
        require_writable_inside(folder_ / name, folder_);
}

/// Removes files of steps whose process was killed before they were recorded, and uploads that no step reads.
void Session::sweep() const {
    for (const char* part : {"steps", "documents"}) {
        std::error_code code;
        std::vector<Path> removable;
        for (std::filesystem::directory_iterator entry(folder_ / part, code), end; !code && entry != end; entry.increment(code)) {
            const std::string name = entry->path().filename().string(), step = name.substr(0, name.find('-'));
            const bool has_step_name =
                step.size() >= 4 && step[0] == 's' && step.find_first_not_of("0123456789", 1) == std::string::npos;
            const bool is_recorded =
                std::any_of(steps_.begin(), steps_.end(), [&](const SessionStep& recorded) { return recorded.name == step; });
            if (has_step_name && !is_recorded) removable.push_back(entry->path());
        }
        for (const Path& path : removable) std::filesystem::remove_all(path, code);
    }
    std::string settings;
    for (const SessionStep& step : steps_) settings += to_compact_text(step.with);
    std::error_code code;
    std::vector<Path> unused;
    for (std::filesystem::directory_iterator entry(folder_ / "uploads", code), end; !code && entry != end; entry.increment(code))
        if (const std::string name = entry->path().filename().string();
            Uploads::is_batch(name) && settings.find(fmt::format("uploads/{}/", name)) == std::string::npos)
            unused.push_back(entry->path());
    for (const Path& path : unused) std::filesystem::remove_all(path, code);
}

void Session::write() const {
    Json document = json_document("session");
    auto& a = document.GetAllocator();
    add_members(document, a, "place", place_, "counter", counter_, "steps", json_list(steps_, a, [&](const SessionStep& step) {
                    JsonValue record = json_object(a, "name", step.name, "title", step.title);
                    if (!step.operation.empty()) {
                        JsonValue sums(rapidjson::kObjectType);
                        for (const auto& [output, sum] : step.sha256) add_members(sums, a, output, sum);
                        add_members(record, a, "operation", step.operation, "with", JsonValue(step.with, a), "keep",
                                    JsonValue(step.keep, a), "sha256", std::move(sums));
                        add_nonempty_members(record, a, "no", !step.holds);
                    }
                    add_members(record, a, "state", to_json(step.state, a));
                    return record;
                }));
    OutputTransaction transaction;
    write_file(folder_ / file_name, to_text(document), FileAccess::owner_only);
    const Json steps = study();
    if (!steps["steps"].ObjectEmpty()) write_file(folder_ / "session.study.json", to_text(steps), FileAccess::owner_only);
    transaction.commit();
}

Json Session::study() const {
    Json document = json_document("study");
    auto& a = document.GetAllocator();
    JsonValue steps(rapidjson::kObjectType);
    for (std::size_t i = 0; i < place_; ++i) {
        const SessionStep& step = steps_[i];
        if (step.operation.empty()) continue;
        add_members(steps, a, step.name,
                    json_object(a, "note", step.title, "operation", step.operation, "with", JsonValue(step.with, a), "keep",
                                JsonValue(step.keep, a)));
    }
    add_members(document, a, "title", "What was done in the workbench", "steps", std::move(steps));
    return document;
}

// ---- position in the history ----

const SessionState& Session::state() const { return place_ == 0 ? begin_ : steps_[place_ - 1].state; }

std::string Session::relative(const Path& file) const {
    const std::string name = file.lexically_relative(folder_).generic_string();
    return name.empty() ? file.generic_string() : name;
}

std::string Session::next_name() const {
    std::string digits = std::to_string(counter_ + 1);
    if (digits.size() < 3) digits.insert(0, 3 - digits.size(), '0');
    return "s" + digits;
}

void Session::add(SessionStep step) {
    // Undone steps can no longer be reached: their files are removed once the session is written without them.
    std::vector<std::string> discarded_steps;
    for (std::size_t i = place_; i < steps_.size(); ++i)
        if (!steps_[i].operation.empty()) discarded_steps.push_back(steps_[i].name);
    std::vector<SessionStep> undone(std::make_move_iterator(steps_.begin() + static_cast<std::ptrdiff_t>(place_)),
                                    std::make_move_iterator(steps_.end()));
    steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(place_), steps_.end());
    steps_.push_back(std::move(step));
    ++place_, ++counter_;
    try {
        write();
    } catch (...) {
        steps_.pop_back();
        --place_, --counter_;
        steps_.insert(steps_.end(), std::make_move_iterator(undone.begin()), std::make_move_iterator(undone.end()));
        throw;
    }
    for (const std::string& name : discarded_steps) {
        std::error_code ignored;
        std::filesystem::remove_all(folder_ / "steps" / name, ignored);
    }
}

void Session::go_to(std::size_t place) {
    if (place > steps_.size()) fail_request("there is no step " + std::to_string(place));
    const std::size_t before = place_;
    place_ = place;
    try {
        write();
    } catch (...) {
        place_ = before;
        throw;
    }
}

Path Session::path_of(const std::string& file) const {
    const SessionState& current = state();
    const auto is_same_file = [&](const SessionFile& session_file) { return session_file.file == file; };
    bool is_known = std::any_of(current.files.begin(), current.files.end(), is_same_file);
    for (const SessionObject& object : current.objects)
        for (const auto& [part, name] : object.parts) is_known = is_known || name == file;
    if (!is_known) fail_request(fmt::format("'{}' is not a file of the session", printable(file, 100)));
    return (folder_ / file).lexically_normal();
}

// ---- choices ----

std::vector<std::string> Session::openable() const {
    std::vector<std::string> names;
    const auto add_openable = [&](const Path& folder, const std::string& prefix) {
        for (const std::string& name : files_in(folder)) {
            if (!is_inside(folder / name, root_)) continue;
            if (name.front() == '.' || name.find(".cage.") != std::string::npos) continue;
            const std::string ending = extension(name);
            const bool is_other_mesh = ending == ".glb" || ending == ".gltf" || ending == ".3mf";
            if (is_mesh_name(name) || is_other_mesh || name.ends_with(".template.json")) names.push_back(prefix + name);
        }
    };
    add_openable(root_, "");
    std::error_code ignored;
    std::vector<Path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(root_, ignored))
        if (entry.is_directory(ignored) && entry.path().filename().string().front() != '.' &&
            !same_place(entry.path(), folder_) && is_inside(entry.path(), root_))
            folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    for (const Path& folder : folders)
        if (!file_exists(folder / file_name)) add_openable(folder, folder.filename().string() + "/");
    return names;
}

void Session::open(const std::string& name, const std::function<void(const SessionObject&)>& inspect) {
    const std::vector<std::string> openable_names = openable();
    if (std::find(openable_names.begin(), openable_names.end(), name) == openable_names.end())
        fail_input(printable(name, 100), "is not a mesh or template in " + root_.string(), "open one that is in the list");
    const Path file = root_ / name;
    SessionObject object{stem_of(name), {}};
    if (name.ends_with(".template.json")) {
        const TemplateFile package = read_template(file);
        for (const char* part : {"mesh", "annotations", "graph", "cage", "coordinates"})
            if (const auto files = package.of(part); !files.empty())
                object.parts[part] = relative(std::filesystem::weakly_canonical(files.front()->file));
        if (!object.parts.contains("mesh")) fail_input(name, "has no mesh", "open another template");
    } else {
        object.parts["mesh"] = relative(file);
        const auto beside = [&](const char* part, const std::string& ending) {
            const Path other = file.parent_path() / (object.name + ending);
            if (!same_place(other, file) && file_exists(other)) object.parts[part] = relative(other);
        };
        beside("annotations", ".ant.json");
        if (object.parts.contains("annotations")) beside("graph", ".graph.json");
        beside("cage", ".cage.ply");
        if (object.parts.contains("cage") && file_exists(coordinate_header_file(file.parent_path() / (object.name + ".npy"))))
            beside("coordinates", ".npy");
    }
    for (const auto& [part, ref] : object.parts) {
        const Path path = (folder_ / ref).lexically_normal();
        if (!file_exists(path))
            fail_input(name, fmt::format("names '{}', which does not exist", ref), "run: ostraka template check " + name);
        if (!is_inside(path, root_)) fail_input(path.string(), "leads out of " + root_.string(), "copy it there");
    }
    if (inspect) inspect(object);
    SessionStep step{next_name(), "open " + name, {}, {}, {}, {}, true, state()};
    object.name = free_name(step.state, object.name);
    step.state.objects.push_back(std::move(object));
    step.state.active = step.state.objects.size() - 1;
    add(std::move(step));
}

void Session::change(const JsonValue& request) {
    const std::string action = text_in(request, "do");
    SessionStep step{next_name(), {}, {}, {}, {}, {}, true, state()};
    SessionState& current = step.state;
    const auto chosen_index = [&] {
        const auto index = static_cast<std::size_t>(number_or(request, "object", static_cast<double>(current.active)));
        if (index >= current.objects.size()) fail_request("there is no object " + std::to_string(index));
        return index;
    };
    if (action == "activate") {
        current.active = chosen_index();
        step.title = "work on " + current.objects[current.active].name;
    } else if (action == "close") {
        const std::size_t index = chosen_index();
        step.title = "close " + current.objects[index].name;
        current.objects.erase(current.objects.begin() + static_cast<std::ptrdiff_t>(index));
        if (current.active > index || current.active >= current.objects.size())
            current.active = current.active == 0 ? 0 : current.active - 1;
    } else if (action == "accept" || action == "withdraw") {
        SessionObject& object = current.objects[chosen_index()];
        auto& parts = object.parts;
        if (!parts.contains("deformed")) fail_request("nothing is being deformed", "move some control points first");
        step.title = fmt::format("{} the deformation of {}", action, object.name);
        if (action == "accept") {
            parts["mesh"] = parts["deformed"];
            for (const char* part : {"cage", "annotations"})
                if (const auto deformed_part = parts.find(std::string("deformed ") + part); deformed_part != parts.end())
                    parts[part] = deformed_part->second;
            parts.erase("coordinates");  // coordinates belong to the undeformed shape
            parts.erase("recipe");
        }
        for (const char* part : {"edit", "deformed", "deformed cage", "deformed annotations"}) parts.erase(part);
    } else {
        fail_request(fmt::format("'{}' is not a change", printable(action, 40)));
    }
    add(std::move(step));
}

}  // namespace ostraka

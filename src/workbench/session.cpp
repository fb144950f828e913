#include "ostraka/workbench/session.h"

#include "request.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/words.h"
#include "ostraka/template_package/template.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace ostraka {

using workbench::fail_request;

namespace {

constexpr const char* file_name = "session.json";

/// The part of an object that an output of this kind becomes; empty: none.
std::string part_of(Kind kind) {
    switch (kind) {
        case Kind::mesh:
            return "mesh";
        case Kind::annotations:
            return "annotations";
        case Kind::graph:
            return "graph";
        case Kind::cage:
            return "cage";
        case Kind::coordinates:
            return "coordinates";
        case Kind::recipe:
            return "recipe";
        case Kind::edit:
            return "edit";
        default:
            return {};
    }
}

bool is_plain_name(const std::string& name) {
    return !name.empty() && name.size() <= 100 && name.front() != '.' && printable(name) == name &&
           name.find_first_of("/\\:$") == std::string::npos;
}

SessionState state_from(const JsonValue& value) {
    SessionState state;
    for (const JsonValue& one : list_in(value, "objects")) {
        SessionObject object{text_in(one, "name"), {}};
        for (const auto& part : one["parts"].GetObject()) object.parts[text_of(part.name)] = text_of(part.value);
        state.objects.push_back(std::move(object));
    }
    for (const JsonValue& one : list_in(value, "files"))
        state.files.push_back({text_in(one, "name"), text_in(one, "kind"), text_in(one, "file")});
    state.active = static_cast<std::size_t>(number_or(value, "active", 0));
    return state;
}

Json copy_of(const JsonValue& value) {
    Json copy;
    copy.CopyFrom(value, copy.GetAllocator());
    return copy;
}

/// A name that no object has yet.
std::string free_name(const SessionState& state, const std::string& name) {
    const auto taken = [&](const std::string& one) {
        return std::any_of(state.objects.begin(), state.objects.end(), [&](const SessionObject& o) { return o.name == one; });
    };
    std::string free = name;
    for (int i = 2; taken(free); ++i) free = name + "-" + std::to_string(i);
    return free;
}

/// Without the endings that files of parts have.
std::string stem_of(const std::string& file) {
    const std::string name = Path(file).filename().string();
    for (const std::string_view end : {".ant.json", ".graph.json", ".recipe.json", ".edit.json", ".template.json", ".cage.ply"})
        if (name.ends_with(end)) return name.substr(0, name.size() - end.size());
    return Path(name).stem().string();
}

}  // namespace

const std::vector<std::string>& session_parts() {
    static const std::vector<std::string> parts{"mesh",   "annotations", "graph",    "cage",          "coordinates",
                                                "recipe", "edit",        "deformed", "deformed cage", "deformed annotations"};
    return parts;
}

std::string SessionObject::part(const std::string& which) const {
    const auto found = parts.find(which);
    return found == parts.end() ? std::string() : found->second;
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
                           return json_object(allocator, "name", file.name, "kind", file.kind, "file", file.file);
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
    lock();
    write();
}

Session::~Session() {
    if (lock_ >= 0) ::close(lock_);
}

/// The folder itself is locked: nothing is left where a process is killed.
void Session::lock() {
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(std::exchange(lock_, -1));
    fail_input(folder_.string(), "another workbench is at work on this session",
               "use the one that is open, or name another folder (--session)");
}

void Session::read() {
    const Path file = folder_ / file_name;
    const Json document = read_json(file);
    validate(document, "session", file.string());
    for (const JsonValue& one : list_in(document, "steps")) {
        SessionStep step{text_in(one, "name"), text_in(one, "title"),   text_in(one, "operation"), {}, {}, {},
                         !flag_in(one, "no"),  state_from(one["state"])};
        if (const JsonValue* with = find_member(one, "with")) step.with = copy_of(*with);
        if (const JsonValue* keep = find_member(one, "keep")) step.keep = copy_of(*keep);
        if (const JsonValue* made = find_member(one, "sha256"))
            for (const auto& member : made->GetObject()) step.sha256[text_of(member.name)] = text_of(member.value);
        steps_.push_back(std::move(step));
    }
    place_ = std::min(steps_.size(), static_cast<std::size_t>(number_or(document, "place", 0)));
    counter_ = static_cast<std::size_t>(number_or(document, "counter", 0));
    for (const SessionObject& object : state().objects)
        for (const auto& [part, name] : object.parts) check_file(name);
}

void Session::check_file(const std::string& file) const {
    const Path path = (folder_ / file).lexically_normal();
    if (file_exists(path)) return;
    fail_input((folder_ / file_name).string(), "needs '" + path.string() + "', which is not there any more",
               "put it back, or begin another session (--session)");
}

void Session::write() const {
    Json document = json_document("session");
    auto& a = document.GetAllocator();
    add_members(document, a, "place", place_, "counter", counter_, "steps", json_list(steps_, a, [&](const SessionStep& step) {
                    JsonValue made = json_object(a, "name", step.name, "title", step.title);
                    if (!step.operation.empty()) {
                        JsonValue sums(rapidjson::kObjectType);
                        for (const auto& [output, sum] : step.sha256) add_members(sums, a, output, sum);
                        add_members(made, a, "operation", step.operation, "with", JsonValue(step.with, a), "keep",
                                    JsonValue(step.keep, a), "sha256", std::move(sums));
                        add_given(made, a, "no", !step.holds);
                    }
                    add_members(made, a, "state", to_json(step.state, a));
                    return made;
                }));
    OutputTransaction transaction;
    write_file(folder_ / file_name, to_text(document));
    const Json steps = study();
    if (!steps["steps"].ObjectEmpty()) write_json(folder_ / "session.study.json", steps);
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

// ---- where one is ----

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
    // What was undone is no longer reached: its files go once the session is written without it.
    std::vector<std::string> gone;
    for (std::size_t i = place_; i < steps_.size(); ++i)
        if (!steps_[i].operation.empty()) gone.push_back(steps_[i].name);
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
    for (const std::string& name : gone) {
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
    const SessionState& now = state();
    const auto is_it = [&](const SessionFile& one) { return one.file == file; };
    bool known = std::any_of(now.files.begin(), now.files.end(), is_it);
    for (const SessionObject& object : now.objects)
        for (const auto& [part, name] : object.parts) known = known || name == file;
    if (!known) fail_request("'" + printable(file, 100) + "' is no file of the session");
    return (folder_ / file).lexically_normal();
}

// ---- choices ----

std::vector<std::string> Session::openable() const {
    std::vector<std::string> found;
    const auto look = [&](const Path& folder, const std::string& before) {
        for (const std::string& name : files_in(folder)) {
            const std::string kind = extension(name);
            const bool is_mesh = kind == ".ply" || kind == ".obj" || kind == ".off" || kind == ".stl";
            if (name.front() == '.' || name.find(".cage.") != std::string::npos) continue;
            if (is_mesh || name.ends_with(".template.json")) found.push_back(before + name);
        }
    };
    look(root_, "");
    std::error_code ignored;
    std::vector<Path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(root_, ignored))
        if (entry.is_directory(ignored) && entry.path().filename().string().front() != '.' && !same_place(entry.path(), folder_))
            folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    for (const Path& folder : folders)
        if (!file_exists(folder / file_name)) look(folder, folder.filename().string() + "/");
    return found;
}

void Session::open(const std::string& name, const std::function<void(const SessionObject&)>& look) {
    const std::vector<std::string> known = openable();
    if (std::find(known.begin(), known.end(), name) == known.end())
        fail_input(printable(name, 100), "is no mesh or template of " + root_.string(), "open one that is in the list");
    const Path file = root_ / name;
    SessionObject object{stem_of(name), {}};
    if (name.ends_with(".template.json")) {
        const TemplateFile known_parts = read_template(file);
        for (const char* part : {"mesh", "annotations", "graph", "cage", "coordinates"})
            if (const auto files = known_parts.of(part); !files.empty())
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
    for (const auto& [part, ref] : object.parts)
        if (!file_exists((folder_ / ref).lexically_normal()))
            fail_input(name, "names '" + ref + "', which is not there", "run: ostraka template check " + name);
    if (look) look(object);
    SessionStep step{next_name(), "open " + name, {}, {}, {}, {}, true, state()};
    object.name = free_name(step.state, object.name);
    step.state.objects.push_back(std::move(object));
    step.state.active = step.state.objects.size() - 1;
    add(std::move(step));
}

void Session::change(const JsonValue& request) {
    const std::string what = text_in(request, "do");
    SessionStep step{next_name(), {}, {}, {}, {}, {}, true, state()};
    SessionState& now = step.state;
    const auto chosen = [&] {
        const auto index = static_cast<std::size_t>(number_or(request, "object", static_cast<double>(now.active)));
        if (index >= now.objects.size()) fail_request("there is no object " + std::to_string(index));
        return index;
    };
    if (what == "activate") {
        now.active = chosen();
        step.title = "work on " + now.objects[now.active].name;
    } else if (what == "close") {
        const std::size_t index = chosen();
        step.title = "close " + now.objects[index].name;
        now.objects.erase(now.objects.begin() + static_cast<std::ptrdiff_t>(index));
        if (now.active > index || now.active >= now.objects.size()) now.active = now.active == 0 ? 0 : now.active - 1;
    } else if (what == "accept" || what == "withdraw") {
        SessionObject& object = now.objects[chosen()];
        auto& parts = object.parts;
        if (!parts.contains("deformed")) fail_request("nothing is being deformed", "move some control points first");
        step.title = what + " the deformation of " + object.name;
        if (what == "accept") {
            parts["mesh"] = parts["deformed"];
            for (const char* part : {"cage", "annotations"})
                if (const auto made = parts.find(std::string("deformed ") + part); made != parts.end())
                    parts[part] = made->second;
            parts.erase("coordinates");  // they are of the shape at rest
            parts.erase("recipe");
        }
        for (const char* part : {"edit", "deformed", "deformed cage", "deformed annotations"}) parts.erase(part);
    } else {
        fail_request("'" + printable(what, 40) + "' is no change");
    }
    add(std::move(step));
}

// ---- operations ----

struct Session::Settings {
    Json with{rapidjson::kObjectType}, keep{rapidjson::kObjectType};
    Json options{rapidjson::kObjectType};
    std::map<std::string, std::string> outputs;           ///< slot, name of its file
    std::vector<std::pair<Path, std::string>> documents;  ///< that the request brings along
    std::size_t object = no_index;                        ///< that most inputs are of
};

/// What a study says for a file: the output of the step that made it, or its name.
std::string Session::reference(const std::string& file) const {
    for (std::size_t i = 0; i < place_; ++i) {
        const SessionStep& step = steps_[i];
        if (step.operation.empty() || !file.starts_with("steps/" + step.name + "/")) continue;
        for (const auto& member : step.keep.GetObject())
            if (file == "steps/" + step.name + "/" + text_of(member.value))
                return "${" + step.name + "." + text_of(member.name) + "}";
    }
    return file;
}

/// A mesh whose annotations are read beside it: both under the names that they have to have.
Path Session::with_beside(const SessionObject& object, const std::string& step, Settings& settings) const {
    const Path mesh = (folder_ / object.part("mesh")).lexically_normal();
    const Path annotations = (folder_ / object.part("annotations")).lexically_normal();
    if (annotations.parent_path() == mesh.parent_path() && annotations.filename() == mesh.stem().string() + ".ant.json")
        return mesh;
    const Path folder = folder_ / "documents" / step;
    const Path copy = folder / mesh.filename();
    settings.documents.emplace_back(copy, read_file(mesh));
    settings.documents.emplace_back(folder / (mesh.stem().string() + ".ant.json"), read_file(annotations));
    return copy;
}

Path Session::resolved(const JsonValue& value, const Slot& input, const std::string& step, Settings& settings) const {
    const std::string& slot = input.name;
    if (!value.IsObject()) fail_request("input '" + printable(slot, 40) + "' is not given as a part, a file or a document");
    if (const JsonValue* document = find_member(value, "document")) {
        if (!document->IsObject()) fail_request("the document of '" + printable(slot, 40) + "' is no object");
        const Path file = folder_ / "documents" / (step + "-" + slot + ".json");
        settings.documents.emplace_back(file, to_text(*document));
        return file;
    }
    if (find_member(value, "file") != nullptr) return path_of(text_in(value, "file"));
    const SessionState& now = state();
    const auto index = static_cast<std::size_t>(number_or(value, "object", static_cast<double>(now.active)));
    if (index >= now.objects.size()) fail_request("no object is open", "open a mesh or a template");
    const std::string part = text_in(value, "part"), file = now.objects[index].part(part);
    if (file.empty())
        fail_request(now.objects[index].name + " has no " + printable(part.empty() ? "part" : part, 40),
                     part == "annotations"   ? "annotate it first"
                     : part == "cage"        ? "make a cage first"
                     : part == "coordinates" ? "link the cage with the mesh first"
                     : part == "graph"       ? "add a relationship first"
                                             : "choose another input");
    if (settings.object == no_index || slot == "target") settings.object = index;
    if (input.reads_beside && part == "mesh" && !now.objects[index].part("annotations").empty())
        return with_beside(now.objects[index], step, settings);
    return (folder_ / file).lexically_normal();
}

void Session::name_outputs(Call& call, const JsonValue& request, const std::string& step, Settings& settings) const {
    std::map<std::string, std::string> wanted;  // with the names of their files, where they are given
    for (const JsonValue& one : list_in(request, "keep")) {
        if (one.IsString()) wanted[text_of(one)];
        if (!one.IsObject()) continue;
        const std::string file = text_in(one, "file");
        if (!is_plain_name(file))
            fail_request("'" + printable(file, 60) + "' is no name for a file", "use letters, digits, . - and _");
        wanted[text_in(one, "output")] = file;
    }
    for (const auto& [name, file] : wanted)
        if (call.slot(name).role != Role::output) fail_request("'" + printable(name, 40) + "' is no output");
    const SessionState& now = state();
    std::string stem = settings.object < now.objects.size() ? stem_of(now.objects[settings.object].part("mesh")) : std::string();
    std::string word = call.entry().name;
    word = word.substr(word.rfind(' ') + 1);
    bool makes_mesh = false;
    for (const Slot* slot : call.parameters().slots())
        makes_mesh = makes_mesh || (slot->role == Role::output && slot->kind == Kind::mesh && slot->needed);
    if (stem.empty()) stem = word;
    else if (makes_mesh) stem += text_in(request, "as") == "deformed" ? "-deformed" : "-" + word;
    std::map<std::string, std::string> taken;  // name of a file, its slot
    for (Slot* slot : call.parameters().slots()) {
        if (slot->role != Role::output) continue;
        const auto own = wanted.find(slot->name);
        const bool asked = own != wanted.end();
        const bool updates = slot->updated != nullptr && !slot->updated->sources.empty();
        const bool begins = slot->updated != nullptr && slot->updated->needed;
        if (!asked && !updates && !slot->needed && !begins) continue;
        std::string name;
        switch (slot->kind) {
            case Kind::mesh:
                name = stem + ".ply";
                break;
            case Kind::annotations:
                name = stem + ".ant.json";
                break;
            case Kind::graph:
                name = stem + ".graph.json";
                break;
            case Kind::cage:
                name = stem + ".cage.ply";
                break;
            case Kind::coordinates:
                name = stem + ".npy";
                break;
            case Kind::recipe:
                name = stem + ".recipe.json";
                break;
            case Kind::template_package:
                name = stem + ".template.json";
                break;
            default:
                name = stem + "-" + slot->name + call.usual_ending(slot->name);
        }
        if (asked && !own->second.empty()) name = own->second;
        if (updates) name = Path(slot->updated->file()).filename().string();
        if (!taken.emplace(name, slot->name).second) {
            const std::string ending = Path(name).extension().string();
            name = stem + "-" + slot->name + ending;
            taken.emplace(name, slot->name);
        }
        settings.outputs[slot->name] = name;
        add_members(settings.keep, settings.keep.GetAllocator(), slot->name, name);
        call.set_file(slot->name, folder_ / "steps" / step / name);
    }
}

Report Session::run(const JsonValue& request, Context& context) {
    const OperationEntry& entry = find_operation(text_in(request, "operation"));
    for (const char* refused : {"run", "replay", "conformance run", "conformance self", "operations"})
        if (std::string_view(entry.name) == refused)
            fail_request("'" + std::string(entry.name) + "' is not run here",
                         "run it as a command: ostraka " + std::string(entry.name));
    Call call(entry);
    SessionStep step{next_name(), text_in(request, "title"), entry.name, {}, {}, {}, true, state()};
    if (step.title.empty()) step.title = entry.name;
    step.title = printable(step.title, 200);
    std::erase(step.title, '$');
    Settings settings;
    auto& with = settings.with.GetAllocator();
    if (const JsonValue* given = find_member(request, "with"); given != nullptr && given->IsObject())
        for (const auto& member : given->GetObject()) {
            const std::string name = text_of(member.name);
            const Slot* slot = call.parameters().slot(name);
            if (slot == nullptr) {
                if (to_compact_text(member.value).find("${") != std::string::npos)
                    fail_request("'" + printable(name, 40) + "' holds '${', which means something else in study files",
                                 "write it otherwise");
                add_members(settings.options, settings.options.GetAllocator(), name, member.value);
                add_members(settings.with, with, name, member.value);
                continue;
            }
            if (slot->role == Role::output) fail_request("'" + printable(name, 40) + "' is an output", "name it in 'keep'");
            const auto take = [&](const JsonValue& value) {
                const Path file = resolved(value, *slot, step.name, settings);
                if (!slot->repeated && !slot->sources.empty()) fail_request("'" + printable(name, 40) + "' is given twice");
                call.set_file(name, file);
                return reference(relative(file));
            };
            if (member.value.IsArray()) add_members(settings.with, with, name, json_list(member.value.GetArray(), with, take));
            else add_members(settings.with, with, name, take(member.value));
        }
    call.set(settings.options, entry.name);
    name_outputs(call, request, step.name, settings);

    const Path folder = folder_ / "steps" / step.name;
    const auto clear = [&] {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
        for (const auto& [file, text] : settings.documents) std::filesystem::remove(file, ignored);
    };
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);  // of a run that was killed
    try {
        make_folder(folder);
        for (const auto& [file, text] : settings.documents) make_folder(file.parent_path()), write_file(file, text);
        Report report = call.run(context);
        write_file(folder / "report.json", report.to_text(ReportFormat::json));
        for (const auto& [output, name] : settings.outputs)
            if (file_exists(folder / name)) step.sha256[output] = sha256_of_file(folder / name);
        step.holds = report.holds();
        take_outputs(call, request, settings, step);
        step.with = std::move(settings.with);
        step.keep = std::move(settings.keep);
        add(std::move(step));
        return report;
    } catch (...) {
        clear();
        throw;
    }
}

void Session::take_outputs(const Call& call, const JsonValue& request, const Settings& settings, SessionStep& step) const {
    SessionState& now = step.state;
    const bool deforms = text_in(request, "as") == "deformed";
    std::size_t target = settings.object;
    const auto made = [&](const std::string& name) { return "steps/" + step.name + "/" + name; };
    const auto is_there = [&](const std::string& name) {
        return file_exists(folder_ / made(name)) || is_folder(folder_ / made(name));
    };
    // A mesh that is made is a new object, which what is made with it belongs to.
    for (const auto& [output, name] : settings.outputs) {
        const Slot* slot = call.parameters().slot(output);
        if (slot->kind != Kind::mesh || !slot->needed || deforms || !is_there(name)) continue;
        now.objects.push_back({free_name(now, stem_of(name)), {{"mesh", made(name)}}});
        target = now.active = now.objects.size() - 1;
    }
    for (const auto& [output, name] : settings.outputs) {
        if (!is_there(name)) continue;
        const Slot* slot = call.parameters().slot(output);
        std::string part = part_of(slot->kind);
        if (deforms && slot->kind == Kind::mesh) part = "deformed";
        else if (deforms && (part == "cage" || part == "annotations")) part.insert(0, "deformed ");
        if (slot->kind == Kind::mesh && slot->needed && !deforms) continue;
        if (part.empty() || target >= now.objects.size() || (slot->kind == Kind::mesh && !slot->needed)) {
            std::erase_if(now.files, [&](const SessionFile& one) { return one.name == name; });
            const bool folder = is_folder(folder_ / made(name));
            now.files.push_back({name, slot->kind == Kind::folder && !folder ? "file" : to_string(slot->kind), made(name)});
            if (folder) take_folder(made(name), now);
            continue;
        }
        now.objects[target].parts[part] = made(name);
        if (part == "cage") now.objects[target].parts.erase("coordinates");
        // A recipe that does not make the annotations any more is none.
        if (part == "annotations" && !settings.outputs.contains("recipe")) now.objects[target].parts.erase("recipe");
    }
    if (!deforms || target >= now.objects.size()) return;
    for (const auto& [file, text] : settings.documents)
        if (file.filename().string().ends_with("-edit.json")) now.objects[target].parts["edit"] = relative(file);
}

/// Meshes that a folder was filled with are objects, with their annotations.
void Session::take_folder(const std::string& folder, SessionState& state) const {
    constexpr std::size_t maximum = 24;
    std::size_t count = 0;
    for (const std::string& name : files_in(folder_ / folder)) {
        if (extension(name) != ".ply" || ++count > maximum) continue;
        SessionObject object{free_name(state, stem_of(name)), {{"mesh", folder + "/" + name}}};
        const std::string annotations = folder + "/" + stem_of(name) + ".ant.json";
        if (file_exists(folder_ / annotations)) object.parts["annotations"] = annotations;
        state.objects.push_back(std::move(object));
        state.active = state.objects.size() - 1;
    }
}

Path Session::save(const std::string& name, Context& context) const {
    if (!is_plain_name(name))
        fail_request("'" + printable(name, 60) + "' is no name for a folder", "use letters, digits, - and _");
    const SessionObject* object = state().object();
    if (object == nullptr) fail_request("no object is open", "open a mesh or a template");
    if (object->part("annotations").empty()) fail_request(object->name + " has no annotations", "annotate it first");
    const Path folder = root_ / name, saved = folder / (name + ".template.json");
    if (file_exists(folder) || (is_folder(folder) && !std::filesystem::is_empty(folder) && !file_exists(saved)))
        fail_input(folder.string(), "is there already and holds something else", "give another name");
    make_folder(folder);
    Call call(find_operation("template pack"));
    call.set("copy", true);
    call.set_file("output", saved);
    for (const char* part : {"mesh", "annotations", "graph", "cage", "coordinates"})
        if (const std::string file = object->part(part); !file.empty()) call.set_file(part, (folder_ / file).lexically_normal());
    const Report report = call.run(context);
    if (!report.holds()) {
        const auto findings = list_in(report.result(), "findings");
        fail_input(object->name, findings.Empty() ? "is not sound" : text_in(findings[0], "text"), "mend it, then save again");
    }
    if (const std::string recipe = object->part("recipe"); !recipe.empty()) {
        const Path source = (folder_ / recipe).lexically_normal();
        write_file(folder / source.filename(), read_file(source));
    }
    return saved;
}

}  // namespace ostraka

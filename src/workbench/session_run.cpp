// Runs operations as steps of a session.
#include "workbench/session_names.h"

#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/workbench/uploads.h"

#include <fmt/core.h>

namespace ostraka {

using workbench::fail_request;
using workbench::free_name;
using workbench::is_plain_name;
using workbench::part_of;
using workbench::stem_of;

struct Session::Settings {
    Json with{rapidjson::kObjectType}, keep{rapidjson::kObjectType};
    Json options{rapidjson::kObjectType};
    std::map<std::string, std::string> outputs;           ///< slot -> file name
    std::vector<std::pair<Path, std::string>> documents;  ///< documents contained in the request
    std::size_t object = no_index;                        ///< object of most inputs
};

/// How a study refers to a file: as the output of the step that made it, or by its name.
std::string Session::reference(const std::string& file) const {
    for (std::size_t i = 0; i < place_; ++i) {
        const SessionStep& step = steps_[i];
        if (step.operation.empty() || !file.starts_with(fmt::format("steps/{}/", step.name))) continue;
        for (const auto& member : step.keep.GetObject())
            if (file == fmt::format("steps/{}/{}", step.name, text_of(member.value)))
                return fmt::format("${{{}.{}}}", step.name, text_of(member.name));
    }
    return file;
}

/// Provides a mesh and its annotations under matching names, so that the annotations are read with the mesh.
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
    if (!value.IsObject())
        fail_request(fmt::format("input '{}' is not given as a part, a file or a document", printable(slot, 40)));
    if (const JsonValue* document = find_member(value, "document")) {
        if (!document->IsObject()) fail_request(fmt::format("the document of '{}' is not an object", printable(slot, 40)));
        const Path file = folder_ / "documents" / fmt::format("{}-{}.json", step, slot);
        settings.documents.emplace_back(file, to_text(*document));
        return file;
    }
    if (find_member(value, "file") != nullptr) return path_of(text_in(value, "file"));
    if (find_member(value, "upload") != nullptr)
        return Uploads::path_of(folder_, text_in(value, "upload"), text_in(value, "name"));
    const SessionState& current = state();
    const auto index = static_cast<std::size_t>(number_or(value, "object", static_cast<double>(current.active)));
    if (index >= current.objects.size()) fail_request("no object is open", "open a mesh or a template");
    const std::string part = text_in(value, "part"), file = current.objects[index].part(part);
    if (file.empty())
        fail_request(fmt::format("{} has no {}", current.objects[index].name, printable(part.empty() ? "part" : part, 40)),
                     part == "annotations"   ? "annotate it first"
                     : part == "cage"        ? "make a cage first"
                     : part == "coordinates" ? "link the cage with the mesh first"
                     : part == "graph"       ? "add a relationship first"
                                             : "choose another input");
    if (settings.object == no_index || slot == "target") settings.object = index;
    if (input.reads_annotations_beside && part == "mesh" && !current.objects[index].part("annotations").empty())
        return with_beside(current.objects[index], step, settings);
    return (folder_ / file).lexically_normal();
}

void Session::name_outputs(Call& call, const JsonValue& request, const std::string& step, Settings& settings) const {
    std::map<std::string, std::string> requested;  // output -> file name, if given
    for (const JsonValue& entry : list_in(request, "keep")) {
        if (entry.IsString()) requested[text_of(entry)];
        if (!entry.IsObject()) continue;
        const std::string file = text_in(entry, "file");
        if (!is_plain_name(file))
            fail_request(fmt::format("'{}' is not a valid file name", printable(file, 60)), "use letters, digits, . - and _");
        requested[text_in(entry, "output")] = file;
    }
    for (const auto& [name, file] : requested)
        if (call.slot(name).role != Role::output) fail_request(fmt::format("'{}' is not an output", printable(name, 40)));
    const SessionState& current = state();
    std::string stem =
        settings.object < current.objects.size() ? stem_of(current.objects[settings.object].part("mesh")) : std::string();
    std::string word = call.entry().name;
    word = word.substr(word.rfind(' ') + 1);
    bool makes_mesh = false;
    for (const Slot* slot : call.parameters().slots())
        makes_mesh = makes_mesh || (slot->role == Role::output && slot->kind == Kind::mesh && slot->needed);
    if (stem.empty()) stem = word;
    else if (makes_mesh) stem += text_in(request, "as") == "deformed" ? "-deformed" : "-" + word;
    std::map<std::string, std::string> used_names;  // file name -> slot
    for (Slot* slot : call.parameters().slots()) {
        if (slot->role != Role::output) continue;
        const auto request_of_slot = requested.find(slot->name);
        const bool is_requested = request_of_slot != requested.end();
        const bool updates = slot->updated != nullptr && !slot->updated->sources.empty();
        const bool is_created = slot->updated != nullptr && slot->updated->needed;
        if (!is_requested && !updates && !slot->needed && !is_created) continue;
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
                name = fmt::format("{}-{}{}", stem, slot->name, call.usual_ending(slot->name));
        }
        if (is_requested && !request_of_slot->second.empty()) name = request_of_slot->second;
        if (updates) name = Path(slot->updated->file()).filename().string();
        if (!used_names.emplace(name, slot->name).second) {
            const std::string ending = Path(name).extension().string();
            name = fmt::format("{}-{}{}", stem, slot->name, ending);
            used_names.emplace(name, slot->name);
        }
        settings.outputs[slot->name] = name;
        add_members(settings.keep, settings.keep.GetAllocator(), slot->name, name);
        call.set_file(slot->name, folder_ / "steps" / step / name);
    }
}

Report Session::run(const JsonValue& request, Context& context) {
    const OperationEntry& entry = find_operation(text_in(request, "operation"));
    if (entry.runs_others || std::string_view(entry.name) == "operations")
        fail_request(fmt::format("'{}' cannot be run in the workbench", entry.name),
                     fmt::format("run it as a command: ostraka {}", entry.name));
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
                if (const Option* option = call.parameters().options.find(name); option != nullptr && !option->from_files)
                    fail_request(fmt::format("'{}' may be set by the caller of a command only", printable(name, 40)),
                                 "leave it out");
                if (to_compact_text(member.value).find("${") != std::string::npos)
                    fail_request(
                        fmt::format("'{}' contains '${{', which has a special meaning in study files", printable(name, 40)),
                        "leave it out of the value");
                add_members(settings.options, settings.options.GetAllocator(), name, member.value);
                add_members(settings.with, with, name, member.value);
                continue;
            }
            if (slot->role == Role::output)
                fail_request(fmt::format("'{}' is an output", printable(name, 40)), "name it in 'keep'");
            const auto resolve_input = [&](const JsonValue& value) {
                const Path file = resolved(value, *slot, step.name, settings);
                if (!slot->repeated && !slot->sources.empty())
                    fail_request(fmt::format("'{}' is given twice", printable(name, 40)));
                call.set_file(name, file);
                return reference(relative(file));
            };
            if (member.value.IsArray())
                add_members(settings.with, with, name, json_list(member.value.GetArray(), with, resolve_input));
            else add_members(settings.with, with, name, resolve_input(member.value));
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
    check_folders();
    const WriteScope write_scope(folder_);  // also for links that the folder already held
    for (const auto& [file, text] : settings.documents) require_writable_inside(file, folder_);
    std::filesystem::remove_all(folder, ignored);  // left by a killed run
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
    SessionState& current = step.state;
    const bool deforms = text_in(request, "as") == "deformed";
    std::size_t target = settings.object;
    const auto step_file = [&](const std::string& name) { return fmt::format("steps/{}/{}", step.name, name); };
    const auto exists = [&](const std::string& name) {
        return file_exists(folder_ / step_file(name)) || is_folder(folder_ / step_file(name));
    };
    // A resulting mesh is a new object; the other outputs belong to it.
    for (const auto& [output, name] : settings.outputs) {
        const Slot* slot = call.parameters().slot(output);
        if (slot->kind != Kind::mesh || !slot->needed || deforms || !exists(name)) continue;
        current.objects.push_back({free_name(current, stem_of(name)), {{"mesh", step_file(name)}}});
        target = current.active = current.objects.size() - 1;
    }
    for (const auto& [output, name] : settings.outputs) {
        if (!exists(name)) continue;
        const Slot* slot = call.parameters().slot(output);
        std::string part = part_of(slot->kind);
        if (deforms && slot->kind == Kind::mesh) part = "deformed";
        else if (deforms && (part == "cage" || part == "annotations")) part.insert(0, "deformed ");
        if (slot->kind == Kind::mesh && slot->needed && !deforms) continue;
        if (part.empty() || target >= current.objects.size() || (slot->kind == Kind::mesh && !slot->needed)) {
            const std::string object_name = target < current.objects.size() ? current.objects[target].name : std::string();
            std::erase_if(current.files, [&](const SessionFile& session_file) {
                return session_file.name == name && session_file.object == object_name;
            });
            const bool folder = is_folder(folder_ / step_file(name));
            const std::string kind = slot->kind == Kind::folder && !folder ? "file" : to_string(slot->kind);
            current.files.push_back({name, kind, step_file(name), object_name});
            if (folder) take_folder(step_file(name), current);
            continue;
        }
        current.objects[target].parts[part] = step_file(name);
        if (part == "cage") current.objects[target].parts.erase("coordinates");
        // A recipe that no longer reproduces the annotations is removed.
        if (part == "annotations" && !settings.outputs.contains("recipe")) current.objects[target].parts.erase("recipe");
    }
    if (!deforms || target >= current.objects.size()) return;
    for (const auto& [file, text] : settings.documents)
        if (file.filename().string().ends_with("-edit.json")) current.objects[target].parts["edit"] = relative(file);
}

/// Adds the meshes in an output folder as objects, with their annotations.
void Session::take_folder(const std::string& folder, SessionState& state) const {
    constexpr std::size_t maximum = 24;
    std::size_t count = 0;
    for (const std::string& name : files_in(folder_ / folder)) {
        if (extension(name) != ".ply" || ++count > maximum) continue;
        SessionObject object{free_name(state, stem_of(name)), {{"mesh", folder + "/" + name}}};
        const std::string annotations = fmt::format("{}/{}.ant.json", folder, stem_of(name));
        if (file_exists(folder_ / annotations)) object.parts["annotations"] = annotations;
        state.objects.push_back(std::move(object));
        state.active = state.objects.size() - 1;
    }
}

Path Session::save(const std::string& name, Context& context) const {
    if (!is_plain_name(name))
        fail_request(fmt::format("'{}' is not a valid folder name", printable(name, 60)), "use letters, digits, - and _");
    const SessionObject* object = state().object();
    if (object == nullptr) fail_request("no object is open", "open a mesh or a template");
    if (object->part("annotations").empty()) fail_request(object->name + " has no annotations", "annotate it first");
    const Path folder = root_ / name, template_file = folder / (name + ".template.json");
    if (file_exists(folder) || (is_folder(folder) && !std::filesystem::is_empty(folder) && !file_exists(template_file)))
        fail_input(folder.string(), "exists already and holds other data", "give another name");
    const WriteScope write_scope(root_);
    make_folder(folder);
    Call call(find_operation("template pack"));
    call.set("copy", true);
    call.set_file("output", template_file);
    for (const char* part : {"mesh", "annotations", "graph", "cage", "coordinates"})
        if (const std::string file = object->part(part); !file.empty()) call.set_file(part, (folder_ / file).lexically_normal());
    const Report report = call.run(context);
    if (!report.holds()) {
        const auto findings = list_in(report.result(), "findings");
        fail_input(object->name, findings.Empty() ? "is not sound" : text_in(findings[0], "text"), "correct it, then save again");
    }
    if (const std::string recipe = object->part("recipe"); !recipe.empty()) {
        const Path source = (folder_ / recipe).lexically_normal();
        write_file(folder / source.filename(), read_file(source));
    }
    return template_file;
}

}  // namespace ostraka

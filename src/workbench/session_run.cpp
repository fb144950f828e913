// Runs operations as steps of a session.
#include "session_names.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/safe_path.h"

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
        if (step.operation.empty() || !file.starts_with("steps/" + step.name + "/")) continue;
        for (const auto& member : step.keep.GetObject())
            if (file == "steps/" + step.name + "/" + text_of(member.value))
                return "${" + step.name + "." + text_of(member.name) + "}";
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
    std::map<std::string, std::string> wanted;  // output -> file name, if given
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
    std::map<std::string, std::string> taken;  // file name -> slot
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
    if (entry.runs_others || std::string_view(entry.name) == "operations")
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
                if (const Option* option = call.parameters().options.find(name); option != nullptr && !option->from_files)
                    fail_request("'" + printable(name, 40) + "' may be set by the caller of a command only", "leave it out");
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
    check_folders();
    const WriteScope written(folder_);  // also for links that the folder already held
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
    SessionState& now = step.state;
    const bool deforms = text_in(request, "as") == "deformed";
    std::size_t target = settings.object;
    const auto made = [&](const std::string& name) { return "steps/" + step.name + "/" + name; };
    const auto is_there = [&](const std::string& name) {
        return file_exists(folder_ / made(name)) || is_folder(folder_ / made(name));
    };
    // A resulting mesh is a new object; the other outputs belong to it.
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
            const std::string of = target < now.objects.size() ? now.objects[target].name : std::string();
            std::erase_if(now.files, [&](const SessionFile& one) { return one.name == name && one.of == of; });
            const bool folder = is_folder(folder_ / made(name));
            const std::string kind = slot->kind == Kind::folder && !folder ? "file" : to_string(slot->kind);
            now.files.push_back({name, kind, made(name), of});
            if (folder) take_folder(made(name), now);
            continue;
        }
        now.objects[target].parts[part] = made(name);
        if (part == "cage") now.objects[target].parts.erase("coordinates");
        // A recipe that no longer reproduces the annotations is removed.
        if (part == "annotations" && !settings.outputs.contains("recipe")) now.objects[target].parts.erase("recipe");
    }
    if (!deforms || target >= now.objects.size()) return;
    for (const auto& [file, text] : settings.documents)
        if (file.filename().string().ends_with("-edit.json")) now.objects[target].parts["edit"] = relative(file);
}

/// Adds the meshes in an output folder as objects, with their annotations.
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
    const WriteScope written(root_);
    make_folder(folder);
    Call call(find_operation("template pack"));
    call.set("copy", true);
    call.set_file("output", saved);
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
    return saved;
}

}  // namespace ostraka

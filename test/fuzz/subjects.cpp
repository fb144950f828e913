// Cases of the conformance kit as subjects, and functions shared by all subjects.
#include "subjects.h"

#include "ostraka/files/json_build.h"
#include "ostraka/operations/table.h"

#include <algorithm>
#include <set>

namespace ostraka::fuzz {

namespace {

/// Operations that run others have separate subjects; the others take more than a second per case.
bool is_left_out(const std::string& operation) {
    static const std::set<std::string> names{"run",
                                             "replay",
                                             "operations",
                                             "conformance run",
                                             "conformance self",
                                             "study make moulds",
                                             "study make proportions",
                                             "study make technique",
                                             "template learn",
                                             "template propagate"};
    return names.contains(operation);
}

/// The kind of file of an input: for meshes the format, since each format has its own reader.
std::string kind_of(const Slot& slot, const std::string& file) {
    const bool is_mesh = slot.kind == Kind::mesh || slot.kind == Kind::cage || slot.kind == Kind::collection;
    if (is_mesh && Path(file).has_extension()) return extension(file).substr(1);
    return slot.kind == Kind::mesh ? "mesh" : to_string(slot.kind);
}

/// Files that a run needs: the named ones, files of the same name next to them, and files named by JSON files.
class Closure {
public:
    explicit Closure(Path kit) : kit_(std::move(kit)) {}

    void add(const std::string& name) {
        const Path path = kit_ / name;
        if (std::filesystem::is_directory(path)) {
            if (!folders_.insert(name).second) return;
            for (const SubjectFile& file : files_below(path, name + "/"))
                add(Path(file.name).lexically_normal().generic_string());
            return;
        }
        if (!file_exists(path) || !names_.insert(name).second) return;
        files.push_back({name, path});
        add_beside(name);
        if (is_json_name(name) && size_of_file(path) < 300000) add_named(name, read_file(path));
    }

    std::vector<SubjectFile> files;
    [[nodiscard]] std::vector<std::string> folders() const { return {folders_.begin(), folders_.end()}; }

private:
    void add_beside(const std::string& name) {
        const Path folder = Path(name).parent_path();
        const std::string stem = Path(name).filename().string().substr(0, Path(name).filename().string().find('.'));
        for (const std::string& other : files_in(kit_ / folder))
            if (other.starts_with(stem + ".")) add((folder / other).generic_string());
    }

    void add_named(const std::string& name, const std::string& text) {
        const Path folder = Path(name).parent_path();
        for (std::size_t begin = text.find('"'); begin != std::string::npos;) {
            const std::size_t end = text.find('"', begin + 1);
            if (end == std::string::npos) return;
            const std::string word = text.substr(begin + 1, end - begin - 1);
            if (word.find('.') != std::string::npos && word.size() < 200 && word.find('\\') == std::string::npos &&
                file_exists(kit_ / folder / word))
                add((folder / word).lexically_normal().generic_string());
            begin = text.find('"', end + 1);
        }
    }

    Path kit_;
    std::set<std::string> names_, folders_;
};

std::string without_label(const std::string& file) {
    const std::size_t equals = file.find('=');
    return equals == std::string::npos ? file : file.substr(equals + 1);
}

Subject subject_of(const JsonValue& test_case, const Path& kit) {
    Subject subject;
    subject.name = text_in(test_case, "id");
    subject.keeps_inside = false;
    const std::string operation = text_in(test_case, "operation");
    Json call(rapidjson::kObjectType);
    auto& a = call.GetAllocator();
    JsonValue with(test_case["with"], a);
    Closure closure(kit);
    const Call declared(find_operation(operation));
    const auto take = [&](const Slot& slot, const std::string& text) {
        const std::string file = without_label(text);
        closure.add(file);
        if (std::filesystem::is_regular_file(kit / file)) subject.targets.push_back({kind_of(slot, file), file});
        else if (std::filesystem::is_directory(kit / file))
            for (const SubjectFile& each : files_below(kit / file, file + "/"))
                subject.targets.push_back({to_string(slot.kind), each.name});
    };
    for (const auto& member : with.GetObject()) {
        const Slot* slot = declared.parameters().slot(text_of(member.name));
        if (slot == nullptr) subject.options.push_back(text_of(member.name));
        else if (member.value.IsString()) take(*slot, text_of(member.value));
        else if (member.value.IsArray())
            for (const auto& file : member.value.GetArray())
                if (file.IsString()) take(*slot, text_of(file));
    }
    if (const JsonValue* outputs = find_member(test_case, "outputs"))
        for (const auto& member : outputs->GetObject()) add_member(with, text_of(member.name), "out/" + text_of(member.value), a);
    add_member(call, "operation", operation, a);
    add_member(call, "with", std::move(with), a);
    subject.files = std::move(closure.files);
    subject.folders = closure.folders();
    subject.folders.emplace_back("out");
    subject.files.push_back({"call.json", {}, to_compact_text(call)});
    if (!subject.options.empty()) subject.targets.push_back({"options", "call.json"});
    subject.act = call_of_file;
    return subject;
}

}  // namespace

std::string call_operation(const std::string& operation, const JsonValue& with, Stopper& stopper) {
    Context context;
    context.watch.memory_limit = stopper.memory;
    stopper.set([&context] { context.watch.cancel(); });
    struct Unset {
        Stopper& stopper;
        ~Unset() { stopper.set({}); }
    } const unset{stopper};
    Call call(find_operation(operation));
    call.set(with, operation);
    return call.run(context).to_text(ReportFormat::json);
}

std::string call_operation(const std::string& operation, const std::string& with, Stopper& stopper) {
    return call_operation(operation, parse_json(with, "the settings"), stopper);
}

std::string call_of_file(Stopper& stopper) {
    const Json call = read_json("call.json");
    return call_operation(text_in(call, "operation"), call["with"], stopper);
}

std::string call_text(const std::string& operation, const std::string& with) {
    return R"({"operation":")" + operation + R"(","with":)" + with + "}";
}

std::vector<SubjectFile> files_below(const Path& folder, const std::string& before) {
    std::vector<SubjectFile> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files.push_back({before + entry.path().lexically_relative(folder).generic_string(), entry.path()});
    std::sort(files.begin(), files.end(), [](const SubjectFile& p, const SubjectFile& q) { return p.name < q.name; });
    return files;
}

void add_cases(const Path& project, std::vector<Subject>& subjects) {
    const Path kit = project / "data" / "conformance";
    const Json document = read_json(kit / "conformance.json");
    for (const auto& test_case : list_in(document, "cases")) {
        const int code = test_case["code"].GetInt();
        if (is_left_out(text_in(test_case, "operation")) || (code != 0 && code != 3)) continue;
        Subject subject = subject_of(test_case, kit);
        if (!subject.targets.empty()) subjects.push_back(std::move(subject));
    }
}

void make_seeds(const Path& project) {
    make_formats(project);
    make_studies(project);
    make_session(project);
    make_kit(project);
}

std::vector<Subject> list_subjects(const Path& project, const Path& seeds) {
    std::vector<Subject> subjects;
    add_cases(project, subjects);
    add_formats(project, seeds, subjects);
    add_studies(project, seeds, subjects);
    add_sessions(seeds, subjects);
    add_kits(seeds, subjects);
    add_wrongdoer(subjects);
    return subjects;
}

}  // namespace ostraka::fuzz

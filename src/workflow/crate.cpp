#include "ostraka/workflow/crate.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

constexpr const char* profile = "https://w3id.org/ro/wfrun/process/0.5";

JsonValue id_of(const std::string& id, JsonAllocator& allocator) { return json_object(allocator, "@id", id); }

/// Content-based name (RFC 6920): ni:///sha-256;BASE64URL.
std::string content_id(const std::string& sha256) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    std::string id = "ni:///sha-256;";
    unsigned bits = 0, count = 0;
    for (const char c : sha256) {
        bits = (bits << 4U) | static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
        count += 4;
        while (count >= 6) {
            id += letters[(bits >> (count - 6)) & 63U];
            count -= 6;
        }
    }
    if (count > 0) id += letters[(bits << (6 - count)) & 63U];
    return id;
}

/// Relative URI (RFC 3986) of a file in the crate; names of instance folders need no escaping.
std::string uri_of(const Path& file) {
    std::string uri;
    for (const char c : file.generic_string())
        uri += std::string_view("/=,+").find(c) != std::string_view::npos ? std::string(1, c)
                                                                          : percent_encoded(std::string_view(&c, 1));
    return uri;
}

const char* media_type(const std::string& file) {
    static constexpr std::pair<const char*, const char*> types[]{
        {".json", "application/json"}, {".csv", "text/csv"},  {".md", "text/markdown"},     {".tex", "application/x-tex"},
        {".svg", "image/svg+xml"},     {".png", "image/png"}, {".txt", "text/plain"},       {".ply", "application/octet-stream"},
        {".obj", "model/obj"},         {".stl", "model/stl"}, {".glb", "model/gltf-binary"}};
    for (const auto& [ending, type] : types)
        if (file.ends_with(ending)) return type;
    return "application/octet-stream";
}

class CrateMaker {
public:
    CrateMaker(const StudyPlan& plan, const std::vector<InstanceResult>& results, Path folder)
        : plan_(plan),
          results_(results),
          folder_(std::move(folder)),
          allocator_(crate_.GetAllocator()),
          graph_(rapidjson::kArrayType),
          parts_(rapidjson::kArrayType),
          mentions_(rapidjson::kArrayType) {}

    Json make(const std::vector<std::string>& collected) {
        crate_.SetObject();
        JsonValue context(rapidjson::kArrayType);
        for (const char* context_url :
             {"https://w3id.org/ro/crate/1.1/context", "https://w3id.org/ro/terms/workflow-run/context"})
            context.PushBack(json_string(context_url, allocator_), allocator_);
        JsonValue terms = json_object(allocator_, "sha256", "https://w3id.org/ro/terms/workflow-run#sha256");
        context.PushBack(terms, allocator_);
        add_members(crate_, allocator_, "@context", std::move(context));
        for (const std::string& name : collected) add_file(name, {}, "");
        for (const char* name : {"run.json", "run.study.json"}) add_file(name, {}, "");
        for (std::size_t i = 0; i < plan_.instances.size(); ++i) add_instance(i);
        JsonValue entities(rapidjson::kArrayType);
        entities.PushBack(json_object(allocator_, "@id", "ro-crate-metadata.json", "@type", "CreativeWork", "conformsTo",
                                      id_of("https://w3id.org/ro/crate/1.1", allocator_), "about", id_of("./", allocator_)),
                          allocator_);
        const std::string title = plan_.study.title.empty() ? plan_.study.file.filename().string() : plan_.study.title;
        std::string note = text_in(*plan_.study.document, "note");
        if (note.empty()) note = "Results of 'ostraka run' for the study " + plan_.study.file.filename().string();
        entities.PushBack(json_object(allocator_, "@id", "./", "@type", "Dataset", "name", title, "description", note,
                                      "datePublished", latest_.empty() ? "1970-01-01T00:00:00Z" : latest_, "license",
                                      "The licence of the input data applies to the results", "conformsTo",
                                      json_list_of(id_of(profile, allocator_), allocator_), "hasPart", std::move(parts_),
                                      "mentions", std::move(mentions_)),
                          allocator_);
        entities.PushBack(
            json_object(allocator_, "@id", profile, "@type", "CreativeWork", "name", "Process Run Crate", "version", "0.5"),
            allocator_);
        entities.PushBack(json_object(allocator_, "@id", "#ostraka", "@type", "SoftwareApplication", "name", "ostraka",
                                      "description", "Semantics-aware modelling of 3D shapes", "softwareVersion", version()),
                          allocator_);
        for (auto& entity : graph_.GetArray()) entities.PushBack(entity, allocator_);
        add_members(crate_, allocator_, "@graph", std::move(entities));
        return std::move(crate_);
    }

private:
    void add_file(const Path& name, const std::string& checksum, const std::string& description) {
        const std::string id = uri_of(name);
        if (!entity_ids_.insert(id).second) return;
        parts_.PushBack(id_of(id, allocator_), allocator_);
        JsonValue file = json_object(allocator_, "@id", id, "@type", "File", "name", name.filename().string(), "encodingFormat",
                                     media_type(name.string()));
        if (!description.empty()) add_members(file, allocator_, "description", description);
        if (!checksum.empty())
            add_members(file, allocator_, "sha256", checksum, "contentSize", std::to_string(size_of_file(folder_ / name)));
        graph_.PushBack(file, allocator_);
    }

    std::string add_content(const std::string& checksum, const std::string& name) {
        std::string id = content_id(checksum);
        if (entity_ids_.insert(id).second)
            graph_.PushBack(json_object(allocator_, "@id", id, "@type", "CreativeWork", "name", name, "sha256", checksum),
                            allocator_);
        return id;
    }

    std::string output_id(std::size_t i, const OutputRecord& output, const std::string& description) {
        const Path file = plan_.instances[i].folder / output.file;
        if (!output.kept) return add_content(output.sha256, output.file);
        if (!output.is_folder) {
            add_file(file, output.sha256, description);
            return uri_of(file);
        }
        std::string id = uri_of(file) + "/";
        if (entity_ids_.insert(id).second) {
            parts_.PushBack(id_of(id, allocator_), allocator_);
            graph_.PushBack(
                json_object(allocator_, "@id", id, "@type", "Dataset", "name", output.file, "description", description),
                allocator_);
        }
        return id;
    }

    void add_instance(std::size_t i) {
        const InstanceResult& result = results_[i];
        const StudyInstance& instance = plan_.instances[i];
        const bool is_made = result.state == InstanceState::done || result.state == InstanceState::unchanged;
        if (!is_made && result.state != InstanceState::failed) return;
        const StudyStep& step = plan_.study.steps[instance.step];
        const std::string program_name = step.operation != nullptr ? step.operation->name : instance.program.front();
        JsonValue objects(rapidjson::kArrayType), products(rapidjson::kArrayType);
        for (const auto& [name, value] : result.record.depends) {
            if (name.starts_with("option ")) {
                const std::string id = "#" + uri_of(instance.folder / name.substr(7));
                graph_.PushBack(
                    json_object(allocator_, "@id", id, "@type", "PropertyValue", "name", name.substr(7), "value", value),
                    allocator_);
                objects.PushBack(id_of(id, allocator_), allocator_);
            } else if (name.starts_with("input ") && value.size() > 65) {
                objects.PushBack(id_of(add_content(value.substr(0, 64), value.substr(65)), allocator_), allocator_);
            }
        }
        for (const StudyInput& input : instance.inputs)
            if (input.instance != no_instance) {
                const auto& outputs = results_[input.instance].record.outputs;
                if (const auto output = outputs.find(input.output); output != outputs.end() && output->second.kept)
                    objects.PushBack(id_of(output_id(input.instance, output->second, ""), allocator_), allocator_);
            }
        for (const auto& [name, checksum] : result.record.read)
            objects.PushBack(id_of(add_content(checksum, Path(name).filename().string()), allocator_), allocator_);
        for (const auto& [name, output] : result.record.outputs)
            if (!output.sha256.empty())
                products.PushBack(
                    id_of(output_id(i, output, fmt::format("'{}' of {}", name, instance.title(plan_.study))), allocator_),
                    allocator_);
        const Path report = instance.folder / "report.json";
        if (is_made) {
            add_file(instance.folder / "record.json", {},
                     fmt::format("dependencies and outputs of {}", instance.title(plan_.study)));
            add_file(report, {}, fmt::format("report of {}", instance.title(plan_.study)));
            products.PushBack(id_of(uri_of(report), allocator_), allocator_);
        }
        const std::string id = "#" + uri_of(instance.folder);
        JsonValue action = json_object(
            allocator_, "@id", id, "@type", "CreateAction", "name", instance.title(plan_.study), "description",
            (step.operation != nullptr ? "ostraka " : "") + program_name, "instrument",
            id_of(step.operation != nullptr ? "#ostraka" : program(program_name), allocator_), "actionStatus",
            id_of(is_made ? "http://schema.org/CompletedActionStatus" : "http://schema.org/FailedActionStatus", allocator_));
        add_nonempty_members(action, allocator_, "object", std::move(objects), "result", std::move(products), "startTime",
                             result.record.began, "endTime", result.record.ended, "error", result.problem);
        latest_ = std::max(latest_, result.record.ended);
        graph_.PushBack(action, allocator_);
        mentions_.PushBack(id_of(id, allocator_), allocator_);
    }

    std::string program(const std::string& name) {
        std::string id = "#program-" + percent_encoded(name);
        if (entity_ids_.insert(id).second)
            graph_.PushBack(
                json_object(allocator_, "@id", id, "@type", "SoftwareApplication", "name", name, "softwareVersion", version()),
                allocator_);
        return id;
    }

    const StudyPlan& plan_;
    const std::vector<InstanceResult>& results_;
    const Path folder_;
    Json crate_;
    JsonAllocator& allocator_;
    JsonValue graph_, parts_, mentions_;
    std::set<std::string> entity_ids_;
    std::string latest_;
};

}  // namespace

Json crate_of(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
              const std::vector<std::string>& collected) {
    return CrateMaker(plan, results, folder).make(collected);
}

Json run_request_to_json(const RunRequest& request) {
    Json document = json_document("run");
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "folder", request.study_folder.string(), "quick", request.quick, "set", request.set, "only",
                request.only);
    return document;
}

RunRequest read_run_request(const Path& folder) {
    const Path file = folder / "run.json";
    if (!is_folder(folder) || !file_exists(file))
        fail_input(folder.string(), "is not the folder of a run: it has no run.json", "name the folder that 'ostraka run' wrote");
    const Json document = read_json(file);
    check_format(document, "ostraka-run", file.string(), "name the folder that 'ostraka run' wrote");
    validate(document, "run", file.string());
    RunRequest request;
    request.study_folder = text_in(document, "folder");
    request.quick = flag_in(document, "quick");
    for (const auto& setting : list_in(document, "set")) request.set.push_back(text_of(setting));
    for (const auto& step_name : list_in(document, "only")) request.only.push_back(text_of(step_name));
    return request;
}

}  // namespace ostraka

#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/transfer/survival.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct SurvivalCommand {
    std::string mesh, annotations;
    ReadAnnotationsOptions reading;
    SurvivalOptions options;
};

int run(const Session& session, SurvivalCommand& command) {
    const MeshFile file = read_mesh(command.mesh);
    const AnnotationSet set = read_annotations(command.annotations, file.mesh, command.reading);
    const std::vector<Survival> survivals = smallest_resolutions(file.mesh, set, command.options);
    if (session.json) {
        Provenance provenance;
        provenance.command = "annotation survival";
        provenance.options = list_options(command.options);
        provenance.add_input(command.mesh);
        provenance.add_input(command.annotations);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        for (const Survival& survival : survivals) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "id", JsonValue(survival.id), allocator);
            add_member(entry, "tag", survival.tag, allocator);
            add_member(entry, "vertices", JsonValue(static_cast<std::uint64_t>(survival.vertices)), allocator);
            if (!survival.end.empty()) add_member(entry, "end", survival.end, allocator);
            list.PushBack(entry, allocator);
        }
        add_member(result, "annotations", std::move(list), allocator);
        session.print_report(provenance, document, result);
    } else {
        std::vector<std::vector<std::string>> rows;
        for (const Survival& survival : survivals)
            rows.push_back({std::to_string(survival.id), survival.tag, std::to_string(survival.vertices),
                            survival.end.empty() ? "survived every resolution tried" : survival.end});
        std::cout << table({"id", "tag", "smallest number of vertices", "and below"}, rows);
    }
    return done;
}

}  // namespace

void add_annotation_survival(CLI::App& annotation, Session& session) {
    const auto command = std::make_shared<SurvivalCommand>();
    CLI::App* app = session.add(annotation, "survival", "the smallest resolution at which each annotation survives",
                                [&session, command] { return run(session, *command); });
    app->add_option("mesh", command->mesh, "the annotated mesh")->required();
    app->add_option("annotations", command->annotations, "its annotations")->required();
    add_flags(app, command->options);
    add_flags(app, command->reading);
}

}  // namespace ostraka::app

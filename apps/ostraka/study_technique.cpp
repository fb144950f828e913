// ostraka study technique: which objects of a collection are wheel-made, which hand-made.
#include "number_lists.h"
#include "study.h"
#include "study_technique_report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/technique_study.h"
#include "ostraka/io/mesh_file.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct StudyTechnique {
    StudyFiles files;
    std::string up;
    TechniqueOptions slices;
    TechniqueStudyOptions options;

    /// Of the option, else as the annotations say, else z.
    [[nodiscard]] Vector upward(const CollectionObject& object, const Mesh& mesh) const {
        std::array<double, 3> way{0, 0, 1};
        if (!up.empty()) way = direction_of(up, "--up");
        else if (!object.annotations.empty()) way = read_annotations(object.annotations, mesh).up.value_or(way);
        return {way[0], way[1], way[2]};
    }

    int run(const Session& session) const {
        check_options(slices, "study technique");
        check_options(options, "study technique");
        if (!up.empty()) direction_of(up, "--up");
        Provenance provenance{"study technique", list_options(slices), {}};
        for (const auto& option : list_options(options)) provenance.options.push_back(option);
        provenance.options.emplace_back("up", up.empty() ? "auto" : up);
        const Collection collection = files.read(session, provenance);
        std::vector<std::string> what{"technique slices 1", up};
        for (const auto& [key, value] : list_options(slices)) what.push_back(key + "=" + value);
        const auto results = for_each_object(collection, files.store(), what, [&](const CollectionObject& object) {
            if (object.mesh.empty())
                throw Error(ErrorKind::input, object.name, "has landmarks but no mesh", "give a mesh, or leave the object out");
            const MeshFile file = read_mesh(object.mesh);
            return in_file(object.mesh.string(),
                           [&] { return technique_to_json(measure_technique(file.mesh, upward(object, file.mesh), slices)); });
        });
        std::vector<TechniqueObject> objects;
        for (std::size_t i = 0; i < results.size(); ++i) {
            if (!results[i].problem.empty()) continue;
            objects.push_back({collection.objects[i].name, collection.objects[i].label, technique_from_json(results[i].result)});
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        const std::size_t left_out = report_failures(session, collection, results, result, allocator);
        if (objects.empty())
            throw Error(ErrorKind::input, files.collection, "no object of the collection could be studied",
                        "see the notes above for each of them");
        const TechniqueStudy study = study_technique(objects, options);
        add_technique_result(result, study, objects, allocator);
        write_study_report(files.in("technique.json"), "technique", result, provenance);
        write_technique_tables(files, study, objects);
        draw_technique(files, study, objects);
        if (session.json) {
            session.print_report(provenance, document, result);
        } else {
            std::cout << technique_summary(study, objects, left_out);
        }
        // Without known answers the question was whether there are two groups at all.
        return study.learned || study.separated ? done : answer_is_no;
    }
};

}  // namespace

void add_study_technique(CLI::App& study, Session& session) {
    const auto work = std::make_shared<StudyTechnique>();
    CLI::App* command = session.add(study, "technique", "which bodies are wheel-made and which hand-made, by their lower slices",
                                    [&session, work] { return work->run(session); });
    add_study_files(command, work->files, true);
    command->add_option("--up", work->up, "x,y,z: upward direction of all objects; else as their annotations say, else 0,0,1");
    add_flags(command, work->slices);
    add_flags(command, work->options);
}

}  // namespace ostraka::app

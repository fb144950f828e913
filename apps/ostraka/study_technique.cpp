// ostraka study technique: which objects of a collection are wheel-made, which hand-made.
#include "number_lists.h"
#include "study.h"
#include "study_technique_report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/technique_study.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

namespace ostraka::app {

namespace {

struct StudyTechnique {
    StudyFiles files;
    std::string up;
    TechniqueOptions slices;
    TechniqueStudyOptions options;

    /// Of the option, else as the annotations say, else z; and where it is from.
    struct Upward {
        Vector way;
        const char* from;
    };
    [[nodiscard]] Upward upward(const CollectionObject& object, const Mesh& mesh) const {
        const auto vector = [](const std::array<double, 3>& way) { return Vector(way[0], way[1], way[2]); };
        std::optional<std::array<double, 3>> known;
        if (up.empty()) {
            if (!object.annotations.empty()) known = read_annotations(object.annotations, mesh).up;
            return known ? Upward{vector(*known), "annotations"} : Upward{Vector(0, 0, 1), "assumed"};
        }
        const Vector way = vector(direction_of(up, "--up"));
        try {
            if (!object.annotations.empty()) known = read_annotations(object.annotations, mesh).up;
        } catch (const Error&) {
            known.reset();  // nothing is asked of these annotations
        }
        // Another direction: by more than half a degree.
        const bool other = known && way * vector(*known) < std::cos(0.5 * std::numbers::pi / 180) *
                                                               std::sqrt(way.squared_length() * vector(*known).squared_length());
        return {way, other ? "option against the annotations" : "option"};
    }

    /// Directions that nobody gave, or that were given twice.
    static void note_directions(const Session& session, const Collection& collection, const std::vector<ObjectResult>& results) {
        const auto say = [&](const char* from, const std::string& words) {
            std::vector<std::string> names;
            for (std::size_t i = 0; i < results.size(); ++i)
                if (results[i].problem.empty() && std::string_view(results[i].result["upFrom"].GetString()) == from)
                    names.push_back(collection.objects[i].name);
            if (!names.empty())
                session.note("note: " + words + " (" + std::to_string(names.size()) + " objects: " + names.front() +
                             (names.size() > 1 ? " ..." : "") + ")");
        };
        say("assumed", "no upward direction is known, z is taken; else give --up, or annotations that have one");
        say("option against the annotations", "--up is taken, though the annotations have another upward direction");
    }

    int run(const Session& session) const {
        check_options(slices, "study technique");
        check_options(options, "study technique");
        if (!up.empty()) direction_of(up, "--up");
        Provenance provenance{"study technique", list_options(slices), {}};
        for (const auto& option : list_options(options)) provenance.options.push_back(option);
        provenance.options.emplace_back("up", up.empty() ? "auto" : up);
        const Collection collection = files.read(session, provenance);
        std::vector<std::string> what{"technique slices 2", up};
        for (const auto& [key, value] : list_options(slices)) what.push_back(key + "=" + value);
        const auto results = for_each_object(collection, files.store(), what, [&](const CollectionObject& object) {
            if (object.mesh.empty())
                throw Error(ErrorKind::input, object.name, "has landmarks but no mesh", "give a mesh, or leave the object out");
            const MeshFile file = read_mesh(object.mesh);
            return in_file(object.mesh.string(), [&] {
                const Upward direction = upward(object, file.mesh);
                Json kept = technique_to_json(measure_technique(file.mesh, direction.way, slices));
                add_member(kept, "upFrom", direction.from, kept.GetAllocator());
                return kept;
            });
        });
        note_directions(session, collection, results);
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
        // Whether they can be told apart is the question, and without known answers whether there are two groups at all.
        return study.separated ? done : answer_is_no;
    }
};

}  // namespace

void add_study_technique(CLI::App& study, Session& session) {
    const auto work = std::make_shared<StudyTechnique>();
    CLI::App* command = session.add(study, "technique", "which bodies are wheel-made and which hand-made, by their lower slices",
                                    [&session, work] { return work->run(session); });
    add_study_files(command, work->files, true);
    command->add_option(
        "--up", work->up,
        "x, y, z, -x, -y, -z or three numbers: upward direction of all objects; else as their annotations say, else 0,0,1");
    add_flags(command, work->slices);
    add_flags(command, work->options);
}

}  // namespace ostraka::app

// ostraka study make technique: a population of statuettes whose technique is known.
#include "study.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/core/csv.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shapes/statuettes.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct MakePopulation {
    std::string folder;
    PopulationOptions options;

    /// Mesh and annotations in the folder, and what was measured on the annotations.
    std::vector<std::string> make_one(const StatuetteParameters& parameters, const std::string& name) const {
        const Statuette statuette = generate_statuette(parameters);
        Provenance provenance{"study make technique", list_options(parameters), {}};
        MeshExtras extras;
        extras.face_labels = statuette.face_labels;
        for (const std::int32_t label : statuette.face_labels) {
            const auto& [red, green, blue] = statuette.part_colours[static_cast<std::size_t>(label)];
            extras.face_colours.push_back({red, green, blue, 255});
        }
        const Path mesh = Path(folder) / (name + ".ply");
        WriteOptions write_options;
        write_options.comment = provenance.to_line();
        write_mesh(mesh, statuette.mesh, extras, write_options);
        const AnnotationSet set = annotate_statuette(statuette);
        write_annotations(Path(folder) / (name + ".ant.json"), set, statuette.mesh, mesh.string(), provenance);

        std::vector<std::string> row{name, parameters.technique};
        for (const auto& [key, value] : list_options(parameters))
            if (key != "technique") row.push_back(value);
        row.push_back(std::to_string(statuette.mesh.number_of_vertices()));
        row.emplace_back(is_closed(statuette.mesh) ? "true" : "false");
        return row;
    }

    static bool is_closed(const Mesh& mesh) {
        for (const Halfedge h : mesh.halfedges())
            if (mesh.is_border(h)) return false;
        return true;
    }

    int run(const Session& session) const {
        const std::vector<StatuetteParameters> population = draw_population(options);
        make_collection_folder(folder);
        const std::size_t digits = std::to_string(population.size()).size();
        std::vector<std::vector<std::string>> rows(population.size());
        Progress progress("statuettes", population.size());
        parallel_for(
            population.size(),
            [&](std::size_t i) {
                const std::string number = std::to_string(i + 1);
                rows[i] = make_one(population[i], "statuette-" + std::string(digits - number.size(), '0') + number);
                progress.advance();
            },
            1);
        std::vector<std::string> header{"name", "label"};
        for (const auto& [key, value] : list_options(population.front()))
            if (key != "technique") header.push_back(key);
        header.emplace_back("mesh-vertices");
        header.emplace_back("closed");
        std::string csv = csv_row(header);
        for (const auto& row : rows) csv += csv_row(row);
        write_file(Path(folder) / "truth.csv", csv);

        std::size_t wheel = 0;
        for (const auto& parameters : population) wheel += parameters.technique == "wheel" ? 1 : 0;
        if (session.json) {
            Json document;
            auto& allocator = document.GetAllocator();
            JsonValue result(rapidjson::kObjectType);
            add_member(result, "folder", folder, allocator);
            add_member(result, "objects", JsonValue(static_cast<std::uint64_t>(rows.size())), allocator);
            add_member(result, "wheel", JsonValue(static_cast<std::uint64_t>(wheel)), allocator);
            add_member(result, "hand", JsonValue(static_cast<std::uint64_t>(rows.size() - wheel)), allocator);
            session.print_report({"study make technique", list_options(options), {}}, document, result);
        } else {
            std::cout << rows.size() << " statuettes of level " << options.level << ", " << wheel << " wheel-made and "
                      << rows.size() - wheel << " hand-made, and truth.csv in " << printable(folder) << "\n";
        }
        return done;
    }
};

}  // namespace

void add_study_make_technique(CLI::App& made, Session& session) {
    const auto work = std::make_shared<MakePopulation>();
    CLI::App* command = session.add(made, "technique", "statuettes thrown on the wheel and built by hand, with their annotations",
                                    [&session, work] { return work->run(session); });
    command->add_option("folder", work->folder, "folder to write meshes, annotations and truth.csv to")->required();
    add_flags(command, work->options);
}

}  // namespace ostraka::app

// study make technique
#include "operations/study/made_statuettes.h"

#include "ostraka/files/csv.h"

#include <CGAL/boost/graph/helpers.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace ostraka {

namespace {

struct StudyMakeTechnique final : StudyMakeStatuettes {
    void declare(Parameters& p) override {
        declare_folder(p, "folder to write: meshes, annotations and their true techniques (truth.csv)");
        options.declare_options(p.options);
        p.report.values(text("folder"));
        for (const char* count : {"objects", "wheel", "hand"}) p.report.values(integer(count));
    }

    void run(Context& context, Report& report) override {
        std::vector<std::array<std::string, 2>> meshes(static_cast<std::size_t>(options.objects));
        const std::vector<StatuetteParameters> statuettes =
            make_population(context, options, true, [&](std::size_t i, const Statuette& statuette) {
                meshes[i] = {std::to_string(statuette.mesh.number_of_vertices()),
                             CGAL::is_closed(statuette.mesh) ? "true" : "false"};
            });
        std::vector<std::string> header{"name", "label"};
        for (const auto& [key, value] : declare_options(statuettes.front()))
            if (key != "technique") header.push_back(key);
        header.insert(header.end(), {"mesh-vertices", "closed"});
        std::string truth = csv_row(header);
        for (std::size_t i = 0; i < statuettes.size(); ++i) {
            std::vector<std::string> row{name_of(i, statuettes.size()), option_text(statuettes[i], "technique")};
            for (const auto& [key, value] : declare_options(statuettes[i]))
                if (key != "technique") row.push_back(value);
            row.insert(row.end(), meshes[i].begin(), meshes[i].end());
            truth += csv_row(row);
        }
        write_file(folder.in("truth.csv"), truth);

        const auto wheel =
            static_cast<std::size_t>(std::count_if(statuettes.begin(), statuettes.end(), [](const auto& parameters) {
                return parameters.technique == StatuetteParameters::Technique::wheel;
            }));
        report("folder", folder.path().string())("objects", statuettes.size())("wheel", wheel)("hand", statuettes.size() - wheel);
        report.line(fmt::format("{} statuettes of level {}, {} wheel-made and {} hand-made, and truth.csv in {}",
                                statuettes.size(), options.level, wheel, statuettes.size() - wheel,
                                printable(folder.path().string())));
    }

    PopulationOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_make_technique() { return make<StudyMakeTechnique>(); }

}  // namespace ostraka

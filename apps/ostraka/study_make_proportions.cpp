// ostraka study make proportions: a population of statuettes some of whose proportions are fixed.
#include "commands.h"
#include "study.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/core/csv.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shapes/statuettes.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

/// The measures that `study proportions` takes on these statuettes. The two arms of each are equally long.
constexpr const char* measures_file = R"({
  "format": "ostraka-measures",
  "version": 1,
  "measures": [
    {"name": "total height", "tool": "bounding", "annotation": "votive statuette", "direction": "up"},
    {"name": "base diameter", "tool": "ruler", "annotation": "base", "from": "base right", "to": "base left"},
    {"name": "right arm", "tool": "tape", "annotation": "right arm", "geodesic": "exact", "from": "arm joint right",
     "via": ["arm outside 1 right", "arm outside 2 right", "arm outside 3 right", "arm outside 4 right", "arm outside 5 right"], "to": "hand end right"},
    {"name": "left arm", "tool": "tape", "annotation": "left arm", "geodesic": "exact", "from": "arm joint left",
     "via": ["arm outside 1 left", "arm outside 2 left", "arm outside 3 left", "arm outside 4 left", "arm outside 5 left"], "to": "hand end left"},
    {"name": "head height", "tool": "ruler", "annotation": "head", "from": "head joint", "to": "top of the head"}
  ]
}
)";

constexpr std::array<const char*, 4> size_names{"total height", "base diameter", "arm length", "head height"};
/// Medians as in the thesis's Table 3.1, mm.
constexpr std::array<double, 4> medians{198, 58, 80, 42};

struct MakeProportions {
    std::string folder;
    std::vector<std::string> together{"arm length", "base diameter"};
    bool none = false;
    int objects = 40;
    double size_deviation = 0.12, ratio_deviation = 0.15, planted_deviation = 0.03, scan_noise = 0.05;
    std::uint64_t seed = 1, vertices = 10000;

    template <class Visitor>
    void describe(Visitor& visit) {
        visit("objects", objects, "number of statuettes", Range{1, 100000});
        visit("size-deviation", size_deviation, "standard deviation of the logarithm of their common size", Range{0, 0.2});
        visit("ratio-deviation", ratio_deviation, "standard deviation of the logarithm of ratios that are not fixed",
              Range{0, 0.2});
        visit("planted-deviation", planted_deviation, "standard deviation of the logarithm of fixed ratios", Range{0, 0.2});
        visit("scan-noise", scan_noise, "standard deviation of each vertex along its normal, mm", Range{0, 0.5});
        visit("seed", seed, "of the whole population", Range{0, 1e9});
        visit("vertices", vertices, "of each mesh", Range{4000, 5e6});
    }

    /// Sizes of statuette i, each draw within three deviations.
    [[nodiscard]] std::array<double, 4> sizes(std::size_t i) const {
        Random random(seed, i);
        const auto draw = [&](double deviation) { return deviation * std::clamp(random.normal(), -3.0, 3.0); };
        const double size = draw(size_deviation), shared = draw(ratio_deviation / std::sqrt(2.0));
        std::array<double, 4> result{};
        for (std::size_t k = 0; k < 4; ++k) {
            const double own = draw(ratio_deviation / std::sqrt(2.0)), small = draw(planted_deviation / std::sqrt(2.0));
            result.at(k) = medians.at(k) * std::exp(size + (planted(k) ? shared + small : own));
        }
        return result;
    }
    [[nodiscard]] bool planted(std::size_t k) const {
        return !none && std::find(together.begin(), together.end(), size_names.at(k)) != together.end();
    }

    void make_one(const StatuetteParameters& parameters, const std::string& name) const {
        const Statuette statuette = generate_statuette(parameters);
        const Provenance provenance{"study make proportions", list_options(parameters), {}};
        MeshExtras extras;
        extras.face_labels = statuette.face_labels;
        WriteOptions options;
        options.comment = provenance.to_line();
        const Path mesh = Path(folder) / (name + ".ply");
        write_mesh(mesh, statuette.mesh, extras, options);
        write_annotations(Path(folder) / (name + ".ant.json"), annotate_statuette(statuette), statuette.mesh, mesh.string(),
                          provenance);
    }

    int run(const Session& session) const {
        check_options(*this, "study make proportions");
        if (!none && together.size() < 2) fail_usage("--fixed names one measure", "a proportion is between two");
        PopulationOptions population;
        population.objects = objects;
        population.seed = seed;
        population.vertices = vertices;
        population.scan_noise = scan_noise;
        std::vector<StatuetteParameters> list = draw_population(population);
        std::string truth =
            csv_row({"name", "total height [mm]", "base diameter [mm]", "right arm [mm]", "left arm [mm]", "head height [mm]"});
        std::vector<std::string> names;
        const std::size_t width = std::to_string(list.size()).size();
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::array<double, 4> drawn = sizes(i);
            list[i].height = drawn[0];
            list[i].base_diameter = drawn[1];
            list[i].arm_length = drawn[2];
            list[i].head_height = drawn[3];
            const std::string number = std::to_string(i + 1);
            names.push_back("statuette-" + std::string(width - number.size(), '0') + number);
            truth +=
                csv_row({names.back(), digits(drawn[0]), digits(drawn[1]), digits(drawn[2]), digits(drawn[2]), digits(drawn[3])});
        }
        make_collection_folder(folder);
        Progress progress("statuettes", list.size());
        parallel_for(
            list.size(),
            [&](std::size_t i) {
                make_one(list[i], names[i]);
                progress.advance();
            },
            1);
        write_file(Path(folder) / "truth.csv", truth);
        write_file(Path(folder) / "statuettes.measures.json", measures_file);

        std::string kept = "right arm and left arm";
        std::string group;
        for (std::size_t k = 0; k < 4; ++k)
            if (planted(k)) group += (group.empty() ? "" : ", ") + std::string(size_names.at(k));
        if (session.json) {
            Json document(rapidjson::kObjectType);
            auto& allocator = document.GetAllocator();
            JsonValue result(rapidjson::kObjectType);
            add_member(result, "folder", folder, allocator);
            add_member(result, "objects", JsonValue(static_cast<std::uint64_t>(list.size())), allocator);
            add_member(result, "fixed", group, allocator);
            session.print_report({"study make proportions", list_options(*this), {}}, document, result);
        } else {
            std::cout << list.size() << " statuettes with truth.csv and statuettes.measures.json in " << printable(folder)
                      << "; in fixed proportion: " << kept << (group.empty() ? "" : "; " + group) << '\n';
        }
        return done;
    }
};

}  // namespace

void add_study_make_proportions(CLI::App& made, Session& session) {
    const auto work = std::make_shared<MakeProportions>();
    CLI::App* command = session.add(
        made, "proportions", "statuettes with annotations some of whose proportions are fixed, and the measures that find them",
        [&session, work] { return work->run(session); });
    command->add_option("folder", work->folder, "folder to write meshes, annotations, measures and truth.csv to")->required();
    command
        ->add_option(
            "--fixed", work->together,
            "measures in fixed proportion to each other, comma separated: total height, base diameter, arm length, head height")
        ->delimiter(',')
        ->check(CLI::IsMember(std::vector<std::string>(size_names.begin(), size_names.end())))
        ->capture_default_str();
    command->add_flag("--none", work->none, "no fixed proportion, but that the two arms are equally long");
    add_flags(command, *work);
}

}  // namespace ostraka::app

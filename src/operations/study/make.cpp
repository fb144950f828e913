// study make: synthetic collections with known answers.
#include "operations/operations.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/collection/objects.h"
#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/csv.h"
#include "ostraka/synthetic/head_casts.h"
#include "ostraka/synthetic/statuettes.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

/// The output folder, common to all of them.
struct StudyMake : Operation {
    void describe_folder(Parameters& p, const std::string& help) { p.output("folder", Kind::collection, folder, help); }

    /// Creates the folder, which must not contain objects yet, and makes the objects in parallel.
    template <class MakeOne>
    void make_each(const std::string& phase, std::size_t count, const MakeOne& make_one) const {
        check_new_collection(folder.path());
        folder.open(0, false);
        Progress progress(phase, count);
        parallel_for(
            count,
            [&](std::size_t i) {
                make_one(i);
                progress.advance();
            },
            1);
    }

    void write(const std::string& name, const Mesh& mesh, const MeshExtras& extras, const Provenance& provenance) const {
        write_mesh(folder.in(name + ".ply"), mesh, extras, {.comment = provenance.to_line()});
    }

    FolderOutput folder;
};

/// Common to the operations that make statuettes.
struct StudyMakeStatuettes : StudyMake {
    static std::string name_of(std::size_t i, std::size_t count) { return "statuette-" + padded(i + 1, count); }
    /// Generates the i-th statuette of a population. If its dimensions give no valid surface (for instance arms that touch the
    /// head), they are drawn again from the same population with another seed, and `drawn` changes. After ten attempts, throws
    /// as generate_statuette does.
    template <class Population>
    static Statuette generate_one(Population population, std::size_t i, StatuetteParameters& drawn) {
        constexpr int attempts = 10;
        for (int attempt = 1;; ++attempt) {
            try {
                return generate_statuette(drawn);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::failure || attempt == attempts) throw;
            }
            population.seed = (population.seed + 1000003) % 1000000000;
            drawn = draw_population(population).at(i);
        }
    }

    /// Makes the whole population and returns the parameters used. Notes report which were drawn again.
    template <class Population>
    std::vector<StatuetteParameters> make_population(
        Context& context, const Population& population, bool coloured,
        const std::function<void(std::size_t, const Statuette&)>& inspect = {}) const {
        std::vector<StatuetteParameters> all_parameters = draw_population(population);
        std::vector<char> is_drawn_again(all_parameters.size(), 0);
        const std::string command = context.provenance().command;
        make_each("statuettes", all_parameters.size(), [&](std::size_t i) {
            const std::uint64_t seed = all_parameters[i].seed;
            const Statuette statuette = generate_one(population, i, all_parameters[i]);
            is_drawn_again[i] = all_parameters[i].seed != seed ? 1 : 0;
            write_one(name_of(i, all_parameters.size()), statuette, all_parameters[i], command, coloured);
            if (inspect) inspect(i, statuette);
        });
        for (std::size_t i = 0; i < all_parameters.size(); ++i)
            if (is_drawn_again[i] != 0)
                context.note(name_of(i, all_parameters.size()) +
                             " was generated again: its first dimensions gave no valid surface");
        return all_parameters;
    }

    /// Writes mesh and annotations; their provenance holds the parameters of the statuette.
    void write_one(const std::string& name, const Statuette& statuette, const StatuetteParameters& parameters,
                   const std::string& command, bool coloured) const {
        const Provenance provenance{command, list_options(parameters), {}};
        MeshExtras extras;
        extras.face_labels = statuette.face_labels;
        if (coloured)
            for (const std::int32_t label : statuette.face_labels) {
                const auto& [red, green, blue] = statuette.part_colours[static_cast<std::size_t>(label)];
                extras.face_colours.push_back({red, green, blue, 255});
            }
        write(name, statuette.mesh, extras, provenance);
        write_annotations(folder.in(name + ".ant.json"), annotate_statuette(statuette), statuette.mesh, name + ".ply",
                          provenance);
    }
};

/// The measures that `study proportions` takes on these statuettes. Both arms of a statuette have the same length.
constexpr const char* statuette_measures = R"({
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

struct StudyMakeProportions final : StudyMakeStatuettes {
    void describe(Parameters& p) override {
        describe_folder(p, "folder to write meshes, annotations, measures and truth.csv to");
        options.describe(p.options);
        p.report.values(text("folder"), integer("objects"), text("fixed"));
    }

    void run(Context& context, Report& report) override {
        const std::vector<StatuetteParameters> statuettes = make_population(context, options, false);
        std::string truth =
            csv_row({"name", "total height [mm]", "base diameter [mm]", "right arm [mm]", "left arm [mm]", "head height [mm]"});
        for (std::size_t i = 0; i < statuettes.size(); ++i) {
            const std::string arm = digits(statuettes[i].arm_length);
            truth += csv_row({name_of(i, statuettes.size()), digits(statuettes[i].height), digits(statuettes[i].base_diameter),
                              arm, arm, digits(statuettes[i].head_height)});
        }
        write_file(folder.in("truth.csv"), truth);
        write_file(folder.in("statuettes.measures.json"), statuette_measures);

        std::string fixed;
        for (const std::string size : ProportionedOptions::size_names)
            if (options.is_fixed(size)) fixed += (fixed.empty() ? "" : ", ") + size;
        report("folder", folder.path().string())("objects", statuettes.size())("fixed", fixed);
        report.line(fmt::format(
            "{} statuettes with truth.csv and statuettes.measures.json in {}; in fixed proportion: right arm and left arm{}",
            statuettes.size(), printable(folder.path().string()), fixed.empty() ? "" : "; " + fixed));
    }

    ProportionedOptions options;
};

struct StudyMakeTechnique final : StudyMakeStatuettes {
    void describe(Parameters& p) override {
        describe_folder(p, "folder to write meshes, annotations and truth.csv to");
        options.describe(p.options);
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
        for (const auto& [key, value] : list_options(statuettes.front()))
            if (key != "technique") header.push_back(key);
        header.insert(header.end(), {"mesh-vertices", "closed"});
        std::string truth = csv_row(header);
        for (std::size_t i = 0; i < statuettes.size(); ++i) {
            std::vector<std::string> row{name_of(i, statuettes.size()), option_text(statuettes[i], "technique")};
            for (const auto& [key, value] : list_options(statuettes[i]))
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

struct StudyMakeMoulds final : StudyMake {
    void describe(Parameters& p) override {
        describe_folder(p, "folder to write to: a PLY mesh with labelled faces for each object, and truth.csv");
        population.describe(p.options);
        cast.describe(p.options);
        p.report.values(integer("objects"), texts("parts"));
        p.report.people_table("", {"label", "part"});
    }

    void run(Context& context, Report& report) override {
        const std::vector<PlannedHead> plan = plan_heads(population, cast);
        const Provenance provenance = context.provenance();
        std::vector<HeadCast> casts(plan.size());
        make_each("heads", plan.size(), [&](std::size_t i) {
            casts[i] = cast_head(plan[i].shape, plan[i].cast);
            MeshExtras extras;
            extras.face_labels = std::move(casts[i].face_labels);
            write(plan[i].name, casts[i].mesh, extras, provenance);
            if (cast.body)
                write_annotations(folder.in(plan[i].name + ".ant.json"), annotate_head(casts[i], extras.face_labels),
                                  casts[i].mesh, plan[i].name + ".ply", provenance);
            casts[i].mesh = {};
        });
        std::string truth = csv_row({"name", "label", "hair", "beard", "missing piece", "wear", "shrinkage", "seed"});
        const auto yes_or_no = [](bool value) { return value ? "yes" : "no"; };
        for (std::size_t i = 0; i < plan.size(); ++i) {
            const char* hair = plan[i].shape.hat != HeadShape::Hat::none ? "hat" : plan[i].shape.long_hair ? "long" : "short";
            truth += csv_row({plan[i].name, plan[i].mould, hair, yes_or_no(casts[i].beard), yes_or_no(casts[i].chunk),
                              number(casts[i].wear, 4), number(casts[i].shrinkage, 4), std::to_string(plan[i].cast.seed)});
        }
        write_file(folder.in("truth.csv"), truth);

        const std::vector<std::string> parts = head_part_names();
        report("objects", plan.size())("parts", parts);
        report.line(fmt::format("{} {} in {}, their moulds in truth.csv", plan.size(),
                                cast.body ? "statuettes with heads" : "heads", printable(folder.path().string())));
        for (std::size_t part = 0; part < parts.size(); ++part) report.row("", {part, parts[part]});
    }

    /// Annotates the parts, and "head" for all of them except the body and the stump of the neck.
    static AnnotationSet annotate_head(const HeadCast& head_cast, const std::vector<std::int32_t>& labels) {
        std::map<std::int32_t, std::string> names;
        const std::vector<std::string> parts = head_part_names();
        for (std::size_t part = 0; part < parts.size(); ++part) names[static_cast<std::int32_t>(part)] = parts[part];
        AnnotationSet set = regions_from_labels(head_cast.mesh, labels, names);
        set.object_class = "statuette";
        set.unit = "mm";
        set.up = head_cast.up;
        Annotation head;
        head.id = static_cast<int>(parts.size());
        head.tag = "head";
        for (std::size_t f = 0; f < labels.size(); ++f)
            if (labels[f] < static_cast<std::int32_t>(HeadPart::stump)) head.faces.push_back(static_cast<Index>(f));
        head.colour = fresh_colour(head_cast.mesh, set, head);
        set.annotations.push_back(std::move(head));
        return set;
    }

    MouldPopulationOptions population;
    CastOptions cast;
};

}  // namespace

std::unique_ptr<Operation> make_study_make_proportions() { return make<StudyMakeProportions>(); }
std::unique_ptr<Operation> make_study_make_moulds() { return make<StudyMakeMoulds>(); }
std::unique_ptr<Operation> make_study_make_technique() { return make<StudyMakeTechnique>(); }

}  // namespace ostraka

// study make proportions
#include "operations/study/made_statuettes.h"

#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

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
    void declare(Parameters& p) override {
        declare_folder(p, "folder to write: meshes, annotations, measure definitions and true sizes (truth.csv)");
        options.declare_options(p.options);
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

}  // namespace

std::unique_ptr<Operation> make_study_make_proportions() { return make<StudyMakeProportions>(); }

}  // namespace ostraka

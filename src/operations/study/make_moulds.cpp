// study make moulds
#include "operations/study/made_collection.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/files/csv.h"
#include "ostraka/synthetic/head_casts.h"

#include <fmt/core.h>

#include <map>

namespace ostraka {

namespace {

struct StudyMakeMoulds final : StudyMake {
    void declare(Parameters& p) override {
        declare_folder(p, "folder to write: PLY meshes with labelled faces, and their true moulds (truth.csv)");
        population.declare_options(p.options);
        cast.declare_options(p.options);
        p.report.values(integer("objects"), texts("parts"));
        p.report.text_table("", {"label", "part"});
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
                write_annotations(folder.in(plan[i].name + ".ant.json"),
                                  {casts[i].mesh, annotate_head(casts[i], extras.face_labels)}, plan[i].name + ".ply",
                                  provenance);
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
        head.colour = unused_colour({head_cast.mesh, set}, head);
        set.annotations.push_back(std::move(head));
        return set;
    }

    MouldPopulationOptions population;
    CastOptions cast;
};

}  // namespace

std::unique_ptr<Operation> make_study_make_moulds() { return make<StudyMakeMoulds>(); }

}  // namespace ostraka

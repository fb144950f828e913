// template learn: learns a class of objects from its members.
#include "operations/operations.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct TemplateLearn final : Operation {
    void declare(Parameters& p) override {
        p.input(
            "template", Kind::template_package, template_input,
            "template (.template.json), or, for a class of landmarks only, the first landmark file (.mrk.json, .fcsv, .tps, .pp, "
            ".nts, .dta, .pts, .csv, Morphologika), whose first specimen determines the set of landmarks and the orientation "
            "of the mean");
        p.input("members", Kind::mesh, members,
                "mesh file of each member, with annotations in NAME.ant.json beside it; for a class of landmarks, further "
                "landmark files, with one or several members each")
            .many()
            .with_annotations_beside()
            .optional();
        p.input_option("out-of-class", Kind::mesh, out_of_class,
                       "mesh of an object that is not a member, such as a member of another class; repeatable; these objects "
                       "determine the dissimilarity up to which objects are recognised as members")
            .many()
            .with_annotations_beside();
        p.output("output", Kind::folder, output, "folder for the class and a copy of the template; created if missing").flag();
        p.options("name", name, "name of the class; by default the class of the template");
        vocabulary.declare(p, as_template_words);
        p.options("given", given, "same effect as --correspondence given");
        p.options(
            "missing", missing,
            "class of landmarks: members that lack a landmark are refused, or the landmark is estimated by the thin-plate "
            "spline of the mean of complete members, by regression, or by the mirrored other side ('left', 'right' in names)",
            Choices{"refuse", "tps", "regression", "mirror"});
        specimen_options.declare_options(p.options);
        options.declare_options(p.options);
        p.report.values(text("class"), integer("members"), text("archetype"), number("meanSize", "", "length"),
                        number("diversity"), numbers("varianceShares"));
        p.report.text_table("members", {"member", "placed by", "scale", "centroid size", "from the mean %", "archetype"});
        p.report.text_table("ranges",
                            {"quantity", "n", "min", "median", "max", "mean", "sd", "from", "to", "recognised to", "unit"});
        p.report.text_table("modes", {"mode", "deviation", "% of variance", "together"});
    }

    void check() const override {
        if (!is_landmark_class() && !members) fail_usage("the class is empty: there is no member", "give TEMPLATE MEMBER ...");
        if (is_landmark_class() && out_of_class)
            fail_usage("--out-of-class with a class of landmarks",
                       "leave out --out-of-class, which applies to classes of meshes only");
        std::vector<std::string> names;
        if (is_landmark_class()) names.push_back(template_input.file());
        for (std::size_t i = 0; i < members.size(); ++i) names.push_back(members.file(i));
        check_object_names(names);
        if (!name.empty()) check_class_name(name);
    }

    void run(Context& context, Report& report) override {
        if (given) options.correspondence = CorrespondenceChoice::given;
        const ShapeClass learnt = is_landmark_class() ? learn_landmarks(context) : learn_meshes(context);
        report.notes(learnt.notes);
        report_result(report, learnt);
    }

    [[nodiscard]] bool is_landmark_class() const { return is_landmark_file(template_input.file()); }

    ShapeClass learn_meshes(Context& context) {
        const Template& package = *template_input;
        check_usable(package, template_input.file());
        if (name.empty()) name = package.file.object_class;
        if (name.empty()) {
            name = template_input.file_name();
            const std::string ending = ".template.json";
            if (name.size() > ending.size() && name.ends_with(ending)) name.resize(name.size() - ending.size());
        }
        std::replace(name.begin(), name.end(), ' ', '-');
        check_class_name(name);
        Progress progress("fitting the template to objects", members.size() + out_of_class.size());
        const auto fit_to = [&](const FileInput& files) {
            std::vector<LearntMember> learnt_members;
            for (std::size_t i = 0; i < files.size(); ++i, progress.advance()) {
                const WholeObject& given_object = files.load<WholeObject>(read_member, i);
                std::optional<WholeObject> renamed;
                if (vocabulary && package.annotations)
                    vocabulary.words().rename_like(renamed.emplace(given_object).annotations, *package.annotations);
                const WholeObject& object = renamed ? *renamed : given_object;
                learnt_members.push_back(
                    in_file(files.file(i), [&] { return learn_member(class_template(package), object, options); }));
            }
            return learnt_members;
        };
        const std::vector<LearntMember> fitted = fit_to(members), others = fit_to(out_of_class);
        ShapeClass result = learn_class(class_template(package), fitted, options, others);
        const bool in_place = open_for(result);
        if (!in_place) {
            for (const PackagedFile& part : package.file.contents) check_copy(part.file);
            static_cast<void>(copy_template(package.file, output.open(), result.template_file, context.provenance()));
        }
        output.write(name + ".mean.ply", with_points(package.mesh->mesh, points_of(result.modes.mean)));
        write_class(output.open(), result, context.provenance());
        return result;
    }

    /// Learns a class of landmarks; all files are members.
    ShapeClass learn_landmarks(Context& context) {
        if (name.empty()) name = "landmarks";
        std::vector<Path> files{template_input.file()};
        for (std::size_t i = 0; i < members.size(); ++i) files.push_back(members.path(i));
        LandmarkMembers read;
        context.record([&] { read = read_landmark_members(files, missing, specimen_options); });
        const LandmarkTemplate& first_landmarks = read.landmark_template;
        const std::vector<LearntMember>& fitted = read.members;
        for (const LearntMember& member : fitted) context.notes(member.name, member.fit.notes);
        ShapeClass result = learn_class(first_landmarks.known(), fitted, options);
        if (!open_for(result)) write_file(output.in(result.template_file), read_file(files[0]));
        write_landmark_mean(output.in(name + ".mean.mrk.json"), first_landmarks, result.modes.mean, context.provenance());
        write_class(output.open(), result, context.provenance());
        return result;
    }

    /// Names the class, creates the folder, and checks that no output overwrites an input. Returns whether the template file
    /// lies in the output folder.
    bool open_for(ShapeClass& learnt) const {
        learnt.name = name;
        learnt.template_file = template_input.file_name();
        output.open(0, false);  // keeps the files of other classes in the folder
        for (const char* ending : {".class.json", ".mean.npy", ".modes.npy"}) static_cast<void>(output.in(name + ending));
        return same_place(output.open() / learnt.template_file, template_input.file());
    }
    void check_copy(const Path& part) const {
        const Path copy_name = part.filename();
        if (!same_place(output.open() / copy_name, part)) static_cast<void>(output.in(copy_name.string()));
    }

    static void report_result(Report& report, const ShapeClass& learnt) {
        const ShapeModes& modes = learnt.modes;
        std::vector<double> variance_fractions;
        for (const double variance : modes.variances) variance_fractions.push_back(modes.total > 0 ? variance / modes.total : 0);
        report("class", learnt.name)("members", learnt.members.size())("archetype", learnt.members[modes.archetype].name)(
            "meanSize", modes.mean_size)("diversity", learnt.diversity)("varianceShares", variance_fractions);
        for (std::size_t i = 0; i < learnt.members.size(); ++i)
            report.row("members", {learnt.members[i].name, learnt.members[i].placed_by, number(learnt.members[i].scale, 4),
                                   number(modes.centroid_sizes[i], 5), number(100 * modes.distances[i], 3),
                                   i == modes.archetype ? "archetype" : ""});
        report.line("");
        for (const LearntRange& range : learnt.ranges) {
            if (range.count == 0) continue;
            const auto text = [](const std::optional<double>& x, int digits = 4) { return x ? number(*x, digits) : "-"; };
            report.row("ranges", {range.quantity.text(), range.count, text(range.min), text(range.median), text(range.max),
                                  text(range.mean), text(range.deviation, 3), text(range.low), text(range.high),
                                  text(range.recognised), range.quantity.unit});
        }
        if (!modes.variances.empty()) report.line("");
        double sum = 0;
        for (std::size_t k = 0; k < modes.variances.size() && k < 10; ++k) {
            sum += modes.variances[k];
            report.row("modes", {k + 1, number(std::sqrt(modes.variances[k]), 4),
                                 number(100 * modes.variances[k] / modes.total, 3), number(100 * sum / modes.total, 3)});
        }
        report.line(fmt::format("{} members of '{}', archetype {}", learnt.members.size(), printable(learnt.name),
                                printable(learnt.members[modes.archetype].name)));
    }

    TemplateInput template_input;
    FileInput members, out_of_class;
    FolderOutput output;
    std::string name;
    bool given = false;
    MissingInMembers missing = MissingInMembers::refuse;
    SpecimenOptions specimen_options;
    VocabularyOption vocabulary;
    LearnOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_template_learn() { return make<TemplateLearn>(); }

}  // namespace ostraka

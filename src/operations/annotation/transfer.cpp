// annotation transfer
#include "operations/mesh/baking.h"
#include "operations/registered.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/angles.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/orientation.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/transfer/misalignment.h"
#include "ostraka/transfer/moved_annotations.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Shares below 1e-9 % are rounding errors and shown as 0.
std::string percent(double share) { return std::abs(share) < 1e-11 ? "0" : number(100 * share, 3); }

std::string remarks_on(const TransferScore& score) {
    std::vector<std::string> remarks;
    if (score.outcome != TransferOutcome::kept) remarks.push_back(to_string(score.outcome));
    if (score.by_closest_point > 0) remarks.push_back(std::to_string(score.by_closest_point) + " by closest point");
    if (score.without_place > 0) remarks.push_back(std::to_string(score.without_place) + " without a place");
    if (score.relocated > 0) remarks.push_back(std::to_string(score.relocated) + " on another layer, placed again");
    if (score.detours > 0) remarks.push_back(std::to_string(score.detours) + " detours");
    if (score.voted) remarks.emplace_back("outlines crossed, filled face by face");
    else if (score.crossings_resolved) remarks.emplace_back("crossing outlines resolved");
    if (!score.note.empty()) remarks.push_back(score.note);
    return joined(remarks, "; ");
}

struct AnnotationTransfer final : Operation {
    void declare(Parameters& p) override {
        p.input("source", Kind::mesh, source, "annotated mesh");
        p.input("annotations", Kind::annotations, annotations, "annotations of the source mesh (.ant.json)");
        p.input("target", Kind::mesh, target, "mesh of the same object at another resolution");
        p.output("output", Kind::annotations, output, "annotations of the target mesh to write (.ant.json)");
        p.output_option(
            "back", Kind::annotations, back,
            "annotation file to write: the result transferred back to the source mesh; this second transfer is scored as well");
        p.output_option("ply", Kind::mesh, coloured,
                        "target mesh to write, coloured by its annotations (PLY or another format with colours)");
        p.output_option("colours", Kind::mesh, baked,
                        "target mesh to write, with the colours of the source: an image if the source has one and the format "
                        "keeps it (.obj, .ply, .glb), else colours of vertices");
        p.output_option("refined-mesh", Kind::mesh, refined, "with --refine: the target mesh with the inserted vertices");
        p.output_option("map", Kind::index_map, map,
                        "with --refine: JSON file to write: for each new face, the index of the old face");
        options.declare_options(p.options);
        p.options("register", registers, "first register the source onto the target; the two meshes may differ in unit and pose",
                  Anything{});

        p.report.values(number("meanDistance", "", "length"), any("registration"));
        Baking::declare_report(p.report);
        for (const char* direction : {"annotations", "back"})
            p.report.table(
                direction, integer("id", "id"), text("tag", "tag"), text("sourceType"), text("targetType", "type"),
                text("outcome"), text("note"), number("sourceArea", "", "length^2"), number("targetArea", "", "length^2"),
                number("sourcePerimeter", "", "length"), number("targetPerimeter", "", "length"), number("distortion.A", "A %"),
                number("distortion.P", "P %"), number("distortion.P/A", "P/A %"), number("distortion.A/P", "A/P %"),
                number("distortion.C", "C %"), number("distortion.average", "mean %"), number("sourceLength", "", "length"),
                number("targetLength", "", "length"), number("hausdorff", "Hausdorff"), number("overlap", "overlap"),
                number("wrongSide"), text_only("by ray"), integer("correspondence.vertices"), integer("correspondence.byRay"),
                integer("correspondence.byClosestPoint"), integer("correspondence.withoutPlace"),
                integer("correspondence.relocated"), integer("correspondence.detours"), boolean("crossingsResolved"),
                boolean("voted"), text_only("remarks"));
    }

    void check() const override {
        if (options.refine != static_cast<bool>(refined))
            fail_usage("--refine inserts vertices on the target",
                       "give --refine together with --refined-mesh FILE for the mesh that results");
        if (map && !refined) fail_usage("--map needs --refine", "leave it out or refine");
        if (const std::string kind = extension(refined.file()); kind == ".stl" || kind == ".glb")
            fail_usage("annotations need a mesh whose vertices keep their order, which " + kind + " files do not",
                       "write a .ply, .obj or .off");
    }

    void run(Context&, Report& report) override {
        const Stopwatch reading;
        const Mesh& onto = target->mesh;
        const AnnotatedMeshView given(source->mesh, annotations.on(source->mesh));
        report.run("reading", reading.seconds());
        const std::optional<RegisteredSource> registered = registers ? registered_source(report) : std::nullopt;
        const AnnotatedMeshView from = registered ? AnnotatedMeshView(*registered) : given;
        const Stopwatch tree;
        const auto search = in_file(target.file(), [&] { return std::make_unique<SurfaceSearch>(onto); });
        report.run("tree", tree.seconds());
        TransferResult there = in_file(target.file(), [&] { return transfer(from, *search, options); });
        if (there.turned_over)
            report.note(
                fmt::format("{} is inside out: the faces of the source were turned over in memory (ostraka mesh repair "
                            "corrects the file)",
                            is_inside_out(onto) ? target.file() : source.file()));
        const Misalignment apart = find_misalignment(from.mesh, *search);
        report("meanDistance", apart.distance);
        if (apart.is_significant) report.note(message_about(apart, search->diagonal(), printable(from.annotations.unit, 20)));
        note_unused_options(there.annotations, report);
        const AnnotatedMeshView on(there.refined ? there.refined->mesh : onto, there.annotations);
        std::optional<TransferResult> again;
        if (back) {
            const auto home = in_file(source.file(), [&] { return std::make_unique<SurfaceSearch>(from.mesh); });
            TransferOptions how = options;
            how.refine = false;
            again = transfer(on, *home, how);
            if (registered) take_home(*registered, again->annotations);
        }

        // All work is done, so what is written now is complete.
        if (coloured) coloured.write(on.mesh, colour_by_annotation(on));
        if (baked) bake_colours(from.mesh, on.mesh, report);
        if (map) map.write({"face-origin", there.refined->face_origin, onto.number_of_faces()});
        report.run("checks", there.times.checks);
        report.run("correspondence", there.times.correspondence);
        report.run("paths", there.times.paths);
        report.run("regions", there.times.regions);
        report.run("scores", there.times.scores);
        report.line(source.file_name() + " -> " + target.file_name());
        report_result(report, "annotations", there.scores);
        if (again) {
            report.line("and back");
            report_result(report, "back", again->scores);
            back.write(std::move(again->annotations), source->mesh, source.file());
        }
        output.write(std::move(there.annotations), on.mesh, there.refined ? refined.file() : target.file());
        if (refined) refined.write(std::move(there.refined->mesh));
    }

    /// The source, registered to the target.
    struct RegisteredSource : AnnotatedMesh {
        Motion motion;
    };
    [[nodiscard]] std::optional<RegisteredSource> registered_source(Report& report) const {
        const Mesh &from = source->mesh, &onto = target->mesh;
        const AnnotationSet& set = annotations.on(from);
        const Stopwatch clock;
        const MeshRegistration found = ostraka::registered(source, target);
        report.run("registration", clock.seconds());
        const double diagonal = box_diagonal(onto);
        if (found.verdict != RegistrationVerdict::aligned && !options.force)
            fail_input(source.file() + " onto " + target.file(), message_about(found, diagonal),
                       "or --force to go on with the best motion found");
        report.notes(remarks_on(found));
        RegisteredSource registered{
            {moved(from, found.motion), moved_annotations({from, set}, found.motion, unit_scaled(set.unit, found.motion.scale))},
            found.motion};
        report("registration", json_object(report.allocator(), "verdict", to_string(found.verdict), "matrix",
                                           pose_to_json(found.motion, report.allocator()), "scale", found.motion.scale, "rms",
                                           found.agreement.rms, "share", found.agreement.share));
        report.line("registered: rotated by " + number(Eigen::AngleAxisd(found.motion.rotation).angle() / degree, 4) +
                    " degrees, scaled by " + number(found.motion.scale, 6) + "; " + message_about(found, diagonal));
        if (registered.annotations.unit != set.unit)
            report.note("lengths were in " + printable(set.unit, 20) + " and are " +
                        (registered.annotations.unit.empty() ? "in an unknown unit" : "in " + registered.annotations.unit) +
                        " on the target");
        return registered;
    }

    /// Writes the target with the colours of the source, whose mesh is given in the place of the target.
    void bake_colours(const Mesh& from, const Mesh& onto, Report& report) const {
        if (!has_colours(source->extras))
            fail_input(source.file(), "has no image and no colours", "leave out --colours, or give a source with colours");
        const MeshFile coloured_source{from, source->extras, {}, {}};
        MeshExtras extras;
        const Baking baking;
        if (!source->extras.appearance.empty() && keeps_texture(baked))
            baking.to_image(onto, extras, coloured_source, source.file(), baked.file(), nullptr, report);
        else baking.to_vertices(onto, extras, coloured_source, source.file(), report);
        baked.write(onto, extras);
    }

    /// Transforms annotations of the registered source back to the source, and measures there.
    void take_home(const RegisteredSource& registered, AnnotationSet& set) const {
        AnnotationSet home =
            moved_annotations({source->mesh, set}, registered.motion.inverse(), annotations.on(source->mesh).unit);
        refresh_measures(source->mesh, home);
        set = std::move(home);
    }

    static void report_result(Report& report, const std::string& table, const std::vector<TransferScore>& scores) {
        report.empty_table(table);
        for (const TransferScore& score : scores) {
            Report::Row row = report.row(table);
            row("id", score.id)("tag", score.tag)("sourceType", to_string(score.source_type))(
                "targetType", to_string(score.target_type))("outcome", to_string(score.outcome));
            if (!score.note.empty()) row("note", score.note);
            const Distortions d = distortions(score);
            const bool kept = score.outcome == TransferOutcome::kept, region = score.source_type == AnnotationType::region,
                       both = region && score.target_type == AnnotationType::region;
            if (region) {
                row("sourceArea", score.source_area)("targetArea", score.target_area)("sourcePerimeter", score.source_length)(
                    "targetPerimeter", score.target_length);
                const auto shown = [&](double value) { return kept ? percent(value) : "-"; };
                if (both && score.target_area > 0)
                    row("distortion.A", d.area, shown(d.area))("distortion.P", d.perimeter, shown(d.perimeter))(
                        "distortion.P/A", d.perimeter_by_area, shown(d.perimeter_by_area))("distortion.A/P", d.area_by_perimeter,
                                                                                           shown(d.area_by_perimeter))(
                        "distortion.C", d.circularity, shown(d.circularity))("distortion.average", d.mean, shown(d.mean));
                if (score.overlap) row("overlap", *score.overlap, both && kept ? number(*score.overlap, 5) : "-");
                row("wrongSide", score.wrong_side);
            } else {
                row("sourceLength", score.source_length)("targetLength", score.target_length);
            }
            if (score.source_length > 0 && kept) row.shown("distortion.P", percent(d.perimeter));
            if (score.hausdorff) row("hausdorff", *score.hausdorff, number(*score.hausdorff, 3));
            row("correspondence.vertices", score.vertices)("correspondence.byRay", score.by_ray)(
                "correspondence.byClosestPoint", score.by_closest_point)("correspondence.withoutPlace", score.without_place)(
                "correspondence.relocated", score.relocated)("correspondence.detours", score.detours)(
                "crossingsResolved", score.crossings_resolved)("voted", score.voted)
                .shown("by ray", std::to_string(score.by_ray) + "/" + std::to_string(score.vertices))
                .shown("remarks", remarks_on(score));
            if (score.outcome == TransferOutcome::lost && table == "annotations") report.answer_no();
        }
    }

    /// --metric, --spikes and --rounding concern outlines along edges alone.
    void note_unused_options(const AnnotationSet& carried, Report& report) const {
        const TransferOptions defaults;
        std::vector<std::string> unused;
        if (options.metric != defaults.metric) unused.emplace_back("--metric");
        if (options.spikes != defaults.spikes) unused.emplace_back("--spikes");
        if (options.rounding != defaults.rounding) unused.emplace_back("--rounding");
        const auto free = std::count_if(carried.annotations.begin(), carried.annotations.end(), is_free);
        if (free == 0 || unused.empty()) return;
        report.note(std::to_string(free) + " of " + std::to_string(carried.annotations.size()) +
                    " annotations have free outlines, which do not depend on " + joined(unused, ", ") +
                    ": add --outlines kept or --outlines edges for outlines along edges");
    }

    MeshInput source, target;
    AnnotationsInput annotations;
    AnnotationsOutput output, back;
    MeshOutput coloured, baked, refined;
    IndexMapOutput map;
    TransferOptions options;
    bool registers = false;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_transfer() { return std::make_unique<AnnotationTransfer>(); }

}  // namespace ostraka

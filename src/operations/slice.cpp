// slice: cuts an object into slices, describes and draws them.
#include "operations/operations.h"
#include "operations/slice_report.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/catalogue/entry.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/memory.h"
#include "ostraka/figures/catalogue.h"
#include "ostraka/figures/slice_drawing.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/slicing/silhouette.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

enum class SliceForm { json, csv, sheet, mesh, profile };

/// The output: one format, chosen by the file extension, or all formats if the name has none and denotes a folder.
class SliceOutput final : public FolderOutput {
public:
    void check() const override {
        for (std::size_t i = 0; i < sources.size(); ++i)
            if (fills_folder(i)) check_folder(i);
            else if (!form_of(sources[i].file))
                fail_usage(fmt::format("slices cannot be written to '{}'", printable(file(i), 60)),
                           "end its name in .json, .csv, .svg, .pdf, .png or .ply, or give a folder for all of them");
    }

    [[nodiscard]] bool fills_folder(std::size_t i) const override {
        return is_folder(sources[i].file) || extension(sources[i].file).empty();
    }

    /// Lists the files to write, and creates their folders.
    [[nodiscard]] std::vector<std::pair<SliceForm, Path>> files(bool with_profile) const {
        std::vector<std::pair<SliceForm, Path>> outputs;
        for (std::size_t i = 0; i < sources.size(); ++i) {
            if (!fills_folder(i)) {
                outputs.emplace_back(*form_of(sources[i].file), sources[i].file);
                continue;
            }
            for (const auto& [form, file_name] : {std::pair{SliceForm::json, "slices.json"},
                                                  {SliceForm::csv, "slices.csv"},
                                                  {SliceForm::sheet, "slices.svg"},
                                                  {SliceForm::mesh, "slices.ply"}})
                outputs.emplace_back(form, in(file_name, i));
            if (with_profile) outputs.emplace_back(SliceForm::profile, in("profile.svg", i));
        }
        return outputs;
    }

private:
    static std::optional<SliceForm> form_of(const Path& file) {
        const std::string ending = extension(file);
        if (ending == ".json") return SliceForm::json;
        if (ending == ".csv") return SliceForm::csv;
        if (ending == ".svg" || ending == ".pdf" || ending == ".png") return SliceForm::sheet;
        if (ending == ".ply") return SliceForm::mesh;
        return std::nullopt;
    }
};

struct SliceObject final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations,
                "annotations of the mesh (.ant.json): unit, upward direction, parts")
            .optional();
        p.output_option("output", Kind::folder, output,
                        "folder for all outputs, or one file: .json (all results), .csv (descriptors), .svg, .pdf, .png "
                        "(drawing), .ply (slices on the mesh)")
            .many();
        p.output_option("profile", Kind::picture, profile, "profile drawing to write (.svg, .pdf, .png)");
        p.options("annotation", names, "id or tag of a region to slice; several for their union; the whole object if left out")
            .words();
        p.options.group("Planes");
        p.options("direction", direction, "direction perpendicular to the slices",
                  direction_words("--direction", {"up", "principal", "rotation", "skeleton"}));
        up.declare(p, "upward direction; by default the upward direction of the annotations, or 0,0,1");
        p.options("count", count, "number of layers of equal height, with a slice in the middle of each (default 50)",
                  Range{1, 1e6});
        p.options("spacing", spacing, "distance between slices, counted upwards from the lowest point", Anything{},
                  "the mesh's unit");
        p.options("heights", heights, "heights of the slices above the lowest point, separated by commas", Anything{},
                  "the mesh's unit");
        p.options("range", range, "for --count and --spacing: lower and upper end of the sliced range, fractions of the height",
                  Range{0, 1});
        p.options("plane", plane, "one slice only, in the plane given by a point and the normal: x,y,z,nx,ny,nz");
        p.options.group("What is reported and drawn");
        p.options("medial-axis", residues,
                  "also compute medial axes of the slices, pruned at these residues, like 0.01,0.05,0.15", Range{0.001, 1});
        p.options("axes", axes, "also report the straightness of the object relative to the axes that `ostraka axis` computes");
        p.options("unit", unit, "unit of the mesh's coordinates; by default the unit of the annotations");
        p.options("title", title, "title of the drawings; by default the name of the mesh file");
        p.options("profile-angle", angle, "direction of the profile's section about the axis; default: automatic",
                  Range{-360, 360}, "degrees");
        p.options("drawn", drawn, "maximum number of slices that the drawing shows", Range{1, 10000});
        p.options("colour-by", colour_by,
                  "quantity that colours the .ply output: height, or a descriptor by its name in the .csv output",
                  Choices(slice_quantities()));
        p.options.group("The tubular part");
        tube_options.declare_options(p.options);
        declare_slices(p.report);
    }

    void check() const override {
        check_planes();
        if (!annotations && !names.empty())
            fail_usage(fmt::format("--annotation '{}' names a part of {}, but no annotation file is given",
                                   printable(names[0], 60), printable(mesh.file(), 60)),
                       "put it after the mesh: ostraka slice MESH ANNOTATIONS --annotation ...");
        if (!profile) return;
        if (const std::string ending = extension(profile.file());
            !profile.file().empty() && ending != ".svg" && ending != ".png" && ending != ".pdf")
            fail_usage(fmt::format("'{}' is not a drawing", profile.file()), "end its name in .svg, .pdf or .png");
        if (direction == "skeleton") fail_usage("--profile with --direction skeleton", "a profile has a straight axis");
        if (!plane.empty()) fail_usage("--profile with --plane", "a profile is cut along an axis: --direction, --profile-angle");
    }

    void run(Context& context, Report& report) override {
        read_part();
        const SlicedObject cut = in_file(mesh.file(), [&] { return cut_slices(); });
        if (!cut.reason.empty()) {
            report.note(fmt::format("{}: {} (slice along another --direction)", mesh.file(), cut.reason));
            return report.answer_no();
        }
        add_slices(report, {cut, unit_of_lengths, !plane.empty(), compared_axes(sliced_mesh(), faces, cut, axes),
                            thickness_homogeneity(cut.slices),
                            plane.empty() ? tubular_part(cut.stack(), cut.descriptors, tube_options) : Tube{}});
        for (const auto& [form, file] : output.files(plane.empty() && direction != "skeleton"))
            write(form, file, cut, context, report);
        if (profile && is_drawable(profile.file_name(), cut, report)) draw_profile(profile.path(), true, cut, report);
        add_notes(report, cut);
        if (!cut.met()) report.answer_no();
    }

    void check_planes() const {
        const int ways = (count ? 1 : 0) + (spacing ? 1 : 0) + (heights.empty() ? 0 : 1);
        if (ways > 1) fail_usage("heights are specified in more than one way", "give one of --count, --spacing and --heights");
        if (!plane.empty() && (ways > 0 || direction != "up"))
            fail_usage("--plane is one slice", "leave out --count, --spacing, --heights, --direction");
        if (direction == "skeleton" && (spacing || !heights.empty()))
            fail_usage("--spacing and --heights with --direction skeleton", "give --count");
        if (spacing && !(*spacing > 0 && *spacing <= max_coordinate))
            fail_usage("--spacing is " + number(*spacing), "give a length above 0, in the mesh's unit");
        for (const double height : heights)
            if (!(std::abs(height) <= max_coordinate))
                fail_usage("--heights has " + number(height), "give heights above the lowest point, in the mesh's unit");
        if (range.size() != 2 || !(range[0] < range[1]))
            fail_usage(fmt::format("--range is '{}'", comma_separated(range)),
                       "give two fractions of the height, the lower one first, like 0,0.4");
        if (!plane.empty()) static_cast<void>(frame_of_plane());
    }

    static std::string comma_separated(const std::vector<double>& numbers) {
        return joined(numbers, ",", [](double x) { return number(x); });
    }

    [[nodiscard]] std::optional<AxisMethod> requested_axis() const {
        for (const AxisMethod method : {AxisMethod::principal, AxisMethod::rotation, AxisMethod::skeleton})
            if (direction == to_string(method)) return method;
        return std::nullopt;
    }

    [[nodiscard]] SliceFrame frame_of_plane() const {
        const std::string problem = fmt::format("--plane is '{}'", comma_separated(plane));
        if (plane.size() != 6) fail_usage(problem, "give six numbers: a point and the normal");
        if (!is_place(plane[0], plane[1], plane[2]))
            fail_usage(problem + ": its point is not valid", "give finite coordinates, within those of the mesh");
        const Vector normal(plane[3], plane[4], plane[5]);
        if (unit_vector(normal) == CGAL::NULL_VECTOR)
            fail_usage(problem + ": its normal has no direction", "give finite numbers that are not all 0");
        return slice_frame({plane[0], plane[1], plane[2]}, normal);
    }

    /// The mesh, cut along the outlines of the sliced part if these are free.
    [[nodiscard]] const Mesh& sliced_mesh() const { return along_edges ? along_edges->object().mesh : mesh->mesh; }

    /// Sets unit, up direction and faces from the options, or else from the annotations.
    void read_part() {
        unit_of_lengths = unit;
        std::array<double, 3> upward{0, 0, 1};
        if (annotations) {
            const AnnotationSet& set = annotations.on(mesh->mesh);
            if (unit.empty()) unit_of_lengths = set.unit;
            if (set.up) upward = *set.up, up_known = true;
            if (!names.empty()) along_edges.emplace(AnnotatedMeshView(mesh->mesh, set));
            for (const auto& name : names) {
                const Annotation& annotation =
                    *along_edges->object().annotations.find(find_annotation(set, name, annotations.file()).id);
                if (annotation.type != AnnotationType::region)
                    fail_usage(fmt::format("annotation '{}' is not a region", name), "only regions can be sliced");
                faces.insert(faces.end(), annotation.faces.begin(), annotation.faces.end());
            }
            std::sort(faces.begin(), faces.end());
            faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        }
        if (up) upward = *up.value(), up_known = true;
        upwards = {upward[0], upward[1], upward[2]};
    }

    [[nodiscard]] SlicedObject cut_slices() const {
        SlicedObject cut;
        if (!plane.empty()) {
            cut = slice_parallel(sliced_mesh(), frame_of_plane(), {0}, faces);
        } else {
            CutOptions options{requested_axis(), upwards, {heights, spacing, count.value_or(50), range[0], range[1]}, {}};
            if (!options.direction && direction != "up") {
                const auto along = direction_of(direction, "--direction");
                options.up = {along[0], along[1], along[2]};
            }
            // A slice crosses about 3 sqrt(number of faces) edges, with points and descriptors for each.
            const double crossed_edges = 3 * std::sqrt(static_cast<double>(sliced_mesh().number_of_faces()));
            require_memory(200 * crossed_edges * static_cast<double>(count.value_or(50)),
                           std::to_string(count.value_or(50)) + " slices", "request fewer (--count)");
            cut = cut_object(sliced_mesh(), faces, options);
        }
        if (!residues.empty()) add_medial_axes(cut, residues);
        return cut;
    }

    void write(SliceForm form, const Path& file, const SlicedObject& cut, Context& context, Report& report) const {
        context.check_output(file);
        switch (form) {
            case SliceForm::json:
                write_json(file, document_of("slices", report.result(), context.provenance()));  // the result so far
                break;
            case SliceForm::csv:
                write_file(file, slice_table(cut, unit_of_lengths));
                break;
            case SliceForm::mesh: {
                MeshExtras extras;
                extras.face_colours = slice_colours(sliced_mesh(), cut, colour_by);
                context.notes({}, write_mesh(file, sliced_mesh(), extras, {.comment = context.provenance().to_line()}));
                break;
            }
            case SliceForm::sheet:
                if (is_drawable(file.filename().string(), cut, report)) write_slice_sheet(file, sheet(cut));
                break;
            case SliceForm::profile:
                if (is_drawable(file.filename().string(), cut, report)) draw_profile(file, false, cut, report);
        }
    }

    /// Whether any plane meets the mesh; otherwise nothing is drawn.
    static bool is_drawable(const std::string& name, const SlicedObject& cut, Report& report) {
        if (!cut.met()) report.note(fmt::format("no plane meets the mesh: {} is not written", name));
        return cut.met();
    }

    [[nodiscard]] std::string name_of_drawing() const { return title.empty() ? mesh.file_name() : title; }

    /// The slices to draw: all, or the requested number, evenly distributed.
    [[nodiscard]] SliceSheet sheet(const SlicedObject& cut) const {
        const std::size_t n = cut.slices.size(), maximum = static_cast<std::size_t>(drawn);
        SliceSheet content;
        content.title = fmt::format("{}: {}", name_of_drawing(), counted(n, "slice"));
        content.unit = unit_of_lengths;
        for (std::size_t k = 0; k < std::min(n, maximum); ++k) {
            const std::size_t i = n <= maximum ? k : k * (n - 1) / std::max<std::size_t>(1, maximum - 1);
            DrawnSlice entry{&cut.slices[i], &cut.descriptors[i], {}, i + 1};
            if (!cut.medial.empty() && !cut.medial[i].levels.empty())
                for (const auto& branch : cut.medial[i].levels[0].branches) entry.lines.push_back(branch.points);
            content.slices.push_back(entry);
        }
        if (n > maximum) content.title += fmt::format(", {} of them drawn", maximum);
        if (cut.parallel && plane.empty()) {
            SliceFrame view = cut.frames[0];
            view.v = view.normal;
            view.normal = CGAL::cross_product(view.u, view.v);
            content.view = silhouette(sliced_mesh(), view, 500, faces);
        }
        return content;
    }

    /// Draws the profile; of an object that is not a surface of revolution only if requested.
    void draw_profile(const Path& file, bool is_requested, const SlicedObject& cut, Report& report) const {
        const double section_angle = angle ? *angle * pi / 180 : std::numeric_limits<double>::quiet_NaN();
        const SliceFrame axis = direction == "rotation" ? cut.frames[0] : median_frame(cut);
        const Profile found_profile = find_profile(sliced_mesh(), axis, section_angle);
        const std::string name = file.filename().string();
        if (!found_profile.is_revolved && 2 * found_profile.open < 24 && draw_sherd(file, is_requested, report)) return;
        const std::string reason = 2 * found_profile.open >= 24
                                       ? fmt::format(
                                             "the contours of {} of 24 slices do not close, so that it cannot be determined "
                                             "whether the object is round: ",
                                             found_profile.open)
                                       : "not a surface of revolution about this axis (fewer than half of 24 slices are round): ";
        if (!found_profile.is_revolved && !is_requested)
            return report.note(fmt::format("{}{} is not written; --profile FILE draws it anyway", reason, name));
        if (!found_profile.is_revolved)
            report.note(reason + (found_profile.rim_high > 0
                                      ? "the drawing shows one section, and the circle of the rim as far as its arc determines it"
                                      : "a profile drawing describes it poorly"));
        if (found_profile.hides)
            report.note(
                name +
                " does not show everything that protrudes from the surface of revolution: some of it lies in front or behind");
        write_profile_drawing(file, found_profile, name_of_drawing(), unit_of_lengths);
    }

    /// Draws a closed sherd about its own axis of revolution, if it has one and its wall does not go all around.
    bool draw_sherd(const Path& file, bool is_requested, Report& report) const {
        CatalogueSubject subject;
        subject.name = name_of_drawing();
        subject.soup = to_soup(sliced_mesh());
        subject.unit = unit_of_lengths;
        CatalogueOptions drawing;
        drawing.views = false;
        drawing.outside = CatalogueOptions::Outside::lines;
        const CatalogueEntry entry = catalogue_entry(subject, drawing);
        const bool is_sherd =
            entry.kind == CatalogueKind::rim || entry.kind == CatalogueKind::wall || entry.kind == CatalogueKind::base;
        if (!is_sherd) return false;
        report.note(fmt::format("a {}: {}", to_string(entry.kind),
                                is_requested ? "the drawing shows it about its own axis of revolution"
                                             : file.filename().string() + " is not written; --profile FILE draws it"));
        for (const std::string& clause : entry.unknown) report.note(clause);
        if (entry.unit_assumed) report.note("the unit is not known: the scale of the drawing holds for millimetres (--unit)");
        if (is_requested) write_pottery_drawing(file, entry, CatalogueStyle());
        return true;
    }

    void add_notes(Report& report, const SlicedObject& cut) const {
        if (!up_known && (direction == "rotation" || direction == "principal"))
            report.note("which end of the axis points up is unknown (0,0,1 is assumed): if the object is upside down, give --up");
        if (!cut.parallel && is_hollow(sliced_mesh(), upwards, faces))
            report.note(
                "the object is hollow: its skeleton lies in the wall or leaves through the mouth, so that slices across it cut "
                "the wall obliquely (--direction rotation or up cuts a vessel)");
        report.notes(slice_remarks(cut, !plane.empty()));
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    SliceOutput output;
    FileOutput profile{".svg"};
    std::vector<std::string> names;
    std::string direction = "up", unit, title, colour_by = "height";
    DirectionOption up;
    std::optional<int> count;
    std::optional<double> spacing, angle;
    std::vector<double> heights, range{0, 1}, plane, residues;
    int drawn = 24;
    bool axes = false;
    TubeOptions tube_options;

    // Set by `read_part`.
    std::optional<EdgeAlignedAnnotations> along_edges;
    std::vector<Index> faces;  ///< faces of the part; empty: all
    Vector upwards{0, 0, 1};
    bool up_known = false;
    std::string unit_of_lengths;
};

}  // namespace

std::unique_ptr<Operation> make_slice() { return make<SliceObject>(); }

}  // namespace ostraka

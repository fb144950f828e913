// assemble: joins fragments along their fracture surfaces.
#include "operations/completed_output.h"
#include "operations/operations.h"
#include "operations/outward.h"
#include "operations/turned_groups.h"

#include "ostraka/collection/objects.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/reassembly/reassembly_json.h"
#include "ostraka/reassembly/suspicious_fragments.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/render/render.h"
#include "ostraka/shape_classes/fragment_thresholds.h"
#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

struct Assemble final : Operation {
    void declare(Parameters& p) override {
        p.input("fragments", Kind::collection, files,
                "mesh files, point clouds, and folders of such files; regions \"outer\", \"inner\" and \"fracture\" in "
                "NAME.ant.json beside NAME.ply override the computed classification of its surface")
            .many()
            .with_annotations_beside();
        p.output("output", Kind::folder, output,
                 "folder, created if missing, for assembly.json and, for each group, group-N.ply (face labels: number of the "
                 "fragment), group-N.png, group-N.exploded.png (fragments drawn apart) and NAME.placed.ply; its subfolder pairs "
                 "stores the results of pairs for later runs")
            .flag();
        p.input_option("template", Kind::template_package, object_template,
                       "template of the class of the objects: each group of joined fragments is completed with the template");
        p.input_option("class", Kind::shape_class, class_file, "class learnt with the template (NAME.class.json)");
        p.options("no-pictures", no_pictures, "write no pictures of the groups");
        p.options("fresh", fresh, "register all pairs again, and ignore the stored results of earlier runs").unrecorded();
        options.declare_options(p.options);
        reading.declare_options(p.options);
        p.report.schema = "reassembly";
        p.report.text_table("fragments", {"fragment", "facets by", "fracture %", "group", "why alone"});
        p.report.text_table("joins", {"joined", "confidence", "of the pair alone", "contact %", "confirmed by"});
    }

    void check() const override {
        if (class_file && !object_template) fail_usage("--class needs the template that it was learnt with", "give --template");
    }

    void run(Context& context, Report& report) override {
        read(context, report);
        const Path folder = output.open();
        const ResultStore store(is_memory(folder) ? Path() : folder / "pairs");
        const Reassembly result = reassemble(fragments, options, memory_of(store));
        if (pairs_recalled > 0)
            report.note(fmt::format("{} of {} pairs were tried by an earlier run in {}: fragments and options are the same",
                                    pairs_recalled, pairs_requested, output.file()));
        write(context, report, result);
    }

private:
    /// A file given by name, or found in a given folder.
    struct Given {
        Path file;
        std::size_t slot;
        bool listed;  ///< found in a folder
    };

    void read(Context& context, Report& report) {
        std::vector<Given> given_files;
        for (std::size_t k = 0; k < files.size(); ++k) {
            const Path file = files.path(k);
            if (!is_folder(file)) {
                given_files.push_back({file, k, false});
                continue;
            }
            const std::vector<std::string> endings = extensions_of(Kind::mesh);
            const std::size_t before = given_files.size();
            std::size_t points = 0;
            for (const std::string& name : files_in(file)) {
                const std::string ending = extension(name);
                if (std::find(endings.begin(), endings.end(), ending) != endings.end())
                    given_files.push_back({file / name, k, true});
                points += ending == ".xyz" || ending == ".pts" || ending == ".asc" ? 1 : 0;
            }
            if (points > 0)
                report.note(
                    fmt::format("{} files of points (.xyz, .pts, .asc) in {} are not read: name them, or save them as .ply",
                                points, printable(file.string())));
            if (given_files.size() == before)
                fail_input(file.string(), "holds no mesh files",
                           "name the folder that holds the fragments (.ply, .obj, .off, .stl)");
        }
        if (given_files.size() < 2) fail_usage("only one fragment is given", "name two or more, or their folder");
        // Makes the result independent of the order of the files.
        std::stable_sort(given_files.begin(), given_files.end(),
                         [](const Given& x, const Given& y) { return x.file.stem().string() < y.file.stem().string(); });
        for (std::size_t k = 1; k < given_files.size(); ++k)
            if (given_files[k].file.stem() == given_files[k - 1].file.stem())
                fail_usage(fmt::format("two fragments are called '{}'", printable(given_files[k].file.stem().string())),
                           "rename one of the files");
        std::vector<FragmentFile> fragment_files(given_files.size());
        std::vector<std::optional<Error>> problems(given_files.size());
        Progress progress("read fragments", given_files.size());
        const auto attempt = [&](std::size_t k, const auto& from) {
            try {
                fragment_files[k] = from();
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input || given_files.size() < 3) throw;
                problems[k] = error;
            }
            progress.advance();
        };
        const auto in_memory = [&](std::size_t k) { return !given_files[k].listed && files.sources[given_files[k].slot].object; };
        parallel_for(given_files.size(), 1, [&](std::size_t k) {
            if (!in_memory(k)) attempt(k, [&] { return read_fragment(given_files[k].file, reading); });
        });
        // The files were read by several threads; record them as inputs here.
        context.record([&] {
            for (std::size_t k = 0; k < given_files.size(); ++k)
                if (!in_memory(k))
                    for (const Path& file : fragment_files[k].inputs) read_file(file);
        });
        for (std::size_t k = 0; k < given_files.size(); ++k) {
            if (in_memory(k))
                attempt(k, [&] {
                    return files.load<FragmentFile>([&](const Path& path) { return read_fragment(path, reading); },
                                                    given_files[k].slot, options_text(reading));
                });
            const std::string name = given_files[k].file.stem().string();
            if (problems[k]) {
                unreadable.emplace_back(name, problems[k]->problem() + remedy_of(*problems[k]));
                report.note("left out: " + std::string(problems[k]->what()));
                continue;
            }
            context.notes(given_files[k].file.string(), fragment_files[k].notes);
            fragment_files[k].fragment.name = name;
            fragments.push_back(std::move(fragment_files[k].fragment));
            face_colours.push_back(std::move(fragment_files[k].face_colours));
            facets_from.push_back(fragment_files[k].facets_from);
        }
        if (fragments.size() < 2)
            fail_input(
                files.file(0) + (files.size() > 1 ? " and others" : ""),
                fmt::format("only {} of {} fragments can be read, and two are needed", fragments.size(), given_files.size()),
                "correct what the notes above name");
        leave_out_outliers(report);
    }

    static std::string remedy_of(const Error& error) {
        return error.remedy().empty() ? "" : fmt::format(" ({})", error.remedy());
    }

    /// Leaves out copies and fragments of a very different size, and reports them.
    void leave_out_outliers(Report& report) {
        for (const SuspiciousFragment& outlier : suspicious_fragments(fragments)) {
            report.note(fmt::format("{} {}", printable(fragments[outlier.fragment].name), outlier.text));
            if (!outlier.left_out) continue;
            left_out[outlier.fragment] = outlier.text;
            // A fragment without a surface is not joined to others.
            fragments[outlier.fragment].mesh = Mesh();
            fragments[outlier.fragment].facets.clear();
        }
    }

    PairMemory memory_of(const ResultStore& store) {
        std::vector<std::string> sums;
        for (const Fragment& fragment : fragments) sums.push_back(fragment_checksum(fragment));
        const auto key = [sums](std::size_t i, std::size_t j, const PairOptions& pair_options) {
            return ResultStore::key({sums[i], sums[j], options_text(pair_options) + join_model_version()});
        };
        PairMemory memory;
        memory.load = [this, key, &store](std::size_t i, std::size_t j,
                                          const PairOptions& pair_options) -> std::optional<PairResult> {
            ++pairs_requested;
            if (fresh) return {};
            const std::string pair_key = key(i, j, pair_options);
            const std::optional<Json> stored = store.find(pair_key.substr(0, 32), pair_key);
            if (!stored) return {};
            ++pairs_recalled;
            return pair_result_from_json(*stored, i, j);
        };
        memory.store = [key, &store](const PairResult& pair, const PairOptions& pair_options) {
            const std::string pair_key = key(pair.first, pair.second, pair_options);
            Json document;
            store.keep(pair_key.substr(0, 32), pair_key, pair_result_to_json(pair, document.GetAllocator()));
        };
        return memory;
    }

    void write(Context& context, Report& report, const Reassembly& result) {
        std::vector<std::string> names;
        for (const Fragment& fragment : fragments) names.push_back(fragment.name);
        Json document;
        auto& allocator = document.GetAllocator();
        JsonValue content = json_object(allocator, "format", "ostraka-reassembly", "version", 1);
        JsonValue fragment_entries(rapidjson::kArrayType);
        const std::vector<GroupAxis> axes = own_axes(fragments, result);
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            const double fracture_fraction = fracture_share(fragments[k]);
            const std::string alone = why_alone(k, result.reasons_not_joined[k], fracture_fraction);
            JsonValue fragment_entry =
                json_object(allocator, "name", names[k], "group", result.group[k] + 1, "facetsBy", facets_from[k], "fracture",
                            fracture_fraction, "pose", pose_to_json(result.poses[k], allocator));
            if (!alone.empty()) add_members(fragment_entry, allocator, "alone", alone);
            report_own_axis(axes[k], fragment_entry, allocator);
            fragment_entries.PushBack(fragment_entry, allocator);
            report.row("fragments",
                       {names[k], facets_from[k], left_out.contains(k) ? std::string("-") : number(100 * fracture_fraction, 3),
                        result.group[k] < 0 ? std::string("-") : std::to_string(result.group[k] + 1), alone});
        }
        for (const auto& [name, problem] : unreadable) {
            fragment_entries.PushBack(json_object(allocator, "name", name, "group", 0, "alone", "cannot be read: " + problem),
                                      allocator);
            report.row("fragments", {name, std::string("-"), std::string("-"), std::string("-"), "cannot be read: " + problem});
        }
        add_members(content, allocator, "fragments", fragment_entries);
        const JsonValue reassembly = reassembly_to_json(result, names, allocator);
        for (const auto& member : reassembly.GetObject()) add_members(content, allocator, member.name.GetString(), member.value);
        for (const FragmentJoin& join : result.joins)
            report.row("joins", {names[join.first] + " - " + names[join.second], number(join.confidence, 3),
                                 number(join.pair_probability, 3), number(100 * join.evidence.share, 3), join.reason});
        for (const RejectedJoin& undone : result.rejected)
            report.line(fmt::format("not joined: {} and {} (confidence of the pair alone {}): {}", printable(names[undone.first]),
                                    printable(names[undone.second]), number(undone.pair_probability, 2), undone.reason));
        for (int g = 0; g < result.groups(); ++g) {
            JsonValue& group = content["groups"][static_cast<unsigned>(g)];
            report_group_axis(report, fragments, result, g, group, content["joins"], allocator);
            write_group(context, report, result, g, group, allocator);
        }
        report.values(content);
        output.write("assembly.json", content);
        if (result.pairs_left > 0)
            report.note(
                fmt::format("only {} of {} pairs were tried: those whose fracture surfaces fit best in a quick comparison; two "
                            "other fragments are joined only if both join the same group (a larger --partners tries more pairs)",
                            result.pairs_tried, result.pairs_tried + result.pairs_left));
        const std::size_t joined_count =
            static_cast<std::size_t>(std::count_if(result.group.begin(), result.group.end(), [](int g) { return g >= 0; }));
        report.line(fmt::format("{} of {} fragments are joined in {} {}; {} are not joined", joined_count,
                                fragments.size() + unreadable.size(), result.groups(), result.groups() == 1 ? "group" : "groups",
                                fragments.size() + unreadable.size() - joined_count));
        if (result.groups() == 0) report.answer_no();
    }

    /// Why a fragment is not joined, in terms of the files: includes where its facets came from.
    [[nodiscard]] std::string why_alone(std::size_t k, const std::string& reason, double fracture_fraction) const {
        if (left_out.contains(k)) return left_out.at(k);
        if (reason.empty() || fragments[k].mesh.number_of_faces() < static_cast<std::size_t>(options.min_faces) ||
            (fracture_fraction > 0 && fracture_fraction < 1))
            return reason;
        const std::string annotation_file = fragments[k].name + ".ant.json", &source = facets_from[k];
        if (fracture_fraction > 0)
            return fmt::format(
                "all of its surface is classified as fracture (by {}), so that its fracture surface has no border; mark what is "
                "intact as regions \"outer\" or \"inner\" in {}",
                source, annotation_file);
        if (source == "nowhere")
            return fmt::format(
                "no fracture surface was searched for, because its surface is open or --facets excludes it: give --facets auto, "
                "or mark a region \"fracture\" in {}",
                annotation_file);
        if (source == "annotations") return annotation_file + " names no region \"fracture\" that has faces: mark one";
        return "no fracture surface is found; the object may be whole; if it is not, mark a region \"fracture\" in " +
               annotation_file;
    }

    static double fracture_share(const Fragment& fragment) {
        double fracture_area = 0, total_area = 0;
        for (const Face f : fragment.mesh.faces()) {
            const double area = face_area(fragment.mesh, f);
            total_area += area;
            if (!fragment.facets.empty() && fragment.facets[f] == Facet::fracture) fracture_area += area;
        }
        return total_area > 0 ? fracture_area / total_area : 0;
    }

    void write_group(Context& context, Report& report, const Reassembly& result, int g, JsonValue& entry,
                     JsonAllocator& allocator) {
        const bool is_coloured = has_colours_in(result, g);
        TriangleSoup soup;
        Fragment joined_group;
        MeshExtras extras;
        Scene scene;
        std::size_t shown = 0;
        std::vector<std::size_t> begins;  // first point of each fragment
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            if (result.group[k] != g) continue;
            const Mesh placed = moved(fragments[k].mesh, result.poses[k]);
            MeshExtras facets;
            for (const Facet facet : fragments[k].facets) facets.face_labels.push_back(static_cast<std::int32_t>(facet));
            facets.face_colours = face_colours[k];
            if (is_coloured) append_colours(extras.face_colours, k);
            output.write(fragments[k].name + ".placed.ply", placed, facets);
            const TriangleSoup fragment_soup = to_soup(placed);
            const auto offset = static_cast<Index>(soup.points.size());
            begins.push_back(offset);
            soup.points.insert(soup.points.end(), fragment_soup.points.begin(), fragment_soup.points.end());
            const Rgb colour = category_colour(shown);
            for (auto triangle : fragment_soup.triangles) {
                for (Index& v : triangle) v += offset;
                soup.triangles.push_back(triangle);
                extras.face_labels.push_back(static_cast<std::int32_t>(k + 1));
                scene.face_colours.push_back(colour);
            }
            joined_group.facets.insert(joined_group.facets.end(), fragments[k].facets.begin(), fragments[k].facets.end());
            constexpr std::size_t max_legend_entries = 16;
            if (shown < max_legend_entries) scene.legend.push_back({fragments[k].name, colour, LegendMark::area});
            ++shown;
        }
        const std::string name = "group-" + std::to_string(g + 1);
        joined_group.name = name;
        joined_group.mesh = build_mesh(soup);
        output.write(name + ".ply", joined_group.mesh, extras);
        add_members(entry, allocator, "mesh", name + ".ply");
        if (!no_pictures) {
            if (shown > scene.legend.size())
                scene.legend.push_back({fmt::format("and {} more", shown - scene.legend.size()), clay, LegendMark::point});
            RenderOptions drawing;
            drawing.views = "six";
            drawing.size = "1500x1000";
            for (const auto& [ending, member] : {std::pair(".png", "picture"), std::pair(".exploded.png", "exploded")}) {
                scene.mesh = soup;
                write_png(output.in(name + ending), render({scene}, drawing).picture);
                add_members(entry, allocator, member, name + ending);
                draw_apart(soup, begins);
            }
        }
        if (object_template) complete(context, report, joined_group, extras.face_colours, name, entry, allocator);
    }

    /// True if a fragment of the group has colours.
    [[nodiscard]] bool has_colours_in(const Reassembly& result, int g) const {
        for (std::size_t k = 0; k < fragments.size(); ++k)
            if (result.group[k] == g && !face_colours[k].empty()) return true;
        return false;
    }

    /// Appends the colours of a fragment's faces; the tone of clay if it has none.
    void append_colours(std::vector<Colour>& colours, std::size_t k) const {
        if (face_colours[k].empty()) {
            colours.resize(colours.size() + fragments[k].mesh.number_of_faces(), {clay.red, clay.green, clay.blue, 255});
            return;
        }
        colours.insert(colours.end(), face_colours[k].begin(), face_colours[k].end());
    }

    /// Moves fragments away from their common centre, so that fracture surfaces are visible.
    static void draw_apart(TriangleSoup& soup, std::vector<std::size_t> begins) {
        begins.push_back(soup.points.size());
        const auto middle = [&](std::size_t begin, std::size_t end) {
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            for (std::size_t i = begin; i < end; ++i)
                sum += Eigen::Vector3d(soup.points[i][0], soup.points[i][1], soup.points[i][2]);
            return Eigen::Vector3d(sum / static_cast<double>(std::max<std::size_t>(1, end - begin)));
        };
        constexpr double separation = 0.4;  // fraction of the distance from the centre
        const Eigen::Vector3d centre = middle(0, soup.points.size());
        for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
            const Eigen::Vector3d shift = separation * (middle(begins[k], begins[k + 1]) - centre);
            for (std::size_t i = begins[k]; i < begins[k + 1]; ++i)
                for (int c = 0; c < 3; ++c) soup.points[i][static_cast<std::size_t>(c)] += shift[c];
        }
    }

    void complete(Context& context, Report& report, const Fragment& joined_group, const std::vector<Colour>& colours,
                  const std::string& name, JsonValue& entry, JsonAllocator& allocator) {
        if (!object_template->annotations) fail_input(object_template.file(), "has no annotations", "pack them");
        std::optional<ShapePrior> prior;
        if (class_file) {
            const ShapeClass& learnt = class_file.load<ShapeClass>(read_class);
            check_topology(learnt, class_file.file(), object_template->mesh->mesh, object_template.file());
            prior = prior_of(learnt.modes);
        }
        const RelationGraph& graph = class_template(*object_template).graph;
        const AnnotatedMeshView given(object_template->mesh->mesh, *object_template->annotations);
        const std::optional<AnnotatedMesh> turned = outward(given, object_template.file(), report);
        const Reconstruction completed =
            reconstruct(turned ? AnnotatedMeshView(*turned) : given, graph, {&joined_group}, {}, {}, prior ? &*prior : nullptr);
        for (const auto& notes : completed.notes) context.notes(name, notes);
        add_members(entry, allocator, "completion", to_string(completed.verdict), "observed", completed.observed_share);
        if (!completed.undecided.empty()) add_members(entry, allocator, "because", completed.undecided);
        report.line(fmt::format("{} on the template: {}{}; observed {} % of the surface", name, to_string(completed.verdict),
                                completed.undecided.empty() ? "" : ", because " + completed.undecided,
                                number(100 * completed.observed_share, 3)));
        if (completed.points.empty()) return;
        write_completed(output, name + ".completed.ply", completed.object, {colours});
        add_members(entry, allocator, "completed", name + ".completed.ply");
    }

    FileInput files, class_file;
    TemplateInput object_template;
    FolderOutput output;
    ReassemblyOptions options;
    FragmentFileOptions reading;
    bool no_pictures = false, fresh = false;
    std::vector<Fragment> fragments;
    std::vector<std::vector<Colour>> face_colours;  ///< colours of the faces of each fragment; empty: none
    std::vector<std::string> facets_from;
    std::vector<std::pair<std::string, std::string>> unreadable;  ///< name and problem
    std::map<std::size_t, std::string> left_out;                  ///< reason for each excluded fragment
    std::size_t pairs_requested = 0, pairs_recalled = 0;          ///< numbers of pairs
};

}  // namespace

std::unique_ptr<Operation> make_assemble() { return make<Assemble>(); }

}  // namespace ostraka

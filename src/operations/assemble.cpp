// assemble: joins fragments along their fracture surfaces.
#include "completed_output.h"
#include "operations.h"
#include "turned_groups.h"

#include "ostraka/collection/objects.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/reassembly/odd_fragments.h"
#include "ostraka/reassembly/reassembly_json.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/render/render.h"
#include "ostraka/shape_classes/fragment_thresholds.h"
#include "ostraka/shape_classes/member_file.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

struct Assemble final : Operation {
    void describe(Parameters& p) override {
        p.input(
             "fragments", Kind::collection, files,
             "mesh files, or points without faces, and folders of such files; NAME.ant.json beside one with regions \"outer\", "
             "\"inner\", \"fracture\" overrides what is found of its facets")
            .many()
            .with_annotations_beside();
        p.output(
             "output", Kind::folder, output,
             "folder for assembly.json and, of each group, group-N.ply (face labels: the number of the fragment), group-N.png, "
             "group-N.exploded.png (fragments drawn apart) and NAME.placed.ply; pairs that were tried are kept in its folder "
             "pairs, and not tried again; made if it is missing")
            .flag();
        p.input_option("template", Kind::template_package, known,
                       "template of the objects' class: each group is completed by it");
        p.input_option("class", Kind::shape_class, class_file, "a class learnt with the template (NAME.class.json)");
        p.options("no-pictures", no_pictures, "draw no pictures");
        p.options("fresh", fresh, "register all pairs again, whatever an earlier run found").unrecorded();
        options.describe(p.options);
        reading.describe(p.options);
        p.report.schema = "reassembly";
        p.report.people_table("fragments", {"fragment", "facets by", "fracture %", "group", "why alone"});
        p.report.people_table("joins", {"joined", "confidence", "by the two alone", "contact %", "confirmed by"});
    }

    void check() const override {
        if (class_file && !known) fail_usage("--class needs the template that it was learnt with", "give --template");
    }

    void run(Context& context, Report& report) override {
        read(context, report);
        const Path folder = output.open();
        const ResultStore store(is_memory(folder) ? Path() : folder / "pairs");
        const Reassembly result = reassemble(fragments, options, memory_of(store));
        if (recalled > 0)
            report.note(std::to_string(recalled) + " of " + std::to_string(asked) + " pairs were tried by an earlier run in " +
                        output.file() + ": fragments and options are the same");
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
        std::vector<Given> list;
        for (std::size_t k = 0; k < files.size(); ++k) {
            const Path file = files.path(k);
            if (!is_folder(file)) {
                list.push_back({file, k, false});
                continue;
            }
            const std::vector<std::string> endings = endings_of(Kind::mesh);
            const std::size_t before = list.size();
            std::size_t points = 0;
            for (const std::string& name : files_in(file)) {
                const std::string ending = extension(name);
                if (std::find(endings.begin(), endings.end(), ending) != endings.end()) list.push_back({file / name, k, true});
                points += ending == ".xyz" || ending == ".pts" || ending == ".asc" ? 1 : 0;
            }
            if (points > 0)
                report.note(std::to_string(points) + " files of points (.xyz, .pts, .asc) in " + printable(file.string()) +
                            " are not read: name them, or save them as .ply");
            if (list.size() == before)
                fail_input(file.string(), "holds no mesh files",
                           "name the folder that holds the fragments (.ply, .obj, .off, .stl)");
        }
        if (list.size() < 2)
            fail_usage("there is one fragment, and nothing to join it with", "name two or more, or their folder");
        // Makes the result independent of the order of the files.
        std::stable_sort(list.begin(), list.end(),
                         [](const Given& x, const Given& y) { return x.file.stem().string() < y.file.stem().string(); });
        for (std::size_t k = 1; k < list.size(); ++k)
            if (list[k].file.stem() == list[k - 1].file.stem())
                fail_usage("two fragments are called '" + printable(list[k].file.stem().string()) + "'",
                           "rename one of the files");
        std::vector<FragmentFile> found(list.size());
        std::vector<std::optional<Error>> problems(list.size());
        Progress progress("read fragments", list.size());
        const auto attempt = [&](std::size_t k, const auto& from) {
            try {
                found[k] = from();
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input || list.size() < 3) throw;
                problems[k] = error;
            }
            progress.advance();
        };
        const auto in_memory = [&](std::size_t k) { return !list[k].listed && files.sources[list[k].slot].object; };
        parallel_for(
            list.size(),
            [&](std::size_t k) {
                if (!in_memory(k)) attempt(k, [&] { return read_fragment(list[k].file, reading); });
            },
            1);
        // The files were read by several threads; record them as inputs here.
        context.record([&] {
            for (std::size_t k = 0; k < list.size(); ++k)
                if (!in_memory(k))
                    for (const Path& file : found[k].inputs) read_file(file);
        });
        for (std::size_t k = 0; k < list.size(); ++k) {
            if (in_memory(k))
                attempt(k, [&] {
                    return files.load<FragmentFile>([&](const Path& path) { return read_fragment(path, reading); }, list[k].slot,
                                                    options_text(reading));
                });
            const std::string name = list[k].file.stem().string();
            if (problems[k]) {
                unreadable.emplace_back(name, problems[k]->problem() + remedy_of(*problems[k]));
                report.note("left out: " + std::string(problems[k]->what()));
                continue;
            }
            context.notes(list[k].file.string(), found[k].notes);
            found[k].fragment.name = name;
            fragments.push_back(std::move(found[k].fragment));
            facets_from.push_back(found[k].facets_from);
        }
        if (fragments.size() < 2)
            fail_input(files.file(0) + (files.size() > 1 ? " and others" : ""),
                       "only " + std::to_string(fragments.size()) + " of " + std::to_string(list.size()) +
                           " fragments can be read, and two are needed",
                       "correct what the notes above name");
        find_odd(report);
    }

    static std::string remedy_of(const Error& error) { return error.remedy().empty() ? "" : " (" + error.remedy() + ")"; }

    /// Leaves out copies and fragments of a very different size, and reports them.
    void find_odd(Report& report) {
        for (const OddFragment& odd : odd_fragments(fragments)) {
            report.note(printable(fragments[odd.fragment].name) + " " + odd.text);
            if (!odd.left_out) continue;
            left_out[odd.fragment] = odd.text;
            // A fragment without a surface is not joined to others.
            fragments[odd.fragment].mesh = Mesh();
            fragments[odd.fragment].facets.clear();
        }
    }

    PairMemory memory_of(const ResultStore& store) {
        std::vector<std::string> sums;
        for (const Fragment& one : fragments) sums.push_back(fragment_checksum(one));
        const auto key = [sums](std::size_t i, std::size_t j, const PairOptions& how) {
            return ResultStore::key({sums[i], sums[j], options_text(how) + join_model_version()});
        };
        PairMemory memory;
        memory.recall = [this, key, &store](std::size_t i, std::size_t j, const PairOptions& how) -> std::optional<PairOfMany> {
            ++asked;
            if (fresh) return {};
            const std::string known_by = key(i, j, how);
            const std::optional<Json> found = store.find(known_by.substr(0, 32), known_by);
            if (!found) return {};
            ++recalled;
            return pair_of_many_from_json(*found, i, j);
        };
        memory.keep = [key, &store](const PairOfMany& pair, const PairOptions& how) {
            const std::string known_by = key(pair.first, pair.second, how);
            Json document;
            store.keep(known_by.substr(0, 32), known_by, pair_of_many_to_json(pair, document.GetAllocator()));
        };
        return memory;
    }

    void write(Context& context, Report& report, const Reassembly& result) {
        std::vector<std::string> names;
        for (const Fragment& one : fragments) names.push_back(one.name);
        Json document;
        auto& allocator = document.GetAllocator();
        JsonValue content = json_object(allocator, "format", "ostraka-reassembly", "version", 1);
        JsonValue list(rapidjson::kArrayType);
        const std::vector<GroupAxis> axes = own_axes(fragments, result);
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            const double broken = fracture_share(fragments[k]);
            const std::string alone = why_alone(k, result.alone[k], broken);
            JsonValue one = json_object(allocator, "name", names[k], "group", result.group[k] + 1, "facetsBy", facets_from[k],
                                        "fracture", broken, "pose", pose_to_json(result.poses[k], allocator));
            if (!alone.empty()) add_members(one, allocator, "alone", alone);
            report_own_axis(axes[k], one, allocator);
            list.PushBack(one, allocator);
            report.row("fragments", {names[k], facets_from[k], left_out.contains(k) ? std::string("-") : number(100 * broken, 3),
                                     result.group[k] < 0 ? std::string("-") : std::to_string(result.group[k] + 1), alone});
        }
        for (const auto& [name, problem] : unreadable) {
            list.PushBack(json_object(allocator, "name", name, "group", 0, "alone", "cannot be read: " + problem), allocator);
            report.row("fragments", {name, std::string("-"), std::string("-"), std::string("-"), "cannot be read: " + problem});
        }
        add_members(content, allocator, "fragments", list);
        const JsonValue found = reassembly_to_json(result, names, allocator);
        for (const auto& member : found.GetObject()) add_members(content, allocator, member.name.GetString(), member.value);
        for (const FragmentJoin& join : result.joins)
            report.row("joins", {names[join.first] + " - " + names[join.second], number(join.confidence, 3), number(join.pair, 3),
                                 number(100 * join.evidence.share, 3), join.reason});
        for (const UndoneJoin& one : result.undone)
            report.line("not joined: " + printable(names[one.first]) + " and " + printable(names[one.second]) + " (" +
                        number(one.pair, 2) + " by the two alone): " + one.reason);
        for (int g = 0; g < result.groups(); ++g) {
            JsonValue& group = content["groups"][static_cast<unsigned>(g)];
            report_group_axis(report, fragments, result, g, group, content["joins"], allocator);
            write_group(context, report, result, g, group, allocator);
        }
        report.values(content);
        output.write("assembly.json", content);
        if (result.pairs_left > 0)
            report.note(
                "not all pairs were tried, but " + std::to_string(result.pairs_tried) + " of " +
                std::to_string(result.pairs_tried + result.pairs_left) +
                ", whose breaks fit best when compared quickly; a join of two others is only found where both are joined " +
                "to the same group (--partners tries more)");
        const std::size_t joined =
            static_cast<std::size_t>(std::count_if(result.group.begin(), result.group.end(), [](int g) { return g >= 0; }));
        report.line(std::to_string(joined) + " of " + std::to_string(fragments.size() + unreadable.size()) +
                    " fragments are in " + std::to_string(result.groups()) + (result.groups() == 1 ? " group; " : " groups; ") +
                    std::to_string(fragments.size() + unreadable.size() - joined) + " stay alone");
        if (result.groups() == 0) report.answer_no();
    }

    /// Why a fragment is not joined, in terms of the files: includes where its facets came from.
    [[nodiscard]] std::string why_alone(std::size_t k, const std::string& reason, double broken) const {
        if (left_out.contains(k)) return left_out.at(k);
        if (reason.empty() || fragments[k].mesh.number_of_faces() < static_cast<std::size_t>(options.min_faces) ||
            (broken > 0 && broken < 1))
            return reason;
        const std::string beside = fragments[k].name + ".ant.json", &from = facets_from[k];
        if (broken > 0)
            return "all of its surface is called fracture (by " + from +
                   "), so that its break has no edge; mark what is not broken " + "as regions \"outer\" or \"inner\" in " +
                   beside;
        if (from == "nowhere")
            return "no break was looked for, because its surface is open or --facets says so: give --facets auto, or mark a "
                   "region " +
                   std::string("\"fracture\" in ") + beside;
        if (from == "annotations") return beside + " names no region \"fracture\" that has faces: mark one";
        return "no break is found on it, it may be whole; if it is not, mark a region \"fracture\" in " + beside;
    }

    static double fracture_share(const Fragment& fragment) {
        double broken = 0, all = 0;
        for (const Face f : fragment.mesh.faces()) {
            const double area = face_area(fragment.mesh, f);
            all += area;
            if (!fragment.facets.empty() && fragment.facets[f] == Facet::fracture) broken += area;
        }
        return all > 0 ? broken / all : 0;
    }

    void write_group(Context& context, Report& report, const Reassembly& result, int g, JsonValue& entry,
                     JsonAllocator& allocator) {
        TriangleSoup soup;
        Fragment whole;
        MeshExtras extras;
        Scene scene;
        std::size_t shown = 0;
        std::vector<std::size_t> begins;  // first point of each fragment
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            if (result.group[k] != g) continue;
            const Mesh placed = moved(fragments[k].mesh, result.poses[k]);
            MeshExtras facets;
            for (const Facet facet : fragments[k].facets) facets.face_labels.push_back(static_cast<std::int32_t>(facet));
            output.write(fragments[k].name + ".placed.ply", placed, facets);
            const TriangleSoup own = to_soup(placed);
            const auto offset = static_cast<Index>(soup.points.size());
            begins.push_back(offset);
            soup.points.insert(soup.points.end(), own.points.begin(), own.points.end());
            const Rgb colour = category_colour(shown);
            for (auto triangle : own.triangles) {
                for (Index& v : triangle) v += offset;
                soup.triangles.push_back(triangle);
                extras.face_labels.push_back(static_cast<std::int32_t>(k + 1));
                scene.face_colours.push_back(colour);
            }
            whole.facets.insert(whole.facets.end(), fragments[k].facets.begin(), fragments[k].facets.end());
            constexpr std::size_t named = 16;
            if (shown < named) scene.legend.push_back({fragments[k].name, colour, LegendMark::area});
            ++shown;
        }
        const std::string name = "group-" + std::to_string(g + 1);
        whole.name = name;
        whole.mesh = build_mesh(soup);
        output.write(name + ".ply", whole.mesh, extras);
        add_members(entry, allocator, "mesh", name + ".ply");
        if (!no_pictures) {
            if (shown > scene.legend.size())
                scene.legend.push_back({"and " + std::to_string(shown - scene.legend.size()) + " more", clay, LegendMark::point});
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
        if (known) complete(context, report, whole, name, entry, allocator);
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
        constexpr double apart = 0.4;  // fraction of the distance from the centre
        const Eigen::Vector3d whole = middle(0, soup.points.size());
        for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
            const Eigen::Vector3d way = apart * (middle(begins[k], begins[k + 1]) - whole);
            for (std::size_t i = begins[k]; i < begins[k + 1]; ++i)
                for (int c = 0; c < 3; ++c) soup.points[i][static_cast<std::size_t>(c)] += way[c];
        }
    }

    void complete(Context& context, Report& report, const Fragment& whole, const std::string& name, JsonValue& entry,
                  JsonAllocator& allocator) {
        if (!known->annotations) fail_input(known.file(), "has no annotations", "pack them");
        std::optional<ShapePrior> prior;
        if (class_file) {
            const ShapeClass& learnt = class_file.load<ShapeClass>(read_class);
            check_topology(learnt, class_file.file(), known->mesh->mesh, known.file());
            prior = prior_of(learnt.modes);
        }
        const RelationGraph& graph = class_template(*known).graph;
        const Reconstruction completed =
            reconstruct(known->mesh->mesh, *known->annotations, graph, {&whole}, {}, {}, prior ? &*prior : nullptr);
        for (const auto& notes : completed.notes) context.notes(name, notes);
        add_members(entry, allocator, "completion", to_string(completed.verdict), "observed", completed.observed_share);
        if (!completed.undecided.empty()) add_members(entry, allocator, "because", completed.undecided);
        report.line(name + " on the template: " + to_string(completed.verdict) +
                    (completed.undecided.empty() ? "" : ", because " + completed.undecided) + "; observed " +
                    number(100 * completed.observed_share, 3) + " % of the surface");
        if (completed.points.empty()) return;
        write_completed(output, name + ".completed.ply", completed.object);
        add_members(entry, allocator, "completed", name + ".completed.ply");
    }

    FileInput files, class_file;
    TemplateInput known;
    FolderOutput output;
    ReassemblyOptions options;
    FragmentFileOptions reading;
    bool no_pictures = false, fresh = false;
    std::vector<Fragment> fragments;
    std::vector<std::string> facets_from;
    std::vector<std::pair<std::string, std::string>> unreadable;  ///< name and problem
    std::map<std::size_t, std::string> left_out;                  ///< reason for each excluded fragment
    std::size_t asked = 0, recalled = 0;                          ///< numbers of pairs
};

}  // namespace

std::unique_ptr<Operation> make_assemble() { return make<Assemble>(); }

}  // namespace ostraka

// cage make, cage check: cages around meshes.
#include "operations.h"

#include "ostraka/coords/nested.h"
#include "ostraka/semantic/cage_density.h"
#include "ostraka/semantic/cage_reach.h"
#include "ostraka/semantic/part_cages.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

/// Declares the table of the constraints that a cage can satisfy.
void declare_reach(ReportLayout& report) {
    report.table("reach", integer("id", "id"), text("type", "constraint"), texts("parts", "parts"), integer("rows", "rows"),
                 integer("rank", "rank through the cage"), number("asked", "asked", "length"), number("left", "left", "length"),
                 number("tolerance", "tolerance", "length"), text("lacking", "most at"), text("verdict", "verdict"),
                 boolean("reached", "reached"));
}

void report_reach(Report& report, const std::vector<ConstraintReach>& list, const AnnotationSet& set) {
    report.empty_table("reach", false);
    for (const ConstraintReach& one : list) {
        std::vector<std::string> parts;
        for (const int id : one.annotations) parts.push_back(set.find(id)->tag);
        const Annotation* lacking = one.lacking ? set.find(*one.lacking) : nullptr;
        report.row("reach")("id", one.id)("type", one.type)("parts", parts)("rows", one.rows)("rank", one.rank)(
            "asked", one.asked)("left", one.left)("tolerance", one.tolerance)("lacking", lacking ? lacking->tag : "")(
            "verdict", to_string(one.verdict))("reached", one.reached);
    }
}

struct CageMake final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file; it may be open");
        p.output("output", Kind::cage, output, "cage to write (.ply, .obj, .off, .stl)");
        p.input_option(
            "annotations", Kind::annotations, annotations,
            "annotations of the mesh (.ant.json): the cage has four times as many vertices near points, lines and outlines");
        p.input_option("graph", Kind::graph, graph,
                       "relationships (.graph.json): a mirror symmetry gives the mirror plane of the cage and of the cages of "
                       "symmetric parts");
        p.input_option("for", Kind::graph, constraints,
                       "relationships (.graph.json) whose constraints the cage is to be able to meet: denser at their parts, "
                       "nearer to the mesh and with "
                       "up to twice the vertices if need be (exit code 3: it cannot meet one)");
        vocabulary.describe(p, "by which tags are compared with --parts");
        options.describe(p.options);
        p.options("levels", levels,
                  "numbers of vertices, separated by commas: nested cages, each around the finer one, written as output-NUMBER",
                  Range{4, 1000000});
        p.options("together", one_file, "write the levels to one file: nested cages, each of which can be edited");
        p.options("parts", parts, "regions, by id or tag, that get cages of their own, nested in that of the whole").words();
        p.options("part-vertices", part_vertices, "target number of vertices of a part's cage", Range{4, 1000000});
        p.options("mirror", mirror,
                  "make the cage mirror-symmetric about this plane; auto: about the symmetry plane of the object",
                  Words{{"auto"}, "a point and a normal as six numbers with commas", [](const std::string& text) {
                            if (text != "auto") static_cast<void>(plane_of(text));
                        }});
        p.options("detail", details, "annotation=factor: factor on the vertex density there; may be given several times");
        p.report.table("cages", text("file", "cage"), integer("level"), text("part"), integer("vertices", "vertices"),
                       integer("faces", "faces"), boolean("reached"), integer("genus", "genus"),
                       number("clearance", "clearance", "length"), number("alpha", "alpha"));
        declare_reach(p.report);
    }

    void check() const override {
        if (constraints && (!levels.empty() || !parts.empty() || !details.empty()))
            fail_usage("--for with --levels, --parts or --detail",
                       "let --for choose where the cage is dense, or say it yourself");
        if (constraints && !annotations) fail_usage("--for without --annotations", "add --annotations");
        const auto sizes = wanted();
        if (std::adjacent_find(sizes.begin(), sizes.end()) != sizes.end())
            fail_usage("--levels has a number twice", "give each once");
        if (!annotations && !details.empty()) fail_usage("--detail without --annotations", "add --annotations");
        if (!annotations && (!parts.empty() || graph))
            fail_usage(std::string(parts.empty() ? "--graph" : "--parts") + " without --annotations", "add --annotations");
        if (!parts.empty() && levels.size() > 1 && !one_file)
            fail_usage("--parts with --levels", "add --together: parts are nested in the finest level, in one file");
        if (levels.empty() || one_file || output.file().empty()) return;
        std::vector<Path> files;
        for (const std::uint64_t size : sizes) files.emplace_back(output.part_file(ending(size)));
        check_outputs({mesh.file(), annotations.file()}, files);
    }

    void run(Context&, Report& report) override {
        const Mesh& object = mesh->mesh;
        AnnotationSet set;
        if (annotations) set = annotations.on(object);
        CageDensity density;
        if (annotations) density = annotation_density(object, set, factors(set));
        report.set_unit(set.unit);
        const auto border =
            std::count_if(object.halfedges().begin(), object.halfedges().end(), [&](Halfedge h) { return object.is_border(h); });
        if (border > 0)
            report.note("the mesh is open (" + std::to_string(border) +
                        " border edges): the cage goes around both sides of its surface, in through openings that are wider than "
                        "--alpha; close it with 'mesh repair' where it stands for a solid");
        const auto sizes = wanted();
        const RelationGraph none;
        const RelationGraph& relations = graph ? graph.on(set) : none;
        const auto plane = mirror_of(object, set, relations, report);
        const std::vector<std::size_t> regions = regions_of(set);
        auto results = in_file(mesh.file(), [&] {
            return constraints ? for_constraints(object, set, plane, report)
                               : make_nested_cages(object, sizes, options, density, plane);
        });
        bool reached = true;
        std::size_t left_out = 0;
        std::set<long> genera;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const CageResult& made = results[i];
            const CageCheck check = check_cage(made.cage, i == 0 ? object : results[i - 1].cage);
            reached = reached && made.reached;
            left_out += check.outside.size();
            genera.insert(check.genus);
            const bool alone = levels.empty() || one_file;
            std::string file = alone ? output.file() : output.part_file(ending(sizes[i]));
            if (file.empty()) file = output.name + (alone ? "" : ending(sizes[i]));
            const std::string name = Path(file).filename().string();
            if (made.cage.number_of_vertices() < sizes[i])
                report.note(name + " has " + std::to_string(made.cage.number_of_vertices()) + " vertices instead of " +
                            std::to_string(sizes[i]) +
                            (made.wrap_vertices < sizes[i] ? ": its wrap has no more, a smaller --alpha gives more"
                                                           : ": a mirrored cage has as many on both sides of the plane"));
            report.row("cages")("file", file, name)("level", results.size() - 1 - i)("part", "")(
                "vertices", made.cage.number_of_vertices())("faces", made.cage.number_of_faces())("reached", made.reached)(
                "genus", check.genus)("clearance", check.clearance)("alpha", made.alpha);
        }
        if (!reached) report.note("fewer vertices could not be had without leaving a part of the mesh outside");
        if (genera.size() > 1)
            report.note("the levels differ in genus: the wrap of a coarser one closes holes that a finer one follows");
        if (left_out > 0)
            report.note(
                (left_out == 1 ? "1 vertex that no face has is" : std::to_string(left_out) + " vertices that no face has are") +
                std::string(" not inside the cage, which is made around faces: remove with 'mesh repair'"));
        if (!reached || left_out > 0) report.answer_no();
        if (one_file || !regions.empty()) {
            output.write(nested(object, set, relations, regions, results, report));
            return;
        }
        for (std::size_t i = 0; i < results.size(); ++i)
            if (levels.empty()) output.write(std::move(results[i].cage));
            else output.write_part(ending(sizes[i]), std::move(results[i].cage));
    }

    /// One cage fine enough to satisfy the constraints, as far as a cage can.
    [[nodiscard]] std::vector<CageResult> for_constraints(const Mesh& object, const AnnotationSet& set,
                                                          const std::optional<MirrorPlane>& plane, Report& report) const {
        CageForConstraints made =
            make_cage_for(object, set, constraints.on(set), options, plane, deform_tolerances(), constraints.file());
        report_reach(report, made.reach, set);
        for (const ConstraintReach& one : made.reach) {
            if (one.reached) continue;
            report.note(ostraka::describe(one, set) + "; 'deform --space auto' solves for it over the mesh");
            report.answer_no();
        }
        std::vector<CageResult> results;
        results.push_back(std::move(made.made));
        return results;
    }

    /// All levels and the cages of the parts in one mesh, the outermost first.
    [[nodiscard]] Mesh nested(const Mesh& object, const AnnotationSet& set, const RelationGraph& relations,
                              const std::vector<std::size_t>& regions, const std::vector<CageResult>& results,
                              Report& report) const {
        CageOptions of_parts = options;
        of_parts.vertices = part_vertices;
        const std::vector<PartCage> inner =
            in_file(annotations.file(), [&] { return make_part_cages(object, set, regions, of_parts, relations, graph.file()); });
        for (std::size_t k = 0; k < inner.size(); ++k)
            if (inner[k].check.components > 1)
                fail_input(annotations.file(),
                           "'" + tag_of(set, regions, k) + "' lies apart in " + counted(inner[k].check.components, "piece"),
                           "annotate the pieces one by one: each has a cage of its own");
        std::vector<const Mesh*> all;
        for (std::size_t i = results.size(); i-- > 0;) all.push_back(&results[i].cage);
        for (const PartCage& one : inner) all.push_back(&one.made.cage);
        Mesh cage = together(all);
        const std::vector<CageLevel> found = cage_levels(cage);
        std::size_t first = 0;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const auto level = std::find_if(found.begin() + (k > 0 ? 1 : 0), found.end(),
                                            [&](const CageLevel& l) { return l.cage.vertices.front() == first; });
            const std::string what =
                k < results.size() ? "a level" : "the cage of '" + tag_of(set, regions, k - results.size()) + "'";
            if (level == found.end() || level->cage.vertices.size() != all[k]->number_of_vertices())
                throw Error(ErrorKind::failure, "cage", what + " does not lie in that of the whole",
                            "raise --offset, or give the whole more --vertices");
            first += all[k]->number_of_vertices();
            if (k < results.size()) continue;
            const PartCage& one = inner[k - results.size()];
            const std::string file = output.file().empty() ? output.name : output.file();
            report.row("cages")("file", file, Path(file).filename().string() + ", " + tag_of(set, regions, k - results.size()))(
                "level", level - found.begin())("part", tag_of(set, regions, k - results.size()))(
                "vertices", one.made.cage.number_of_vertices())("faces", one.made.cage.number_of_faces())(
                "reached", one.made.reached)("genus", one.check.genus)("clearance", one.check.clearance)("alpha", one.made.alpha);
            if (!one.made.reached) report.answer_no();
        }
        return cage;
    }

    static std::string tag_of(const AnnotationSet& set, const std::vector<std::size_t>& regions, std::size_t k) {
        return set.annotations[regions[k]].tag;
    }

    /// The regions named by --parts, without duplicates.
    [[nodiscard]] std::vector<std::size_t> regions_of(const AnnotationSet& set) const {
        const TagWords words = vocabulary.words();
        std::vector<std::size_t> regions;
        for (const std::string& name : parts) {
            const std::size_t before = regions.size();
            for (const std::size_t i : words.require(set, name, annotations.file()))
                if (set.annotations[i].type == AnnotationType::region &&
                    std::find(regions.begin(), regions.end(), i) == regions.end())
                    regions.push_back(i);
            if (regions.size() == before)
                fail_input(annotations.file(), "no annotation '" + printable(name, 60) + "' is a region, or it was named before",
                           "name regions, each once");
        }
        return regions;
    }

    static std::string ending(std::uint64_t size) { return "-" + std::to_string(size); }

    /// Requested numbers of vertices, from fine to coarse.
    [[nodiscard]] std::vector<std::uint64_t> wanted() const {
        std::vector<std::uint64_t> sizes(levels.begin(), levels.end());
        if (sizes.empty()) sizes.push_back(options.vertices);
        std::sort(sizes.rbegin(), sizes.rend());
        return sizes;
    }

    [[nodiscard]] std::vector<std::pair<int, double>> factors(const AnnotationSet& set) const {
        std::vector<std::pair<int, double>> list;
        for (const std::string& detail : details) {
            const std::size_t at = detail.rfind('=');
            if (at == std::string::npos)
                fail_usage("--detail is '" + printable(detail, 60) + "'", "give annotation=factor, like spout=4");
            const auto factor = numbers_of<double>(detail.substr(at + 1), "--detail");
            if (factor.size() != 1 || !(factor[0] >= 0.1 && factor[0] <= 100))
                fail_usage("--detail is '" + printable(detail, 60) + "'", "give a factor from 0.1 to 100");
            const std::string name = detail.substr(0, at);
            const std::size_t before = list.size();
            for (const Annotation& annotation : set.annotations)
                if (annotation.tag == name || std::to_string(annotation.id) == name) list.emplace_back(annotation.id, factor[0]);
            if (list.size() == before)
                fail_usage("--detail names '" + printable(name, 60) + "', which is no annotation", "use an id or a tag");
        }
        return list;
    }

    static MirrorPlane plane_of(const std::string& text) {
        const auto n = numbers_of<double>(text, "--mirror");
        if (n.size() != 6)
            fail_usage("--mirror is '" + printable(text, 60) + "'", "give auto, or six numbers: a point and a normal");
        return {Point(n[0], n[1], n[2]), Vector(n[3], n[4], n[5])};
    }

    [[nodiscard]] std::optional<MirrorPlane> mirror_of(const Mesh& object, const AnnotationSet& set,
                                                       const RelationGraph& relations, Report& report) const {
        if (mirror.empty()) return mirror_of(relations, object, set);
        if (mirror != "auto") return plane_of(mirror);
        const MirrorPlane plane = find_mirror_plane(object, set, mesh.file());
        const auto three = [](const auto& p) { return number(p.x()) + "," + number(p.y()) + "," + number(p.z()); };
        report.note("mirror plane through " + three(plane.point) + " with normal " + three(plane.normal));
        return plane;
    }

    /// Mirror plane of the whole object, from the graph. Mirror planes of parts are ignored.
    [[nodiscard]] std::optional<MirrorPlane> mirror_of(const RelationGraph& relations, const Mesh& object,
                                                       const AnnotationSet& set) const {
        for (const Annotation& one : set.annotations)
            if (is_whole(object, one))
                if (const auto plane = symmetry_plane(object, set, relations, {one.id}, graph.file())) return plane;
        return {};
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    GraphInput graph, constraints;
    VocabularyOption vocabulary;
    MeshOutput output;
    CageOptions options;
    bool one_file = false;
    std::vector<std::string> parts;
    std::uint64_t part_vertices = 40;
    std::vector<int> levels;
    std::string mirror;
    std::vector<std::string> details;
};

struct CheckOfCage final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "cage file");
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json), for --graph");
        p.input_option(
            "graph", Kind::graph, graph,
            "relationships (.graph.json): report which constraints the cage can satisfy and where control points are missing");
        p.input_option("weights", Kind::coordinates, weights,
                       "weights of 'cage weights' (.npy), for --graph; without: mean value");
        p.input_option("edit", Kind::edit, edit,
                       "an edit (.edit.json), for --graph; without, the object is stretched by a tenth along x, y and z");
        p.report.checks = true;
        declare_reach(p.report);
    }

    void check() const override {
        if (static_cast<bool>(annotations) != static_cast<bool>(graph))
            fail_usage("--annotations and --graph belong together", "give both");
        if (!graph && (weights || edit)) fail_usage("--weights and --edit are for --graph", "add --annotations and --graph");
    }

    void run(Context&, Report& report) override {
        std::vector<Finding> list = findings(check_cage(cage->mesh, mesh->mesh), "");
        const bool sound = std::none_of(list.begin(), list.end(), [](const Finding& one) { return one.defect; });
        if (graph && sound) {
            for (const ConstraintReach& one : reach(report))
                if (!one.reached) list.push_back({true, "/reach/" + std::to_string(one.id), ostraka::describe(one, *set_)});
        } else if (graph) {
            report.note("what the cage can hold is told of a sound cage only");
        }
        report.findings(list);
    }

private:
    [[nodiscard]] std::vector<ConstraintReach> reach(Report& report) {
        set_ = &annotations.on(mesh->mesh);
        report.set_unit(set_->unit);
        const std::string edit_name = edit ? edit.file() : "a stretch by a tenth";
        std::optional<Edit> given;
        if (edit) given = edit_from_json(*edit, edit_name);
        Coordinates own;
        if (!weights) own = compute_coordinates("mean-value", cage->mesh, mesh->mesh);
        const HandleSpace space{mesh->mesh, *set_, &cage->mesh, weights ? &weights.of(mesh->mesh, cage->mesh) : &own};
        auto list = cage_reach(space, graph.on(*set_), given ? &*given : nullptr, edit_name, deform_tolerances(), graph.file());
        report_reach(report, list, *set_);
        return list;
    }

    MeshInput mesh, cage;
    AnnotationsInput annotations;
    GraphInput graph;
    CoordinatesInput weights;
    JsonInput edit;
    const AnnotationSet* set_ = nullptr;
};

}  // namespace

std::unique_ptr<Operation> make_cage_make() { return make<CageMake>(); }
std::unique_ptr<Operation> make_cage_check() { return make<CheckOfCage>(); }

}  // namespace ostraka

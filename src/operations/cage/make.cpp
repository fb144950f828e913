// cage make
#include "operations/cage/reach.h"
#include "operations/operations.h"

#include "ostraka/coords/nested.h"
#include "ostraka/semantic/cage_density.h"
#include "ostraka/semantic/cage_reach.h"
#include "ostraka/semantic/part_cages.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

struct CageMake final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file; the mesh may be open");
        p.output("output", Kind::cage, output, "cage to write (.ply, .obj, .off, .stl)");
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the mesh (.ant.json): the vertex density of the cage is four times as high near points, "
                       "lines and outlines");
        p.input_option("graph", Kind::graph, graph,
                       "relationships (.graph.json): if they contain a mirror symmetry, the cage of the object and the cages of "
                       "its symmetric parts are made symmetric");
        p.input_option("for", Kind::graph, constraints,
                       "relationships (.graph.json) with constraints that the cage must be able to satisfy: near the constrained "
                       "parts the cage is denser and closer to the mesh, with up to twice the vertices (exit code 3: a "
                       "constraint cannot be satisfied)");
        vocabulary.declare(p, "used to match tags of annotations with --parts");
        options.declare_options(p.options);
        p.options("levels", levels, "numbers of vertices, separated by commas, of nested cages, written as output-NUMBER",
                  Range{4, 1000000});
        p.options("together", one_file,
                  "write the cages of --levels to one file, in which each of the nested cages can be edited");
        p.options("parts", parts, "ids or tags of regions that get cages of their own, nested in the cage of the whole object")
            .words();
        p.options("part-vertices", part_vertices, "target number of vertices of a part's cage", Range{4, 1000000});
        p.options("mirror", mirror,
                  "make the cage mirror-symmetric about this plane; auto: about the symmetry plane of the object",
                  Words{{"auto"}, "a point and a normal as six numbers with commas", [](const std::string& text) {
                            if (text != "auto") static_cast<void>(plane_of(text));
                        }});
        p.options("detail", details,
                  "ANNOTATION=FACTOR: factor on the vertex density of the cage near an annotation; repeatable");
        p.report.table("cages", text("file", "cage"), integer("level"), text("part"), integer("vertices", "vertices"),
                       integer("faces", "faces"), boolean("reached"), integer("genus", "genus"),
                       number("clearance", "clearance", "length"), number("alpha", "alpha"));
        declare_reach(p.report);
    }

    void check() const override {
        if (constraints && (!levels.empty() || !parts.empty() || !details.empty()))
            fail_usage("--for with --levels, --parts or --detail", "leave out --for, or the options that specify the density");
        if (constraints && !annotations) fail_usage("--for without --annotations", "add --annotations");
        const auto sizes = wanted();
        if (std::adjacent_find(sizes.begin(), sizes.end()) != sizes.end())
            fail_usage("--levels contains a number twice", "give each once");
        if (!annotations && !details.empty()) fail_usage("--detail without --annotations", "add --annotations");
        if (!annotations && (!parts.empty() || graph))
            fail_usage(fmt::format("{} without --annotations", parts.empty() ? "--graph" : "--parts"), "add --annotations");
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
        if (annotations) density = annotation_density({object, set}, factors(set));
        report.set_unit(set.unit);
        const auto border =
            std::count_if(object.halfedges().begin(), object.halfedges().end(), [&](Halfedge h) { return object.is_border(h); });
        if (border > 0)
            report.note(
                fmt::format("the mesh is open ({} border edges): the cage goes around both sides of its surface, in through "
                            "openings that are wider than twice --alpha; close it with 'mesh repair' where it represents a solid",
                            border));
        const auto sizes = wanted();
        const RelationGraph no_relations;
        const RelationGraph& relations = graph ? graph.on(set) : no_relations;
        const auto plane = mirror_of({object, set}, relations, report);
        const std::vector<std::size_t> regions = regions_of(set);
        auto results = in_file(mesh.file(), [&] {
            return constraints ? for_constraints({object, set}, plane, report)
                               : make_nested_cages(object, sizes, options, density, plane);
        });
        bool reached = true;
        std::size_t left_out = 0;
        std::set<long> genera;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const CageResult& result = results[i];
            const CageCheck check = check_cage(result.cage, i == 0 ? object : results[i - 1].cage);
            reached = reached && result.reached;
            left_out += check.outside.size();
            genera.insert(check.genus);
            const bool single_file = levels.empty() || one_file;
            std::string file = single_file ? output.file() : output.part_file(ending(sizes[i]));
            if (file.empty()) file = output.name + (single_file ? "" : ending(sizes[i]));
            const std::string name = Path(file).filename().string();
            if (result.cage.number_of_vertices() < sizes[i])
                report.note(fmt::format("{} has {} vertices instead of {}: {}", name, result.cage.number_of_vertices(), sizes[i],
                                        result.wrap_vertices < sizes[i]
                                            ? "its wrap has no more vertices; a smaller --alpha gives more"
                                            : "a mirrored cage has the same number of vertices on both sides of the plane"));
            report.row("cages")("file", file, name)("level", results.size() - 1 - i)("part", "")(
                "vertices", result.cage.number_of_vertices())("faces", result.cage.number_of_faces())("reached", result.reached)(
                "genus", check.genus)("clearance", check.clearance)("alpha", result.alpha);
        }
        if (!reached) report.note("with fewer vertices a part of the mesh would be outside");
        if (genera.size() > 1)
            report.note("the levels differ in genus: the wrap of a coarser cage closes openings that a finer cage preserves");
        if (left_out > 0)
            report.note(fmt::format("{} {} not inside the cage, because the cage is made around faces: remove with 'mesh repair'",
                                    left_out, left_out == 1 ? "vertex without faces is" : "vertices without faces are"));
        if (!reached || left_out > 0) report.answer_no();
        if (one_file || !regions.empty()) {
            output.write(nested({object, set}, relations, regions, results, report));
            return;
        }
        for (std::size_t i = 0; i < results.size(); ++i)
            if (levels.empty()) output.write(std::move(results[i].cage));
            else output.write_part(ending(sizes[i]), std::move(results[i].cage));
    }

    /// One cage fine enough to satisfy the constraints, as far as a cage can.
    [[nodiscard]] std::vector<CageResult> for_constraints(AnnotatedMeshView object, const std::optional<MirrorPlane>& plane,
                                                          Report& report) const {
        ConstraintCage cage_for = make_cage_for_constraints(object, constraints.on(object.annotations), options, plane,
                                                            deform_tolerances(), constraints.file());
        report_reach(report, cage_for.reach, object.annotations);
        for (const ConstraintReach& reach : cage_for.reach) {
            if (reach.reached) continue;
            report.note(ostraka::describe(reach, object.annotations) +
                        "; 'deform --space auto' solves for this constraint over the mesh");
            report.answer_no();
        }
        std::vector<CageResult> results;
        results.push_back(std::move(cage_for.made));
        return results;
    }

    /// All levels and the cages of the parts in one mesh, the outermost first.
    [[nodiscard]] Mesh nested(AnnotatedMeshView object, const RelationGraph& relations, const std::vector<std::size_t>& regions,
                              const std::vector<CageResult>& results, Report& report) const {
        CageOptions part_options = options;
        part_options.vertices = part_vertices;
        const std::vector<PartCage> inner =
            in_file(annotations.file(), [&] { return make_part_cages(object, regions, part_options, relations, graph.file()); });
        for (std::size_t k = 0; k < inner.size(); ++k)
            if (inner[k].check.components > 1)
                fail_input(annotations.file(),
                           fmt::format("'{}' consists of {} that are not connected", tag_of(object.annotations, regions, k),
                                       counted(inner[k].check.components, "piece")),
                           "annotate each piece separately: each gets a cage of its own");
        std::vector<const Mesh*> nested_cages;
        for (std::size_t i = results.size(); i-- > 0;) nested_cages.push_back(&results[i].cage);
        for (const PartCage& part_cage : inner) nested_cages.push_back(&part_cage.made.cage);
        Mesh cage = together(nested_cages);
        const std::vector<CageLevel> nested_levels = cage_levels(cage);
        std::size_t first = 0;
        for (std::size_t k = 0; k < nested_cages.size(); ++k) {
            const auto level = std::find_if(nested_levels.begin() + (k > 0 ? 1 : 0), nested_levels.end(),
                                            [&](const CageLevel& l) { return l.cage.vertices.front() == first; });
            const std::string cage_name =
                k < results.size() ? "a level"
                                   : fmt::format("the cage of '{}'", tag_of(object.annotations, regions, k - results.size()));
            if (level == nested_levels.end() || level->cage.vertices.size() != nested_cages[k]->number_of_vertices())
                throw Error(ErrorKind::failure, "cage", cage_name + " does not lie inside the cage of the whole object",
                            "raise --offset, or raise --vertices of the whole object's cage");
            first += nested_cages[k]->number_of_vertices();
            if (k < results.size()) continue;
            const PartCage& part_cage = inner[k - results.size()];
            const std::string file = output.file().empty() ? output.name : output.file();
            report.row("cages")(
                "file", file,
                fmt::format("{}, {}", Path(file).filename().string(), tag_of(object.annotations, regions, k - results.size())))(
                "level", level - nested_levels.begin())("part", tag_of(object.annotations, regions, k - results.size()))(
                "vertices", part_cage.made.cage.number_of_vertices())("faces", part_cage.made.cage.number_of_faces())(
                "reached", part_cage.made.reached)("genus", part_cage.check.genus)("clearance", part_cage.check.clearance)(
                "alpha", part_cage.made.alpha);
            if (!part_cage.made.reached) report.answer_no();
        }
        return cage;
    }

    static std::string tag_of(const AnnotationSet& set, const std::vector<std::size_t>& regions, std::size_t k) {
        return set.annotations[regions[k]].tag;
    }

    /// The regions named by --parts, without duplicates.
    [[nodiscard]] std::vector<std::size_t> regions_of(const AnnotationSet& set) const {
        const TagMatcher words = vocabulary.words();
        std::vector<std::size_t> regions;
        for (const std::string& name : parts) {
            const std::size_t before = regions.size();
            for (const std::size_t i : words.require(set, name, annotations.file()))
                if (set.annotations[i].type == AnnotationType::region &&
                    std::find(regions.begin(), regions.end(), i) == regions.end())
                    regions.push_back(i);
            if (regions.size() == before)
                fail_input(annotations.file(),
                           fmt::format("no annotation '{}' is a region, or it was named before", printable(name, 60)),
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
        std::vector<std::pair<int, double>> density_factors;
        for (const std::string& detail : details) {
            const std::size_t at = detail.rfind('=');
            if (at == std::string::npos)
                fail_usage(fmt::format("--detail is '{}'", printable(detail, 60)), "give annotation=factor, like spout=4");
            const auto factor = numbers_of<double>(detail.substr(at + 1), "--detail");
            if (factor.size() != 1 || !(factor[0] >= 0.1 && factor[0] <= 100))
                fail_usage(fmt::format("--detail is '{}'", printable(detail, 60)), "give a factor from 0.1 to 100");
            const std::string name = detail.substr(0, at);
            const std::size_t before = density_factors.size();
            for (const Annotation& annotation : set.annotations)
                if (annotation.tag == name || std::to_string(annotation.id) == name)
                    density_factors.emplace_back(annotation.id, factor[0]);
            if (density_factors.size() == before)
                fail_usage(fmt::format("--detail names '{}', which is not an annotation", printable(name, 60)),
                           "use an id or a tag");
        }
        return density_factors;
    }

    static MirrorPlane plane_of(const std::string& text) {
        const auto n = numbers_of<double>(text, "--mirror");
        if (n.size() != 6)
            fail_usage(fmt::format("--mirror is '{}'", printable(text, 60)), "give auto, or six numbers: a point and a normal");
        return {Point(n[0], n[1], n[2]), Vector(n[3], n[4], n[5])};
    }

    [[nodiscard]] std::optional<MirrorPlane> mirror_of(AnnotatedMeshView object, const RelationGraph& relations,
                                                       Report& report) const {
        if (mirror.empty()) return mirror_of(relations, object);
        if (mirror != "auto") return plane_of(mirror);
        const MirrorPlane plane = find_mirror_plane(object.mesh, object.annotations, mesh.file());
        const auto coordinates_text = [](const auto& p) {
            return fmt::format("{},{},{}", number(p.x()), number(p.y()), number(p.z()));
        };
        report.note(
            fmt::format("mirror plane through {} with normal {}", coordinates_text(plane.point), coordinates_text(plane.normal)));
        return plane;
    }

    /// Mirror plane of the whole object, from the graph. Mirror planes of parts are ignored.
    [[nodiscard]] std::optional<MirrorPlane> mirror_of(const RelationGraph& relations, AnnotatedMeshView object) const {
        for (const Annotation& annotation : object.annotations.annotations)
            if (is_whole(object.mesh, annotation))
                if (const auto plane = symmetry_plane(object, relations, {annotation.id}, graph.file())) return plane;
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

}  // namespace

std::unique_ptr<Operation> make_cage_make() { return make<CageMake>(); }

}  // namespace ostraka

// cage make, cage check: cages around meshes.
#include "operations.h"

#include "ostraka/semantic/cage_density.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

struct CageMake final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file; it may be open");
        p.output("output", Kind::cage, output, "cage to write (.ply, .obj, .off, .stl)");
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the mesh (.ant.json): four times the vertices where points, lines and outlines are");
        options.describe(p.options);
        p.options("levels", levels,
                  "numbers of vertices with commas: nested cages, each around the finer one, written as output-NUMBER",
                  Range{4, 1000000});
        p.options("mirror", mirror, "a mirror-symmetric cage about this plane; auto: about that of the object",
                  Words{{"auto"}, "a point and a normal as six numbers with commas", [](const std::string& text) {
                            if (text != "auto") static_cast<void>(plane_of(text));
                        }});
        p.options("detail", details, "annotation=factor: so many times the vertices there, instead; may be given several times");
        p.report.table("cages", text("file", "cage"), integer("vertices", "vertices"), integer("faces", "faces"),
                       boolean("reached"), integer("genus", "genus"), number("clearance", "clearance", "length"),
                       number("alpha", "alpha"));
    }

    void check() const override {
        const auto sizes = wanted();
        if (std::adjacent_find(sizes.begin(), sizes.end()) != sizes.end())
            fail_usage("--levels has a number twice", "give each once");
        if (!annotations && !details.empty()) fail_usage("--detail without --annotations", "add --annotations");
        if (levels.empty() || output.file().empty()) return;
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
        const auto plane = mirror_of(object, set, report);
        auto results = in_file(mesh.file(), [&] { return make_nested_cages(object, sizes, options, density, plane); });
        bool reached = true;
        std::size_t left_out = 0;
        std::set<long> genera;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const CageResult& made = results[i];
            const CageCheck check = check_cage(made.cage, i == 0 ? object : results[i - 1].cage);
            reached = reached && made.reached;
            left_out += check.outside.size();
            genera.insert(check.genus);
            std::string file = levels.empty() ? output.file() : output.part_file(ending(sizes[i]));
            if (file.empty()) file = output.name + (levels.empty() ? "" : ending(sizes[i]));
            const std::string name = Path(file).filename().string();
            if (made.cage.number_of_vertices() < sizes[i])
                report.note(name + " has " + std::to_string(made.cage.number_of_vertices()) + " vertices instead of " +
                            std::to_string(sizes[i]) +
                            (made.wrap_vertices < sizes[i] ? ": its wrap has no more, a smaller --alpha gives more"
                                                           : ": a mirrored cage has as many on both sides of the plane"));
            report.row("cages")("file", file, name)("vertices", made.cage.number_of_vertices())(
                "faces", made.cage.number_of_faces())("reached", made.reached)("genus", check.genus)(
                "clearance", check.clearance)("alpha", made.alpha);
        }
        if (!reached) report.note("fewer vertices could not be had without leaving a part of the mesh outside");
        if (genera.size() > 1)
            report.note("the levels differ in genus: the wrap of a coarser one closes holes that a finer one follows");
        if (left_out > 0)
            report.note(
                (left_out == 1 ? "1 vertex that no face has is" : std::to_string(left_out) + " vertices that no face has are") +
                std::string(" not inside the cage, which is made around faces: remove with 'mesh repair'"));
        if (!reached || left_out > 0) report.answer_no();
        for (std::size_t i = 0; i < results.size(); ++i)
            if (levels.empty()) output.write(std::move(results[i].cage));
            else output.write_part(ending(sizes[i]), std::move(results[i].cage));
    }

    static std::string ending(std::uint64_t size) { return "-" + std::to_string(size); }

    /// Numbers of vertices, from fine to coarse.
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

    [[nodiscard]] std::optional<MirrorPlane> mirror_of(const Mesh& object, const AnnotationSet& set, Report& report) const {
        if (mirror.empty()) return {};
        if (mirror != "auto") return plane_of(mirror);
        const MirrorPlane plane = find_mirror_plane(object, set, mesh.file());
        const auto three = [](const auto& p) { return number(p.x()) + "," + number(p.y()) + "," + number(p.z()); };
        report.note("mirror plane through " + three(plane.point) + " with normal " + three(plane.normal));
        return plane;
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    MeshOutput output;
    CageOptions options;
    std::vector<int> levels;
    std::string mirror;
    std::vector<std::string> details;
};

struct CheckOfCage final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("cage", Kind::cage, cage, "cage file");
        p.report.checks = true;
    }

    void run(Context&, Report& report) override { report.findings(findings(check_cage(cage->mesh, mesh->mesh), "")); }

    MeshInput mesh, cage;
};

}  // namespace

std::unique_ptr<Operation> make_cage_make() { return make<CageMake>(); }
std::unique_ptr<Operation> make_cage_check() { return make<CheckOfCage>(); }

}  // namespace ostraka

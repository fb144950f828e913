// report: one HTML page of results, objects in 3D with tables and drawings, that opens anywhere without a network.
#include "operations.h"

#include "ostraka/core/csv.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/page/page.h"
#include "ostraka/render/values.h"
#include "ostraka/transfer/bound_mesh.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace ostraka {

namespace {

/// An object of the page as it is read.
struct ShownObject {
    std::string name;
    MeshFile file;
    std::optional<AnnotationSet> set;
    std::optional<RelationGraph> graph;
    std::optional<Mesh> cage;
    std::vector<PageMap> maps;
    std::string unit;
};

/// Of each element the mean of the finite values that were added; none without any.
class Means {
public:
    explicit Means(std::size_t elements) : sums_(elements, 0), counts_(elements, 0) {}
    void add(std::size_t element, double value) {
        if (std::isfinite(value)) sums_[element] += value, counts_[element] += 1;
    }
    [[nodiscard]] std::vector<double> values() const {
        std::vector<double> means;
        for (std::size_t i = 0; i < sums_.size(); ++i) means.push_back(counts_[i] > 0 ? sums_[i] / counts_[i] : std::nan(""));
        return means;
    }

private:
    std::vector<double> sums_, counts_;
};

struct MakeReport final : Operation {
    void describe(Parameters& p) override {
        p.input("results", Kind::text, results,
                "what to show: meshes, each followed by what belongs to it (.ant.json, .graph.json, .cage.ply, maps .npy); "
                "templates (.template.json); tables (.csv) and drawings (.svg); folders of such files, such as a run's or a "
                "fit's, but for cages and maps")
            .many();
        p.output("page", Kind::text, page, "page to write (.html)");
        p.order({"results", "page"});
        p.options("title", title, "of the page; else the name of the first result");
        p.options("unit", unit, "of objects whose annotations tell none");
        p.options("limit", limit,
                  "vertices of an object that the page shows; larger ones are simplified for it, with their annotations",
                  Range{1000, 2'000'000});
        p.report.values(text("page"), integer("bytes"));
        p.report.table("objects", text("name"), integer("vertices"), integer("shown"), integer("annotations"), integer("maps"));
    }

    void check() const override {
        if (!page.file().empty() && extension(page.file()) != ".html")
            fail_usage("page '" + page.file() + "' does not end in .html", "name the page last");
    }

    void run(Context& context, Report& report) override {
        for (std::size_t i = 0; i < results.size(); ++i) {
            const Path file = results.path(i);
            context.record([&] { in_file(results.file(i), [&] { read(context, file, results.file_name(i)); }); });
        }
        if (objects.empty() && tables.empty() && drawings.empty())
            fail_input(results.file(), "holds nothing that a page can show", "give meshes, templates, tables or drawings");
        Page made(title.empty() ? (objects.empty() ? Path(results.file()).stem().string() : objects.front().name) : title);
        report.empty_table("objects");
        for (ShownObject& one : objects) add(made, report, one);
        for (PageTable& table : tables) made.add(link(std::move(table)));
        for (const auto& [name, svg] : drawings) made.add_drawing(name, svg);
        for (const std::string& text : notes) made.note(text);
        const std::string html = made.html(context.provenance().to_line());
        page.write(html);
        report("page", page.file_name())("bytes", html.size());
    }

    // ---- reading ----

    void read(Context& context, const Path& file, const std::string& name) {
        if (is_folder(file)) return read_folder(context, file);
        const std::string kind = extension(name);
        if (name.ends_with(".template.json")) return read_template_object(file, name);
        if (name.ends_with(".ant.json")) {
            ShownObject& of = object_for(file, name);
            of.set = read_annotations(file, of.file.mesh);
        } else if (name.ends_with(".graph.json")) {
            ShownObject& of = object_for(file, name);
            if (!of.set)
                fail_input(name, "comes before the annotations that it is of", "name the mesh, its annotations, then it");
            of.graph = read_graph(file, *of.set);
        } else if (name.find(".cage.") != std::string::npos) {
            object_for(file, name).cage = read_mesh(file).mesh;
        } else if (kind == ".npy") {
            ShownObject& of = object_for(file, name);
            of.maps.push_back({Path(name).stem().string(), Path(name).stem().string(), vertex_values(of, file, name)});
        } else if (kind == ".csv") {
            read_table(file, name);
        } else if (kind == ".svg") {
            drawings.emplace_back(Path(name).stem().string(), read_file(file));
        } else if (kind == ".ply" || kind == ".obj" || kind == ".off" || kind == ".stl") {
            read_object(context, file, name);
        } else {
            fail_input(name, "is nothing that a page can show",
                       "give .ply, .obj, .off, .stl, .ant.json, .graph.json, .template.json, .npy, .csv, .svg or a folder");
        }
    }

    void read_object(Context& context, const Path& file, const std::string& name) {
        ShownObject& one = objects.emplace_back();
        one.name = Path(name).stem().string();
        one.file = read_mesh(file);
        context.notes(name, one.file.notes);
        Path beside = file;
        beside.replace_extension(".ant.json");
        const bool named = std::any_of(results.sources.begin(), results.sources.end(), [&](const Source& source) {
            return !source.object && source.file.lexically_normal() == beside.lexically_normal();
        });
        if (!named && file_exists(beside)) one.set = read_annotations(beside, one.file.mesh);
    }

    void read_template_object(const Path& file, const std::string& name) {
        Template known = load_template(read_template(file));
        if (!known.mesh) fail_input(name, "has no mesh that could be read", "run: ostraka template check " + name);
        ShownObject& one = objects.emplace_back();
        one.name = name.substr(0, name.size() - std::string(".template.json").size());
        one.file = std::move(*known.mesh);
        one.set = std::move(known.annotations);
        one.graph = std::move(known.graph);
        one.unit = known.file.unit;
        for (std::optional<Mesh>& cage : known.cages)
            if (cage && !one.cage) one.cage = std::move(*cage);
        for (const Finding& finding : known.findings) notes.push_back(name + ": " + finding.text);
    }

    /// Meshes with the annotations beside them, templates, tables and drawings that lie in the folder itself, by name.
    void read_folder(Context& context, const Path& folder) {
        std::vector<std::string> names = files_in(folder);
        std::sort(names.begin(), names.end());
        std::size_t read_here = 0;
        for (const std::string& name : names) {
            const std::string kind = extension(name);
            const bool shown = name.ends_with(".template.json") || kind == ".csv" || kind == ".svg" || kind == ".ply" ||
                               kind == ".obj" || kind == ".off" || kind == ".stl";
            if (!shown || name.front() == '.' || name.find(".cage.") != std::string::npos) continue;
            in_file((folder / name).string(), [&] { read(context, folder / name, name); });
            ++read_here;
        }
        if (read_here == 0)
            fail_input(folder.string(), "holds nothing that a page can show", "give a folder with meshes, tables or drawings");
    }

    ShownObject& object_for(const Path& file, const std::string& name) {
        if (objects.empty())
            fail_input(file.string(), "comes before any mesh that it could belong to", "name the mesh before " + name);
        return objects.back();
    }

    static std::vector<double> vertex_values(const ShownObject& of, const Path& file, const std::string& name) {
        const std::vector<double> values = read_values(file);
        const Mesh& mesh = of.file.mesh;
        if (values.size() == mesh.number_of_vertices()) return values;
        if (values.size() != mesh.number_of_faces())
            fail_input(name,
                       "holds " + std::to_string(values.size()) + " values for a mesh of " +
                           std::to_string(mesh.number_of_vertices()) + " vertices and " + std::to_string(mesh.number_of_faces()) +
                           " faces",
                       "give one value an element");
        // The page colours vertices: each gets the mean of its faces.
        Means means(mesh.number_of_vertices());
        for (const Face face : mesh.faces())
            for (const Vertex v : corners(mesh, face)) means.add(v.idx(), values[face.idx()]);
        return means.values();
    }

    void read_table(const Path& file, const std::string& name) {
        const std::string content = read_file(file);
        const auto rows = csv_rows(content, csv_separator(content), name);
        if (rows.empty()) return;
        PageTable& table = tables.emplace_back();
        table.title = Path(name).stem().string();
        for (const std::string& cell : rows.front().cells) table.columns.push_back(unguarded(cell));
        for (std::size_t r = 1; r < rows.size(); ++r) {
            PageTable::Row& row = table.rows.emplace_back();
            for (std::size_t k = 0; k < table.columns.size(); ++k) {
                Json& cell = row.cells.emplace_back();
                const std::string value = k < rows[r].cells.size() ? unguarded(rows[r].cells[k]) : std::string();
                if (const auto x = number_of(value)) cell.SetDouble(*x);
                else if (!value.empty()) static_cast<JsonValue&>(cell) = json_string(value, cell.GetAllocator());
            }
        }
    }

    // ---- the page ----

    void add(Page& made, Report& report, ShownObject& one) const {
        const std::size_t place = report_object(report, one);
        PageObject shown;
        shown.name = one.name;
        shown.unit = !one.unit.empty() ? one.unit : unit;
        shown.cage = one.cage ? &*one.cage : nullptr;
        shown.graph = one.graph ? &*one.graph : nullptr;
        if (one.graph && one.set) shown.checks = check_relations(one.file.mesh, *one.set, *one.graph);
        PageTable table;
        if (one.set && !one.set->annotations.empty())
            table = annotation_table(one.file.mesh, *one.set, static_cast<int>(place), one.name);
        std::optional<BoundMesh> smaller;
        if (one.file.mesh.number_of_vertices() > limit) {
            smaller = simplified(one, shown);
            shown.mesh = &smaller->mesh;
            if (smaller->annotations) shown.annotations = &*smaller->annotations;
        } else {
            shown.mesh = &one.file.mesh;
            shown.maps = std::move(one.maps);
            if (one.set) shown.annotations = &*one.set;
        }
        made.add(shown);
        if (!table.rows.empty()) made.add(std::move(table));
    }

    std::size_t report_object(Report& report, const ShownObject& one) const {
        const std::size_t vertices = one.file.mesh.number_of_vertices();
        report.row("objects")("name", one.name)("vertices", vertices)("shown", std::min<std::size_t>(vertices, limit))(
            "annotations", one.set ? one.set->annotations.size() : 0)("maps", one.maps.size());
        return static_cast<std::size_t>(&one - &objects.front());
    }

    /// For the eye only: measures keep the values of the whole object.
    BoundMesh simplified(ShownObject& one, PageObject& shown) const {
        MeshFile copy;
        copy.mesh = one.file.mesh;
        BoundMesh bound(std::move(copy), one.set);
        SimplifyOptions options;
        options.vertices = limit;
        const SimplifyResult result = bound.simplify(options);
        const SurfaceSearch surface(bound.mesh);
        PageObject::Whole whole{one.file.mesh.number_of_vertices(), one.file.mesh.number_of_faces(), 0};
        for (const Vertex v : one.file.mesh.vertices())
            whole.deviation = std::max(whole.deviation, surface.closest(one.file.mesh.point(v)).distance);
        shown.whole = whole;
        for (PageMap& map : one.maps) {
            Means means(bound.mesh.number_of_vertices());
            for (std::size_t i = 0; i < map.values.size(); ++i)
                if (const Index to = result.vertex_map[i]; to != no_index) means.add(to, map.values[i]);
            shown.maps.push_back({map.name, map.label, means.values()});
        }
        if (one.set && bound.annotations)
            for (Annotation& annotation : bound.annotations->annotations)
                if (const Annotation* original = one.set->find(annotation.id))
                    for (Attribute& attribute : annotation.attributes)
                        for (const Attribute& known : original->attributes)
                            if (known.id == attribute.id && known.type == attribute.type) {
                                attribute.measure.value = known.measure.value;
                                attribute.measure.uncertainty = known.measure.uncertainty;
                                attribute.measure.stale = known.measure.stale;
                                attribute.descriptor = known.descriptor;
                            }
        return bound;
    }

    /// Rows whose first texts name an object of the page show it.
    PageTable link(PageTable table) const {
        for (PageTable::Row& row : table.rows)
            for (const Json& cell : row.cells)
                for (std::size_t o = 0; o < objects.size() && row.object < 0; ++o)
                    if (cell.IsString() && cell.GetString() == objects[o].name) row.object = static_cast<int>(o);
        return table;
    }

    FileInput results;
    FileOutput page{".html"};
    std::string title, unit;
    std::uint64_t limit = 200'000;
    std::deque<ShownObject> objects;
    std::vector<PageTable> tables;
    std::vector<std::pair<std::string, std::string>> drawings;
    std::vector<std::string> notes;
};

}  // namespace

std::unique_ptr<Operation> make_report() { return make<MakeReport>(); }

}  // namespace ostraka

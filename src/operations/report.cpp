// report: one self-contained HTML page of results: objects in 3D with tables and drawings.
#include "annotated_scene.h"
#include "operations.h"
#include "ostraka/operations/page_results.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/text.h"
#include "ostraka/core/words.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/page/page.h"
#include "ostraka/render/values.h"
#include "ostraka/semantic/measure_constraints.h"
#include "ostraka/transfer/bound_mesh.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

/// An object of the page while it is read.
struct ShownObject {
    std::string name;
    MeshFile file;
    std::optional<AnnotationSet> set;
    std::optional<RelationGraph> graph;
    std::optional<Mesh> cage;
    std::vector<PageMap> maps;
    std::optional<PageSlices> slices;
    std::vector<PageConstraint> constraints;
    std::vector<std::string> conflicts;
    std::vector<PageVerdict> conformance;
    std::string unit;
};

bool is_document(const std::string& name) {
    return extension(name) == ".json" && !name.ends_with(".ant.json") && !name.ends_with(".graph.json") &&
           !name.ends_with(".template.json");
}

/// URL of the path relative to the page.
std::string address_of(const Path& path) {
    std::vector<std::string> parts;
    for (const Path& part : path) parts.push_back(percent_encoded(part.string()));
    return joined(parts, "/");
}

struct MakeReport final : Operation {
    void describe(Parameters& p) override {
        p.input("results", Kind::text, results,
                "what to show: meshes, each followed by what belongs to it (.ant.json, .graph.json, .cage.ply, maps .npy, slices "
                "and "
                "reports of deformations and of 'relation check' .json); templates (.template.json); tables (.csv), other "
                "reports (.json) and drawings "
                "(.svg); folders of such files, such as a run's or a fit's, but for cages and maps")
            .many();
        p.output("page", Kind::text, page, "page to write (.html)");
        p.order({"results", "page"});
        p.output_option("beside", Kind::folder, beside,
                        "write the objects to this folder, which stays with the page: the page is an index that loads an object "
                        "when it is selected, for collections");
        p.options("title", title, "title of the page; otherwise the name of the first result");
        p.options("unit", unit, "unit of objects whose annotations have none");
        p.options(
            "limit", limit,
            "maximum number of vertices of an object on the page; larger objects are simplified for it, with their annotations",
            Range{1000, 2'000'000});
        p.report.values(text("page"), integer("bytes"));
        p.report.table("objects", text("name"), integer("vertices"), integer("shown"), integer("annotations"), integer("maps"));
    }

    void check() const override {
        if (!page.file().empty() && extension(page.file()) != ".html")
            fail_usage("page '" + page.file() + "' does not end in .html", "name the page last");
    }

    void run(Context& context, Report& report) override {
        made.emplace(title.empty() ? name_of(results.file()) : title);
        report.empty_table("objects");
        if (is_collection()) beside.open();
        for (std::size_t i = 0; i < results.size(); ++i) {
            const Path file = results.path(i);
            context.record([&] { in_file(results.file(i), [&] { read(context, report, file, results.file_name(i)); }); });
        }
        finish(context, report);
        if (places == 0 && tables.empty() && drawings == 0)
            fail_input(results.file(), "holds nothing that a page can show", "give meshes, templates, tables or drawings");
        if (!overview.rows.empty()) made->add(std::move(overview));
        for (PageTable& table : tables) {
            names.link(table);
            made->add(std::move(table));
        }
        const std::string html = made->html(context.provenance().to_line());
        page.write(html);
        report("page", page.file_name())("bytes", html.size());
    }

    [[nodiscard]] bool is_collection() const { return beside.size() > 0; }

    /// The name without folders and extensions.
    static std::string name_of(const std::string& file) {
        Path path = Path(file).lexically_normal();
        if (path.filename().empty() || path.filename() == ".")
            path = std::filesystem::absolute(path).lexically_normal().parent_path();
        std::string name = path.filename().string();
        for (const std::string_view end : {".template.json", ".ant.json", ".graph.json"})
            if (name.ends_with(end)) return name.substr(0, name.size() - end.size());
        return is_folder(path) ? name : Path(name).stem().string();
    }

    // ---- reading ----

    void read(Context& context, Report& report, const Path& file, const std::string& name) {
        if (is_folder(file)) return read_folder(context, report, file);
        const std::string kind = extension(name);
        if (name.ends_with(".template.json")) {
            read_template_object(context, report, file, name);
        } else if (name.ends_with(".ant.json")) {
            ShownObject& of = object_for(name);
            of.set = read_annotations(file, of.file.mesh);
        } else if (name.ends_with(".graph.json")) {
            ShownObject& of = object_for(name);
            if (!of.set)
                fail_input(name, "comes before the annotations that it is of", "name the mesh, its annotations, then it");
            of.graph = read_graph(file, *of.set);
        } else if (kind == ".json") {
            read_document(read_json(file), name);
        } else if (name.find(".cage.") != std::string::npos) {
            object_for(name).cage = read_mesh(file).mesh;
        } else if (kind == ".npy") {
            ShownObject& of = object_for(name);
            of.maps.push_back({Path(name).stem().string(), Path(name).stem().string(), vertex_values(of, file, name)});
        } else if (kind == ".csv") {
            tables.push_back(csv_table(file, name));
        } else if (kind == ".svg") {
            made->add_drawing(Path(name).stem().string(), read_file(file));
            ++drawings;
        } else if (is_mesh_name(name)) {
            read_object(context, report, file, name);
        } else {
            fail_input(name, "is nothing that a page can show",
                       "give .ply, .obj, .off, .stl, .json, .npy, .csv, .svg or a folder");
        }
    }

    void read_object(Context& context, Report& report, const Path& file, const std::string& name) {
        finish(context, report);
        ShownObject& one = current.emplace();
        one.name = Path(name).stem().string();
        one.file = read_mesh(file);
        std::vector<std::string> said = one.file.notes;
        std::erase_if(said, [](const std::string& note) { return note.find("properties not kept") != std::string::npos; });
        context.notes(name, said);  // additional properties become maps of the page
        one.maps = ply_maps(file, one.file);
        Path annotations = file;
        annotations.replace_extension(".ant.json");
        const bool named = std::any_of(results.sources.begin(), results.sources.end(), [&](const Source& source) {
            return !source.object && source.file.lexically_normal() == annotations.lexically_normal();
        });
        if (named) return;
        if (file_exists(annotations)) {
            one.set = read_annotations(annotations, one.file.mesh);
        } else if (const auto& labels = one.file.extras.face_labels; !labels.empty() && !is_completed(one.maps)) {
            AnnotationSet parts = regions_from_labels(one.file.mesh, labels, label_names(file));
            if (parts.annotations.size() > 1) one.set = std::move(parts);
        }
    }

    /// Label names of a group of assembled fragments, whose labels count the fragments from 1.
    static std::map<std::int32_t, std::string> label_names(const Path& mesh) {
        std::map<std::int32_t, std::string> known;
        const Path assembly = mesh.parent_path() / "assembly.json";
        if (!file_exists(assembly)) return known;
        const Json document = read_json(assembly);
        if (format_of(document) != "ostraka-reassembly") return known;
        std::int32_t label = 0;
        for (const JsonValue& fragment : list_in(document, "fragments")) known[++label] = text_in(fragment, "name");
        return known;
    }

    void read_template_object(Context& context, Report& report, const Path& file, const std::string& name) {
        finish(context, report);
        Template known = load_template(read_template(file));
        if (!known.mesh) fail_input(name, "has no mesh that could be read", "run: ostraka template check " + name);
        ShownObject& one = current.emplace();
        one.name = name_of(name);
        one.file = std::move(*known.mesh);
        one.set = std::move(known.annotations);
        one.graph = std::move(known.graph);
        one.unit = known.file.unit;
        for (std::optional<Mesh>& cage : known.cages)
            if (cage && !one.cage) one.cage = std::move(*cage);
        for (const Finding& finding : known.findings) made->note(name + ": " + finding.text);
    }

    /// Slices, and the constraints of a deformation, are added to the preceding object; other data become tables.
    void read_document(const Json& document, const std::string& name) {
        const std::string format = format_of(document);
        constexpr std::array known{"ostraka-slices",         "ostraka-report",      "ostraka-assembly", "ostraka-reassembly",
                                   "ostraka-classification", "ostraka-proportions", "ostraka-study",    "ostraka-technique"};
        if (std::find(known.begin(), known.end(), format) == known.end())
            fail_input(name, "is nothing that a page can show",
                       "of .json give slices, a report (--json), or what fit, assemble, template classify or study wrote");
        if (format == "ostraka-slices") {
            object_for(name).slices = page_slices(document, name);
            return;
        }
        const std::string stem = Path(name).stem().string();
        const bool is_report = format == "ostraka-report";
        const JsonValue* result = is_report ? find_member(document, "result") : &document;
        if (result == nullptr || !result->IsObject())
            fail_input(name, "has no result", "give the output of a command with --json");
        std::set<std::string> shown;
        if (is_report && text_in(document, "command") == "deform") {
            ShownObject& of = object_for(name);
            if (!of.set && !list_in(*result, "constraints").Empty())
                made->note(name + ": the parts of its constraints are not shown, because " + of.name + " has no annotations");
            of.constraints = page_constraints(*result, of.set ? *of.set : AnnotationSet{});
            of.conflicts = page_conflicts(*result);
            shown = {"constraints", "conflicts"};
        }
        if (is_report && text_in(document, "command") == "relation check") {
            ShownObject& of = object_for(name);
            of.conformance = page_conformance(*result, of.set ? *of.set : AnnotationSet{});
            shown = {"relationships", "rules"};
        }
        for (PageTable& table : record_tables(*result, stem, shown)) tables.push_back(std::move(table));
    }

    /// Adds the meshes of the folder with the files of the same name, and its templates, tables and drawings, sorted by name.
    /// Subfolders are not searched.
    void read_folder(Context& context, Report& report, const Path& folder) {
        std::vector<std::string> files = files_in(folder);
        std::erase_if(files, [&](const std::string& name) {
            if (is_memory(folder) || is_inside(folder / name, folder)) return false;
            context.note(name + " is left out: it is a link that leads out of the folder");
            return true;
        });
        std::sort(files.begin(), files.end());
        const auto stem = [](const std::string& name) { return Path(name).stem().string(); };
        // Documents by the name of their mesh; empty if they have none.
        std::multimap<std::string, std::pair<std::string, Json>> documents;
        std::vector<std::string> others;
        std::set<std::string> meshes;
        bool reassembled = false;
        for (const std::string& name : files)
            if (is_mesh_name(name)) meshes.insert(stem(name));
        for (const std::string& name : files) {
            if (name.front() == '.' || name.find(".cage.") != std::string::npos) continue;
            const std::string kind = extension(name);
            if (is_document(name)) {
                Json document = document_in(folder / name);
                const std::string format = format_of(document);
                reassembled = reassembled || format == "ostraka-reassembly";
                if (format != "ostraka-slices" && format != "ostraka-report" && format != "ostraka-assembly" &&
                    format != "ostraka-reassembly")
                    continue;
                documents.emplace(meshes.contains(stem(name)) ? stem(name) : std::string(), std::pair(name, std::move(document)));
            } else if (name.ends_with(".template.json") || kind == ".csv" || kind == ".svg" || is_mesh_name(name)) {
                others.push_back(name);
            }
        }
        if (others.empty() && documents.empty())
            fail_input(folder.string(), "holds nothing that a page can show", "give a folder with meshes, tables or drawings");
        const auto read_here = [&](const std::string& name) {
            in_file((folder / name).string(), [&] { read(context, report, folder / name, name); });
        };
        const std::size_t before = places;
        bool one_object = true;
        const auto read_documents = [&](const std::string& of) {
            for (auto [at, end] = documents.equal_range(of); at != end; ++at) {
                const auto& [name, document] = at->second;
                if (format_of(document) == "ostraka-slices" && !one_object)
                    made->note(name + " is left out: no mesh has its name");
                else in_file((folder / name).string(), [&] { read_document(document, name); });
            }
        };
        for (const std::string& name : others) {
            if (reassembled && name.find(".placed.") != std::string::npos) continue;  // contained in the groups
            read_here(name);
            if (!is_mesh_name(name)) continue;
            read_documents(stem(name));
        }
        one_object = current && places == before;
        read_documents("");
    }

    /// Reads a file of a folder; null if it is unreadable.
    Json document_in(const Path& file) {
        try {
            return read_json(file);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            made->note(file.filename().string() + " is left out: " + error.problem());
            return Json();
        }
    }

    static std::string format_of(const Json& document) {
        return document.IsObject() ? text_in(document, "format") : std::string();
    }

    ShownObject& object_for(const std::string& name) {
        if (!current) fail_input(name, "comes before any mesh that it could belong to", "name the mesh before " + name);
        return *current;
    }

    static std::vector<double> vertex_values(const ShownObject& of, const Path& file, const std::string& name) {
        std::vector<double> values = read_values(file);
        const Mesh& mesh = of.file.mesh;
        if (values.size() == mesh.number_of_vertices()) return values;
        if (values.size() != mesh.number_of_faces())
            fail_input(name,
                       "holds " + std::to_string(values.size()) + " values for a mesh of " +
                           std::to_string(mesh.number_of_vertices()) + " vertices and " + std::to_string(mesh.number_of_faces()) +
                           " faces",
                       "give one value an element");
        return vertex_means(mesh, values);
    }

    // ---- the page ----

    /// Adds the current object to the page, or writes it to a file of its own beside the page.
    void finish(Context& context, Report& report) {
        if (!current) return;
        ShownObject one = std::move(*current);
        current.reset();
        names.add(one.name, one.set && !is_collection() ? &*one.set : nullptr);
        const std::size_t vertices = one.file.mesh.number_of_vertices();
        report.row("objects")("name", one.name)("vertices", vertices)("shown", std::min<std::size_t>(vertices, limit))(
            "annotations", one.set ? one.set->annotations.size() : 0)("maps", one.maps.size());
        const std::size_t place = places++;
        if (!is_collection()) return add(*made, one, place, nullptr);
        Page alone(one.name);
        Picture small;
        add(alone, one, 0, &small);
        const std::string number = padded(place + 1, std::max<std::size_t>(9999, place + 1));
        const Path relative = from_page(beside.path());
        PageEntry entry;
        entry.name = one.name;
        entry.file = address_of(relative / (number + ".js"));
        entry.thumbnail = address_of(relative / (number + ".png"));
        entry.vertices = vertices;
        entry.faces = one.file.mesh.number_of_faces();
        std::set<std::string> tags;
        if (one.set)
            for (const Annotation& annotation : one.set->annotations)
                if (!annotation.tag.empty()) tags.insert(annotation.tag);
        entry.tags.assign(tags.begin(), tags.end());
        made->add(entry);
        write_file(beside.in(number + ".js"), alone.script(entry.file, context.provenance().to_line()));
        write_png(beside.in(number + ".png"), small);
        add_to_overview(one, place);
    }

    [[nodiscard]] Path from_page(const Path& folder) const {
        if (is_memory(folder) || is_memory(page.path())) return folder.filename();
        const Path around = std::filesystem::absolute(page.path()).lexically_normal().parent_path();
        return std::filesystem::absolute(folder / "").lexically_normal().lexically_relative(around);
    }

    /// Adds size and measures of an object to the overview of the collection.
    void add_to_overview(const ShownObject& one, std::size_t place) {
        if (overview.columns.empty()) {
            overview.title = "objects";
            overview.columns = {"object", "vertices", "triangles", "annotations"};
        }
        PageTable::Row& row = overview.rows.emplace_back();
        row.object = static_cast<int>(place);
        row.cells.push_back(cell_of(one.name));
        row.cells.push_back(cell_of(one.file.mesh.number_of_vertices()));
        row.cells.push_back(cell_of(one.file.mesh.number_of_faces()));
        row.cells.push_back(cell_of(one.set ? one.set->annotations.size() : std::size_t{0}));
        constexpr std::size_t most_columns = 40;
        if (one.set)
            for (const Annotation& annotation : one.set->annotations)
                for (const Attribute& attribute : annotation.attributes) {
                    if (attribute.type != AttributeType::measure || !attribute.measure.value) continue;
                    std::string column = annotation.tag + ": " + attribute.name;
                    if (!attribute.measure.unit.empty()) column += " (" + attribute.measure.unit + ")";
                    const auto found = std::find(overview.columns.begin(), overview.columns.end(), column);
                    const auto k = static_cast<std::size_t>(found - overview.columns.begin());
                    if (found == overview.columns.end()) {
                        if (overview.columns.size() >= most_columns) continue;
                        overview.columns.push_back(column);
                    }
                    while (row.cells.size() <= k) row.cells.emplace_back();
                    row.cells[k] = cell_of(*attribute.measure.value);
                }
        for (PageTable::Row& any : overview.rows)
            while (any.cells.size() < overview.columns.size()) any.cells.emplace_back();
    }

    void add(Page& to, ShownObject& one, std::size_t place, Picture* small) const {
        PageObject shown;
        shown.name = one.name;
        shown.unit = !one.unit.empty() ? one.unit : unit;
        shown.cage = one.cage ? &*one.cage : nullptr;
        shown.graph = one.graph ? &*one.graph : nullptr;
        shown.slices = one.slices ? &*one.slices : nullptr;
        shown.constraints = std::move(one.constraints);
        shown.conflicts = std::move(one.conflicts);
        shown.conformance = std::move(one.conformance);
        if (one.graph && one.set) shown.checks = judge_relationships(one.file.mesh, *one.set, *one.graph);
        PageTable table;
        if (one.set && !one.set->annotations.empty()) {
            table = annotation_table(one.file.mesh, *one.set, static_cast<int>(place), one.name);
            if (are_apart(one.file.mesh, *one.set))
                for (std::size_t i = 0; i < one.set->annotations.size(); ++i) shown.parts.push_back(i);
        }
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
        std::optional<AlongEdges> along_edges;  // free outlines are shown on the mesh cut along them
        if (shown.annotations != nullptr) along_edges.emplace(*shown.mesh, *shown.annotations);
        if (along_edges && along_edges->cut()) {
            for (PageMap& map : shown.maps) {
                map.values = along_edges->cut()->vertex_values(*shown.mesh, map.values);
                if (!map.categories.empty())
                    for (double& value : map.values) value = std::round(value);
            }
            shown.mesh = &along_edges->mesh();
            shown.annotations = &along_edges->annotations();
        }
        to.add(shown);
        if (!table.rows.empty()) to.add(std::move(table));
        if (small != nullptr) *small = thumbnail(*shown.mesh, shown.annotations, "240x180");
    }

    /// Simplifies the mesh for display only: measures keep the values of the original.
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
        for (const PageMap& map : one.maps)
            shown.maps.push_back(simplified_map(map, result.vertex_map, bound.mesh.number_of_vertices()));
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

    FileInput results;
    FileOutput page{".html"};
    FolderOutput beside;
    std::string title, unit;
    std::uint64_t limit = 200'000;
    std::optional<Page> made;
    std::optional<ShownObject> current;  ///< the object to which the following files belong
    std::size_t places = 0, drawings = 0;
    PageNames names;
    PageTable overview;  ///< of a collection
    std::vector<PageTable> tables;
};

}  // namespace

std::unique_ptr<Operation> make_report() { return make<MakeReport>(); }

}  // namespace ostraka

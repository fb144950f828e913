// report: one self-contained HTML page of results: objects in 3D with tables and drawings.
#include "operations/annotated_scene.h"
#include "operations/operations.h"
#include "operations/scene_colours.h"
#include "ostraka/operations/page_results.h"

#include "ostraka/annotation/cut_extras.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/page/page.h"
#include "ostraka/render/values.h"
#include "ostraka/semantic/measure_constraints.h"
#include "ostraka/transfer/bound_mesh.h"

#include <fmt/core.h>

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

/// Copies the value of the original attribute; a measure keeps its own pins.
void keep_value(Attribute& attribute, const Attribute& original) {
    Measure* measure = attribute.measure();
    const Measure* original_measure = original.measure();
    if (measure != nullptr && original_measure != nullptr) {
        measure->value = original_measure->value;
        measure->uncertainty = original_measure->uncertainty;
        measure->stale = original_measure->stale;
    } else if (attribute.descriptor() != nullptr && original.descriptor() != nullptr) {
        attribute.value = original.value;
    }
}

struct MakeReport final : Operation {
    void declare(Parameters& p) override {
        p.input("results", Kind::text, results,
                "results to show: meshes, each followed by the files that belong to it (.ant.json, .graph.json, .cage.ply, maps "
                ".npy, slices and reports of deformations or of 'relation check' .json); templates (.template.json); tables "
                "(.csv); other reports (.json); drawings (.svg); folders of such files, for example of a run or a fit (cages and "
                "maps in folders are omitted)")
            .many();
        p.output("page", Kind::text, page, "page to write (.html)");
        p.order({"results", "page"});
        p.output_option("beside", Kind::folder, objects_folder,
                        "folder for the objects of a large collection, which must stay beside the page: the page then loads each "
                        "object when it is selected");
        p.options("title", title, "title of the page; by default the name of the first result");
        p.options("colour", colouring, page_colouring_help, page_colouring_names());
        p.options("unit", unit, "unit of the coordinates of objects whose annotations state no unit");
        p.options(
            "limit", limit,
            "maximum number of vertices of an object on the page; larger objects are simplified together with their annotations",
            Range{1000, 2'000'000});
        p.report.values(text("page"), integer("bytes"));
        p.report.table("objects", text("name"), integer("vertices"), integer("shown"), integer("annotations"), integer("maps"));
    }

    void check() const override {
        if (!page.file().empty() && extension(page.file()) != ".html")
            fail_usage(fmt::format("page '{}' does not end in .html", page.file()), "name the page last");
    }

    void run(Context& context, Report& report) override {
        report_page.emplace(title.empty() ? name_of(results.file()) : title);
        report.empty_table("objects");
        if (is_collection()) objects_folder.open();
        for (std::size_t i = 0; i < results.size(); ++i) {
            const Path file = results.path(i);
            context.record([&] { in_file(results.file(i), [&] { read(context, report, file, results.file_name(i)); }); });
        }
        finish(context, report);
        if (object_count == 0 && tables.empty() && drawings == 0)
            fail_input(results.file(), "holds nothing that a page can show", "give meshes, templates, tables or drawings");
        if (!overview.rows.empty()) report_page->add(std::move(overview));
        for (PageTable& table : tables) {
            names.link(table);
            report_page->add(std::move(table));
        }
        const std::string html = report_page->html(context.provenance().to_line());
        page.write(html);
        report("page", page.file_name())("bytes", html.size());
    }

    [[nodiscard]] bool is_collection() const { return objects_folder.size() > 0; }

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
            ShownObject& object = object_for(name);
            object.set = read_annotations(file, object.file.mesh);
        } else if (name.ends_with(".graph.json")) {
            ShownObject& object = object_for(name);
            if (!object.set)
                fail_input(name, "comes before the annotations to which the graph refers",
                           "name the mesh, its annotations, then the graph");
            object.graph = read_graph(file, *object.set);
        } else if (kind == ".json") {
            read_document(read_json(file), name);
        } else if (name.find(".cage.") != std::string::npos) {
            object_for(name).cage = read_mesh(file).mesh;
        } else if (kind == ".npy") {
            ShownObject& object = object_for(name);
            object.maps.push_back({Path(name).stem().string(), Path(name).stem().string(), vertex_values(object, file, name)});
        } else if (kind == ".csv") {
            tables.push_back(csv_table(file, name));
        } else if (kind == ".svg") {
            report_page->add_drawing(Path(name).stem().string(), read_file(file));
            ++drawings;
        } else if (is_mesh_name(name)) {
            read_object(context, report, file, name);
        } else {
            fail_input(name, "cannot be shown on a page", "give .ply, .obj, .off, .stl, .json, .npy, .csv, .svg or a folder");
        }
    }

    void read_object(Context& context, Report& report, const Path& file, const std::string& name) {
        finish(context, report);
        ShownObject& object = current.emplace();
        object.name = Path(name).stem().string();
        object.file = read_mesh(file);
        std::vector<std::string> notes = object.file.notes;
        std::erase_if(notes, [](const std::string& note) { return note.find("properties not kept") != std::string::npos; });
        context.notes(name, notes);  // additional properties become maps of the page
        object.maps = value_maps(object.file);
        Path annotations = file;
        annotations.replace_extension(".ant.json");
        const bool is_listed = std::any_of(results.sources.begin(), results.sources.end(), [&](const Source& source) {
            return !source.object && source.file.lexically_normal() == annotations.lexically_normal();
        });
        if (is_listed) return;
        if (file_exists(annotations)) {
            object.set = read_annotations(annotations, object.file.mesh);
        } else if (const auto& labels = object.file.extras.face_labels; !labels.empty() && !is_completed(object.maps)) {
            AnnotationSet parts = regions_from_labels(object.file.mesh, labels, label_names(file));
            if (parts.annotations.size() > 1) object.set = std::move(parts);
        }
    }

    /// Label names of a group of assembled fragments, whose labels count the fragments from 1.
    static std::map<std::int32_t, std::string> label_names(const Path& mesh) {
        std::map<std::int32_t, std::string> names_of_labels;
        const Path assembly = mesh.parent_path() / "assembly.json";
        if (!file_exists(assembly)) return names_of_labels;
        const Json document = read_json(assembly);
        if (format_of(document) != "ostraka-reassembly") return names_of_labels;
        std::int32_t label = 0;
        for (const JsonValue& fragment : list_in(document, "fragments")) names_of_labels[++label] = text_in(fragment, "name");
        return names_of_labels;
    }

    void read_template_object(Context& context, Report& report, const Path& file, const std::string& name) {
        finish(context, report);
        Template loaded = load_template(read_template(file));
        if (!loaded.mesh) fail_input(name, "has no mesh that could be read", "run: ostraka template check " + name);
        ShownObject& object = current.emplace();
        object.name = name_of(name);
        object.file = std::move(*loaded.mesh);
        object.set = std::move(loaded.annotations);
        object.graph = std::move(loaded.graph);
        object.unit = loaded.file.unit;
        for (std::optional<Mesh>& cage : loaded.cages)
            if (cage && !object.cage) object.cage = std::move(*cage);
        for (const Finding& finding : loaded.findings) report_page->note(fmt::format("{}: {}", name, finding.text));
    }

    /// Slices, and the constraints of a deformation, are added to the preceding object; other data become tables.
    void read_document(const Json& document, const std::string& name) {
        const std::string format = format_of(document);
        constexpr std::array known_formats{"ostraka-slices",     "ostraka-report",         "ostraka-assembly",
                                           "ostraka-reassembly", "ostraka-classification", "ostraka-proportions",
                                           "ostraka-study",      "ostraka-technique"};
        if (std::find(known_formats.begin(), known_formats.end(), format) == known_formats.end())
            fail_input(
                name, "cannot be shown on a page",
                "among .json files, give slices, a report (--json), or what fit, assemble, template classify or study wrote");
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
            ShownObject& object = object_for(name);
            if (!object.set && !list_in(*result, "constraints").Empty())
                report_page->note(fmt::format("{}: the parts of its constraints are not shown, because {} has no annotations",
                                              name, object.name));
            object.constraints = page_constraints(*result, object.set ? *object.set : AnnotationSet{});
            object.conflicts = page_conflicts(*result);
            shown = {"constraints", "conflicts"};
        }
        if (is_report && text_in(document, "command") == "relation check") {
            ShownObject& object = object_for(name);
            object.conformance = page_conformance(*result, object.set ? *object.set : AnnotationSet{});
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
        const auto read_entry = [&](const std::string& name) {
            in_file((folder / name).string(), [&] { read(context, report, folder / name, name); });
        };
        const std::size_t before = object_count;
        bool one_object = true;
        const auto read_documents = [&](const std::string& object) {
            for (auto [entry, end] = documents.equal_range(object); entry != end; ++entry) {
                const auto& [name, document] = entry->second;
                if (format_of(document) == "ostraka-slices" && !one_object)
                    report_page->note(name + " is left out: no mesh has its name");
                else in_file((folder / name).string(), [&] { read_document(document, name); });
            }
        };
        for (const std::string& name : others) {
            if (reassembled && name.find(".placed.") != std::string::npos) continue;  // contained in the groups
            read_entry(name);
            if (!is_mesh_name(name)) continue;
            read_documents(stem(name));
        }
        one_object = current && object_count == before;
        read_documents("");
    }

    /// Reads a file of a folder; null if it is unreadable.
    Json document_in(const Path& file) {
        try {
            return read_json(file);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            report_page->note(fmt::format("{} is left out: {}", file.filename().string(), error.problem()));
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

    static std::vector<double> vertex_values(const ShownObject& object, const Path& file, const std::string& name) {
        std::vector<double> values = read_values(file);
        const Mesh& mesh = object.file.mesh;
        if (values.size() == mesh.number_of_vertices()) return values;
        if (values.size() != mesh.number_of_faces())
            fail_input(name,
                       fmt::format("holds {} values for a mesh of {} vertices and {} faces", values.size(),
                                   mesh.number_of_vertices(), mesh.number_of_faces()),
                       "give one value per element");
        return vertex_means(mesh, values);
    }

    // ---- the page ----

    /// Adds the current object to the page, or writes it to a file of its own beside the page.
    void finish(Context& context, Report& report) {
        if (!current) return;
        ShownObject object = std::move(*current);
        current.reset();
        names.add(object.name, object.set && !is_collection() ? &*object.set : nullptr);
        const std::size_t vertices = object.file.mesh.number_of_vertices();
        report.row("objects")("name", object.name)("vertices", vertices)("shown", std::min<std::size_t>(vertices, limit))(
            "annotations", object.set ? object.set->annotations.size() : 0)("maps", object.maps.size());
        const std::size_t place = object_count++;
        if (!is_collection()) return add(*report_page, object, place, nullptr);
        Page object_page(object.name);
        Picture small_picture;
        add(object_page, object, 0, &small_picture);
        const std::string file_number = padded(place + 1, std::max<std::size_t>(9999, place + 1));
        const Path relative = from_page(objects_folder.path());
        PageEntry entry;
        entry.name = object.name;
        entry.file = address_of(relative / (file_number + ".js"));
        entry.thumbnail = address_of(relative / (file_number + ".png"));
        entry.vertices = vertices;
        entry.faces = object.file.mesh.number_of_faces();
        std::set<std::string> tags;
        if (object.set)
            for (const Annotation& annotation : object.set->annotations)
                if (!annotation.tag.empty()) tags.insert(annotation.tag);
        entry.tags.assign(tags.begin(), tags.end());
        report_page->add(entry);
        write_file(objects_folder.in(file_number + ".js"), object_page.script(entry.file, context.provenance().to_line()));
        write_png(objects_folder.in(file_number + ".png"), small_picture);
        add_to_overview(object, place);
    }

    [[nodiscard]] Path from_page(const Path& folder) const {
        if (is_memory(folder) || is_memory(page.path())) return folder.filename();
        const Path page_folder = std::filesystem::absolute(page.path()).lexically_normal().parent_path();
        return std::filesystem::absolute(folder / "").lexically_normal().lexically_relative(page_folder);
    }

    /// Adds size and measures of an object to the overview of the collection.
    void add_to_overview(const ShownObject& object, std::size_t place) {
        if (overview.columns.empty()) {
            overview.title = "objects";
            overview.columns = {"object", "vertices", "triangles", "annotations"};
        }
        PageTable::Row& row = overview.rows.emplace_back();
        row.object = static_cast<int>(place);
        row.cells.push_back(cell_of(object.name));
        row.cells.push_back(cell_of(object.file.mesh.number_of_vertices()));
        row.cells.push_back(cell_of(object.file.mesh.number_of_faces()));
        row.cells.push_back(cell_of(object.set ? object.set->annotations.size() : std::size_t{0}));
        constexpr std::size_t max_columns = 40;
        if (object.set)
            for (const Annotation& annotation : object.set->annotations)
                for (const Attribute& attribute : annotation.attributes) {
                    const Measure* measure = attribute.measure();
                    if (measure == nullptr || !measure->value) continue;
                    std::string column = fmt::format("{}: {}", annotation.tag, attribute.name);
                    if (!measure->unit.empty()) column += fmt::format(" ({})", measure->unit);
                    const auto column_place = std::find(overview.columns.begin(), overview.columns.end(), column);
                    const auto k = static_cast<std::size_t>(column_place - overview.columns.begin());
                    if (column_place == overview.columns.end()) {
                        if (overview.columns.size() >= max_columns) continue;
                        overview.columns.push_back(column);
                    }
                    while (row.cells.size() <= k) row.cells.emplace_back();
                    row.cells[k] = cell_of(*measure->value);
                }
        for (PageTable::Row& table_row : overview.rows)
            while (table_row.cells.size() < overview.columns.size()) table_row.cells.emplace_back();
    }

    void add(Page& target_page, ShownObject& object, std::size_t place, Picture* small_picture) const {
        PageObject shown;
        shown.name = object.name;
        shown.unit = !object.unit.empty() ? object.unit : unit;
        shown.cage = object.cage ? &*object.cage : nullptr;
        shown.graph = object.graph ? &*object.graph : nullptr;
        shown.slices = object.slices ? &*object.slices : nullptr;
        shown.constraints = std::move(object.constraints);
        shown.conflicts = std::move(object.conflicts);
        shown.conformance = std::move(object.conformance);
        if (object.graph && object.set) shown.checks = judge_relationships({object.file.mesh, *object.set}, *object.graph);
        PageTable table;
        if (object.set && !object.set->annotations.empty()) {
            table = annotation_table({object.file.mesh, *object.set}, static_cast<int>(place), object.name);
            if (are_apart({object.file.mesh, *object.set}))
                for (std::size_t i = 0; i < object.set->annotations.size(); ++i) shown.parts.push_back(i);
        }
        shown.colouring = page_colouring(colouring);
        std::optional<BoundMesh> simplified_mesh;
        shown.extras = &object.file.extras;
        if (object.file.mesh.number_of_vertices() > limit) {
            simplified_mesh = simplified(object, shown);
            shown.mesh = &simplified_mesh->mesh;
            shown.extras = &simplified_mesh->extras;
            if (simplified_mesh->annotations) shown.annotations = &*simplified_mesh->annotations;
        } else {
            shown.mesh = &object.file.mesh;
            shown.maps = std::move(object.maps);
            if (object.set) shown.annotations = &*object.set;
        }
        std::optional<EdgeAlignedAnnotations> along_edges;  // free outlines are shown on the mesh cut along them
        if (shown.annotations != nullptr) along_edges.emplace(AnnotatedMeshView(*shown.mesh, *shown.annotations));
        MeshExtras extras_of_cut;
        if (along_edges && along_edges->cut()) {
            extras_of_cut = cut_extras(*along_edges->cut(), *shown.mesh, *shown.extras);
            shown.extras = &extras_of_cut;
            for (PageMap& map : shown.maps) {
                map.values = along_edges->cut()->vertex_values(*shown.mesh, map.values);
                if (!map.categories.empty())
                    for (double& value : map.values) value = std::round(value);
            }
            shown.mesh = &along_edges->object().mesh;
            shown.annotations = &along_edges->object().annotations;
        }
        target_page.add(shown);
        if (!table.rows.empty()) target_page.add(std::move(table));
        if (small_picture != nullptr) *small_picture = thumbnail(*shown.mesh, shown.annotations, *shown.extras, "240x180");
    }

    /// Simplifies the mesh for display only: measures keep the values of the original.
    BoundMesh simplified(ShownObject& object, PageObject& shown) const {
        MeshFile copy;
        copy.mesh = object.file.mesh;
        copy.extras = object.file.extras;
        BoundMesh bound(std::move(copy), object.set);
        SimplifyOptions options;
        options.vertices = limit;
        const SimplifyResult result = bound.simplify(options);
        const SurfaceSearch surface(bound.mesh);
        PageObject::Whole whole{object.file.mesh.number_of_vertices(), object.file.mesh.number_of_faces(), 0};
        for (const Vertex v : object.file.mesh.vertices())
            whole.deviation = std::max(whole.deviation, surface.closest(object.file.mesh.point(v)).distance);
        shown.whole = whole;
        for (const PageMap& map : object.maps)
            shown.maps.push_back(simplified_map(map, result.vertex_map, bound.mesh.number_of_vertices()));
        if (object.set && bound.annotations)
            for (Annotation& annotation : bound.annotations->annotations)
                if (const Annotation* original = object.set->find(annotation.id))
                    for (Attribute& attribute : annotation.attributes)
                        for (const Attribute& original_attribute : original->attributes)
                            if (original_attribute.id == attribute.id) keep_value(attribute, original_attribute);
        return bound;
    }

    FileInput results;
    FileOutput page{".html"};
    FolderOutput objects_folder;
    std::string title, unit;
    std::uint64_t limit = 200'000;
    PageColouring colouring = PageColouring::automatic;
    std::optional<Page> report_page;
    std::optional<ShownObject> current;  ///< the object to which the following files belong
    std::size_t object_count = 0, drawings = 0;
    PageNames names;
    PageTable overview;  ///< of a collection
    std::vector<PageTable> tables;
};

}  // namespace

std::unique_ptr<Operation> make_report() { return make<MakeReport>(); }

}  // namespace ostraka

// catalogue: a printed catalogue of a folder of scans: one page for each object, or sheets of many, and a table of all.
#include "operations/operations.h"

#include "ostraka/catalogue/entry.h"
#include "ostraka/collection/objects.h"
#include "ostraka/core/memory.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/figures/catalogue.h"
#include "ostraka/interchange/landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// The provenance as one line, with numbers as short as they are exact.
std::string printed_line(Provenance provenance) {
    for (auto& [name, value] : provenance.options)
        if (const std::optional<double> amount = number_of(value)) value = digits(*amount);
    return provenance.to_line();
}

/// Descriptive fields of an object: NAME.dc.json beside the mesh, an object whose members are texts or lists of texts.
std::vector<std::pair<std::string, std::string>> record_beside(const CollectionObject& object, std::vector<std::string>& notes) {
    std::vector<std::pair<std::string, std::string>> fields_of_object;
    const Path of = object.mesh.empty() ? object.landmarks : object.mesh;
    const Path file = of.parent_path() / (of.stem().string() + ".dc.json");
    if (of.empty() || !file_exists(file)) return fields_of_object;
    try {
        const Json document = read_json(file);
        if (!document.IsObject())
            fail_input(file.string(), "is not a JSON object", "write {\"title\": \"...\", \"creator\": \"...\"}");
        for (const auto& member : document.GetObject()) {
            std::string name = text_of(member.name);
            if (name.starts_with("dc:") || name.starts_with("dcterms:")) name = name.substr(name.find(':') + 1);
            std::vector<std::string> texts;
            if (member.value.IsString()) texts.push_back(text_of(member.value));
            if (member.value.IsArray())
                for (const JsonValue& element : member.value.GetArray())
                    if (element.IsString()) texts.push_back(text_of(element));
            if (member.value.IsNumber()) texts.push_back(digits(member.value.GetDouble()));
            if (!texts.empty()) fields_of_object.emplace_back(printable(name, 60), printable(joined(texts, "; "), 1000));
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        notes.push_back(fmt::format("the descriptive fields are not shown: {}", error.what()));
    }
    return fields_of_object;
}

CatalogueEntry entry_of(const CollectionObject& object, const CatalogueOptions& options) {
    if (object.mesh.empty())
        fail_input(object.landmarks.string(), "there are landmarks, but no mesh of this name", "put the mesh beside them");
    TriangulatedSoup triangles = in_file(object.mesh.string(), [&] { return triangulate(read_polygons(object.mesh)); });
    CatalogueSubject subject;
    subject.name = object.name;
    subject.notes = triangles.notes;
    subject.soup = std::move(triangles.soup);
    subject.unit = object.unit;
    AnnotationSet set;
    if (!object.annotations.empty()) {
        Mesh mesh;
        if (try_build_mesh(subject.soup, mesh).any()) {
            subject.notes.emplace_back("the annotations are not shown: the surface is no manifold (ostraka mesh repair)");
        } else {
            set = read_annotations(object.annotations, mesh);
            subject.annotations = &set;
            subject.notes.insert(subject.notes.end(), set.notes.begin(), set.notes.end());
            if (subject.unit.empty()) subject.unit = set.unit;
        }
    }
    if (!object.landmarks.empty()) {
        const LandmarkSet landmarks = read_landmarks(object.landmarks, LandmarkFormat::mrk);
        for (const Landmark& landmark : landmarks.landmarks) subject.landmarks.emplace_back(landmark.name, landmark.position);
        subject.notes.insert(subject.notes.end(), landmarks.notes.begin(), landmarks.notes.end());
        if (subject.unit.empty()) subject.unit = landmarks.unit;
    }
    return in_file(object.mesh.string(), [&] { return catalogue_entry(subject, options); });
}

/// A collection of a single mesh file, with the files of the same name beside it.
Collection collection_of_mesh(const Path& mesh) {
    Collection collection;
    CollectionObject object;
    object.name = printable(mesh.stem().string(), 150);
    object.mesh = mesh;
    const Path stem = mesh.parent_path() / mesh.stem();
    if (const Path file = stem.string() + ".ant.json"; file_exists(file)) object.annotations = file;
    if (const Path file = stem.string() + ".mrk.json"; file_exists(file)) object.landmarks = file;
    Sha256 hash;
    for (const Path& file : {object.mesh, object.annotations, object.landmarks}) {
        const std::string checksum = file.empty() ? "-" : sha256_of_file(file);
        hash.update(checksum.data(), checksum.size());
    }
    object.checksum = hash.hexadecimal();
    collection.objects.push_back(std::move(object));
    return collection;
}

struct MakeCatalogue final : Operation {
    void declare(Parameters& p) override {
        p.input("collection", Kind::collection, collection, "folder of scans, a list of objects (.study.json), or one mesh");
        p.output(
            "output", Kind::picture, output,
            "catalogue to write: .pdf (all pages), .html (pages and table in one file) or .svg (the page of a single object)");
        p.output_option("html", Kind::text, html, "HTML file to write as well");
        p.output_option("table", Kind::table, table, "table of all objects to write (.csv)");
        options.declare_options(p.options);
        p.options.group("Print");
        style.declare_options(p.options);
        p.report.values(integer("objects", "objects"), integer("unreadable", "unreadable"), integer("pages", "pages"),
                        integer("resumed"));
        p.report.table("entries", text("name", "name"), text("kind", "kind"), text("diameterOf"),
                       number("diameter", "diameter", "mm"), number("diameterLow", "from", "mm"),
                       number("diameterHigh", "to", "mm"), number("preserved", "preserved"), number("height", "height", "mm"),
                       number("thickness", "wall", "mm"), number("thicknessLow", "", "mm"), number("thicknessHigh", "", "mm"),
                       number("capacity", "", "litres"), number("volume", "", "cm^3"), number("weight", "", "g"),
                       text("scale", "scale"), integer("page", "page"), texts("unknown"), text("problem"));
    }

    void check() const override {
        const auto check_ending = [](const Slot& slot, const std::vector<std::string>& endings) {
            for (const Source& source : slot.sources)
                if (const std::string ending = extension(source.file);
                    !source.file.empty() && std::find(endings.begin(), endings.end(), ending) == endings.end())
                    fail_usage(fmt::format("'{}' is not a name for this output", printable(source.file.string(), 60)),
                               "end its name in " + joined(endings, " or "));
        };
        check_ending(output, {".pdf", ".html", ".svg"});
        check_ending(html, {".html"});
        check_ending(table, {".csv"});
    }

    [[nodiscard]] double memory_needed(double /*input_bytes*/) const override { return 0; }  // objects are read one by one

    void run(Context& context, Report& report) override {
        const Collection objects = read(context);
        options.section_right = style.section_right();
        const std::vector<ObjectResult> results = work(objects);
        std::vector<CatalogueEntry> entries;
        std::size_t resumed = 0, unreadable = 0;
        for (std::size_t i = 0; i < results.size(); ++i) {
            CatalogueEntry& entry = entries.emplace_back();
            resumed += results[i].resumed ? 1 : 0;
            if (results[i].problem.empty()) {
                entry = entry_from_json(results[i].result);
                auto record = record_beside(objects.objects[i], entry.notes);
                entry.provenance.insert(entry.provenance.begin(), record.begin(), record.end());
                continue;
            }
            entry.name = objects.objects[i].name;
            set_problem(entry, results[i].problem, report);
            ++unreadable;
        }
        for (const auto& [name, problem] : objects.left_out) {
            CatalogueEntry& entry = entries.emplace_back();
            entry.name = name;
            set_problem(entry, problem, report);
            ++unreadable;
        }
        report.notes(objects.notes);
        write(entries, context, report);
        report("objects", entries.size())("unreadable", unreadable)("resumed", resumed);
        if (unreadable == entries.size()) report.answer_no();
    }

    static void set_problem(CatalogueEntry& entry, const std::string& problem, Report& report) {
        entry.kind = CatalogueKind::unreadable;
        entry.problem = problem;
        report.note(fmt::format("{} could not be read: {}", printable(entry.name, 80), problem));
    }

    Collection read(Context& context) const {
        Collection result;
        const Path path = collection.path();
        const bool is_mesh = !is_folder(path) && extension(path) != ".json";
        context.record([&] { result = is_mesh ? collection_of_mesh(path) : read_collection(path); });
        for (const CollectionObject& object : result.objects) context.record_input(object.name, object.checksum);
        return result;
    }

    /// The entries, several at a time as far as memory permits.
    [[nodiscard]] std::vector<ObjectResult> work(const Collection& objects) const {
        const Path file = output.sources.front().file;
        const bool keeps = !file.empty() && !is_memory(file);
        const ResultStore store(keeps ? file.parent_path() / (file.stem().string() + ".catalogue") : Path());
        const std::vector<std::string> key{"catalogue 2", options_text(options), options.section_right ? "right" : "left"};
        const auto make_entry = [&](const CollectionObject& object) { return to_json(entry_of(object, options)); };
        std::size_t largest = 0;
        for (const CollectionObject& object : objects.objects)
            largest = std::max(largest, object.mesh.empty() ? std::size_t{0} : size_of_file(object.mesh));
        // A mesh, its search trees and its slices take about sixty times the size of a binary file.
        constexpr double per_byte = 60;
        const double available = memory_limit() - resident_memory();
        if (memory_limit() <= 0 || available > per_byte * double(largest) * threads())
            return for_each_object(objects, store, key, make_entry);
        std::vector<ObjectResult> results;
        for (const CollectionObject& object : objects.objects) {
            Collection single;
            single.objects.push_back(object);
            results.push_back(std::move(for_each_object(single, store, key, make_entry).front()));
        }
        return results;
    }

    void write(const std::vector<CatalogueEntry>& entries, Context& context, Report& report) const {
        const Catalogue catalogue(entries, style, printed_line(context.provenance()));
        const std::string ending = extension(output.sources.front().file);
        if (ending == ".svg" && entries.size() > 1)
            fail_usage(fmt::format("an SVG file holds one page, and there are {} objects", entries.size()),
                       "write .pdf or .html, or name one mesh");
        output.write(ending == ".html" ? catalogue.html() : ending == ".svg" ? catalogue.svg(1) : catalogue.pdf());
        if (html) html.write(catalogue.html());
        if (table) table.write(catalogue_table(entries, catalogue.places()).csv());
        report("pages", catalogue.pages());
        report.empty_table("entries");
        for (std::size_t i = 0; i < entries.size(); ++i) add_row(report, entries[i], catalogue.places()[i]);
    }

    static void add_row(Report& report, const CatalogueEntry& entry, const std::pair<std::size_t, std::string>& place) {
        Report::Row row = report.row("entries");
        row("name", entry.name)("kind", to_string(entry.kind))("page", place.first)("scale", place.second);
        const CatalogueDiameter& diameter = entry.diameter;
        if (!diameter.name.empty()) {
            row("diameterOf", diameter.name)("diameterLow", diameter.low)("diameterHigh", diameter.high)("preserved",
                                                                                                         diameter.share);
            if (diameter.known) row("diameter", diameter.value);
            else row.shown("diameter", "cannot be told");
        }
        row("height", entry.height)("thickness", entry.thickness)("thicknessLow", entry.thickness_low)(
            "thicknessHigh", entry.thickness_high)("capacity", entry.capacity)("volume", entry.volume)("weight", entry.weight);
        row("unknown", entry.unknown);
        if (!entry.problem.empty()) row("problem", entry.problem);
    }

    FileInput collection;
    FileOutput output{".pdf"}, html{".html"}, table{".csv"};
    CatalogueOptions options;
    CatalogueStyle style;
};

}  // namespace

std::unique_ptr<Operation> make_catalogue() { return make<MakeCatalogue>(); }

}  // namespace ostraka

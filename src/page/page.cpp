#include "ostraka/page/page.h"

#include "page/viewer.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/base64.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/markup.h"
#include "ostraka/measure/measure.h"

#include <zlib.h>

namespace ostraka {

namespace {

std::string deflated(std::string_view bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string packed(size, '\0');
    const int status = ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                                   bytes.size(), 6);
    if (status != Z_OK) fail_work("the page", "the data cannot be compressed", "show fewer objects on one page");
    packed.resize(size);
    return packed;
}

}  // namespace

Page::Page(std::string title) {
    document_.SetObject();
    add_members(document_, document_.GetAllocator(), "version", 1, "title", printable(title, 200));
}

std::size_t Page::add_bytes(std::string_view bytes) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8, '\0');
    places_.PushBack(json_value(std::array{bytes_.size(), bytes.size()}, document_.GetAllocator()), document_.GetAllocator());
    bytes_ += bytes;
    return places_.Size() - 1;
}

void Page::add(PageTable table) {
    auto& allocator = document_.GetAllocator();
    JsonValue rows(rapidjson::kArrayType), columns(rapidjson::kArrayType);
    std::vector<int> objects, annotations;
    bool has_objects = false, has_annotations = false;
    std::vector<bool> numeric(table.columns.size(), true);
    for (const PageTable::Row& row : table.rows) {
        for (std::size_t k = 0; k < row.cells.size() && k < numeric.size(); ++k)
            numeric[k] = numeric[k] && (row.cells[k].IsNumber() || row.cells[k].IsNull());
        rows.PushBack(json_list(row.cells, allocator, [](const Json& cell) -> const JsonValue& { return cell; }), allocator);
        objects.push_back(row.object);
        annotations.push_back(row.annotation);
        has_objects = has_objects || row.object >= 0;
        has_annotations = has_annotations || row.annotation >= 0;
    }
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        columns.PushBack(json_object(allocator, "title", table.columns[k], "numeric", static_cast<bool>(numeric[k])), allocator);
    JsonValue entry = json_object(allocator, "name", "table-" + std::to_string(tables_.Size()), "title", table.title, "note",
                                  table.note, "columns", std::move(columns), "rows", std::move(rows));
    if (has_objects) add_members(entry, allocator, "objects", objects);
    if (has_annotations) add_members(entry, allocator, "annotations", annotations);
    tables_.PushBack(entry, allocator);
}

void Page::add_drawing(const std::string& title, const std::string& svg) {
    auto& allocator = document_.GetAllocator();
    drawings_.PushBack(json_object(allocator, "title", printable(title, 200), "blob", add_bytes(svg)), allocator);
}

void Page::note(const std::string& text) {
    notes_.PushBack(json_string(printable(text, 2000), document_.GetAllocator()), document_.GetAllocator());
}

void Page::add(const PageEntry& entry) {
    auto& allocator = document_.GetAllocator();
    entries_.PushBack(json_object(allocator, "name", printable(entry.name, 200), "file", entry.file, "thumbnail", entry.thumbnail,
                                  "vertices", entry.vertices, "faces", entry.faces, "tags", entry.tags),
                      allocator);
}

std::string Page::data(const std::string& provenance_text) const {
    Json document;
    auto& allocator = document.GetAllocator();
    document.CopyFrom(document_, allocator);
    const auto copy = [&](const JsonValue& value) { return JsonValue(value, allocator); };
    add_nonempty_members(document, allocator, "collection", copy(entries_));
    add_members(document, allocator, "notes", copy(notes_), "provenance", provenance_text, "objects", copy(objects_), "tables",
                copy(tables_), "drawings", copy(drawings_), "blobs", copy(places_));
    return with_markup_escaped(to_compact_text(document));
}

std::string Page::html(const std::string& provenance_text) const {
    return viewer_with(data(provenance_text), to_base64(deflated(bytes_)), !entries_.Empty());
}

std::string Page::script(const std::string& file, const std::string& provenance_text) const {
    Json name;
    static_cast<JsonValue&>(name) = json_string(file, name.GetAllocator());
    return "ostrakaObject(" + with_markup_escaped(to_compact_text(name)) + ", " + data(provenance_text) + ", \"" +
           to_base64(deflated(bytes_)) + "\");\n";
}

Page::Content Page::content(const std::string& provenance_text) const { return {data(provenance_text), bytes_}; }

PageTable annotation_table(AnnotatedMeshView annotated, int object, const std::string& name) {
    PageTable table;
    table.title = name;
    table.columns = {"annotation", "id", "type", "elements", "area or length", "unit"};
    const auto cell = [](const auto& value) {
        Json json;
        static_cast<JsonValue&>(json) = json_value(value, json.GetAllocator());
        return json;
    };
    for (std::size_t i = 0; i < annotated.annotations.annotations.size(); ++i) {
        const Annotation& annotation = annotated.annotations.annotations[i];
        PageTable::Row& row = table.rows.emplace_back();
        const bool region = annotation.type == AnnotationType::region, line = annotation.type == AnnotationType::line;
        const auto size = region ? evaluate(annotated.mesh, annotation, "area")
                          : line ? evaluate(annotated.mesh, annotation, "length")
                                 : std::nullopt;
        std::size_t elements = region ? annotation.faces.size() : annotation.points.size();
        for (const auto& polyline : annotation.polylines) elements += polyline.size();
        row.cells.push_back(cell(annotation.tag.empty() ? "annotation " + std::to_string(annotation.id) : annotation.tag));
        row.cells.push_back(cell(annotation.id));
        row.cells.push_back(cell(to_string(annotation.type)));
        row.cells.push_back(cell(elements));
        row.cells.push_back(cell(size));
        row.cells.push_back(cell(size ? descriptor_unit(region ? "area" : "length", annotated.annotations.unit) : std::string()));
        row.object = object;
        row.annotation = static_cast<int>(i);
    }
    return table;
}

}  // namespace ostraka

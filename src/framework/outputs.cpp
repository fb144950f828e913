#include "framework/polygons.h"

#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/framework/inputs.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/render/values.h"

#include <fmt/core.h>
#include <unistd.h>

#include <stdexcept>

namespace ostraka {

namespace {

/// Inserts `ending` before the extension of the file name.
Path with_suffix(const Path& file, const std::string& ending) {
    return ending.empty() ? file : file.parent_path() / (file.stem().string() + ending + file.extension().string());
}

bool goes_to_file(const Slot& slot) { return !slot.sources.empty() && !slot.sources.front().file.empty(); }

/// Writes `data` to the slot's file with `write(file, data)`, or keeps it in memory together with `write`. `ending`: inserted
/// before the extension for one of several parts.
template <class T, class Write>
void write_or_keep(const Slot& slot, T data, Write write, const std::string& ending = {}) {
    auto& sources = const_cast<std::vector<Source>&>(slot.sources);
    if (sources.empty()) throw std::logic_error(fmt::format("output {} was not requested", slot.name));
    if (goes_to_file(slot)) {
        const Path file = with_suffix(sources.front().file, ending);
        slot.context->check_output(file);
        write(file, data);
        return;
    }
    if (!ending.empty() && sources.back().object) sources.emplace_back();
    Source& source = sources.back();
    const auto shared_data = std::make_shared<const T>(std::move(data));
    Object object(shared_data, (source.object.name.empty() ? slot.name : source.object.name) + ending);
    object.write = [shared_data, write = std::move(write)](const Path& file) { write(file, *shared_data); };
    source.object = std::move(object);
}

/// Throws if the nearest existing ancestor of the folder is not a folder.
void check_can_be_created(const Path& folder) {
    std::error_code code;
    Path ancestor = std::filesystem::absolute(folder, code);
    while (ancestor.has_relative_path() && !std::filesystem::exists(ancestor, code)) ancestor = ancestor.parent_path();
    if (!is_folder(ancestor))
        throw Error(ErrorKind::failure, folder.string(),
                    fmt::format("the folder cannot be created: '{}' is not a folder", ancestor.string()), "name another one");
}

}  // namespace

void MeshOutput::declare_options(OptionList& options) {
    if (encoded_) options("ascii", ascii_, "write PLY and STL as text");
}

void MeshOutput::check() const {
    for (const Source& source : sources)
        if (!source.file.empty()) check_mesh_extension(source.file);
}

void MeshOutput::write(Mesh mesh, MeshExtras extras, WriteOptions options) const {
    keep(std::move(mesh), std::move(extras), std::move(options), {});
}

void MeshOutput::write_part(const std::string& suffix, Mesh mesh, MeshExtras extras) const {
    keep(std::move(mesh), std::move(extras), {}, suffix);
}

std::string MeshOutput::part_file(const std::string& suffix) const {
    return file().empty() ? std::string() : with_suffix(file(), suffix).string();
}

void MeshOutput::keep(Mesh mesh, MeshExtras extras, WriteOptions options, const std::string& ending) const {
    // Make the mesh in memory equal to the one read back from its file, with the same order of edge traversal.
    if (!goes_to_file(*this)) mesh = build_mesh(to_soup(mesh));
    options = written(std::move(options));
    write_or_keep(
        *this, MeshFile{std::move(mesh), std::move(extras), {}, {}},
        [options, context = goes_to_file(*this) ? context : nullptr](const Path& path, const MeshFile& file) {
            const auto notes = write_mesh(path, file.mesh, file.extras, options);
            if (context != nullptr) context->notes({}, notes);
        },
        ending);
}

WriteOptions MeshOutput::written(WriteOptions options) const {
    if (ascii_) options.encoding = Encoding::ascii;
    options.comment = context->provenance().to_line();
    return options;
}

void MeshOutput::write(TriangleSoup soup, MeshExtras extras, WriteOptions options) const {
    PolygonSoup polygons = as_polygons(soup, extras);
    write_or_keep(*this, std::move(polygons),
                  [soup = std::move(soup), extras = std::move(extras), options = written(std::move(options)),
                   context = goes_to_file(*this) ? context : nullptr](const Path& path, const PolygonSoup&) {
                      const auto notes = write_triangles(path, soup, extras, options);
                      if (context != nullptr) context->notes({}, notes);
                  });
}

void AnnotationsOutput::write(AnnotationSet set, const Mesh& mesh, const std::string& mesh_name,
                              const std::optional<Provenance>& provenance_override) const {
    const Provenance provenance = provenance_override ? *provenance_override : context->provenance();
    if (goes_to_file(*this)) {  // avoids a copy of the mesh
        context->check_output(sources.front().file);
        write_annotations(sources.front().file, {mesh, set}, mesh_name, provenance);
        return;
    }
    set.provenance.CopyFrom(provenance.to_json(set.provenance.GetAllocator()), set.provenance.GetAllocator());  // as if read
    write_or_keep(*this, std::move(set), [mesh, mesh_name, provenance](const Path& path, const AnnotationSet& value) {
        write_annotations(path, {mesh, value}, mesh_name, provenance);
    });
}

void TemplateOutput::write(Template package) const {
    write_or_keep(*this, std::move(package),
                  [to_file = goes_to_file(*this), provenance = context->provenance()](const Path& path, const Template& value) {
                      if (to_file) write_json(path, template_to_json(value.file, provenance));
                      else static_cast<void>(copy_template(value.file, path.parent_path(), path.filename().string(), provenance));
                  });
}

void GraphOutput::write(RelationGraph graph, const AnnotationSet& set) const {
    write_or_keep(*this, std::move(graph),
                  [set, provenance = context->provenance()](const Path& path, const RelationGraph& value) {
                      write_graph(path, value, set, provenance);
                  });
}

void CoordinatesOutput::check() const {
    for (const Source& source : sources)
        if (!source.file.empty() && extension(source.file) != ".npy")
            throw Error(ErrorKind::usage, source.file.string(), "is not the name of a NumPy array", "end its name in .npy");
}

void CoordinatesOutput::write(Coordinates coordinates, const Mesh& mesh, const Mesh& cage,
                              const CoordinateCertificate& certificate) const {
    write_or_keep(*this, std::move(coordinates),
                  [mesh, cage, certificate, provenance = context->provenance()](const Path& path, const Coordinates& value) {
                      write_coordinates(path, value, mesh, cage, certificate, provenance);
                  });
}

void ValuesOutput::write(std::vector<double> values) const { write_or_keep(*this, std::move(values), write_values); }

namespace {
/// A copy of the document; if it is an object, the provenance is appended as its last member.
Json signed_document(const JsonValue& value, const Context& context) {
    Json document;
    auto& allocator = document.GetAllocator();
    document.CopyFrom(value, allocator);
    if (document.IsObject() && find_member(document, "provenance") == nullptr)
        add_members(document, allocator, "provenance", context.provenance().to_json(allocator));
    return document;
}
}  // namespace

void JsonOutput::write(const JsonValue& value) const { write_or_keep(*this, signed_document(value, *context), write_json); }

Json to_json(const IndexMap& map) {
    Json document = json_document("map");
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "kind", map.kind);
    if (!map.description.empty()) add_members(document, allocator, "description", map.description);
    add_members(document, allocator, "from", map.map.size(), "to", map.to);
    if (map.nearest) add_members(document, allocator, "method", "nearest");
    JsonValue index_list(rapidjson::kArrayType);
    index_list.Reserve(static_cast<rapidjson::SizeType>(map.map.size()), allocator);
    for (const Index i : map.map) index_list.PushBack(i == no_index ? std::int64_t{-1} : static_cast<std::int64_t>(i), allocator);
    add_members(document, allocator, "map", std::move(index_list));
    return document;
}

void IndexMapOutput::write(IndexMap map) const {
    Json document = to_json(map);
    add_members(document, document.GetAllocator(), "provenance", context->provenance().to_json(document.GetAllocator()));
    validate(document, "map", name);
    const auto shared_document = std::make_shared<const Json>(std::move(document));
    write_or_keep(*this, std::move(map),
                  [shared_document](const Path& path, const IndexMap&) { write_json(path, *shared_document); });
}

Path FileOutput::path() const {
    const Source& source = sources.at(0);
    if (!source.file.empty()) {
        context->check_output(source.file);
        return source.file;
    }
    if (memory_.empty()) {
        const std::string object_name = Path(source.object.name).filename().string();
        memory_ = context->memory(object_name.empty() ? name + extension_ : object_name);
    }
    return memory_;
}

void FileOutput::finish() {
    if (!memory_.empty() && file_exists(memory_))
        sources.front().object = Object::of(read_file(memory_), memory_.filename().string());
}

Path FolderOutput::path() const {
    const auto opened = opened_.find(0);
    return opened == opened_.end() ? sources.at(0).file : opened->second;
}

void FolderOutput::check() const {
    for (std::size_t i = 0; i < sources.size(); ++i) check_folder(i);
}

void FolderOutput::check_folder(std::size_t i) const {
    const Path& folder = sources[i].file;
    if (!is_memory(folder) && !folder.empty() && std::filesystem::exists(folder) && !is_folder(folder))
        fail_usage(fmt::format("{}{} '{}' is a file", is_positional ? "" : "--", name, folder.string()),
                   "name a folder; it is created if missing");
    if (!is_memory(folder) && !folder.empty()) check_can_be_created(folder);
}

const Path& FolderOutput::open(std::size_t i, bool replaces) const {
    if (const auto opened = opened_.find(i); opened != opened_.end()) return opened->second;
    const Path folder = sources.at(i).file.empty() ? context->memory(name) : sources.at(i).file;
    make_folder(folder);
    if (!is_memory(folder)) {
        // Check now, not when the first object is written hours later.
        if (::access(folder.c_str(), W_OK | X_OK) != 0)
            throw Error(ErrorKind::failure, folder.string(), "the folder cannot be written to",
                        "check its permissions, or name another");
        remove_stale_temporaries(folder);
    }
    std::string owner = context->provenance().command;
    for (char& c : owner)
        if (c == ' ') c = '-';
    if (replaces) replace_outputs(folder, owner);
    return opened_[i] = folder;
}

Path FolderOutput::in(const std::string& file, std::size_t i) const {
    Path path = open(i) / file;
    require_writable_inside(path, open(i));  // the folder may contain links that others placed there
    context->check_output(path);
    return path;
}

void FolderOutput::write(const std::string& file_in_folder, const Mesh& mesh, const MeshExtras& extras,
                         WriteOptions options) const {
    options.comment = context->provenance().to_line();
    context->notes({}, write_mesh(in(file_in_folder), mesh, extras, options));
}
void FolderOutput::write(const std::string& file_in_folder, AnnotatedMeshView object, const std::string& mesh_name) const {
    write_annotations(in(file_in_folder), object, mesh_name, context->provenance());
}
void FolderOutput::write(const std::string& file_in_folder, const JsonValue& document) const {
    write_json(in(file_in_folder), signed_document(document, *context));
}

void FolderOutput::finish() {
    for (const auto& [i, folder] : opened_)
        if (is_memory(folder)) sources[i].object = Object::of(folder, folder.string());
}

}  // namespace ostraka

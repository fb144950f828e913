#include "framework/polygons.h"

#include "ostraka/files/json_build.h"
#include "ostraka/framework/input_path.h"
#include "ostraka/framework/inputs.h"
#include "ostraka/framework/object_files.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/point_cloud/point_cloud.h"
#include "ostraka/render/values.h"

namespace ostraka {

namespace {

/// Path of an in-memory file or folder that holds the object.
Path in_memory(Context& context, const Object& object, const std::string& slot) {
    if (const auto folder = object.as<Path>()) return *folder;
    Path path = context.memory(object.name.empty() ? slot : Path(object.name).filename().string());
    OutputTransaction transaction;  // read before the outputs of the call are committed
    write_object(object, path, slot);
    transaction.commit();
    return path;
}

/// Records the checksum `sum()` for an object that has neither a checksum nor a file form.
void record_checksum(const Slot& slot, std::size_t i, const std::function<std::string()>& sum) {
    const Object& object = slot.sources[i].object;
    if (object.sha256.empty() && !object.write) slot.context->record_object(slot, i, sum());
}

/// The i-th object of a slot. A file is read with `read`. An object in memory is used directly if it is a T, after `check`, and
/// its checksum is `sum`; otherwise it is converted by `convert` if possible, or written to an in-memory file and read from
/// there.
template <class T, class Read, class Sum>
const T& loaded(const Slot& slot, std::size_t i, const std::string& key, const Read& read, const Sum& sum,
                const std::function<std::optional<T>(const Object&)>& convert = {},
                const std::function<void(const T&)>& check = {}) {
    const Object& object = slot.sources.at(i).object;
    return *std::static_pointer_cast<const T>(
        slot.context->load(slot, i, typeid(T), key, [&](const Path& file) -> std::shared_ptr<const void> {
            if (auto data = object.as<T>()) {
                if (check) check(*data);
                record_checksum(slot, i, [&] { return sum(*data); });
                return data;
            }
            if (auto converted = object && convert ? convert(object) : std::nullopt)
                return std::make_shared<const T>(std::move(*converted));
            return std::make_shared<const T>(read(object ? in_memory(*slot.context, object, slot.name) : file));
        }));
}

/// Throws: provenance requires the checksum of every input.
[[noreturn]] std::string unknown_checksum(const Slot& slot) {
    throw Error(ErrorKind::usage, slot.name, "is given as an object without a checksum",
                "set its checksum (Object::sha256), or give a file or its bytes");
}

/// Key for an object that depends on another object in memory.
std::string address(const void* object) { return std::to_string(reinterpret_cast<std::uintptr_t>(object)); }

/// Returns a copy, or moves the object if nothing else holds it.
template <class T>
T copy_or_move(const Slot& slot, std::size_t i, const T& object) {
    if (slot.context->keep_objects || slot.sources.at(i).object) return object;
    return std::move(const_cast<T&>(object));
}

}  // namespace

std::vector<std::string> extensions_of(Kind kind) {
    const auto point_cloud_files = [] {
        std::vector<std::string> endings = point_cloud_endings();
        endings.insert(endings.end(), {".ply", ".obj", ".off"});
        return endings;
    };
    static const std::map<Kind, std::vector<std::string>> endings{
        {Kind::mesh, {".ply", ".obj", ".off", ".stl", ".glb", ".gltf", ".3mf", ".mesh", ".vtu"}},
        {Kind::cage, {".ply", ".obj", ".off", ".stl", ".glb", ".gltf", ".3mf"}},
        {Kind::annotations, {".ant.json", ".ant"}},
        {Kind::graph, {".graph.json"}},
        {Kind::edit, {".edit.json", ".json"}},
        {Kind::recipe, {".recipe.json"}},
        {Kind::rules, {".rules.json"}},
        {Kind::template_package, {".template.json"}},
        {Kind::vocabulary, {".vocabulary.json", ".ttl", ".rdf"}},
        {Kind::shape_class, {".class.json"}},
        {Kind::assembly, {".assembly.json"}},
        {Kind::study, {".study.json"}},
        {Kind::coordinates, {".npy"}},
        {Kind::point_cloud, point_cloud_files()},
    };
    const auto entry = endings.find(kind);
    return entry == endings.end() ? std::vector<std::string>() : entry->second;
}

std::string to_string(Kind kind) {
    static constexpr const char* names[]{
        "mesh",   "annotations", "graph",    "cage",       "coordinates", "values",    "labels",     "index map", "edit",
        "recipe", "rules",       "template", "vocabulary", "class",       "landmarks", "assembly",   "pose",      "collection",
        "study",  "picture",     "table",    "report",     "text",        "folder",    "point cloud"};
    return names[static_cast<std::size_t>(kind)];
}

Slot::~Slot() = default;

bool Slot::exists(std::size_t i) const { return i < size() && (sources[i].object || file_exists(sources[i].file)); }

void write_object(const Object& object, const Path& file, const std::string& slot) {
    if (object.write) return object.write(file);
    if (const auto bytes = object.as<std::string>()) return write_file(file, *bytes);
    if (const auto document = object.as<Json>()) return write_json(file, *document);
    const auto folder = object.as<Path>();
    if (!folder)
        throw Error(ErrorKind::usage, slot, "is given as an object that cannot be read as a file", "give a file, or its bytes");
    make_folder(file);
    for (const std::string& name : files_in(*folder)) write_file(file / name, read_file(*folder / name));
}

const MeshFile& MeshInput::get(std::size_t i) const {
    const auto convert = [&](const Object& object) -> std::optional<MeshFile> {
        const auto mesh = object.as<Mesh>();
        const auto soup = object.as<PolygonSoup>();
        if (!mesh && !soup) return {};
        MeshFile file = mesh ? MeshFile{*mesh, {}, {}, {}} : mesh_of_polygons(*soup, object.name);
        record_checksum(*this, i, [&] { return mesh_checksum(file.mesh); });
        return file;
    };
    // With a cache, the file is read once for both its polygons and its mesh.
    const auto read = [&](const Path& path) {
        return context->keep_objects && !sources.at(i).object ? mesh_of_polygons(polygons(i), path.string()) : read_mesh(path);
    };
    const auto& file = loaded<MeshFile>(
        *this, i, "", read, [](const MeshFile& mesh_file) { return mesh_checksum(mesh_file.mesh); }, convert);
    context->notes(size() > 1 || role != Role::input ? sources[i].name() : std::string(), file.notes);
    return file;
}

MeshFile MeshInput::take(std::size_t i) const { return copy_or_move(*this, i, get(i)); }

const PolygonSoup& MeshInput::polygons(std::size_t i) const {
    const auto convert = [&](const Object& object) -> std::optional<PolygonSoup> {
        const auto file = object.as<MeshFile>();
        const auto mesh = object.as<Mesh>();
        if (!file && !mesh) return {};
        record_checksum(*this, i, [&] { return mesh_checksum(file ? file->mesh : *mesh); });
        return as_polygons(to_soup(file ? file->mesh : *mesh), file ? file->extras : MeshExtras());
    };
    const auto sum = [](const PolygonSoup& soup) {
        const auto bytes = [](const auto& array) {
            return std::string_view(reinterpret_cast<const char*>(array.data()), array.size() * sizeof(array[0]));
        };
        return sha256(sha256(bytes(soup.points)) + sha256(bytes(soup.polygon_begin)) + sha256(bytes(soup.corners)));
    };
    return loaded<PolygonSoup>(*this, i, "", read_polygons, sum, convert);
}

PolygonSoup MeshInput::take_polygons(std::size_t i) const { return copy_or_move(*this, i, polygons(i)); }

void Slot::declare_shared(OptionList& options, const OptionList& slot_options) {
    for (const Option& option : slot_options)
        if (const Option* operation_option = options.find(option.name))
            shared_.emplace_back(operation_option->value, option.value);
        else options(option.name, option.value, option.help, option.rule, option.unit);
}

void Slot::take_shared() const {
    for (const auto& [operation_option, slot_option] : shared_)
        std::visit(
            [](auto& source, auto& target) {
                if constexpr (std::same_as<decltype(source), decltype(target)> && requires { *target = *source; })
                    *target = *source;
            },
            operation_option.place, slot_option.place);
}

void AnnotationsInput::declare_options(OptionList& options) { declare_shared(options, options_of(reading)); }

std::string checksum_of(AnnotatedMeshView object) { return sha256(to_text(annotations_to_json(object, "", {}))); }

const AnnotationSet& AnnotationsInput::on(const Mesh& mesh, std::size_t i) const {
    take_shared();
    const Object& object = sources.at(i).object;
    const std::string key =
        context->keep_objects && !object ? mesh_checksum(mesh) + (reading.force_mesh ? " forced" : "") : address(&mesh);
    const auto& set = loaded<AnnotationSet>(
        *this, i, key, [&](const Path& path) { return read_annotations(path, mesh, reading); },
        [&](const AnnotationSet& annotations) {
            return checksum_of({mesh, annotations});
        },
        {},
        [&](const AnnotationSet& annotations) {
            check_annotations({mesh, annotations}, object.name);
        });
    context->notes(size() > 1 ? sources[i].name() : std::string(), set.notes);
    return set;
}

const RelationGraph& GraphInput::on(const AnnotationSet& set) const {
    return loaded<RelationGraph>(
        *this, 0, address(&set), [&](const Path& path) { return read_graph(path, set); },
        [](const RelationGraph& graph) { return sha256(to_text(graph_to_json(graph, {}))); });
}

const Coordinates& CoordinatesInput::of(const Mesh& mesh, const Mesh& cage) const {
    return loaded<Coordinates>(
        *this, 0, address(&mesh), [&](const Path& path) { return read_coordinates(path, mesh, cage); },
        [&](const Coordinates&) { return unknown_checksum(*this); });
}

const std::vector<double>& ValuesInput::get(std::size_t i) const {
    return loaded<std::vector<double>>(*this, i, "", read_values, [](const std::vector<double>& values) {
        return sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
    });
}

const Json& JsonInput::operator*() const {
    return loaded<Json>(*this, 0, "", read_json, [](const Json& document) { return sha256(to_text(document)); });
}

void TemplateInput::declare_options(OptionList& operation_options) { declare_shared(operation_options, options_of(options)); }

const Template& TemplateInput::operator*() const {
    take_shared();
    return loaded<Template>(
        *this, 0, options_text(options), [&](const Path& path) { return load_template(read_template(path, options), options); },
        [&](const Template&) { return unknown_checksum(*this); });
}

Path path_of(const Slot& slot, std::size_t i) {
    const Source& source = slot.sources.at(i);
    if (!source.object) return source.file;
    Path file = in_memory(*slot.context, source.object, slot.name);
    if (source.object.sha256.empty() && file_exists(file)) slot.context->record_object(slot, i, sha256_of_file(file));
    return file;
}

Path FileInput::path(std::size_t i) const { return path_of(*this, i); }

std::shared_ptr<const AnnotationSet> FileInput::annotations_on(const Mesh& mesh) const {
    auto set = sources.at(0).object.as<AnnotationSet>();
    if (set) record_checksum(*this, 0, [&] { return checksum_of({mesh, *set}); });
    return set;
}

void FileInput::check_checksum(std::size_t i) const {
    if (context->checksum_of_object(*this, i).empty()) unknown_checksum(*this);
}

std::shared_ptr<const void> FileInput::load_any(std::type_index type, std::size_t i, const std::string& key,
                                                const ReadAny& read) const {
    return context->load(*this, i, type, key, [&](const Path& file) { return read(sources.at(i).object ? path(i) : file); });
}

}  // namespace ostraka

#include "ostraka/operation/objects.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/operation/operation.h"
#include "ostraka/render/values.h"

#include <unistd.h>

#include <stdexcept>

namespace ostraka {

namespace {

/// As a soup of polygons: a mesh in memory where one is asked for.
PolygonSoup polygons_of(const MeshFile& file) {
    PolygonSoup soup;
    TriangleSoup triangles = to_soup(file.mesh);
    soup.points = std::move(triangles.points);
    for (const auto& triangle : triangles.triangles) {
        soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
        soup.polygon_begin.push_back(static_cast<Index>(soup.corners.size()));
    }
    soup.extras = file.extras;
    return soup;
}

MeshFile mesh_of(PolygonSoup soup) {
    TriangulatedSoup triangles = triangulate(std::move(soup));
    return {build_mesh(triangles.soup), std::move(triangles.extras), std::move(triangles.triangle_polygon),
            std::move(triangles.notes)};
}

/// Of an object in memory that another operation made, or that is bytes or a folder.
Path in_memory(Context& context, const Object& object, const std::string& slot) {
    if (const auto folder = object.as<Path>()) return *folder;
    const Path path = context.memory(object.name.empty() ? slot : Path(object.name).filename().string());
    OutputTransaction own;  // it is read before the outputs of the call are complete
    if (object.write) object.write(path);
    else if (const auto bytes = object.as<std::string>()) write_file(path, *bytes);
    else if (const auto document = object.as<Json>()) write_json(path, *document);
    else throw Error(ErrorKind::usage, slot, "is given as an object that cannot be read as a file", "give a file, or its bytes");
    own.commit();
    return path;
}

/// What a slot keeps in memory, written on demand.
Object made(std::shared_ptr<const void> keep, std::function<void(const Path&)> write, Object object) {
    object.write = [keep = std::move(keep), write = std::move(write)](const Path& file) { write(file); };
    return object;
}

template <class T>
[[noreturn]] void wrong_type(const Slot& slot) {
    throw Error(ErrorKind::usage, slot.name, "is given as an object of another type", "give a " + to_string(slot.kind));
}

/// The name with this before its extension.
Path with_ending(const Path& file, const std::string& ending) {
    return ending.empty() ? file : file.parent_path() / (file.stem().string() + ending + file.extension().string());
}

/// Puts the object in the slot, or writes its file. `ending`: of one of several, before the extension.
void put(const Slot& slot, Object object, const std::string& ending = {}) {
    auto& sources = const_cast<std::vector<Source>&>(slot.sources);
    if (sources.empty()) throw std::logic_error("output " + slot.name + " was not asked for");
    if (const Path file = with_ending(sources.front().file, ending); !sources.front().file.empty()) {
        slot.context->check_output(file);
        object.write(file);
        return;
    }
    if (!ending.empty() && sources.back().object) sources.emplace_back();
    Source& source = sources.back();
    object.name = (source.object.name.empty() ? slot.name : source.object.name) + ending;
    source.object = std::move(object);
}

/// What the folder would lie in is no file.
void check_can_be_made(const Path& folder) {
    std::error_code code;
    Path known = std::filesystem::absolute(folder, code);
    while (known.has_relative_path() && !std::filesystem::exists(known, code)) known = known.parent_path();
    if (!is_folder(known))
        throw Error(ErrorKind::failure, folder.string(), "the folder cannot be made: '" + known.string() + "' is no folder",
                    "name another one");
}

}  // namespace

std::string to_string(Kind kind) {
    static constexpr const char* names[]{"mesh",       "annotations", "graph",     "cage",     "coordinates", "values",
                                         "labels",     "index map",   "edit",      "recipe",   "rules",       "template",
                                         "vocabulary", "class",       "landmarks", "assembly", "pose",        "collection",
                                         "picture",    "table",       "report",    "text",     "folder"};
    return names[static_cast<std::size_t>(kind)];
}

Slot::~Slot() = default;

bool Slot::exists(std::size_t i) const { return i < size() && (sources[i].object || file_exists(sources[i].file)); }

const MeshFile& MeshInput::get(std::size_t i) const {
    const auto data = context->load(*this, i, typeid(MeshFile), "", [&](const Path& path) -> std::shared_ptr<const void> {
        const Object& object = sources[i].object;
        if (!object) return std::make_shared<const MeshFile>(read_mesh(path));
        if (const auto file = object.as<MeshFile>()) {
            if (object.sha256.empty() && !object.write) context->record_object(*this, i, mesh_checksum(file->mesh));
            return file;
        }
        if (const auto mesh = object.as<Mesh>()) {
            context->record_object(*this, i, mesh_checksum(*mesh));
            return std::make_shared<const MeshFile>(MeshFile{*mesh, {}, {}, {}});
        }
        if (const auto soup = object.as<PolygonSoup>()) {
            auto file = std::make_shared<const MeshFile>(in_file(object.name, [&] { return mesh_of(*soup); }));
            context->record_object(*this, i, mesh_checksum(file->mesh));
            return file;
        }
        return std::make_shared<const MeshFile>(read_mesh(in_memory(*context, object, name)));
    });
    const auto& file = *static_cast<const MeshFile*>(data.get());
    context->notes(size() > 1 || role != Role::input ? sources[i].name() : std::string(), file.notes);
    return file;
}

MeshFile MeshInput::take(std::size_t i) const {
    const MeshFile& file = get(i);
    if (context->keep_objects || sources.at(i).object) return file;
    return std::move(const_cast<MeshFile&>(file));
}

const PolygonSoup& MeshInput::polygons(std::size_t i) const {
    const auto data = context->load(*this, i, typeid(PolygonSoup), "", [&](const Path& path) -> std::shared_ptr<const void> {
        const Object& object = sources[i].object;
        if (!object) return std::make_shared<const PolygonSoup>(read_polygons(path));
        if (auto soup = object.as<PolygonSoup>()) return soup;
        if (const auto file = object.as<MeshFile>()) return std::make_shared<const PolygonSoup>(polygons_of(*file));
        if (const auto mesh = object.as<Mesh>())
            return std::make_shared<const PolygonSoup>(polygons_of(MeshFile{*mesh, {}, {}, {}}));
        return std::make_shared<const PolygonSoup>(read_polygons(in_memory(*context, object, name)));
    });
    return *static_cast<const PolygonSoup*>(data.get());
}

PolygonSoup MeshInput::take_polygons(std::size_t i) const {
    const PolygonSoup& soup = polygons(i);
    if (context->keep_objects || sources.at(i).object) return soup;
    return std::move(const_cast<PolygonSoup&>(soup));
}

void AnnotationsInput::describe(OptionList& options) {
    if (const Option* known = options.find("force-mesh")) shared_ = std::get<bool*>(known->value.place);
    else reading.describe(options);
}

const AnnotationSet& AnnotationsInput::on(const Mesh& mesh, std::size_t i) const {
    ReadAnnotationsOptions how = reading;
    if (shared_ != nullptr) how.force_mesh = *shared_;
    const Object& object = sources.at(i).object;
    const std::string key = context->keep_objects && !object ? mesh_checksum(mesh) + (how.force_mesh ? " forced" : "")
                                                             : std::to_string(reinterpret_cast<std::uintptr_t>(&mesh));
    const auto data = context->load(*this, i, typeid(AnnotationSet), key, [&](const Path& path) -> std::shared_ptr<const void> {
        if (!object) return std::make_shared<const AnnotationSet>(read_annotations(path, mesh, how));
        if (auto set = object.as<AnnotationSet>()) {
            check_annotations(*set, mesh, object.name);
            if (object.sha256.empty() && !object.write)
                context->record_object(*this, i, sha256(to_text(annotations_to_json(*set, mesh, "", {}))));
            return set;
        }
        return std::make_shared<const AnnotationSet>(read_annotations(in_memory(*context, object, name), mesh, how));
    });
    const auto& set = *static_cast<const AnnotationSet*>(data.get());
    context->notes(size() > 1 ? sources[i].name() : std::string(), set.notes);
    return set;
}

const RelationGraph& GraphInput::on(const AnnotationSet& set) const {
    const Object& object = sources.at(0).object;
    const std::string key = std::to_string(reinterpret_cast<std::uintptr_t>(&set));
    return *std::static_pointer_cast<const RelationGraph>(
        context->load(*this, 0, typeid(RelationGraph), key, [&](const Path& path) -> std::shared_ptr<const void> {
            if (!object) return std::make_shared<const RelationGraph>(read_graph(path, set));
            if (auto graph = object.as<RelationGraph>()) {
                if (object.sha256.empty() && !object.write)
                    context->record_object(*this, 0, sha256(to_text(graph_to_json(*graph, {}))));
                return graph;
            }
            return std::make_shared<const RelationGraph>(read_graph(in_memory(*context, object, name), set));
        }));
}

const Coordinates& CoordinatesInput::of(const Mesh& mesh, const Mesh& cage) const {
    const Object& object = sources.at(0).object;
    const std::string key = std::to_string(reinterpret_cast<std::uintptr_t>(&mesh));
    return *std::static_pointer_cast<const Coordinates>(
        context->load(*this, 0, typeid(Coordinates), key, [&](const Path& path) -> std::shared_ptr<const void> {
            if (!object) return std::make_shared<const Coordinates>(read_coordinates(path, mesh, cage));
            if (auto coordinates = object.as<Coordinates>()) return coordinates;
            wrong_type<Coordinates>(*this);
        }));
}

const std::vector<double>& ValuesInput::get(std::size_t i) const {
    using Values = std::vector<double>;
    const Object& object = sources.at(i).object;
    return *std::static_pointer_cast<const Values>(
        context->load(*this, i, typeid(Values), "", [&](const Path& path) -> std::shared_ptr<const void> {
            if (!object) return std::make_shared<const Values>(read_values(path));
            if (auto values = object.as<Values>()) {
                if (object.sha256.empty() && !object.write)
                    context->record_object(
                        *this, i, sha256({reinterpret_cast<const char*>(values->data()), values->size() * sizeof(double)}));
                return values;
            }
            return std::make_shared<const Values>(read_values(in_memory(*context, object, name)));
        }));
}

const Json& JsonInput::operator*() const {
    const Object& object = sources.at(0).object;
    return *std::static_pointer_cast<const Json>(
        context->load(*this, 0, typeid(Json), "", [&](const Path& path) -> std::shared_ptr<const void> {
            const auto keep = [](Json document) { return std::make_shared<const Json>(std::move(document)); };
            if (!object) return keep(read_json(path));
            if (auto document = object.as<Json>()) {
                if (object.sha256.empty() && !object.write) context->record_object(*this, 0, sha256(to_text(*document)));
                return document;
            }
            return keep(read_json(in_memory(*context, object, name)));
        }));
}

void TemplateInput::describe(OptionList& list) {
    OptionList own;
    options.describe(own);
    for (const Option& option : own)
        if (list.find(option.name) == nullptr) list(option.name, option.value, option.help, option.rule, option.unit);
}

const Template& TemplateInput::operator*() const {
    const Object& object = sources.at(0).object;
    return *std::static_pointer_cast<const Template>(
        context->load(*this, 0, typeid(Template), options_text(options), [&](const Path& path) -> std::shared_ptr<const void> {
            if (auto known = object.as<Template>()) return known;
            const Path file = object ? in_memory(*context, object, name) : path;
            return std::make_shared<const Template>(load_template(read_template(file, options), options));
        }));
}

Path FileInput::path(std::size_t i) const {
    const Source& source = sources.at(i);
    if (!source.object) return source.file;
    const Path file = in_memory(*context, source.object, name);
    if (source.object.sha256.empty() && file_exists(file)) context->record_object(*this, i, sha256_of_file(file));
    return file;
}

std::shared_ptr<const void> FileInput::load_any(std::type_index type, std::size_t i, const std::string& key,
                                                const ReadAny& read) const {
    return context->load(*this, i, type, key, [&](const Path& file) { return read(sources.at(i).object ? path(i) : file); });
}

void MeshOutput::describe(OptionList& options) {
    if (encoded_) options("ascii", ascii_, "write PLY and STL as text");
}

void MeshOutput::check() const {
    for (const Source& source : sources)
        if (!source.file.empty()) check_mesh_extension(source.file);
}

void MeshOutput::write(Mesh mesh, MeshExtras extras, WriteOptions options) const {
    keep(std::move(mesh), std::move(extras), std::move(options), {});
}

void MeshOutput::write_part(const std::string& ending, Mesh mesh, MeshExtras extras) const {
    keep(std::move(mesh), std::move(extras), {}, ending);
}

std::string MeshOutput::part_file(const std::string& ending) const {
    return file().empty() ? std::string() : with_ending(file(), ending).string();
}

void MeshOutput::keep(Mesh mesh, MeshExtras extras, WriteOptions options, const std::string& ending) const {
    if (ascii_) options.encoding = Encoding::ascii;
    options.comment = context->provenance().to_line();
    // In memory it is as its file would be read: loops over edges go the same way.
    if (sources.empty() || sources.front().file.empty()) mesh = build_mesh(to_soup(mesh));
    const auto file = std::make_shared<const MeshFile>(MeshFile{std::move(mesh), std::move(extras), {}, {}});
    const bool to_file = !sources.empty() && !sources.front().file.empty();
    put(*this,
        made(
            file,
            [file = file.get(), options, context = to_file ? context : nullptr](const Path& path) {
                const auto notes = write_mesh(path, file->mesh, file->extras, options);
                if (context != nullptr) context->notes({}, notes);
            },
            Object(file)),
        ending);
}

void MeshOutput::write(TriangleSoup soup, MeshExtras extras, WriteOptions options) const {
    if (ascii_) options.encoding = Encoding::ascii;
    options.comment = context->provenance().to_line();
    PolygonSoup polygons;
    polygons.points = soup.points;
    for (const auto& triangle : soup.triangles) {
        polygons.corners.insert(polygons.corners.end(), triangle.begin(), triangle.end());
        polygons.polygon_begin.push_back(static_cast<Index>(polygons.corners.size()));
    }
    polygons.extras = extras;
    const bool to_file = !sources.empty() && !sources.front().file.empty();
    put(*this, made(
                   nullptr,
                   [soup = std::move(soup), extras = std::move(extras), options,
                    context = to_file ? context : nullptr](const Path& path) {
                       const auto notes = write_triangles(path, soup, extras, options);
                       if (context != nullptr) context->notes({}, notes);
                   },
                   Object::of(std::move(polygons))));
}

void AnnotationsOutput::write(AnnotationSet set, const Mesh& mesh, const std::string& mesh_name,
                              const std::optional<Provenance>& own) const {
    const Provenance provenance = own ? *own : context->provenance();
    if (!sources.empty() && !sources.front().file.empty()) {  // no copy of the mesh
        context->check_output(sources.front().file);
        write_annotations(sources.front().file, set, mesh, mesh_name, provenance);
        return;
    }
    set.provenance.CopyFrom(provenance.to_json(set.provenance.GetAllocator()), set.provenance.GetAllocator());  // as if read
    const auto kept = std::make_shared<const AnnotationSet>(std::move(set));
    put(*this, made(
                   kept,
                   [set = kept.get(), mesh, mesh_name, provenance](const Path& path) {
                       write_annotations(path, *set, mesh, mesh_name, provenance);
                   },
                   Object(kept)));
}

void TemplateOutput::write(Template known) const {
    const bool to_file = !sources.empty() && !sources.front().file.empty();
    const auto kept = std::make_shared<const Template>(std::move(known));
    put(*this, made(
                   kept,
                   [kept = kept.get(), to_file, provenance = context->provenance()](const Path& path) {
                       if (to_file) write_json(path, template_to_json(kept->file, provenance));
                       else
                           static_cast<void>(copy_template(kept->file, path.parent_path(), path.filename().string(), provenance));
                   },
                   Object(kept)));
}

void GraphOutput::write(RelationGraph graph, const AnnotationSet& set) const {
    const auto kept = std::make_shared<const RelationGraph>(std::move(graph));
    put(*this, made(
                   kept,
                   [graph = kept.get(), set, provenance = context->provenance()](const Path& path) {
                       write_graph(path, *graph, set, provenance);
                   },
                   Object(kept)));
}

void CoordinatesOutput::check() const {
    for (const Source& source : sources)
        if (!source.file.empty() && extension(source.file) != ".npy")
            throw Error(ErrorKind::usage, source.file.string(), "is no name for a NumPy array", "end it in .npy");
}

void CoordinatesOutput::write(Coordinates coordinates, const Mesh& mesh, const Mesh& cage,
                              const CoordinateCertificate& certificate) const {
    const auto kept = std::make_shared<const Coordinates>(std::move(coordinates));
    put(*this, made(
                   kept,
                   [kept = kept.get(), mesh, cage, certificate, provenance = context->provenance()](const Path& path) {
                       write_coordinates(path, *kept, mesh, cage, certificate, provenance);
                   },
                   Object(kept)));
}

void ValuesOutput::write(std::vector<double> values) const {
    const auto kept = std::make_shared<const std::vector<double>>(std::move(values));
    put(*this, made(
                   kept, [kept = kept.get()](const Path& path) { write_values(path, *kept); }, Object(kept)));
}

void JsonOutput::write(Json document) const {
    if (document.IsObject() && find_member(document, "provenance") == nullptr)
        add_member(document, "provenance", context->provenance().to_json(document.GetAllocator()), document.GetAllocator());
    const auto kept = std::make_shared<const Json>(std::move(document));
    put(*this, made(
                   kept, [kept = kept.get()](const Path& path) { write_json(path, *kept); }, Object(kept)));
}

void JsonOutput::write(const JsonValue& value) const {
    Json document;
    document.CopyFrom(value, document.GetAllocator());
    write(std::move(document));
}

void IndexMapOutput::write(IndexMap map) const {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-map", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "kind", map.kind, allocator);
    if (!map.description.empty()) add_member(document, "description", map.description, allocator);
    add_member(document, "from", JsonValue(static_cast<std::uint64_t>(map.map.size())), allocator);
    add_member(document, "to", JsonValue(static_cast<std::uint64_t>(map.to)), allocator);
    if (map.nearest) add_member(document, "method", "nearest", allocator);
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(map.map.size()), allocator);
    for (const Index i : map.map) list.PushBack(i == no_index ? std::int64_t{-1} : static_cast<std::int64_t>(i), allocator);
    add_member(document, "map", std::move(list), allocator);
    add_member(document, "provenance", context->provenance().to_json(allocator), allocator);
    validate(document, "map", name);
    const auto kept = std::make_shared<const IndexMap>(std::move(map));
    const auto written = std::make_shared<const Json>(std::move(document));
    put(*this, made(
                   written, [written = written.get()](const Path& path) { write_json(path, *written); }, Object(kept)));
}

Path FileOutput::path() const {
    const Source& source = sources.at(0);
    if (!source.file.empty()) {
        context->check_output(source.file);
        return source.file;
    }
    if (memory_.empty()) {
        const std::string called = Path(source.object.name).filename().string();
        memory_ = context->memory(called.empty() ? name + extension_ : called);
    }
    return memory_;
}

void FileOutput::finish() {
    if (!memory_.empty() && file_exists(memory_))
        sources.front().object = Object::of(read_file(memory_), memory_.filename().string());
}

Path FolderOutput::path() const {
    const auto known = opened_.find(0);
    return known == opened_.end() ? sources.at(0).file : known->second;
}

void FolderOutput::check() const {
    for (std::size_t i = 0; i < sources.size(); ++i) check_folder(i);
}

void FolderOutput::check_folder(std::size_t i) const {
    const Path& folder = sources[i].file;
    if (!is_memory(folder) && !folder.empty() && std::filesystem::exists(folder) && !is_folder(folder))
        fail_usage((is_positional ? "" : "--") + name + " '" + folder.string() + "' is a file",
                   "name a folder, which is made if it is missing");
    if (!is_memory(folder) && !folder.empty()) check_can_be_made(folder);
}

const Path& FolderOutput::open(std::size_t i, bool replaces) const {
    if (const auto known = opened_.find(i); known != opened_.end()) return known->second;
    const Path folder = sources.at(i).file.empty() ? context->memory(name) : sources.at(i).file;
    make_folder(folder);
    if (!is_memory(folder)) {
        // Known before the work, not after the first object of many hours.
        if (::access(folder.c_str(), W_OK | X_OK) != 0)
            throw Error(ErrorKind::failure, folder.string(), "the folder cannot be written to",
                        "check its rights, or name another");
        remove_stale_temporaries(folder);
    }
    std::string owner = context->provenance().command;
    for (char& c : owner)
        if (c == ' ') c = '-';
    if (replaces) replace_outputs(folder, owner);
    return opened_[i] = folder;
}

Path FolderOutput::in(const std::string& file, std::size_t i) const {
    const Path path = open(i) / file;
    context->check_output(path);
    return path;
}

void FolderOutput::finish() {
    for (const auto& [i, folder] : opened_)
        if (is_memory(folder)) sources[i].object = Object::of(folder, folder.string());
}

}  // namespace ostraka

#include "saved.h"

#include "archive.h"

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/memory.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/npy.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/values.h"
#include "ostraka/template_package/template.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::python {

template <class Archive, Is<Image> T>
void fields(Archive& archive, T& x) {
    archive(x.name, x.bytes, x.format, x.width, x.height);
}
template <class Archive, Is<Material> T>
void fields(Archive& archive, T& x) {
    archive(x.name, x.base_colour, x.image, x.wrap_u, x.wrap_v, x.nearest, x.alpha, x.alpha_cutoff, x.double_sided, x.gltf_rest,
            x.mtl_rest);
}
template <class Archive, Is<Appearance> T>
void fields(Archive& archive, T& x) {
    archive(x.materials, x.images);
}
template <class Archive, Is<NamedValues> T>
void fields(Archive& archive, T& x) {
    archive(x.name, x.values);
}
template <class Archive, Is<MeshExtras> T>
void fields(Archive& archive, T& x) {
    archive(x.vertex_colours, x.face_colours, x.vertex_labels, x.face_labels, x.corner_texture, x.face_materials, x.appearance,
            x.vertex_values, x.face_values, x.tetrahedra);
}
template <class Archive, Is<PolygonSoup> T>
void fields(Archive& archive, T& x) {
    archive(x.points, x.polygon_begin, x.corners, x.extras, x.notes, x.vertex_of_file_vertex);
}
template <class Archive, Is<IndexMap> T>
void fields(Archive& archive, T& x) {
    archive(x.kind, x.map, x.to, x.description, x.nearest);
}
template <class Archive, Is<PackagedFile> T>
void fields(Archive& archive, T& x) {
    archive(x.role, x.name, x.sha256);
}
template <class Archive, Is<TemplateFile> T>
void fields(Archive& archive, T& x) {
    archive(x.object_class, x.unit, x.up, x.contents);
}

namespace {

constexpr std::string_view magic = "ostraka object 4\n";  ///< includes the version of the format
constexpr std::size_t digest_size = 64;

/// Type of a saved object. The order is part of the format.
enum class Type { mesh, polygons, annotations, text, document, values, coordinates, index_map, folder, template_package };
constexpr Type last_of(Type /*any*/) { return Type::template_package; }

using Files = std::vector<std::pair<std::string, std::string>>;  ///< (name, bytes)

Files files_of_folder(const Path& folder) {
    Files files;
    for (const std::string& file : files_in(folder)) files.emplace_back(file, read_file(folder / file));
    return files;
}
/// The files that the object writes under this name.
Files files_of_object(const Object& object, const std::string& name) {
    const InMemory place(name);
    write_object(object, place.file);
    return files_of_folder(place.folder);
}
std::string bytes_of_object(const Object& object, const std::string& name) {
    const InMemory place(name);
    write_object(object, place.file);
    return read_file(place.file);
}
std::string file_name_of(const Object& object) { return Path(object.name).filename().string(); }

// ---- meshes, including the way they are written ----

/// How an operation wrote a mesh. A PLY file holds all data; other formats hold less.
struct MeshWriting {
    std::string comment;
    bool ascii = false;
    Files files;  ///< by extension: PLY, the format of the mesh's name, and the formats that hold polygons
};
}  // namespace

template <class Archive, Is<MeshWriting> T>
void fields(Archive& archive, T& x) {
    archive(x.comment, x.ascii, x.files);
}

namespace {

/// Number of faces of a PLY file written by the toolkit.
std::size_t faces_of_ply(std::string_view ply) {
    constexpr std::string_view line = "\nelement face ";
    const std::size_t begin = ply.find(line);
    return begin == std::string_view::npos ? 0 : std::strtoull(ply.data() + begin + line.size(), nullptr, 10);
}

/// `faces`: number of faces of the object; if the file has another number, it holds polygons instead of the triangles.
MeshWriting writing_of(const Object& object, std::size_t faces) {
    MeshWriting writing;
    const auto add = [&](const std::string& ending) {
        if (std::none_of(writing.files.begin(), writing.files.end(), [&](const auto& entry) { return entry.first == ending; }))
            writing.files.emplace_back(ending, bytes_of_object(object, "mesh" + ending));
    };
    add(".ply");
    add(extension(object.name));
    if (faces_of_ply(writing.files.front().second) != faces)
        for (const char* ending : {".obj", ".off"}) add(ending);
    const std::string_view ply = writing.files.front().second;
    writing.ascii = ply.starts_with("ply\nformat ascii");
    constexpr std::string_view comment = "\ncomment ";
    const std::size_t begin = ply.find(comment), end = ply.find("\nend_header");
    if (begin < end) writing.comment = ply.substr(begin + comment.size(), ply.find('\n', begin + 1) - begin - comment.size());
    return writing;
}

/// A function that writes the mesh: the stored bytes of the format if available, otherwise `write`.
template <class Write>
std::function<void(const Path&)> write_mesh_with(MeshWriting writing, Write write) {
    return [writing = std::make_shared<const MeshWriting>(std::move(writing)), write](const Path& file) {
        check_mesh_extension(file);
        for (const auto& [ending, bytes] : writing->files)
            if (ending == extension(file)) return write_file(file, bytes);
        WriteOptions options;
        options.comment = writing->comment;
        if (writing->ascii) options.encoding = Encoding::ascii;
        write(file, options);
    };
}

void check_count(std::size_t given, std::size_t elements, const char* attribute) {
    if (given != 0 && given != elements) fail_archive(fmt::format("has another number of {} than of elements", attribute));
}

void check_indices(const std::vector<Index>& list, std::size_t limit) {
    if (std::any_of(list.begin(), list.end(), [&](Index i) { return i >= limit; }))
        fail_archive("names an element that does not exist");
}

void check_mesh(const PolygonSoup& soup) {
    const std::size_t vertices = soup.points.size();
    for (const auto& point : soup.points)
        if (!std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); }))
            fail_archive("has a point that is not finite");
    const auto& begin = soup.polygon_begin;
    if (vertices >= no_index || begin.empty() || begin.front() != 0 || begin.back() != soup.corners.size() ||
        !std::is_sorted(begin.begin(), begin.end()))
        fail_archive("has polygons that do not follow each other");
    check_indices(soup.corners, vertices);
    const MeshExtras& extras = soup.extras;
    check_count(extras.vertex_colours.size(), vertices, "colours");
    check_count(extras.vertex_labels.size(), vertices, "labels");
    check_count(extras.face_colours.size(), soup.polygon_count(), "colours");
    check_count(extras.face_labels.size(), soup.polygon_count(), "labels");
    check_count(extras.corner_texture.size(), soup.corners.size(), "texture coordinates");
    check_count(extras.face_materials.size(), soup.polygon_count(), "materials");
    for (const Index material : extras.face_materials)
        if (material != no_index) check_indices({material}, extras.appearance.materials.size());
    for (const Material& material : extras.appearance.materials)
        if (material.image != no_index) check_indices({material.image}, extras.appearance.images.size());
    for (const NamedValues& column : extras.vertex_values) check_count(column.values.size(), vertices, "values of vertices");
    for (const NamedValues& column : extras.face_values)
        check_count(column.values.size(), soup.polygon_count(), "values of faces");
    for (const Index vertex : soup.vertex_of_file_vertex)
        if (vertex != no_index) check_indices({vertex}, vertices);
    for (const auto& tetrahedron : extras.tetrahedra) check_indices({tetrahedron.begin(), tetrahedron.end()}, vertices);
}

PolygonSoup soup_of(const MeshFile& file) {
    PolygonSoup soup;
    TriangleSoup triangles = to_soup(file.mesh);
    soup.points = std::move(triangles.points);
    soup.corners.reserve(3 * triangles.triangles.size());
    for (const auto& corners : triangles.triangles) {
        soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
        soup.polygon_begin.push_back(static_cast<Index>(soup.corners.size()));
    }
    soup.extras = file.extras;
    soup.notes = file.notes;
    return soup;
}

/// Builds the same halfedge order as reading a file does.
MeshFile mesh_of(PolygonSoup soup, std::vector<Index> polygon_of_triangle) {
    TriangleSoup triangles;
    for (std::size_t i = 0; i < soup.polygon_count(); ++i) {
        if (soup.polygon_begin[i + 1] != 3 * (i + 1)) fail_archive("has polygons that are not triangles");
        triangles.triangles.push_back({soup.corners[3 * i], soup.corners[3 * i + 1], soup.corners[3 * i + 2]});
    }
    check_count(polygon_of_triangle.size(), soup.polygon_count(), "polygons");
    triangles.points = std::move(soup.points);
    return {build_mesh(triangles), std::move(soup.extras), std::move(polygon_of_triangle), std::move(soup.notes)};
}

Object restored_mesh(Reader& reader) {
    PolygonSoup soup;
    std::vector<Index> polygon_of_triangle;
    MeshWriting writing;
    reader(soup, polygon_of_triangle, writing);
    check_mesh(soup);
    const auto mesh = std::make_shared<const MeshFile>(mesh_of(std::move(soup), std::move(polygon_of_triangle)));
    Object object(mesh);
    object.write = write_mesh_with(std::move(writing), [mesh](const Path& file, const WriteOptions& options) {
        write_mesh(file, mesh->mesh, mesh->extras, options);
    });
    return object;
}

Object restored_polygons(Reader& reader) {
    PolygonSoup stored;
    MeshWriting writing;
    reader(stored, writing);
    check_mesh(stored);
    const auto soup = std::make_shared<const PolygonSoup>(std::move(stored));
    Object object(soup);
    object.write = write_mesh_with(std::move(writing), [soup](const Path& file, const WriteOptions& options) {
        const TriangulatedSoup triangulated = triangulate(PolygonSoup(*soup));
        write_triangles(file, triangulated.soup, triangulated.extras, options);
    });
    return object;
}

// ---- arrays ----

std::vector<double> numbers_of(const WeightMatrix& matrix) { return {matrix.data(), matrix.data() + matrix.size()}; }

void save_matrix(Writer& writer, const WeightMatrix& matrix) {
    writer(static_cast<std::uint64_t>(matrix.rows()), static_cast<std::uint64_t>(matrix.cols()), numbers_of(matrix));
}
WeightMatrix restored_matrix(Reader& reader) {
    std::uint64_t rows = 0, columns = 0;
    std::vector<double> numbers;
    reader(rows, columns, numbers);
    const bool fits = rows == 0 || columns == 0 ? numbers.empty() && std::max(rows, columns) < no_index
                                                : numbers.size() % rows == 0 && numbers.size() / rows == columns;
    if (!fits) fail_archive("holds an array of another size than it states");
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        fail_archive("has a weight that is not finite");
    return Eigen::Map<const WeightMatrix>(numbers.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

void save_sparse(Writer& writer, const SparseWeights& matrix) {
    SparseWeights packed = matrix;
    packed.makeCompressed();
    const auto count = static_cast<std::size_t>(packed.nonZeros()), rows = static_cast<std::size_t>(packed.rows());
    writer(static_cast<std::uint64_t>(packed.cols()), std::vector<int>(packed.outerIndexPtr(), packed.outerIndexPtr() + rows + 1),
           std::vector<int>(packed.innerIndexPtr(), packed.innerIndexPtr() + count),
           std::vector<double>(packed.valuePtr(), packed.valuePtr() + count));
}
SparseWeights restored_sparse(Reader& reader, const WeightMatrix& dense) {
    std::uint64_t columns = 0;
    std::vector<int> begin, column;
    std::vector<double> values;
    reader(columns, begin, column, values);
    const auto count = static_cast<int>(values.size());
    if (begin.empty() || begin.front() != 0 || begin.back() != count || !std::is_sorted(begin.begin(), begin.end()) ||
        column.size() != values.size() || begin.size() - 1 != static_cast<std::size_t>(dense.rows()) ||
        columns != static_cast<std::uint64_t>(dense.cols()))
        fail_archive("holds weights of another size than it states");
    for (std::size_t row = 0; row + 1 < begin.size(); ++row)
        for (int i = begin[row]; i < begin[row + 1]; ++i) {
            const auto position = static_cast<std::size_t>(i);
            if (column[position] < 0 || column[position] >= static_cast<int>(columns) ||
                (i > begin[row] && column[position] <= column[position - 1]) || !std::isfinite(values[position]))
                fail_archive("holds weights that are not in order");
        }
    return Eigen::Map<const SparseWeights>(dense.rows(), dense.cols(), count, begin.data(), column.data(), values.data());
}

void save_coordinates(Writer& writer, const Object& object, const Coordinates& coordinates) {
    const std::string header = coordinate_header_file("weights.npy").string();
    const Files files = files_of_object(object, "weights.npy");
    const auto header_file = std::find_if(files.begin(), files.end(), [&](const auto& entry) { return entry.first == header; });
    if (header_file == files.end()) fail_usage("coordinates without a header cannot be kept");
    writer(coordinates.kind, coordinates.seconds, header_file->second);
    save_matrix(writer, coordinates.vertex);
    save_matrix(writer, coordinates.normal);
    writer(coordinates.is_sparse());
    if (coordinates.is_sparse()) save_sparse(writer, coordinates.sparse);
}

/// Writes the files of coordinates as write_coordinates does; `header`: their header, with other names.
void write_restored(const Path& weights, const Coordinates& coordinates, const std::string& header) {
    if (extension(weights) != ".npy")
        fail_usage(fmt::format("'{}' is not the name of a NumPy array", weights.string()), "end its name in .npy");
    Json document = parse_json(header, "pickle");
    auto& allocator = document.GetAllocator();
    const auto write_list = [&](JsonValue& array, const Path& file, const auto& numbers, const std::vector<std::size_t>& shape) {
        array["file"].SetString(file.filename().string(), allocator);
        if (write_npy(file, numbers, shape) != text_in(array, "sha256"))
            fail_archive("has weights that are not those of their header");
    };
    const auto write_matrix = [&](JsonValue& array, const Path& file, const WeightMatrix& matrix) {
        write_list(array, file, std::span(matrix.data(), static_cast<std::size_t>(matrix.size())),
                   {static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())});
    };
    if (coordinates.is_sparse()) {
        const SparseWeights& sparse = coordinates.sparse;
        const auto count = static_cast<std::size_t>(sparse.nonZeros()), rows = static_cast<std::size_t>(sparse.rows());
        const std::vector<std::int64_t> columns(sparse.innerIndexPtr(), sparse.innerIndexPtr() + count),
            begins(sparse.outerIndexPtr(), sparse.outerIndexPtr() + rows + 1);
        write_list(document["vertex"], weights, std::span(sparse.valuePtr(), count), {count});
        write_list(document["sparse"]["column"], sparse_columns_file(weights), columns, {columns.size()});
        write_list(document["sparse"]["row"], sparse_rows_file(weights), begins, {begins.size()});
    } else {
        write_matrix(document["vertex"], weights, coordinates.vertex);
    }
    if (coordinates.has_normals()) write_matrix(document["normal"], normal_weights_file(weights), coordinates.normal);
    write_json(coordinate_header_file(weights), document);
}

Object restored_coordinates(Reader& reader) {
    Coordinates stored;
    std::string header;
    bool is_sparse = false;
    reader(stored.kind, stored.seconds, header);
    stored.vertex = restored_matrix(reader);
    stored.normal = restored_matrix(reader);
    reader(is_sparse);
    if (is_sparse) stored.sparse = restored_sparse(reader, stored.vertex);
    const Json document = parse_json(header, "pickle");
    validate(document, "coordinates", "pickle");
    if ((find_member(document, "sparse") != nullptr) != is_sparse ||
        (find_member(document, "normal") != nullptr) != stored.has_normals())
        fail_archive("has weights that are not those of their header");
    const auto coordinates = std::make_shared<const Coordinates>(std::move(stored));
    Object object(coordinates);
    object.write = [coordinates, header](const Path& file) { write_restored(file, *coordinates, header); };
    return object;
}

Object restored_values(Reader& reader) {
    std::vector<double> stored;
    reader(stored);
    return object_of_values(std::move(stored));
}

Object restored_index_map(Reader& reader) {
    IndexMap map;
    std::string text;
    reader(map, text);
    Object object = Object::of(std::move(map));
    object.write = [text](const Path& file) { write_file(file, text); };
    return object;
}

// ---- documents, annotations ----

Object restored_document(Reader& reader) {
    std::string text;
    bool has_write = false;
    reader(text, has_write);
    const auto document = std::make_shared<const Json>(parse_json(text, "pickle"));
    Object object(document);
    if (has_write) object.write = [document](const Path& file) { write_json(file, *document); };
    return object;
}

Object restored_annotations(Reader& reader) {
    AnnotationSet set;
    std::string text;
    reader(set, text);
    Object object = Object::of(std::move(set));
    object.write = [text](const Path& file) { write_file(file, text); };
    return object;
}

// ---- several files ----

/// Writes the files into an in-memory folder that `context` keeps.
Path write_files(const Files& files, Context& context, const std::string& name) {
    const Path folder = context.memory(name);
    OutputTransaction transaction;
    for (const auto& [file, bytes] : files) {
        require_plain_name(file, "pickle", "files");
        write_file(folder / file, bytes);
    }
    transaction.commit();
    return folder;
}

Held restored_folder(Reader& reader) {
    Files files;
    reader(files);
    const auto context = std::make_shared<Context>();
    return {Object::of(write_files(files, *context, "folder")), context};
}

constexpr const char* template_name = "saved.template.json";

void save_template(Writer& writer, const Object& object, const Template& package) {
    std::vector<std::string> parts;  // by file name in the folder
    for (const PackagedFile& part : package.file.contents) parts.push_back(part.file.filename().string());
    writer(package.file, parts, files_of_object(object, template_name));
}

Held restored_template(Reader& reader) {
    TemplateFile file;
    std::vector<std::string> parts;
    Files files;
    reader(file, parts, files);
    if (parts.size() != file.contents.size()) fail_archive("has another number of parts than it states");
    const auto context = std::make_shared<Context>();
    const Path folder = write_files(files, *context, "template");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        require_plain_name(parts[i], "pickle", "parts");
        file.contents[i].file = folder / parts[i];
    }
    TemplateOptions options;
    options.allow_outside = options.force_mesh = true;  // as permitted by whoever loaded the template
    Object object = Object::of(load_template(std::move(file), options));
    object.write = [files = std::make_shared<const Files>(std::move(files))](const Path& path) {
        for (const auto& [name, bytes] : *files) write_file(name == template_name ? path : path.parent_path() / name, bytes);
    };
    return {std::move(object), context};
}

Held restored(Type type, Reader& reader) {
    switch (type) {
        case Type::mesh:
            return {restored_mesh(reader)};
        case Type::polygons:
            return {restored_polygons(reader)};
        case Type::annotations:
            return {restored_annotations(reader)};
        case Type::document:
            return {restored_document(reader)};
        case Type::values:
            return {restored_values(reader)};
        case Type::coordinates:
            return {restored_coordinates(reader)};
        case Type::index_map:
            return {restored_index_map(reader)};
        case Type::folder:
            return restored_folder(reader);
        case Type::template_package:
            return restored_template(reader);
        case Type::text:
            break;
    }
    std::string bytes;
    reader(bytes);
    return {Object::of(std::move(bytes))};
}

void save_data(Writer& writer, const Object& object) {
    if (const auto mesh = object.as<MeshFile>())
        writer(Type::mesh, soup_of(*mesh), mesh->polygon_of_triangle, writing_of(object, mesh->mesh.number_of_faces()));
    else if (const auto soup = object.as<PolygonSoup>()) writer(Type::polygons, *soup, writing_of(object, soup->polygon_count()));
    else if (const auto set = object.as<AnnotationSet>())
        writer(Type::annotations, *set, bytes_of_object(object, file_name_of(object)));
    // A graph is checked against its annotations when it is read.
    else if (object.as<RelationGraph>()) writer(Type::text, bytes_of_object(object, file_name_of(object)));
    else if (const auto document = object.as<Json>()) writer(Type::document, to_text(*document), static_cast<bool>(object.write));
    else if (const auto values = object.as<std::vector<double>>()) writer(Type::values, *values);
    else if (const auto coordinates = object.as<Coordinates>())
        writer(Type::coordinates), save_coordinates(writer, object, *coordinates);
    else if (const auto map = object.as<IndexMap>()) writer(Type::index_map, *map, bytes_of_object(object, "map.json"));
    else if (const auto folder = object.as<Path>()) writer(Type::folder, files_of_folder(*folder));
    else if (const auto package = object.as<Template>()) writer(Type::template_package), save_template(writer, object, *package);
    else if (const auto text = object.as<std::string>()) writer(Type::text, *text);
    else throw Error(ErrorKind::usage, object.name, "cannot be pickled", "save it as a file");
}

}  // namespace

std::string state_of(const Held& held) {
    const Object& object = held.object;
    Writer writer;
    writer.bytes = magic;
    writer(object.name, object.sha256);
    save_data(writer, object);
    return writer.bytes + sha256(writer.bytes);
}

Held held_of(const std::string& state) {
    const std::string_view archive = state;
    if (!archive.starts_with(magic)) fail_archive("is not an object of this version of the toolkit");
    if (archive.size() < magic.size() + digest_size) fail_archive("is shorter than its content");
    const std::string_view content = archive.substr(0, archive.size() - digest_size);
    if (sha256(content) != archive.substr(content.size())) fail_archive("is damaged (its checksum differs)");
    Reader reader(content.substr(magic.size()));
    std::string name, checksum;
    Type type{};
    reader(name, checksum, type);
    Held held = restored(type, reader);
    reader.end();
    held.object.name = std::move(name);
    held.object.sha256 = std::move(checksum);
    return held;
}

}  // namespace ostraka::python

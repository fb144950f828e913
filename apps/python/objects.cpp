// Objects of the toolkit for Python: meshes and arrays, without a copy if the layout permits it.
#include "objects.h"

#include "saved.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/relation/graph.h"
#include "ostraka/render/values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::python {

/// Decodes text from files, which may contain invalid UTF-8.
py::str text_of_bytes(const std::string& text) {
    return py::reinterpret_steal<py::str>(PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
}

/// Path from a Python file name: bytes, as from os.fsencode.
Path path_of(const py::bytes& name) {
    const std::string text = name;
    if (text.empty()) fail_usage("the name of a file is empty", "name a file");
    if (text.find('\0') != std::string::npos) fail_usage("the name of a file holds a zero byte", "name another file");
    if (is_memory(text)) fail_usage(fmt::format("'{}' names a file in memory", printable(text, 60)), "give the object itself");
    return text;
}

void write_object(const Object& object, const Path& file) {
    OutputTransaction transaction;
    if (const auto folder = object.as<Path>()) {
        make_folder(file);
        for (const std::string& name : files_in(*folder)) write_file(file / name, read_file(*folder / name));
    } else if (object.write) {
        object.write(file);
    } else if (const auto bytes = object.as<std::string>()) {
        write_file(file, *bytes);
    } else if (const auto document = object.as<Json>()) {
        write_json(file, *document);
    } else {
        throw Error(ErrorKind::usage, object.name, "cannot be written as a file");
    }
    check_cancelled();
    transaction.commit();
}

Object object_of_values(std::vector<double> numbers) {
    const auto values = std::make_shared<const std::vector<double>>(std::move(numbers));
    Object object(values);
    object.write = [values](const Path& file) { write_values(file, *values); };
    return object;
}

namespace {

/// The Python class that represents the object.
std::string type_of(const Held& held) {
    const Object& object = held.object;
    if (object.as<MeshFile>() || object.as<PolygonSoup>() || object.as<Mesh>()) return "mesh";
    if (object.as<AnnotationSet>()) return "annotations";
    if (object.as<RelationGraph>() || object.as<Json>()) return "document";
    if (object.as<std::vector<double>>() || object.as<Coordinates>() || object.as<IndexMap>()) return "array";
    if (object.as<Path>()) return "folder";
    if (object.as<std::string>()) return "bytes";
    return "other";
}

void save(const Held& held, const py::bytes& name) {
    const Path file = path_of(name);
    unlocked([held, file] { return write_object(held.object, file), true; });
}

py::bytes bytes_of(const Held& held) {
    if (const auto bytes = held.object.as<std::string>()) return *bytes;
    return unlocked([held] {  // keeps the context that holds the files
        const InMemory place(Path(held.object.name).filename().string());
        write_object(held.object, place.file);
        return read_file(place.file);
    });
}

/// A read-only array that shares memory of the toolkit; it keeps the owner alive.
template <class Number>
py::array view_of(const std::shared_ptr<const void>& owner, const Number* numbers, std::vector<py::ssize_t> shape) {
    const py::capsule keeps(new std::shared_ptr<const void>(owner),
                            [](void* pointer) { delete static_cast<std::shared_ptr<const void>*>(pointer); });
    py::array array(py::dtype::of<Number>(), std::move(shape), numbers, keeps);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}
/// The same for a list that the array takes over.
template <class Number>
py::array array_of(std::vector<Number> numbers, std::vector<py::ssize_t> shape) {
    const auto owner = std::make_shared<const std::vector<Number>>(std::move(numbers));
    return view_of(owner, owner->data(), std::move(shape));
}
py::ssize_t size_of(std::size_t count) { return static_cast<py::ssize_t>(count); }

// ---- meshes ----

/// A manifold mesh if it is a valid triangle mesh, which most operations need; otherwise the polygons as given.
Object mesh_object(PolygonSoup soup, std::string name, const std::string& sha256) {
    const std::size_t count = soup.polygon_count();
    bool triangles = count > 0;
    for (std::size_t i = 0; triangles && i < count; ++i) triangles = soup.polygon_begin[i + 1] == 3 * (i + 1);
    std::shared_ptr<const MeshFile> mesh;
    if (triangles) try {
            mesh = std::make_shared<const MeshFile>(mesh_of_polygons(soup, name));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
        }
    Object object;
    if (mesh) {
        object = Object(mesh, std::move(name), sha256);
        object.write = [mesh](const Path& file) { write_mesh(file, mesh->mesh, mesh->extras); };
    } else {
        const auto polygons = std::make_shared<const PolygonSoup>(std::move(soup));
        object = Object(polygons, std::move(name), sha256);
        object.write = [polygons](const Path& file) {
            const TriangulatedSoup triangulated = triangulate(PolygonSoup(*polygons));
            write_triangles(file, triangulated.soup, triangulated.extras);
        };
    }
    return object;
}

Held read_mesh_object(const py::bytes& name) {
    const Path file = path_of(name);
    return unlocked([file]() -> Held {
        const ReadRecord record;
        PolygonSoup soup = read_polygons(file);
        return {mesh_object(std::move(soup), file.string(), record.files.at(0).sha256)};
    });
}

template <class Number>
using Numbers = py::array_t<Number, py::array::c_style | py::array::forcecast>;

template <class Entry, class Number>
void take_extra(const py::dict& extras, const char* name, std::size_t count, std::vector<Entry>& list) {
    if (!extras.contains(name)) return;
    const auto array = extras[name].cast<Numbers<Number>>();
    if (static_cast<std::size_t>(array.size()) * sizeof(Number) != count * sizeof(Entry))
        fail_input(name, "has another size than the mesh", "give one entry per element");
    list.resize(count);
    std::copy_n(array.data(), array.size(), reinterpret_cast<Number*>(list.data()));
}

/// Makes a mesh from points (n x 3), the concatenated corners of all polygons, and the begin of each polygon among the corners.
Held make_mesh_object(const Numbers<double>& points, const Numbers<std::int64_t>& begin, const Numbers<std::int64_t>& corners,
                      const py::dict& extras, const std::string& name) {
    check_mesh_extension(name);
    PolygonSoup soup;
    if (points.ndim() != 2 || points.shape(1) != 3) fail_input("points", "is not an array of n x 3 numbers", "give x, y, z");
    const auto count = static_cast<std::size_t>(points.shape(0));
    if (count >= no_index || static_cast<std::size_t>(corners.size()) >= no_index)
        fail_work(name, "has more than four thousand million corners", "split it");
    soup.points.resize(count);
    std::copy_n(points.data(), points.size(), reinterpret_cast<double*>(soup.points.data()));
    for (std::size_t i = 0; i < count; ++i)
        for (const double x : soup.points[i])
            if (!std::isfinite(x))
                fail_input("points", fmt::format("point {} is not finite", i), "leave it out, or give its position");
    const auto ends = static_cast<std::size_t>(begin.size());
    soup.polygon_begin.resize(std::max<std::size_t>(ends, 1));
    for (std::size_t i = 0; i < ends; ++i) {
        const std::int64_t minimum = i == 0 ? 0 : begin.data()[i - 1];
        if (begin.data()[i] < minimum || begin.data()[i] > corners.size() || (i == 0 && begin.data()[0] != 0) ||
            (i + 1 == ends && begin.data()[i] != corners.size()))
            fail_input("faces", fmt::format("polygon {} begins at an invalid place in the corners", i), "count corners from 0");
        soup.polygon_begin[i] = static_cast<Index>(begin.data()[i]);
    }
    soup.corners.resize(static_cast<std::size_t>(corners.size()));
    for (std::size_t i = 0; i < soup.corners.size(); ++i) {
        const std::int64_t corner = corners.data()[i];
        if (corner < 0 || corner >= static_cast<std::int64_t>(count)) {
            const auto face =
                std::upper_bound(soup.polygon_begin.begin(), soup.polygon_begin.end(), i) - soup.polygon_begin.begin();
            fail_input("faces", fmt::format("face {} names vertex {}, and there are {}", face - 1, corner, count),
                       "count vertices from 0");
        }
        soup.corners[i] = static_cast<Index>(corner);
    }
    const std::size_t faces = soup.polygon_count();
    take_extra<Colour, std::uint8_t>(extras, "vertex_colours", count, soup.extras.vertex_colours);
    take_extra<Colour, std::uint8_t>(extras, "face_colours", faces, soup.extras.face_colours);
    take_extra<std::int32_t, std::int32_t>(extras, "vertex_labels", count, soup.extras.vertex_labels);
    take_extra<std::int32_t, std::int32_t>(extras, "face_labels", faces, soup.extras.face_labels);
    return unlocked([soup = std::move(soup), name]() mutable -> Held { return {mesh_object(std::move(soup), name, {})}; });
}

static_assert(sizeof(Point) == 3 * sizeof(double), "points of a mesh are shown as they lie in memory");

py::array points_view(const Held& held) {
    if (const auto soup = held.object.as<PolygonSoup>())
        return view_of(soup, reinterpret_cast<const double*>(soup->points.data()), {size_of(soup->points.size()), 3});
    const auto file = held.object.as<MeshFile>();
    if (!file) fail_usage("the object is not a mesh", "give a mesh");
    const std::size_t count = file->mesh.number_of_vertices();
    if (count == 0 || file->mesh.has_garbage()) {
        const TriangleSoup soup = to_soup(file->mesh);
        const auto* first = reinterpret_cast<const double*>(soup.points.data());
        return array_of(std::vector<double>(first, first + 3 * soup.points.size()), {size_of(soup.points.size()), 3});
    }
    return view_of(file, reinterpret_cast<const double*>(&file->mesh.point(Vertex(0))), {size_of(count), 3});
}

/// Begin of each polygon among the corners, and the corners.
std::pair<py::array, py::array> polygons_of(const Held& held) {
    if (const auto soup = held.object.as<PolygonSoup>())
        return {view_of(soup, soup->polygon_begin.data(), {size_of(soup->polygon_begin.size())}),
                view_of(soup, soup->corners.data(), {size_of(soup->corners.size())})};
    const auto file = held.object.as<MeshFile>();
    if (!file) fail_usage("the object is not a mesh", "give a mesh");
    std::vector<Index> begin(file->mesh.number_of_faces() + 1), corner_list;
    corner_list.reserve(3 * file->mesh.number_of_faces());
    for (std::size_t i = 0; i < begin.size(); ++i) begin[i] = static_cast<Index>(3 * i);
    for (const auto& triangle : unlocked([file] { return to_soup(file->mesh); }).triangles)
        corner_list.insert(corner_list.end(), triangle.begin(), triangle.end());
    const py::ssize_t faces = size_of(begin.size()), corners = size_of(corner_list.size());
    return {array_of(std::move(begin), {faces}), array_of(std::move(corner_list), {corners})};
}

/// Attributes of the elements: arrays by name, without empty ones.
py::dict extras_of(const Held& held) {
    const auto soup = held.object.as<PolygonSoup>();
    const auto file = held.object.as<MeshFile>();
    if (!soup && !file) fail_usage("the object is not a mesh", "give a mesh");
    const MeshExtras& extras = soup ? soup->extras : file->extras;
    const std::shared_ptr<const void> owner = soup ? std::shared_ptr<const void>(soup) : file;
    py::dict arrays;
    const auto add = [&]<class Number>(const char* name, const auto& list, Number /*type*/, py::ssize_t columns) {
        std::vector<py::ssize_t> shape{size_of(list.size())};
        if (columns > 1) shape.push_back(columns);
        if (!list.empty()) arrays[name] = view_of(owner, reinterpret_cast<const Number*>(list.data()), std::move(shape));
    };
    add("vertex_colours", extras.vertex_colours, std::uint8_t{}, 4);
    add("face_colours", extras.face_colours, std::uint8_t{}, 4);
    add("vertex_labels", extras.vertex_labels, std::int32_t{}, 1);
    add("face_labels", extras.face_labels, std::int32_t{}, 1);
    add("corner_texture", extras.corner_texture, float{}, 2);
    add("face_materials", extras.face_materials, Index{}, 1);
    for (const NamedValues& column : extras.vertex_values)
        add(("vertex_values/" + column.name).c_str(), column.values, double{}, 1);
    for (const NamedValues& column : extras.face_values) add(("face_values/" + column.name).c_str(), column.values, double{}, 1);
    return arrays;
}

// ---- other objects ----

Held make_bytes(const py::bytes& bytes, const std::string& name) { return {Object::of(std::string(bytes), name)}; }

Held read_bytes(const py::bytes& name) {
    const Path file = path_of(name);
    return unlocked([file]() -> Held { return {Object::of(read_file(file), file.string())}; });
}

Held make_document(const std::string& text, const std::string& name) {
    return unlocked([text, name]() -> Held { return {Object::of(parse_json(text, name), name)}; });
}

Held make_values(const Numbers<double>& array, const std::string& name) {
    Object object = object_of_values({array.data(), array.data() + array.size()});
    object.name = name;
    return {std::move(object)};
}

py::array array_of_object(const Held& held) {
    if (const auto values = held.object.as<std::vector<double>>())
        return view_of(values, values->data(), {size_of(values->size())});
    if (const auto coordinates = held.object.as<Coordinates>())
        return view_of(coordinates, coordinates->vertex.data(), {coordinates->vertex.rows(), coordinates->vertex.cols()});
    const auto map = held.object.as<IndexMap>();
    if (!map) fail_usage("the object is not an array");
    std::vector<std::int64_t> indices;
    for (const Index i : map->map) indices.push_back(i == no_index ? -1 : static_cast<std::int64_t>(i));
    const py::ssize_t count = size_of(indices.size());
    return array_of(std::move(indices), {count});
}

py::object normals_of_coordinates(const Held& held) {
    const auto coordinates = held.object.as<Coordinates>();
    if (!coordinates || !coordinates->has_normals()) return py::none();
    return view_of(coordinates, coordinates->normal.data(), {coordinates->normal.rows(), coordinates->normal.cols()});
}

py::dict files_of(const Held& held) {
    const auto folder = held.object.as<Path>();
    if (!folder) fail_usage("the object is not a folder");
    py::dict files;
    for (const std::string& name : files_in(*folder))
        if (name.front() != '.') files[text_of_bytes(name)] = Held{Object::of(read_file(*folder / name), name)};
    return files;
}

py::bytes pickled(const Held& held) {
    return unlocked([held] { return state_of(held); });
}

Held unpickled(const py::bytes& state) {
    return unlocked([text = std::string(state)] { return held_of(text); });
}

/// The faces of each region, and one label per face: the id of the smallest region that contains it, -1 for none.
std::pair<py::dict, py::array> faces_of(const Held& held, const Held& held_mesh) {
    const auto file = held_mesh.object.as<MeshFile>();
    if (!file)
        throw Error(ErrorKind::input, held_mesh.object.name, "is not an oriented manifold of triangles",
                    "use ostraka.mesh.repair");
    auto [set, labels] = unlocked([held, file] {
        AnnotationSet annotations;
        if (const auto in_memory = held.object.as<AnnotationSet>()) {
            check_annotations({file->mesh, *in_memory}, held.object.name);
            annotations = *in_memory;
        } else {
            const InMemory place(Path(held.object.name).filename().string());
            write_object(held.object, place.file);
            annotations = read_annotations(place.file, file->mesh);
        }
        auto face_labels = labels_of({file->mesh, annotations});
        return std::pair(std::move(annotations), std::move(face_labels));
    });
    py::dict faces;
    for (Annotation& annotation : set.annotations) {
        const py::ssize_t count = size_of(annotation.faces.size());
        if (annotation.type == AnnotationType::region)
            faces[py::int_(annotation.id)] = array_of(std::move(annotation.faces), {count});
    }
    const py::ssize_t count = size_of(labels.size());
    return {faces, array_of(std::move(labels), {count})};
}

}  // namespace

void add_objects(py::module_& module) {
    py::class_<Held>(module, "Object")
        .def_property_readonly("type", type_of)
        .def_property(
            "name", [](const Held& held) { return text_of_bytes(held.object.name); },
            [](Held& held, const std::string& name) { held.object.name = name; })
        .def("save", save)
        .def("bytes", bytes_of)
        .def("state", pickled)
        .def("copy", [](const Held& held) { return held; })
        .def("points", points_view)
        .def("polygons", polygons_of)
        .def("extras", extras_of)
        .def("is_manifold", [](const Held& held) { return held.object.as<MeshFile>() != nullptr; })
        .def("array", array_of_object)
        .def("normals", normals_of_coordinates)
        .def("files", files_of)
        .def("faces", faces_of);
    module.def("restore", unpickled);
    module.def("read_mesh", read_mesh_object);
    module.def("make_mesh", make_mesh_object);
    module.def("check_mesh_name", [](const std::string& name) { check_mesh_extension(name); });
    module.def("read_bytes", read_bytes);
    module.def("make_bytes", make_bytes);
    module.def("make_document", make_document);
    module.def("make_values", make_values);
}

}  // namespace ostraka::python

// Tetrahedral meshes: Medit's .mesh (text) and VTK's .vtu (text). All other modules use their surface.
#include "io/formats.h"
#include "io/text_reader.h"
#include "io/text_writer.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>
#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <map>

namespace ostraka::io {

namespace {

using Tetrahedron = std::array<Index, 4>;

double volume_of(const PolygonSoup& soup, const Tetrahedron& t) {
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) e[i][k] = soup.points[t[i + 1]][k] - soup.points[t[0]][k];
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/// Faces of exactly one tetrahedron become the polygons of the soup, oriented outwards; their labels are those of the file's
/// polygons with the same corners.
void extract_surface(PolygonSoup& soup, const std::string& file) {
    const std::vector<Tetrahedron>& cells = soup.extras.tetrahedra;
    if (cells.empty()) return;
    std::map<std::array<Index, 3>, std::int32_t> labels;
    if (!soup.extras.face_labels.empty())
        for (std::size_t f = 0; f < soup.polygon_count(); ++f) {
            if (soup.polygon_begin[f + 1] - soup.polygon_begin[f] != 3) continue;
            std::array<Index, 3> key{};
            std::copy_n(soup.corners.begin() + soup.polygon_begin[f], 3, key.begin());
            std::sort(key.begin(), key.end());
            labels[key] = soup.extras.face_labels[f];
        }
    struct Side {
        std::array<Index, 3> key, corners;
        bool operator<(const Side& skip_section) const { return key < skip_section.key; }
    };
    std::vector<Side> sides;
    sides.reserve(4 * cells.size());
    for (Tetrahedron t : cells) {
        if (volume_of(soup, t) < 0) std::swap(t[2], t[3]);
        for (const std::array<Index, 3>& corners : {std::array{t[0], t[2], t[1]}, std::array{t[0], t[1], t[3]},
                                                    std::array{t[1], t[2], t[3]}, std::array{t[0], t[3], t[2]}}) {
            Side side{corners, corners};
            std::sort(side.key.begin(), side.key.end());
            sides.push_back(side);
        }
    }
    std::stable_sort(sides.begin(), sides.end());
    const bool labelled = !labels.empty();
    soup.corners.clear();
    soup.polygon_begin.assign(1, 0);
    soup.extras.face_labels.clear();
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].key == sides[i].key) ++end;
        if (end - i > 2) fail_input(file, "has a triangle between more than two tetrahedra", "correct the file");
        if (end - i == 1) {
            soup.corners.insert(soup.corners.end(), sides[i].corners.begin(), sides[i].corners.end());
            close_polygon(soup, file);
            if (labelled) {
                const auto label = labels.find(sides[i].key);
                soup.extras.face_labels.push_back(label == labels.end() ? 0 : label->second);
            }
        }
        i = end;
    }
}

void check_corner(std::int64_t corner, const PolygonSoup& soup, const std::string& file, const std::string& element) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(soup.points.size()))
        fail_input(file, fmt::format("{} names vertex {} of {}", element, corner, soup.points.size()),
                   "the file is damaged; export it again");
}

void check_cells(const PolygonSoup& soup, const std::string& file) {
    for (std::size_t i = 0; i < soup.extras.tetrahedra.size(); ++i) {
        Tetrahedron sorted = soup.extras.tetrahedra[i];
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            fail_input(file, fmt::format("tetrahedron {} names a vertex twice", i), "correct the file");
    }
}

class MeditReader {
public:
    MeditReader(std::string_view text, const std::string& file) : reader_(text, file, '#'), file_(file) {}

    PolygonSoup read() {
        while (reader_.skip_space()) {
            const std::string word(reader_.word());
            if (word == "End") break;
            if (word == "MeshVersionFormatted") {
                static_cast<void>(number("the version"));
            } else if (word == "Dimension") {
                if (number("the dimension") != 3) reader_.fail("the mesh is not three-dimensional", "give a mesh in space");
            } else if (word == "Vertices") {
                vertices();
            } else if (word == "Triangles") {
                polygons(3);
            } else if (word == "Quadrilaterals") {
                polygons(4);
            } else if (word == "Tetrahedra") {
                tetrahedra();
            } else {
                skip_section(word);
            }
        }
        if (std::all_of(labels_.begin(), labels_.end(), [](std::int32_t l) { return l == 0; })) labels_.clear();
        soup_.extras.face_labels = std::move(labels_);
        check_cells(soup_, file_);
        extract_surface(soup_, file_);
        return std::move(soup_);
    }

private:
    std::int64_t number(const char* quantity) {
        if (!reader_.skip_space())
            reader_.fail(fmt::format("the file ends where {} is expected", quantity), "the file is cut off");
        return reader_.integer(quantity);
    }
    std::size_t count() {
        const std::int64_t value = number("a count");
        // An entry has at least two bytes.
        if (value < 0 || static_cast<std::size_t>(value) > reader_.remaining() / 2 + 1)
            reader_.fail(fmt::format("a section of {} entries does not fit the file", value), "the file is cut off");
        return static_cast<std::size_t>(value);
    }
    void vertices() {
        const std::size_t n = count();
        for (std::size_t i = 0; i < n; ++i) {
            if (!reader_.skip_space()) reader_.fail("the file ends among the vertices", "the file is cut off");
            const double x = reader_.finite("x"), y = reader_.finite("y"), z = reader_.finite("z");
            soup_.points.push_back({x, y, z});
            if (!reader_.line_done()) static_cast<void>(reader_.word());  // its reference
        }
    }
    Index corner() {
        const std::int64_t v = number("a vertex") - 1;
        check_corner(v, soup_, file_, "an element");
        return static_cast<Index>(v);
    }
    std::int32_t reference() {
        return reader_.line_done()
                   ? 0
                   : static_cast<std::int32_t>(std::clamp<std::int64_t>(reader_.integer("a reference"), INT32_MIN, INT32_MAX));
    }
    void polygons(int sides) {
        const std::size_t n = count();
        for (std::size_t i = 0; i < n; ++i) {
            for (int k = 0; k < sides; ++k) soup_.corners.push_back(corner());
            close_polygon(soup_, file_);
            labels_.push_back(reference());
        }
    }
    void tetrahedra() {
        const std::size_t n = count();
        for (std::size_t i = 0; i < n; ++i) {
            Tetrahedron t{};
            for (Index& v : t) v = corner();
            soup_.extras.tetrahedra.push_back(t);
            static_cast<void>(reference());
        }
    }
    /// Skips a section that is not kept: a count, then one line per entry.
    void skip_section(const std::string& word) {
        if (word.empty() || !std::isalpha(static_cast<unsigned char>(word.front())))
            reader_.fail(fmt::format("expected a section instead of {}", in_quotes(word)), "export it again as text (.mesh)");
        const std::size_t n = count();
        for (std::size_t i = 0; i < n; ++i)
            if (!reader_.next_line()) break;
        while (!reader_.line_done()) static_cast<void>(reader_.word());
        if (n > 0) soup_.notes.push_back(fmt::format("the section {} is not kept", in_quotes(word)));
    }

    TextReader reader_;
    const std::string& file_;
    PolygonSoup soup_;
    std::vector<std::int32_t> labels_;
};

/// The numbers of a DataArray, which must be text.
template <class Number>
std::vector<Number> numbers_of(const pugi::xml_node& array, const std::string& file, const char* content) {
    if (!array) fail_input(file, std::string("has no ") + content, "export it again");
    if (const std::string format = array.attribute("format").value(); format != "ascii")
        fail_input(file, fmt::format("has its {} in the format '{}'", content, format), "write it as text (ascii)");
    std::vector<Number> values;
    const std::string_view text = array.text().get();
    const char *position = text.data(), *const end = text.data() + text.size();
    while (true) {
        while (position != end && (*position == ' ' || *position == '\n' || *position == '\t' || *position == '\r')) ++position;
        if (position == end) return values;
        Number value{};
        const auto [next, code] = std::from_chars(position, end, value);
        if (code != std::errc()) fail_input(file, std::string("has an invalid number in its ") + content, "export it again");
        values.push_back(value);
        position = next;
    }
}

pugi::xml_node array_named(const pugi::xml_node& parent, const char* name) {
    for (const pugi::xml_node& array : parent.children("DataArray"))
        if (std::string(array.attribute("Name").value()) == name) return array;
    return {};
}

enum : std::int64_t { vtk_triangle = 5, vtk_polygon = 7, vtk_quad = 9, vtk_tetrahedron = 10 };

void write_labels_note(const MeshExtras& extras, const char* format, Notes& notes) {
    if (!extras.vertex_labels.empty()) notes.push_back(std::string(format) + " cannot store labels of vertices");
    if (!extras.vertex_colours.empty() || !extras.face_colours.empty())
        notes.push_back(std::string(format) + " cannot store colours");
    if (!extras.corner_texture.empty()) notes.push_back(std::string(format) + " cannot store texture coordinates");
    if (!extras.appearance.empty()) notes.push_back(std::string(format) + " cannot store materials and images");
}

}  // namespace

PolygonSoup read_medit(std::string& bytes, const std::string& file) {
    normalise_text(bytes);
    return MeditReader(bytes, file).read();
}

PolygonSoup read_vtu(const std::string& bytes, const std::string& file) {
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer(bytes.data(), bytes.size()); !parsed)
        fail_input(file, fmt::format("is not valid XML: {} at byte {}", parsed.description(), parsed.offset),
                   "export it again as text (.vtu)");
    const pugi::xml_node grid = document.child("VTKFile").child("UnstructuredGrid"), piece = grid.child("Piece");
    if (!piece) fail_input(file, "is not a VTK file with an unstructured grid", "export it as .vtu");
    if (piece.next_sibling("Piece")) fail_input(file, "has several pieces", "write it as one");
    PolygonSoup soup;
    const auto coordinates = numbers_of<double>(piece.child("Points").child("DataArray"), file, "points");
    if (coordinates.size() % 3 != 0) fail_input(file, "has points without three coordinates each", "export it again");
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k)
            if (!std::isfinite(coordinates[i + k]))
                fail_input(file, fmt::format("point {} is not finite", i / 3), "give finite coordinates");
        soup.points.push_back({coordinates[i], coordinates[i + 1], coordinates[i + 2]});
    }
    const pugi::xml_node cells = piece.child("Cells");
    const auto corners = numbers_of<std::int64_t>(array_named(cells, "connectivity"), file, "connectivity"),
               offsets = numbers_of<std::int64_t>(array_named(cells, "offsets"), file, "offsets"),
               types = numbers_of<std::int64_t>(array_named(cells, "types"), file, "types");
    if (offsets.size() != types.size()) fail_input(file, "has different numbers of offsets and types", "export it again");
    std::vector<std::int64_t> labels;
    if (const pugi::xml_node array = array_named(piece.child("CellData"), "label"))
        labels = numbers_of<std::int64_t>(array, file, "labels");
    if (!labels.empty() && labels.size() != types.size())
        fail_input(file, "has different numbers of labels and cells", "give one label per cell");
    std::size_t unsupported = 0;
    for (std::size_t i = 0, begin = 0; i < offsets.size(); ++i) {
        const auto end = static_cast<std::size_t>(std::max<std::int64_t>(offsets[i], 0));
        if (end < begin || end > corners.size())
            fail_input(file, "has offsets that do not ascend within its connectivity", "correct or regenerate the file");
        const std::size_t n = end - begin;
        for (std::size_t k = begin; k < end; ++k) check_corner(corners[k], soup, file, "cell " + std::to_string(i));
        if (types[i] == vtk_tetrahedron && n == 4) {
            Tetrahedron t{};
            for (std::size_t k = 0; k < 4; ++k) t[k] = static_cast<Index>(corners[begin + k]);
            soup.extras.tetrahedra.push_back(t);
        } else if ((types[i] == vtk_triangle && n == 3) || (types[i] == vtk_quad && n == 4) ||
                   (types[i] == vtk_polygon && n > 2)) {
            for (std::size_t k = begin; k < end; ++k) soup.corners.push_back(static_cast<Index>(corners[k]));
            close_polygon(soup, file);
            if (!labels.empty()) soup.extras.face_labels.push_back(static_cast<std::int32_t>(labels[i]));
        } else {
            ++unsupported;
        }
        begin = end;
    }
    if (unsupported > 0)
        soup.notes.push_back(std::to_string(unsupported) + " cells are neither polygons nor tetrahedra, and not kept");
    check_cells(soup, file);
    extract_surface(soup, file);
    return soup;
}

Notes write_medit(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    TextWriter writer(file);
    writer.text("MeshVersionFormatted 2\n");
    if (!options.comment.empty()) writer.text(fmt::format("# {}\n", one_line(options.comment)));
    writer.text(fmt::format("Dimension 3\nVertices\n{}\n", soup.points.size()));
    for (const auto& [x, y, z] : soup.points) writer.row({x, y, z}, " 0\n");
    writer.text(fmt::format("Triangles\n{}\n", soup.triangles.size()));
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto [a, b, c] = soup.triangles[t];
        writer.row<std::int64_t>({a + 1, b + 1, c + 1, extras.face_labels.empty() ? 0 : extras.face_labels[t]});
    }
    if (!extras.tetrahedra.empty()) {
        writer.text(fmt::format("Tetrahedra\n{}\n", extras.tetrahedra.size()));
        for (const auto& [a, b, c, d] : extras.tetrahedra) writer.row({a + 1, b + 1, c + 1, d + 1}, " 0\n");
    }
    writer.text("End\n");
    writer.commit();
    Notes notes;
    write_labels_note(extras, "Medit's format", notes);
    return notes;
}

Notes write_vtu(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions&) {
    TextWriter writer(file);
    const std::size_t triangles = soup.triangles.size(), cells = triangles + extras.tetrahedra.size();
    writer.text(
        fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                    "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
                    "NumberOfCells=\"{}\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n",
                    soup.points.size(), cells));
    for (const auto& [x, y, z] : soup.points) writer.row({x, y, z});
    writer.text("</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n");
    for (const auto& t : soup.triangles) {
        writer.numbers({t[0], t[1], t[2]});
        writer.end_line();
    }
    for (const Tetrahedron& t : extras.tetrahedra) {
        writer.numbers({t[0], t[1], t[2], t[3]});
        writer.end_line();
    }
    writer.text("</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
    for (std::size_t i = 0; i < cells; ++i) writer.row({i < triangles ? 3 * (i + 1) : 3 * triangles + 4 * (i + 1 - triangles)});
    writer.text("</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
    for (std::size_t i = 0; i < cells; ++i) writer.text(i < triangles ? "5\n" : "10\n");
    writer.text("</DataArray>\n</Cells>\n");
    if (!extras.face_labels.empty()) {
        writer.text("<CellData>\n<DataArray type=\"Int32\" Name=\"label\" format=\"ascii\">\n");
        for (std::size_t i = 0; i < cells; ++i) writer.row({i < triangles ? extras.face_labels[i] : 0});
        writer.text("</DataArray>\n</CellData>\n");
    }
    writer.text("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    writer.commit();
    Notes notes;
    write_labels_note(extras, "VTU (as written here)", notes);
    return notes;
}

}  // namespace ostraka::io

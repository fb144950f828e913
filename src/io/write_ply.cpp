#include "io/materials.h"
#include "io/text_writer.h"
#include "ostraka/files/transaction.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::io {

namespace {

bool has_alpha(const std::vector<Colour>& colours) {
    return std::any_of(colours.begin(), colours.end(), [](const Colour& c) { return c[3] != 255; });
}

std::string colour_properties(bool alpha) {
    return std::string("property uchar red\nproperty uchar green\nproperty uchar blue\n") +
           (alpha ? "property uchar alpha\n" : "");
}

/// Writes values as words on lines or as bytes.
class Values {
public:
    Values(TextWriter& writer, bool ascii) : writer_(writer), ascii_(ascii) {}
    template <class T>
    void put(T value) {
        if (!ascii_) {
            writer_.bytes(value);
            return;
        }
        if (!first_) writer_.character(' ');
        first_ = false;
        if constexpr (std::is_same_v<T, std::uint8_t>) writer_.number(static_cast<unsigned>(value));
        else writer_.number(value);
    }
    void colour(const Colour& colour, bool alpha) {
        for (std::size_t k = 0; k < (alpha ? 4 : 3); ++k) put(colour[k]);
    }
    void end_element() {
        if (ascii_) writer_.character('\n');
        first_ = true;
        writer_.flush_if_full();
    }

private:
    TextWriter& writer_;
    bool ascii_, first_ = true;
};

/// A list of named values as a property: float if each value is a float, else double.
class ValueColumn {
public:
    explicit ValueColumn(const NamedValues& column) : values_(column.values), name_(property_name(column.name)) {
        for (const double x : values_)
            is_float_ = is_float_ && (std::isnan(x) || static_cast<double>(static_cast<float>(x)) == x);
    }
    [[nodiscard]] std::string declaration() const {
        return fmt::format("property {} {}\n", is_float_ ? "float" : "double", name_);
    }
    void put(Values& out, std::size_t element) const {
        if (is_float_) out.put(static_cast<float>(values_[element]));
        else out.put(values_[element]);
    }

private:
    /// A name in one word.
    static std::string property_name(const std::string& name) {
        std::string word = without_controls(name, "_");
        std::replace(word.begin(), word.end(), ' ', '_');
        return word.empty() ? "value" : word;
    }
    const std::vector<double>& values_;
    std::string name_;
    bool is_float_ = true;
};

std::vector<ValueColumn> columns_of(const std::vector<NamedValues>& lists) {
    return std::vector<ValueColumn>(lists.begin(), lists.end());
}

/// The images of the materials as PLY files name them: comments with the names of image files, and a number for each face.
struct PlyImages {
    std::vector<std::string> names;                ///< names of the image files
    std::vector<std::int32_t> number_of_material;  ///< number of each material's image; -1: none
    bool are_faces_numbered = false;               ///< true: the faces have different images, or some have none
    [[nodiscard]] std::int32_t number(const MeshExtras& extras, std::size_t face) const {
        const Index material = extras.face_materials[face];
        return material == no_index ? -1 : number_of_material[material];
    }
};

PlyImages ply_images(const MeshExtras& extras, ImageFiles& files) {
    PlyImages images;
    for (const Material& material : extras.appearance.materials) {
        std::string name;
        if (material.image != no_index) name = files.use(material.image);
        if (name.empty()) name = missing_image(material);
        const auto entry = std::find(images.names.begin(), images.names.end(), name);
        images.number_of_material.push_back(name.empty() ? -1 : static_cast<std::int32_t>(entry - images.names.begin()));
        if (!name.empty() && entry == images.names.end()) images.names.push_back(name);
    }
    if (extras.face_materials.empty()) images.names.clear();
    for (std::size_t f = 0; f < extras.face_materials.size() && !images.names.empty(); ++f)
        images.are_faces_numbered = images.are_faces_numbered || images.number(extras, f) != 0;
    images.are_faces_numbered = images.are_faces_numbered || images.names.size() > 1;
    return images;
}

/// Colours of faces from the colours of materials, for meshes without images and without other colours.
std::vector<Colour> colours_of_materials(const MeshExtras& extras) {
    std::vector<Colour> colours;
    for (const Index m : extras.face_materials) {
        Colour& colour = colours.emplace_back(white);
        if (m == no_index) continue;
        const auto& base = extras.appearance.materials[m].base_colour;
        for (std::size_t k = 0; k < 3; ++k) colour[k] = srgb_from_linear(base[k]);
        colour[3] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(base[3], 0.0F, 1.0F)));
    }
    return colours;
}

class PlyWriter {
public:
    PlyWriter(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const std::vector<Colour>& face_colours,
              const PlyImages& images, const WriteOptions& options)
        : writer_(file),
          soup_(soup),
          extras_(extras),
          face_colours_(face_colours),
          images_(images),
          faces_(soup, options),
          ascii_(options.encoding == Encoding::ascii),
          vertex_alpha_(has_alpha(extras.vertex_colours)),
          face_alpha_(has_alpha(face_colours)),
          vertex_columns_(columns_of(extras.vertex_values)),
          face_columns_(columns_of(extras.face_values)) {
        for (std::size_t t = 0; t < faces_.size(); ++t) max_corners_ = std::max(max_corners_, faces_.corners(t).size());
    }

    void header(const std::string& comment) {
        const auto& extras = extras_;
        std::string header = fmt::format("ply\nformat {} 1.0\n", ascii_ ? "ascii" : "binary_little_endian");
        if (!comment.empty()) header += fmt::format("comment {}\n", one_line(comment));
        for (const std::string& name : images_.names) header += fmt::format("comment TextureFile {}\n", one_line(name));
        header +=
            fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", soup_.points.size());
        if (!extras.vertex_colours.empty()) header += colour_properties(vertex_alpha_);
        if (!extras.vertex_labels.empty()) header += "property int label\n";
        for (const ValueColumn& column : vertex_columns_) header += column.declaration();
        header += fmt::format("element face {}\nproperty list {} int vertex_indices\n", faces_.size(),
                              max_corners_ > 255 ? "int" : "uchar");
        if (!extras.corner_texture.empty())
            header += fmt::format("property list {} float texcoord\n", max_corners_ > 127 ? "int" : "uchar");
        if (images_.are_faces_numbered) header += "property int texnumber\n";
        if (!face_colours_.empty()) header += colour_properties(face_alpha_);
        if (!extras.face_labels.empty()) header += "property int label\n";
        for (const ValueColumn& column : face_columns_) header += column.declaration();
        writer_.text(header + "end_header\n");
    }

    void vertices() {
        Values values(writer_, ascii_);
        for (std::size_t v = 0; v < soup_.points.size(); ++v) {
            for (const double x : soup_.points[v]) values.put(x);
            if (!extras_.vertex_colours.empty()) values.colour(extras_.vertex_colours[v], vertex_alpha_);
            if (!extras_.vertex_labels.empty()) values.put(extras_.vertex_labels[v]);
            for (const ValueColumn& column : vertex_columns_) column.put(values, v);
            values.end_element();
        }
    }

    void faces() {
        Values values(writer_, ascii_);
        const auto put_count = [&values](std::size_t count, bool wide) {
            if (wide) values.put(static_cast<Index>(count));
            else values.put(static_cast<std::uint8_t>(count));
        };
        std::size_t first_corner = 0;
        for (std::size_t t = 0; t < faces_.size(); ++t) {
            const auto corners = faces_.corners(t);
            put_count(corners.size(), max_corners_ > 255);
            for (const Index v : corners) values.put(v);
            if (!extras_.corner_texture.empty()) {
                put_count(2 * corners.size(), max_corners_ > 127);
                for (std::size_t k = 0; k < corners.size(); ++k)
                    for (const float x : extras_.corner_texture.at(first_corner + k)) values.put(x);
            }
            if (images_.are_faces_numbered) values.put(images_.number(extras_, t));
            if (!face_colours_.empty()) values.colour(face_colours_[t], face_alpha_);
            if (!extras_.face_labels.empty()) values.put(extras_.face_labels[t]);
            for (const ValueColumn& column : face_columns_) column.put(values, t);
            values.end_element();
            first_corner += corners.size();
        }
    }

    void commit() { writer_.commit(); }

private:
    TextWriter writer_;
    const TriangleSoup& soup_;
    const MeshExtras& extras_;
    const std::vector<Colour>& face_colours_;
    const PlyImages& images_;
    WrittenFaces faces_;
    bool ascii_, vertex_alpha_, face_alpha_;
    std::vector<ValueColumn> vertex_columns_, face_columns_;
    std::size_t max_corners_ = 3;
};

bool is_coloured(const Material& material) { return material.base_colour != std::array<float, 4>{1, 1, 1, 1}; }

/// Notes about what PLY cannot store of the materials.
void note_material_losses(const MeshExtras& extras, bool colours_of_faces, Notes& notes) {
    const auto is_special = [](const Material& material) {
        const bool is_missing = !missing_image(material).empty();
        return material.wrap_u != TextureWrap::repeat || material.wrap_v != TextureWrap::repeat || material.nearest ||
               material.alpha != Material::Alpha::opaque || !material.double_sided || !material.gltf_rest.empty() ||
               material.mtl_rest.size() > (is_missing ? 1 : 0);
    };
    const auto& materials = extras.appearance.materials;
    if (colours_of_faces) notes.emplace_back("colours of materials are written as colours of faces");
    else if (std::any_of(materials.begin(), materials.end(), is_coloured))
        notes.emplace_back("PLY cannot store colours of materials");
    if (std::any_of(materials.begin(), materials.end(), is_special))
        notes.emplace_back("PLY stores only the images of materials");
}

}  // namespace

Notes write_ply(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    std::optional<OutputTransaction> transaction;  // unless the caller has one
    if (current_transaction() == nullptr) transaction.emplace();
    ImageFiles files(extras.appearance, file);
    const PlyImages images = ply_images(extras, files);
    const auto& materials = extras.appearance.materials;
    const bool colours_of_faces = images.names.empty() && extras.face_colours.empty() && extras.vertex_colours.empty() &&
                                  !extras.face_materials.empty() && std::any_of(materials.begin(), materials.end(), is_coloured);
    const std::vector<Colour> material_colours = colours_of_faces ? colours_of_materials(extras) : std::vector<Colour>();
    if (!images.names.empty()) files.write();
    PlyWriter writer(file, soup, extras, colours_of_faces ? material_colours : extras.face_colours, images, options);
    writer.header(options.comment);
    writer.vertices();
    writer.faces();
    writer.commit();
    if (transaction) transaction->commit();
    Notes notes;
    note_material_losses(extras, colours_of_faces, notes);
    return notes;
}

}  // namespace ostraka::io

#include "io/materials.h"
#include "io/text_writer.h"
#include "ostraka/files/transaction.h"

#include <fmt/core.h>

#include <stdexcept>

namespace ostraka::io {

namespace {

/// Writes the statements of an OBJ file.
class ObjWriter {
public:
    ObjWriter(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options)
        : writer_(file), soup_(soup), extras_(extras), faces_(soup, options) {}

    void header(const std::string& comment, const std::string& material_file) {
        if (!comment.empty()) writer_.text(fmt::format("# {}\n", one_line(comment)));
        if (!material_file.empty()) writer_.text(fmt::format("mtllib {}\n", material_file));
    }

    void vertices() {
        for (std::size_t v = 0; v < soup_.points.size(); ++v) {
            writer_.character('v');
            for (const double x : soup_.points[v]) writer_.numbers({x});
            if (!extras_.vertex_colours.empty())
                for (std::size_t k = 0; k < 3; ++k) writer_.numbers({static_cast<float>(extras_.vertex_colours[v][k]) / 255.0F});
            writer_.end_line();
        }
    }

    /// Triangles share the texture coordinates of a vertex; corners of polygons have their own.
    void texture_coordinates(bool are_triangles) {
        if (extras_.corner_texture.empty()) return;
        if (are_triangles) {
            TexturedVertices pairs = textured_vertices(soup_, extras_.corner_texture);
            // Vertices without faces need no texture coordinates: the remaining pairs are numbered again.
            std::vector<Index> number(pairs.vertex.size(), no_index);
            for (const Index pair : pairs.pair_of_corner) number[pair] = 0;
            Index count = 0;
            for (std::size_t pair = 0; pair < number.size(); ++pair) {
                if (number[pair] == no_index) continue;
                number[pair] = count++;
                texture_coordinate(pairs.texture[pair]);
            }
            texture_of_corner_ = std::move(pairs.pair_of_corner);
            for (Index& pair : texture_of_corner_) pair = number[pair];
            return;
        }
        for (const TexturePoint& point : extras_.corner_texture) {
            texture_of_corner_.push_back(static_cast<Index>(texture_of_corner_.size()));
            texture_coordinate(point);
        }
    }

    void faces(const std::vector<std::string>& material_names) {
        std::size_t corner = 0;
        Index material = no_index;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const Index material_of_face = extras_.face_materials.empty() ? no_index : extras_.face_materials[f];
            if (material_of_face != material) {
                material = material_of_face;
                writer_.text(fmt::format("usemtl {}\n", material == no_index ? "(null)" : material_names[material]));
            }
            writer_.character('f');
            for (const Index v : faces_.corners(f)) {
                writer_.character(' ');
                writer_.number(static_cast<std::uint64_t>(v) + 1);
                if (!texture_of_corner_.empty()) {
                    writer_.character('/');
                    writer_.number(static_cast<std::uint64_t>(texture_of_corner_.at(corner)) + 1);
                }
                ++corner;
            }
            writer_.end_line();
        }
    }

    void commit() { writer_.commit(); }

private:
    void texture_coordinate(const TexturePoint& point) {
        writer_.text("vt");
        writer_.numbers({point[0], point[1]});
        writer_.end_line();
    }

    TextWriter writer_;
    const TriangleSoup& soup_;
    const MeshExtras& extras_;
    WrittenFaces faces_;
    std::vector<Index> texture_of_corner_;  ///< number of the texture coordinates of each corner, from 0; or empty
};

}  // namespace

Notes write_obj(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    std::optional<OutputTransaction> transaction;  // unless the caller has one
    if (current_transaction() == nullptr) transaction.emplace();
    Notes notes;
    std::vector<std::string> names;
    std::string material_file;
    if (!extras.appearance.empty()) {
        names = material_names(extras.appearance);
        material_file = file.stem().string() + ".mtl";
        ImageFiles images(extras.appearance, file);
        notes = write_mtl(file.parent_path() / material_file, extras.appearance, names, images, options.comment);
        images.write();
    }
    ObjWriter writer(file, soup, extras, options);
    writer.header(options.comment, material_file);
    writer.vertices();
    writer.texture_coordinates(options.polygons.empty());
    writer.faces(names);
    writer.commit();
    if (transaction) transaction->commit();
    for (const Colour& colour : extras.vertex_colours)
        if (colour[3] != 255) {
            notes.emplace_back("OBJ cannot store the opacity of colours");
            break;
        }
    if (!extras.face_colours.empty()) notes.emplace_back("OBJ cannot store colours of faces");
    if (!extras.vertex_labels.empty()) notes.emplace_back("OBJ cannot store labels of vertices");
    if (!extras.face_labels.empty()) notes.emplace_back("OBJ cannot store labels of faces");
    return notes;
}

}  // namespace ostraka::io

#include "io/formats.h"
#include "io/three_mf.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka::io {

namespace {

/// The placement `inner`, followed by `outer`.
Placement combined(const Placement& inner, const Placement& outer) {
    Placement result{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            double sum = row == 3 ? outer[9 + column] : 0;
            for (std::size_t k = 0; k < 3; ++k) sum += inner[3 * row + k] * outer[3 * k + column];
            result[3 * row + column] = sum;
        }
    return result;
}

double determinant(const Placement& m) {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// Puts the objects of a model into one mesh.
class ModelAssembly {
public:
    ModelAssembly(const Model& model, std::string file, std::size_t max_bytes)
        : model_(model), file_(std::move(file)), room_(max_bytes) {}

    void add(const PlacedObject& placed, int depth = 0) {
        constexpr int max_depth = 64;
        if (depth > max_depth) fail_input(file_, "has objects that contain each other, or nested deeper than 64 levels");
        const auto entry = model_.objects.find(placed.object);
        if (entry == model_.objects.end())
            fail_input(
                file_,
                fmt::format("names object {} of {}, which is missing", placed.object.second, printable(placed.object.first, 200)),
                "export the file again");
        const ModelObject& object = entry->second;
        take(64 + object.points.size() * 48 + object.triangles.size() * 40);
        if (!object.triangles.empty()) add_mesh(object, placed.placement);
        for (const PlacedObject& component : object.components)
            add({component.object, combined(component.placement, placed.placement)}, depth + 1);
    }

    PolygonSoup finish() {
        const std::size_t count = soup_.polygon_count();
        if (!soup_.extras.face_colours.empty()) soup_.extras.face_colours.resize(count, white);
        if (!soup_.extras.face_materials.empty()) {
            soup_.extras.face_materials.resize(count, no_index);
            soup_.extras.corner_texture.resize(3 * count, TexturePoint{0, 0});
        }
        return std::move(soup_);
    }

private:
    void take(std::size_t bytes) {
        if (bytes > room_)
            fail_input(file_, "repeats its objects more often than a file of this size may",
                       "such files are made to exhaust memory; get the file from another source");
        room_ -= bytes;
    }

    void add_mesh(const ModelObject& object, const Placement& m) {
        const std::size_t first_point = soup_.points.size(), first_triangle = soup_.polygon_count();
        for (const auto& [x, y, z] : object.points) {
            std::array<double, 3> point{};
            for (std::size_t k = 0; k < 3; ++k) point[k] = x * m[k] + y * m[3 + k] + z * m[6 + k] + m[9 + k];
            if (!(std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2])))
                fail_input(file_, "has a transform that moves vertices to infinity", "export the file again");
            soup_.points.push_back(point);
        }
        if (soup_.points.size() >= no_index) fail_work(file_, "has more than four thousand million vertices", "split it");
        const bool is_mirrored = determinant(m) < 0;
        const std::array<std::size_t, 3> order =
            is_mirrored ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2};
        auto& extras = soup_.extras;
        if (!object.colours.empty()) {
            extras.face_colours.resize(first_triangle, white);
            extras.face_colours.insert(extras.face_colours.end(), object.colours.begin(), object.colours.end());
        }
        if (!object.textures.empty()) {
            extras.face_materials.resize(first_triangle, no_index);
            extras.face_materials.insert(extras.face_materials.end(), object.textures.begin(), object.textures.end());
            extras.corner_texture.resize(3 * first_triangle, TexturePoint{0, 0});
        }
        for (std::size_t t = 0; t < object.triangles.size(); ++t) {
            for (const std::size_t k : order) {
                soup_.corners.push_back(static_cast<Index>(first_point + object.triangles[t][k]));
                if (!object.textures.empty()) extras.corner_texture.push_back(object.coordinates[t][k]);
            }
            close_polygon(soup_, file_);
        }
        // Objects without these data follow: their elements are filled in before the next list, or at the end.
    }

    const Model& model_;
    std::string file_;
    std::size_t room_;
    PolygonSoup soup_;
};

/// Makes a material of each image of the model.
void add_textures(PolygonSoup& soup, const Model& model, const ZipArchive& archive, std::size_t max_bytes,
                  const std::string& file) {
    auto& [materials, images] = soup.extras.appearance;
    for (const ModelTexture& texture : model.textures) {
        Material& material = materials.emplace_back();
        material.name = Path(texture.path).filename().string();
        material.wrap_u = texture.wrap_u;
        material.wrap_v = texture.wrap_v;
        material.nearest = texture.nearest;
        material.image = static_cast<Index>(images.size());
        images.push_back(nullptr);
        const std::string where = fmt::format("{}, {}", file, printable(texture.path, 200));
        try {
            std::string bytes = archive.read(texture.path, max_bytes);
            max_bytes -= bytes.size();
            images.back() = std::make_shared<const Image>(parse_image(std::move(bytes), material.name, where));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            soup.notes.push_back(fmt::format("an image is not kept: {}", error.what()));
        }
    }
}

}  // namespace

PolygonSoup read_3mf(const std::string& bytes, const std::string& file) {
    const std::size_t room = (std::size_t{64} << 20) + 4 * bytes.size();  // for the parts, the mesh, and the images
    const ZipArchive archive(bytes, file);
    Model model = read_model(archive, file, room);
    if (model.build.empty()) {
        for (const auto& [key, object] : model.objects)
            if (!object.triangles.empty()) model.build.push_back({key, no_placement});
        if (!model.build.empty()) model.notes.emplace_back("the file builds nothing: all its meshes were read");
    }
    ModelAssembly assembly(model, file, 2 * room);
    for (const PlacedObject& item : model.build) assembly.add(item);
    PolygonSoup soup = assembly.finish();
    soup.notes = std::move(model.notes);
    soup.notes.push_back(fmt::format("the unit of length is {}", model.unit));
    if (!soup.extras.face_materials.empty()) add_textures(soup, model, archive, room, file);
    return soup;
}

}  // namespace ostraka::io

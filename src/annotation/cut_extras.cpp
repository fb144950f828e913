#include "ostraka/annotation/cut_extras.h"

#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// A vertex of the cut mesh as a mean of the corners of an uncut face.
struct CornerMean {
    std::array<Index, 3> vertices{};
    std::array<double, 3> weights{};
    [[nodiscard]] Index nearest() const {
        const auto largest = std::max_element(weights.begin(), weights.end()) - weights.begin();
        return vertices[static_cast<std::size_t>(largest)];
    }
};

class ExtrasOfCutMesh {
public:
    ExtrasOfCutMesh(const CutMesh& cut, const Mesh& before) : cut_(cut), before_(before) {
        means_.resize(cut.mesh.number_of_vertices());
        for (std::size_t v = 0; v < std::min(cut.old_vertices, means_.size()); ++v)
            means_[v] = {{static_cast<Index>(v), static_cast<Index>(v), static_cast<Index>(v)}, {1, 0, 0}};
        for (const Face face : cut.mesh.faces())
            for (const Vertex v : corners(cut.mesh, face))
                if (v.idx() >= cut.old_vertices) means_[v.idx()] = mean_at(face, v);
    }

    [[nodiscard]] std::vector<TexturePoint> corner_texture(const std::vector<TexturePoint>& texture) const {
        std::vector<TexturePoint> result;
        if (texture.empty()) return result;
        result.reserve(3 * cut_.mesh.number_of_faces());
        for (const Face face : cut_.mesh.faces()) {
            const std::size_t first = 3 * std::size_t{cut_.face_origin[face.idx()]};
            for (const Vertex v : corners(cut_.mesh, face)) {
                const CornerMean mean = mean_at(face, v);
                TexturePoint at{};
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t side = 0; side < 2; ++side)
                        if (mean.weights[k] != 0) at[side] += static_cast<float>(mean.weights[k]) * texture[first + k][side];
                result.push_back(at);
            }
        }
        return result;
    }

    [[nodiscard]] std::vector<Colour> vertex_colours(const std::vector<Colour>& colours) const {
        std::vector<Colour> result;
        for (std::size_t v = 0; !colours.empty() && v < means_.size(); ++v) {
            Colour& colour = result.emplace_back();
            for (std::size_t channel = 0; channel < 4; ++channel) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k) sum += means_[v].weights[k] * colours[means_[v].vertices[k]][channel];
                colour[channel] = static_cast<std::uint8_t>(std::lround(std::clamp(sum, 0.0, 255.0)));
            }
        }
        return result;
    }

    [[nodiscard]] std::vector<std::int32_t> vertex_labels(const std::vector<std::int32_t>& labels) const {
        std::vector<std::int32_t> result;
        for (std::size_t v = 0; !labels.empty() && v < means_.size(); ++v) result.push_back(labels[means_[v].nearest()]);
        return result;
    }

private:
    /// The vertex of this face of the cut mesh in the uncut face; exact at its corners.
    [[nodiscard]] CornerMean mean_at(Face face, Vertex v) const {
        CornerMean mean;
        const auto vertices = corners(before_, Face(cut_.face_origin[face.idx()]));
        for (std::size_t k = 0; k < 3; ++k) mean.vertices[k] = vertices[k].idx();
        for (std::size_t k = 0; k < 3; ++k)
            if (mean.vertices[k] == v.idx()) return mean.weights[k] = 1, mean;
        mean.weights = nearest_barycentric(before_.point(vertices[0]), before_.point(vertices[1]), before_.point(vertices[2]),
                                           cut_.mesh.point(v));
        return mean;
    }

    const CutMesh& cut_;
    const Mesh& before_;
    std::vector<CornerMean> means_;
};

}  // namespace

MeshExtras cut_extras(const CutMesh& cut, const Mesh& before, const MeshExtras& extras) {
    const ExtrasOfCutMesh of_cut(cut, before);
    MeshExtras result;
    const auto faces = [&](const auto& values) { return values.empty() ? values : cut.face_values(values); };
    result.vertex_colours = of_cut.vertex_colours(extras.vertex_colours);
    result.face_colours = faces(extras.face_colours);
    result.vertex_labels = of_cut.vertex_labels(extras.vertex_labels);
    result.face_labels = faces(extras.face_labels);
    result.corner_texture = of_cut.corner_texture(extras.corner_texture);
    result.face_materials = faces(extras.face_materials);
    result.appearance = extras.appearance;
    for (const NamedValues& named : extras.vertex_values)
        result.vertex_values.push_back({named.name, cut.vertex_values(before, named.values)});
    for (const NamedValues& named : extras.face_values) result.face_values.push_back({named.name, faces(named.values)});
    return result;
}

}  // namespace ostraka

#include "texture/target_bands.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::texture {

namespace {

constexpr int band_rows = 32;
constexpr double fringe = 1.5;  ///< width of the border of charts that texels outside show, in texels

}  // namespace

void check_layout(const Mesh& mesh, const TextureLayout& layout) {
    const std::size_t faces = mesh.number_of_faces();
    if (layout.corner_texture.size() != 3 * faces || (!layout.face_image.empty() && layout.face_image.size() != faces))
        fail_usage("the texture coordinates do not fit the mesh", "give three texture coordinates and one image per face");
    if (layout.images == 0) fail_usage("there is no image", "give the number of images");
    if (layout.width < 1 || layout.height < 1 || layout.width > max_image_side || layout.height > max_image_side ||
        static_cast<std::int64_t>(layout.width) * layout.height > max_image_pixels)
        fail_usage("the size of the images is out of range", "give a size that images can have");
    for (std::size_t face = 0; face < faces; ++face)
        if (layout.image_of(face) != no_index && layout.image_of(face) >= layout.images)
            fail_usage("a face lies in an image that does not exist", "give the number of images");
}

TargetBands::TargetBands(const Mesh& mesh, const TextureLayout& layout, int samples)
    : mesh_(mesh), layout_(layout), samples_(samples) {
    make_bands();
    find_borders();
}

Vector2d TargetBands::texel_point(Index face, std::size_t corner) const {
    const TexturePoint& at = layout_.corner_texture[3 * static_cast<std::size_t>(face) + corner];
    return {static_cast<double>(at[0]) * layout_.width, (1 - static_cast<double>(at[1])) * layout_.height};
}

void TargetBands::make_bands() {
    const int per_image = (layout_.height + band_rows - 1) / band_rows;
    for (std::size_t image = 0; image < layout_.images; ++image)
        for (int i = 0; i < per_image; ++i)
            bands_.push_back({image, i * band_rows, std::min((i + 1) * band_rows, layout_.height)});
    const double limit = max_grid_texel / 4;  // of the parts of texels, of which there are up to four per texel
    for (Index face = 0; face < mesh_.number_of_faces(); ++face) {
        const Index image = layout_.image_of(face);
        if (image == no_index) continue;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        bool drawn = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector2d at = texel_point(face, k);
            drawn = drawn && std::abs(at.x()) < limit && std::abs(at.y()) < limit;
            low = std::min(low, at.y()), high = std::max(high, at.y());
        }
        if (!drawn || high + fringe < 0 || low - fringe >= layout_.height) continue;
        const int first = std::clamp(static_cast<int>(std::floor((low - fringe) / band_rows)), 0, per_image - 1);
        const int last = std::clamp(static_cast<int>(std::floor((high + fringe) / band_rows)), 0, per_image - 1);
        for (int i = first; i <= last; ++i)
            bands_[image * static_cast<std::size_t>(per_image) + static_cast<std::size_t>(i)].faces.push_back(face);
    }
}

void TargetBands::find_borders() {
    borders_.assign(mesh_.number_of_faces(), 0);
    std::vector<Index> corner_of(mesh_.number_of_halfedges(), no_index);  // the corner at the target of a halfedge
    for (const Face face : mesh_.faces()) {
        Halfedge h = mesh_.halfedge(face);
        for (Index k = 0; k < 3; ++k, h = mesh_.next(h)) corner_of[h] = 3 * static_cast<Index>(face) + k;
    }
    const auto& texture = layout_.corner_texture;
    for (const Halfedge h : mesh_.halfedges()) {
        if (mesh_.is_border(h)) continue;
        const Halfedge other = mesh_.opposite(h);
        const Index end = corner_of[h], start = corner_of[mesh_.prev(h)];
        const bool joined = !mesh_.is_border(other) &&
                            layout_.image_of(mesh_.face(h)) == layout_.image_of(mesh_.face(other)) &&
                            texture[start] == texture[corner_of[other]] && texture[end] == texture[corner_of[mesh_.prev(other)]];
        if (!joined) borders_[mesh_.face(h)] |= static_cast<std::uint8_t>(1U << (start % 3));
    }
}

std::vector<Index> TargetBands::faces_of_parts(const Band& band) const {
    const std::int64_t width = static_cast<std::int64_t>(layout_.width) * samples_;
    const std::int64_t first = static_cast<std::int64_t>(band.first_row) * samples_;
    const std::int64_t beyond = static_cast<std::int64_t>(band.beyond_row) * samples_;
    std::vector<Index> result(static_cast<std::size_t>(width * (beyond - first)), no_index);
    for (const Index face : band.faces) {
        GridTriangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector2d at = texel_point(face, k) * samples_;
            triangle[k] = grid_point(at.x(), at.y());
        }
        for_each_span(triangle, width, first, beyond, [&](std::int64_t row, std::int64_t begin, std::int64_t end) {
            for (std::int64_t column = begin; column < end; ++column) {
                Index& part = result[static_cast<std::size_t>((row - first) * width + column)];
                if (part == no_index) part = face;
            }
        });
    }
    return result;
}

std::vector<Index> TargetBands::faces_of_fringe(const Band& band, const std::vector<Index>& parts) const {
    const auto width = static_cast<std::size_t>(layout_.width), rows = static_cast<std::size_t>(band.beyond_row - band.first_row);
    const auto samples = static_cast<std::size_t>(samples_);
    std::vector<bool> covered(width * rows);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i] != no_index) covered[i / (width * samples * samples) * width + i % (width * samples) / samples] = true;
    std::vector<Index> result(width * rows, no_index);
    std::vector<double> distance(width * rows, fringe * fringe);
    const auto walk = [&](Index face, const Vector2d& a, const Vector2d& b) {
        const double length = (b - a).norm();
        const auto steps = static_cast<std::size_t>(std::ceil(length)) + 1;
        for (std::size_t i = 0; i <= steps; ++i) {
            const Vector2d at = a + (b - a) * (static_cast<double>(i) / static_cast<double>(steps));
            const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
            for (int y = std::max(row - 2, band.first_row); y <= std::min(row + 2, band.beyond_row - 1); ++y)
                for (int x = std::max(column - 2, 0); x <= std::min(column + 2, layout_.width - 1); ++x) {
                    const auto texel = static_cast<std::size_t>(y - band.first_row) * width + static_cast<std::size_t>(x);
                    if (covered[texel]) continue;
                    const Vector2d centre(x + 0.5, y + 0.5);
                    const double share = length > 0 ? std::clamp((centre - a).dot(b - a) / (length * length), 0.0, 1.0) : 0;
                    const double squared = (a + share * (b - a) - centre).squaredNorm();
                    if (squared < distance[texel]) distance[texel] = squared, result[texel] = face;
                }
        }
    };
    for (const Index face : band.faces)
        for (std::size_t k = 0; k < 3; ++k)
            if ((borders_[face] >> k & 1U) != 0) walk(face, texel_point(face, k), texel_point(face, (k + 1) % 3));
    return result;
}

TargetPlace TargetBands::place(Index face, double x, double y) const {
    std::array<Point, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector2d at = texel_point(face, k);
        corner[k] = {at.x() - x, at.y() - y, 0};
    }
    return {face, nearest_barycentric(corner[0], corner[1], corner[2], Point(0, 0, 0))};
}

}  // namespace ostraka::texture

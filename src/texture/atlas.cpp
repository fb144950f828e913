#include "ostraka/texture/atlas.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/limits.h"
#include "texture/chart.h"
#include "texture/face_clusters.h"
#include "texture/pack.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using texture::Chart;

/// Width of a triangle in texels, or as a share of the mean edge length if this is less, below which its normal does not count.
constexpr double negligible = 1e-3;
constexpr double small_chart = 16;    ///< root of the area of a small chart, in texels
constexpr double small_share = 0.01;  ///< but at most this share of the area of the mesh
constexpr double packed_share = 0.7;  ///< share of the images that rectangles surely fill
constexpr double enlarged = 1.1;      ///< growth of texels that are too small

/// Distance between the borders of a chart and of its rectangle, in texels.
double margin(const AtlasOptions& options) { return options.gutter + 0.5; }

double side_in_texels(double length, double texel, const AtlasOptions& options) {
    return std::max(1.0, std::ceil(length / texel + 2 * margin(options)));
}

/// The smallest texel size, at least the requested one, at which the charts (in units of length) fit into the images.
double fitting_texel(const std::vector<Chart>& charts, const AtlasOptions& options) {
    const double side = options.max_size;
    double texel = options.texel;
    for (;; texel *= enlarged) {
        double area = 0, longest = 0;
        for (const Chart& chart : charts) {
            const double width = side_in_texels(chart.width, texel, options);
            area += width * side_in_texels(chart.height, texel, options);
            longest = std::max(longest, width);
        }
        if (longest <= side && area <= packed_share * side * side * static_cast<double>(max_atlas_images)) return texel;
    }
}

std::vector<Chart> flattened_clusters(const Mesh& mesh, const AtlasOptions& options, double negligible_width) {
    texture::ClusterLimits limits;
    limits.cone = options.cone;
    limits.relaxed_cone = std::max(options.cone, limits.relaxed_cone);
    limits.negligible_width = negligible_width;
    const double area = small_chart * options.texel;
    limits.small_area = std::min(area * area, small_share * surface_area(mesh));
    std::vector<std::vector<Index>> clusters = texture::face_clusters(mesh, limits);
    std::vector<Chart> charts(clusters.size());
    parallel_for(clusters.size(), 1,
                 [&](std::size_t i) { charts[i] = texture::flattened(mesh, std::move(clusters[i]), negligible_width); });
    return charts;
}

/// Scales the charts to texels and divides those that overlap themselves.
std::vector<Chart> overlap_free(const Mesh& mesh, const std::vector<Chart>& charts, double texel, double negligible_width) {
    std::vector<std::vector<Chart>> divided(charts.size());
    parallel_for(charts.size(), 1, [&](std::size_t i) {
        Chart chart = charts[i];
        texture::scale(chart, 1 / texel);
        divided[i] = texture::without_overlaps(mesh, std::move(chart), negligible_width, 1 / texel);
    });
    std::vector<Chart> result;
    for (std::vector<Chart>& pieces : divided) std::move(pieces.begin(), pieces.end(), std::back_inserter(result));
    return result;
}

void place_chart(const Chart& chart, const texture::PackedRectangle& rectangle, std::size_t index, const AtlasOptions& options,
                 Atlas& atlas) {
    TextureLayout& layout = atlas.layout;
    const Vector2d origin(rectangle.x + margin(options), rectangle.y + margin(options));
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
        const Index face = chart.faces[i];
        atlas.face_chart[face] = static_cast<Index>(index);
        layout.face_image[face] = static_cast<Index>(rectangle.image);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector2d corner = origin + chart.corners[3 * i + k];
            // Rows run from the top, v from the bottom; the projection must not be mirrored.
            layout.corner_texture[3 * static_cast<std::size_t>(face) + k] = {static_cast<float>(corner.x() / layout.width),
                                                                             static_cast<float>(corner.y() / layout.height)};
        }
    }
}

void check_mesh(const Mesh& mesh) {
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces for an atlas", "give a mesh with faces");
    for (const Vertex vertex : mesh.vertices())
        if (!is_place(mesh.point(vertex)))
            fail_input(fmt::format("vertex {}", static_cast<Index>(vertex)), "has a coordinate that is not finite or too large",
                       "give finite coordinates");
}

}  // namespace

void AtlasOptions::declare_options(OptionList& list) {
    list("max-size", max_size, "largest width and height of an image", Range{64, 16384}, "texels");
    list("gutter", gutter, "texels left free around each chart", Range{0, 64}, "texels");
    list("cone", cone, "largest angle between the normals of a chart and its axis: less stretch for smaller charts", Range{5, 75},
         "degrees");
}

Atlas make_atlas(const Mesh& mesh, const AtlasOptions& options) {
    check_options(options, "atlas");
    if (!(options.texel > 0) || !std::isfinite(options.texel))
        fail_usage(fmt::format("the texel size is {}", options.texel), "give a length above 0");
    check_mesh(mesh);
    AtlasOptions used = options;
    used.max_size -= used.max_size % 4;
    const double negligible_width = negligible * std::min(options.texel, mean_edge_length(mesh));
    const std::vector<Chart> clusters = flattened_clusters(mesh, used, negligible_width);
    Atlas atlas;
    std::vector<Chart> charts;
    std::vector<texture::PackedRectangle> rectangles;
    for (atlas.texel = fitting_texel(clusters, used);; atlas.texel *= enlarged) {
        charts = overlap_free(mesh, clusters, atlas.texel, negligible_width);
        rectangles.clear();
        bool fits = true;
        for (const Chart& chart : charts) {
            const double width = side_in_texels(chart.width, 1, used), height = side_in_texels(chart.height, 1, used);
            fits = fits && width <= used.max_size;
            rectangles.push_back({static_cast<int>(width), static_cast<int>(height)});
        }
        if (!fits) continue;
        const texture::Packing packing = texture::pack(rectangles, used.max_size);
        if (packing.images > max_atlas_images) continue;
        atlas.layout.width = atlas.layout.height = packing.size;
        atlas.layout.images = packing.images;
        break;
    }
    const std::size_t faces = mesh.number_of_faces();
    atlas.charts = charts.size();
    atlas.face_chart.assign(faces, 0);
    atlas.layout.face_image.assign(faces, 0);
    atlas.layout.corner_texture.assign(3 * faces, {});
    for (std::size_t i = 0; i < charts.size(); ++i) {
        place_chart(charts[i], rectangles[i], i, used, atlas);
        atlas.largest_stretch = std::max(atlas.largest_stretch, charts[i].largest_stretch);
    }
    const double side = atlas.layout.width, texels = side * side * static_cast<double>(atlas.layout.images);
    atlas.used = std::min(1.0, surface_area(mesh) / (atlas.texel * atlas.texel) / texels);
    return atlas;
}

}  // namespace ostraka

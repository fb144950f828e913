// Baked colours of vertices, and baked images as the texture of a mesh.
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/texture/bake.h"
#include "texture/source_values.h"
#include "texture/target_surface.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using namespace texture;

constexpr int min_rows = 3, max_rows = 32;  ///< of samples in a face

/// The means of the samples in a face that are nearest to each of its corners.
struct FaceShares {
    std::array<SampleMean, 3> corner;
    PlaceCounts counts;
};

/// Corner of a triangle that is nearest to a point in it.
std::size_t nearest_corner(const std::array<Point, 3>& points, const Point& at) {
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (CGAL::squared_distance(points[k], at) < CGAL::squared_distance(points[nearest], at)) nearest = k;
    return nearest;
}

FaceShares sampled_face(const Mesh& target, const TargetSurface& surface, Face face, double step, const SourceLookup& lookup,
                        const SourceValues& values) {
    FaceShares shares{{SampleMean(values.is_colour()), SampleMean(values.is_colour()), SampleMean(values.is_colour())}, {}};
    const double area = face_area(target, face);
    const double side = std::sqrt(2 * area);
    const int rows = std::clamp(step > 0 ? static_cast<int>(std::ceil(std::min(side / step, 1e6))) : min_rows, min_rows, max_rows);
    std::array<Point, 3> points;
    const auto vertices = corners(target, face);
    for (std::size_t k = 0; k < 3; ++k) points[k] = target.point(vertices[k]);
    // The centres of the rows^2 triangles that lines parallel to the sides cut the face into; their areas are equal.
    std::uint64_t number = static_cast<std::uint64_t>(face) * max_rows * max_rows;
    const auto add = [&](double first, double second) {
        const std::array<double, 3> barycentric{first / rows, second / rows, (rows - first - second) / rows};
        const Point at = surface.point(face, barycentric);
        const SourcePlace place = lookup.find(at, surface.normal(face, barycentric));
        shares.counts.add(place);
        if (place.found != SourcePlace::Found::nowhere)
            shares.corner[nearest_corner(points, at)].add(values.at(place, number), area / (rows * rows));
        ++number;
    };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; i + j < rows; ++j) {
            add(i + 1.0 / 3, j + 1.0 / 3);
            if (i + j + 1 < rows) add(i + 2.0 / 3, j + 2.0 / 3);
        }
    return shares;
}

}  // namespace

BakedVertices bake_vertices(const Mesh& target, const BakeSource& source, const BakeOptions& options, const std::string& where) {
    check_options(options, "bake");
    const double step = texel_size(source);
    const SourceLookup lookup(source.mesh, options.distance * box_diagonal(target));
    const SourceValues values(source, options, 0, where);
    const TargetSurface surface(target);
    std::vector<FaceShares> shares(target.number_of_faces(),
                                   FaceShares{{SampleMean(true), SampleMean(true), SampleMean(true)}, {}});
    Progress progress("bake", shares.size());
    constexpr std::size_t block = 64;
    parallel_blocks(shares.size(), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            shares[i] = sampled_face(target, surface, Face(static_cast<Index>(i)), step, lookup, values);
        progress.advance(end - begin);
    });
    std::vector<SampleMean> means(target.number_of_vertices(), SampleMean(values.is_colour()));
    PlaceCounts counts;
    for (const Face face : target.faces()) {
        const auto vertices = corners(target, face);
        for (std::size_t k = 0; k < 3; ++k) means[vertices[k]].add(shares[face].corner[k]);
        counts.add(shares[face].counts);
    }
    BakedVertices result;
    result.counts = counts.result();
    std::vector<float> numbers;
    for (const SampleMean& mean : means)
        if (!mean.empty()) numbers.push_back(mean.mean()[0]);
    const ShownRange range = shown_range(options, std::move(numbers));
    result.low = range.low, result.high = range.high;
    for (const SampleMean& mean : means) {
        if (mean.empty()) result.colours.push_back(missing_grey);
        else result.colours.push_back(values.is_colour() ? stored_colour(mean.mean()) : range.grey(mean.mean()[0]));
    }
    return result;
}

void set_texture(MeshExtras& extras, const TextureLayout& layout, const std::vector<Pixels>& images,
                 const BakedImageOptions& options, Material::Alpha alpha) {
    extras.corner_texture = layout.corner_texture;
    extras.face_materials.assign(layout.corner_texture.size() / 3, 0);
    for (std::size_t face = 0; face < extras.face_materials.size(); ++face) extras.face_materials[face] = layout.image_of(face);
    extras.vertex_colours.clear();
    extras.face_colours.clear();
    extras.appearance = {};
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string name = images.size() == 1 ? options.name : fmt::format("{}-{}", options.name, i + 1);
        extras.appearance.images.push_back(std::make_shared<Image>(
            encode(images[i], options.format, name + extension_of(options.format), options.quality)));
        Material material;
        material.name = name;
        material.image = static_cast<Index>(i);
        material.wrap_u = material.wrap_v = TextureWrap::clamp;
        material.alpha = alpha;
        extras.appearance.materials.push_back(std::move(material));
    }
}

Material::Alpha alpha_of(const Appearance& appearance) {
    Material::Alpha result = Material::Alpha::opaque;
    for (const Material& material : appearance.materials) result = std::max(result, material.alpha);
    return result;
}

}  // namespace ostraka

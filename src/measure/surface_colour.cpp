#include "ostraka/measure/surface_colour.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Colour with channels 0 to 255 as linear light.
std::array<float, 3> linear_of(const Colour& colour) {
    return {linear_from_srgb(colour[0]), linear_from_srgb(colour[1]), linear_from_srgb(colour[2])};
}

/// Largest length in texture coordinates that a length of one in the face can have.
double texture_stretch(const std::array<Point, 3>& points, const std::array<TexturePoint, 3>& texture) {
    double stretch = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const double length = std::sqrt(CGAL::squared_distance(points[k], points[next]));
        const double moved = std::hypot(static_cast<double>(texture[next][0]) - static_cast<double>(texture[k][0]),
                                        static_cast<double>(texture[next][1]) - static_cast<double>(texture[k][1]));
        if (length > 0) stretch = std::max(stretch, moved / length);
    }
    return stretch;
}

}  // namespace

bool has_colours(const MeshExtras& extras) {
    return !extras.vertex_colours.empty() || !extras.face_colours.empty() || !extras.appearance.empty();
}

SurfaceColour::SurfaceColour(const Mesh& mesh, const MeshExtras& extras, const std::string& where)
    : mesh_(mesh), extras_(extras), sampler_(extras.appearance, where) {}

std::array<float, 3> SurfaceColour::at(Face face, const std::array<double, 3>& barycentric, double width) const {
    const auto vertices = corners(mesh_, face);
    std::array<float, 3> colour{1, 1, 1};
    const Index material = extras_.face_materials.empty() ? no_index : extras_.face_materials[face];
    if (material != no_index) {
        std::array<TexturePoint, 3> texture{};
        TexturePoint place{0, 0};
        double footprint = 0;
        if (!extras_.corner_texture.empty()) {
            std::array<Point, 3> points;
            for (std::size_t k = 0; k < 3; ++k) {
                texture[k] = extras_.corner_texture[3 * static_cast<std::size_t>(face) + k];
                points[k] = mesh_.point(vertices[k]);
            }
            for (std::size_t axis = 0; axis < 2; ++axis) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k) sum += barycentric[k] * static_cast<double>(texture[k][axis]);
                place[axis] = static_cast<float>(sum);
            }
            footprint = width * texture_stretch(points, texture);
        }
        const auto rgba = sampler_.colour(material, place, static_cast<float>(footprint));
        colour = {rgba[0], rgba[1], rgba[2]};
    }
    if (!extras_.vertex_colours.empty()) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k)
                sum += barycentric[k] * static_cast<double>(linear_from_srgb(extras_.vertex_colours[vertices[k]][channel]));
            colour[channel] *= static_cast<float>(sum);
        }
    } else if (!extras_.face_colours.empty()) {
        const auto own = linear_of(extras_.face_colours[face]);
        for (std::size_t channel = 0; channel < 3; ++channel) colour[channel] *= own[channel];
    }
    return colour;
}

std::vector<Lab> vertex_lab(const Mesh& mesh, const MeshExtras& extras, const std::string& where) {
    const SurfaceColour surface(mesh, extras, where);
    std::vector<Lab> colours(mesh.number_of_vertices());
    parallel_for(colours.size(), 1024, [&](std::size_t i) {
        const Vertex vertex(static_cast<Index>(i));
        if (mesh.is_isolated(vertex)) return;
        std::array<double, 3> sum{};
        double total = 0;
        for (const Halfedge h : CGAL::halfedges_around_target(vertex, mesh)) {
            if (mesh.is_border(h)) continue;
            const Face face = mesh.face(h);
            const auto vertices = corners(mesh, face);
            std::array<double, 3> barycentric{};
            for (std::size_t k = 0; k < 3; ++k) barycentric[k] = vertices[k] == vertex ? 0.8 : 0.1;
            const double area = face_area(mesh, face);
            const auto colour = surface.at(face, barycentric, std::sqrt(area) / 3);
            for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += area * static_cast<double>(colour[channel]);
            total += area;
        }
        if (!(total > 0)) return;
        colours[i] = lab_from_linear(
            {static_cast<float>(sum[0] / total), static_cast<float>(sum[1] / total), static_cast<float>(sum[2] / total)});
    });
    return colours;
}

namespace {

/// A triangle inside a face, its corners in barycentric coordinates of the face.
struct FacePiece {
    Index face;
    std::array<std::array<double, 3>, 3> corners;
    double area;
};

/// A region as whole faces, or, if it is free, as pieces of faces.
std::vector<FacePiece> pieces_of(AnnotatedMeshView object, const Annotation& region) {
    std::vector<FacePiece> pieces;
    if (!is_free(region)) {
        for (const Index face : region.faces)
            pieces.push_back({face, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, face_area(object.mesh, Face(face))});
        return pieces;
    }
    AnnotationSet alone;
    alone.annotations = {region};
    const CutMesh cut = cut_along_curves({object.mesh, alone});
    for (const Index part : cut.annotations.annotations.front().faces) {
        const Index face = cut.face_origin[part];
        const auto [a, b, c] = corners(object.mesh, Face(face));
        FacePiece piece{face, {}, face_area(cut.mesh, Face(part))};
        const auto vertices = corners(cut.mesh, Face(part));
        for (std::size_t k = 0; k < 3; ++k)
            piece.corners[k] = nearest_barycentric(object.mesh.point(a), object.mesh.point(b), object.mesh.point(c),
                                                   cut.mesh.point(vertices[k]));
        pieces.push_back(piece);
    }
    return pieces;
}

/// The colour at a part of the area.
struct ColourSample {
    Lab lab;
    std::array<float, 3> linear;
    double weight;
};

/// Samples of equal area on a grid of a piece: `rows` rows of triangles, one sample in the middle of each.
std::vector<ColourSample> samples_of(const SurfaceColour& surface, const FacePiece& piece, std::size_t rows) {
    std::vector<ColourSample> samples;
    const double count = static_cast<double>(rows), weight = piece.area / (count * count);
    for (std::size_t a = 0; a < rows; ++a)
        for (std::size_t b = 0; a + b < rows; ++b)
            for (const bool upper : {true, false}) {
                if (!upper && a + b + 1 == rows) continue;
                const double shift = upper ? 1.0 / 3 : 2.0 / 3;
                const double u = (static_cast<double>(a) + shift) / count, v = (static_cast<double>(b) + shift) / count;
                std::array<double, 3> barycentric{};
                for (std::size_t k = 0; k < 3; ++k)
                    barycentric[k] = (1 - u - v) * piece.corners[0][k] + u * piece.corners[1][k] + v * piece.corners[2][k];
                const auto linear = surface.at(Face(piece.face), barycentric, std::sqrt(weight));
                samples.push_back({lab_from_linear(linear), linear, weight});
            }
    return samples;
}

/// The lightness below which a share of the weight lies.
double lightness_quantile(const std::vector<ColourSample>& by_lightness, double total, double share) {
    double below = 0;
    for (const ColourSample& sample : by_lightness) {
        below += sample.weight;
        if (below >= share * total) return sample.lab[0];
    }
    return by_lightness.back().lab[0];
}

}  // namespace

ColourMeasures measure_colour(AnnotatedMeshView object, const Annotation& region, const MeshExtras& extras,
                              const std::string& where, std::size_t samples) {
    if (region.type != AnnotationType::region)
        fail_input(where, fmt::format("'{}' is no region, so that it has no colour", region.tag), "choose a region");
    const SurfaceColour surface(object.mesh, extras, where);
    const std::vector<FacePiece> pieces = pieces_of(object, region);
    double area = 0;
    for (const FacePiece& piece : pieces) area += piece.area;
    if (!(area > 0)) fail_input(where, fmt::format("'{}' has no area", region.tag), "choose a region with faces");
    const double area_per_sample = area / static_cast<double>(std::max<std::size_t>(samples, 1));
    std::vector<std::vector<ColourSample>> lists(pieces.size());
    parallel_for(pieces.size(), 64, [&](std::size_t i) {
        if (!(pieces[i].area > 0)) return;
        lists[i] =
            samples_of(surface, pieces[i],
                       static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(pieces[i].area / area_per_sample)), 1.0, 1000.0)));
    });
    std::vector<ColourSample> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    ColourMeasures result;
    std::array<double, 3> light{};
    double total = 0;
    for (const ColourSample& sample : all) {
        total += sample.weight;
        for (std::size_t k = 0; k < 3; ++k) {
            result.mean[k] += sample.weight * sample.lab[k];
            light[k] += sample.weight * static_cast<double>(sample.linear[k]);
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        result.mean[k] /= total;
        result.mean_rgb[k] = srgb_from_linear(static_cast<float>(light[k] / total));
    }
    double variance = 0;
    for (const ColourSample& sample : all)
        for (std::size_t k = 0; k < 3; ++k)
            variance += sample.weight / total * (sample.lab[k] - result.mean[k]) * (sample.lab[k] - result.mean[k]);
    result.spread = std::sqrt(variance);
    std::stable_sort(all.begin(), all.end(), [](const ColourSample& a, const ColourSample& b) { return a.lab[0] < b.lab[0]; });
    result.lightness_low = lightness_quantile(all, total, 0.1);
    result.lightness_high = lightness_quantile(all, total, 0.9);
    return result;
}

}  // namespace ostraka

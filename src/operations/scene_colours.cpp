#include "operations/scene_colours.h"

#include "ostraka/annotation/cut_extras.h"
#include "ostraka/core/error.h"
#include "ostraka/core/options.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

constexpr std::array colouring_words{"auto", "texture", "own", "annotations", "values", "labels", "clay"};

constexpr std::array page_colouring_words{"auto", "texture", "own", "annotations", "values", "clay"};

Rgb opaque(const Colour& colour) { return {colour[0], colour[1], colour[2]}; }

}  // namespace

Choices colouring_names() { return Choices(std::vector<std::string>(colouring_words.begin(), colouring_words.end())); }

std::string to_string(SurfaceColouring colouring) { return colouring_words[static_cast<std::size_t>(colouring)]; }

Choices page_colouring_names() {
    return Choices(std::vector<std::string>(page_colouring_words.begin(), page_colouring_words.end()));
}

std::string page_colouring(PageColouring colouring) { return page_colouring_words[static_cast<std::size_t>(colouring)]; }

bool has_labels(const MeshExtras& extras) { return !extras.face_labels.empty() || !extras.vertex_labels.empty(); }

bool is_available(SurfaceColouring colouring, const MeshExtras& extras, bool values, bool annotated) {
    switch (colouring) {
        case SurfaceColouring::texture:
            return has_texture(extras);
        case SurfaceColouring::own:
            return has_own_colours(extras);
        case SurfaceColouring::labels:
            return has_labels(extras);
        case SurfaceColouring::annotations:
            return annotated;
        case SurfaceColouring::values:
            return values;
        default:
            return true;
    }
}

SurfaceColouring chosen_colouring(SurfaceColouring wanted, const MeshExtras& extras, bool values, bool annotated,
                                  const std::string& file) {
    if (!is_available(wanted, extras, values, annotated)) {
        if (wanted == SurfaceColouring::annotations)
            fail_usage("--colour annotations without annotations", "give --annotations, or leave out --colour");
        if (wanted == SurfaceColouring::values)
            fail_usage("--colour values without a map", "give --map or --property, or leave out --colour");
        fail_input(file, fmt::format("holds no {}", wanted == SurfaceColouring::own ? "colours" : to_string(wanted)),
                   "leave out --colour");
    }
    if (wanted != SurfaceColouring::automatic) return wanted;
    for (const auto colouring : {SurfaceColouring::values, SurfaceColouring::annotations, SurfaceColouring::texture,
                                 SurfaceColouring::labels, SurfaceColouring::own})
        if (is_available(colouring, extras, values, annotated)) return colouring;
    return SurfaceColouring::plain;
}

std::string hidden_colours(SurfaceColouring colouring, const MeshExtras& extras) {
    const bool texture = has_texture(extras) && colouring != SurfaceColouring::texture;
    const bool own = has_own_colours(extras) && colouring != SurfaceColouring::texture && colouring != SurfaceColouring::own;
    if (texture && own)
        return "the texture and the colours in the file are not shown; --colour texture or --colour own shows them";
    if (texture) return "the texture in the file is not shown; --colour texture shows it";
    if (own) return "the colours in the file are not shown; --colour own shows them";
    return {};
}

void show_texture(Scene& scene, const MeshExtras& extras, const std::string& where) {
    scene.texture = std::make_shared<const TextureSampler>(extras.appearance, where);
    scene.corner_texture = extras.corner_texture;
    scene.face_materials = extras.face_materials;
    show_own_colours(scene, extras);
}

void show_own_colours(Scene& scene, const MeshExtras& extras) {
    scene.face_colours.clear();
    scene.vertex_colours.clear();
    for (const Colour& colour : extras.face_colours) scene.face_colours.push_back(opaque(colour));
    if (extras.face_colours.empty())
        for (const Colour& colour : extras.vertex_colours) scene.vertex_colours.push_back(opaque(colour));
}

void cut_scene_colours(Scene& scene, const CutMesh& cut, const Mesh& before) {
    MeshExtras extras;
    extras.corner_texture = std::move(scene.corner_texture);
    extras.face_materials = std::move(scene.face_materials);
    for (const Rgb& colour : scene.face_colours) extras.face_colours.push_back({colour.red, colour.green, colour.blue, 255});
    for (const Rgb& colour : scene.vertex_colours) extras.vertex_colours.push_back({colour.red, colour.green, colour.blue, 255});
    MeshExtras of_cut = cut_extras(cut, before, extras);
    scene.corner_texture = std::move(of_cut.corner_texture);
    scene.face_materials = std::move(of_cut.face_materials);
    show_own_colours(scene, of_cut);
}

}  // namespace ostraka

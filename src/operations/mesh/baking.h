// Baking of a texture or of vertex colours, shared by operations.
#pragma once

#include "operations/operations.h"

#include "ostraka/texture/bake.h"

namespace ostraka {

/// What receives baked colours.
enum class BakeTarget { image, vertices };

/// Bakes a mesh's appearance and reports it.
struct Baking {
    double texel = 0;  ///< 0: that of the source
    AtlasOptions atlas;
    BakeOptions bake;
    BakedImageOptions images;

    /// Declares the option --texel.
    void list_texel(OptionList& list);
    /// Declares all values of the report that `to_image` and `to_vertices` fill.
    static void declare_report(ReportLayout& layout);

    /// Bakes images of the target: into its own texture coordinates if `layout` is given, else into a new atlas. `source_file`: for
    /// messages; `output_file`: the images get its name.
    void to_image(const Mesh& target, MeshExtras& extras, const MeshFile& source, const std::string& source_file,
                  const std::string& output_file, const TextureLayout* layout, Report& report) const;
    /// Bakes colours of the target's vertices, which replace its texture and its other colours.
    void to_vertices(const Mesh& target, MeshExtras& extras, const MeshFile& source, const std::string& source_file,
                     Report& report) const;
};

/// True if a file of this name keeps texture coordinates and images; objects in memory keep all.
bool keeps_texture(const Slot& output);
/// True if the mesh has an image, materials, or colours of vertices or faces.
bool has_colours(const MeshExtras& extras);

}  // namespace ostraka

// Materials of OBJ and PLY files: reading and writing MTL files, and image files written beside a mesh file.
#pragma once

#include "io/formats.h"

#include <map>

namespace ostraka::io {

/// What the options -s and -o of a texture map do to texture coordinates: scale * coordinate + offset.
struct TextureShift {
    std::array<float, 2> scale{1, 1}, offset{0, 0};
    [[nodiscard]] bool is_identity() const { return scale[0] == 1 && scale[1] == 1 && offset[0] == 0 && offset[1] == 0; }
    [[nodiscard]] TexturePoint operator()(const TexturePoint& point) const {
        return {scale[0] * point[0] + offset[0], scale[1] * point[1] + offset[1]};
    }
};

/// A statement of an MTL file that names an image: "map_Kd -s 2 2 -clamp on name.png".
struct MapStatement {
    std::string keyword;                     ///< as it is written in the file
    std::string options;                     ///< options other than -s and -o, with their values
    TextureShift shift;                      ///< options -s and -o
    bool clamp = false;                      ///< option -clamp on
    bool not_applied = false;                ///< options -mm, -t or -imfchan, which change the colours or the place of the image
    std::string reference;                   ///< the image
    [[nodiscard]] std::string line() const;  ///< the statement as text
};
/// The statement on a line of an MTL file; nullopt if the line does not name an image.
std::optional<MapStatement> parse_map_statement(std::string_view line);

/// The name of a material or a file in the text behind a keyword: without blanks at both ends and without a comment, which starts
/// with # at the beginning or behind a blank.
std::string_view name_on_line(std::string_view text);

/// The materials in the MTL files of an OBJ file.
struct Materials {
    std::map<std::string, Index, std::less<>> index;  ///< index of each material in the appearance of the soup, by its name
    std::vector<TextureShift> shifts;                 ///< for each material, how its texture coordinates are shifted
};
/// Reads MTL files and their images into the appearance of the soup. `libraries`: the texts behind the keyword mtllib;
/// `is_used`: true if faces name materials. What cannot be found or read is reported in notes.
Materials read_materials(PolygonSoup& soup, const Path& obj_file, const std::vector<std::string_view>& libraries, bool is_used);

/// An sRGB value of 0 to 1, as MTL files have them, as linear light, and back (the shortest decimal number that gives the light).
float linear_from_unit_srgb(double value);
std::string unit_srgb_text(float light);

/// The name of the missing image that a material keeps in its MTL lines, as "map_Kd NAME"; empty if there is none.
std::string missing_image(const Material& material);

/// The image files to write beside a mesh file.
class ImageFiles {
public:
    ImageFiles(const Appearance& appearance, const Path& mesh_file);
    /// The file name of an image, which is written by `write`; empty for a missing image.
    const std::string& use(Index image);
    /// Likewise for the image that an MTL line of the appearance names; empty if there is no image of this name.
    std::string use(const std::string& image_name);
    /// Writes the images that were used into the folder of the mesh file. An image has its own name, unless a file of this name
    /// with other content exists there: then the name of the mesh file stands before its name.
    void write() const;

private:
    [[nodiscard]] bool is_taken(const std::string& name) const;
    std::string free_name(const Image& image, std::size_t number) const;
    const Appearance& appearance_;
    Path mesh_file_;
    std::vector<std::string> names_;  ///< file names of the images in use
};

/// Writes the materials as an MTL file; `names`: their names in it, one per material. Returns notes about what MTL cannot store.
Notes write_mtl(const Path& file, const Appearance& appearance, const std::vector<std::string>& names, ImageFiles& images,
                const std::string& comment);
/// Names of the materials as they are written in OBJ and MTL files: distinct, not empty, without control characters.
std::vector<std::string> material_names(const Appearance& appearance);

}  // namespace ostraka::io

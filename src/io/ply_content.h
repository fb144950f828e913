// What the elements of a PLY file contain, before their roles in a mesh are decided.
#pragma once

#include "io/formats.h"
#include "io/ply_header.h"

namespace ostraka::io {

/// Meaning of a property. `value`: a number that is kept under its name; `none`: not kept.
enum class Role : std::uint8_t { none, value, x, y, z, red, green, blue, alpha, label, s, t, corners, texture, image, count };
inline constexpr std::size_t role_count = static_cast<std::size_t>(Role::count);

/// Roles of the properties of an element. If several properties could have a role, full names ("red") precede short ones ("r"),
/// then earlier ones later ones; the others are values.
class PlyPlan {
public:
    /// `is_vertex`: the element is the vertices, else the faces or triangle strips.
    PlyPlan(const PlyElement& element, bool is_vertex);
    std::vector<Role> roles;                 ///< one per property
    std::array<PlyType, role_count> type{};  ///< type of the property with each role
    std::vector<std::string> unused;         ///< names of the properties that are not kept
    [[nodiscard]] bool with(Role role) const { return has_[static_cast<std::size_t>(role)]; }
    [[nodiscard]] bool coloured() const { return with(Role::red) && with(Role::green) && with(Role::blue); }

private:
    std::array<bool, role_count> has_{};
};

/// Colours of vertices or faces in the numbers of the file.
struct PlyColours {
    std::array<PlyType, 4> types{};  ///< types of red, green, blue, alpha
    bool are_bytes = false;          ///< true: all types are uchar, and the colours are in `colours`
    bool has_alpha = false;
    std::vector<Colour> colours;                ///< colours in bytes
    std::vector<std::array<float, 4>> numbers;  ///< colours in other numbers

    PlyColours() = default;
    PlyColours(const PlyPlan& plan, std::size_t count);
    void add(const std::array<double, role_count>& row);
};

/// The content of a PLY file. Lists are empty or have one entry per element.
struct PlyContent {
    PolygonSoup soup;
    PlyColours vertex_colours, face_colours;
    std::vector<TexturePoint> vertex_texture;
    std::vector<std::int32_t> image_of_face;  ///< numbers of the images of the faces (texnumber)
    std::vector<Index> unplaced;              ///< vertices with a coordinate that is not finite
    std::size_t bad_texture = 0;              ///< number of texture coordinates that are missing or not finite
};

/// The mesh in the content of a PLY file: colours in bytes, texture coordinates of corners, images; vertices without coordinates
/// are dropped, and must not be used by faces.
PolygonSoup finish_ply(PlyContent&& content, const PlyHeader& header, const std::string& file);

}  // namespace ostraka::io

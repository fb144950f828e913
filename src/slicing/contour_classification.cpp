// Order, orientation and soundness of contours.
#include "slicing/contour_classification.h"

#include "slicing/joining.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/flood.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace ostraka::detail {

namespace {

struct MeshOrientation {
    bool closed = true;
    bool inside_out = false;  ///< closed, with negative volume
};

MeshOrientation mesh_orientation(const Mesh& mesh) {
    MeshOrientation orientation;
    for (const Edge e : mesh.edges())
        if (mesh.is_border(e)) return {false, false};
    const Point o = mesh.point(*mesh.vertices().begin());
    double volume = 0;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        volume += CGAL::cross_product(mesh.point(a) - o, mesh.point(b) - o) * (mesh.point(c) - o);
    }
    orientation.inside_out = volume < 0;
    return orientation;
}

void sort_and_nest(std::vector<Contour>& contours) {
    std::stable_sort(contours.begin(), contours.end(), [](const Contour& a, const Contour& b) {
        if (a.closed != b.closed) return a.closed;
        return a.closed ? std::abs(a.area) > std::abs(b.area) : a.length > b.length;
    });
    nest(contours);
}

bool has_negative_area(const Slice& slice) {
    double area = 0;
    for (const auto& contour : slice.contours) area += contour.area;
    return area < 0;
}

bool has_outermost_hole(const Slice& slice) {
    return std::any_of(slice.contours.begin(), slice.contours.end(), [](const Contour& c) { return c.hole && c.parent < 0; });
}

/// Whether each contour contradicts its nesting: from the outside in, material and empty space alternate. An outermost hole is
/// wrong only if the whole mesh is closed; otherwise its outer contour may be open or unseen. Contours that intersect or
/// coincide with others are uninformative. 0 right, 1 wrong, 2 undetermined.
std::vector<char> against_nesting(const std::vector<Contour>& contours, const Crossings& crossings, bool closed) {
    std::vector<char> wrong(contours.size(), 2);
    for (std::size_t c = 0; c < contours.size() && contours[c].closed; ++c) {
        const Contour& contour = contours[c];
        if (contour.crosses || crossings.cancelled[c]) continue;
        if (contour.parent < 0) {
            wrong[c] = contour.hole && closed ? 1 : 0;
            continue;
        }
        const auto parent = static_cast<std::size_t>(contour.parent);
        if (wrong[parent] == 2) continue;
        wrong[c] = (contour.hole == contours[parent].hole) != (wrong[parent] == 1) ? 1 : 0;
    }
    return wrong;
}

/// Faces of shells whose contours are mostly wrong, by length.
class WrongShells {
public:
    WrongShells(const Mesh& mesh, const std::vector<Slice>& slices, const std::vector<std::vector<char>>& wrong)
        : shells_(face_pieces(mesh)), balance_(shells_.count, 0) {
        for (std::size_t i = 0; i < slices.size(); ++i)
            for (std::size_t c = 0; c < slices[i].contours.size(); ++c) {
                const Contour& contour = slices[i].contours[c];
                if (wrong[i][c] < 2)
                    balance_[shells_.of_face[contour.faces[0]]] += wrong[i][c] == 1 ? contour.length : -contour.length;
            }
    }
    [[nodiscard]] bool contains(const Contour& contour) const { return balance_[shells_.of_face[contour.faces[0]]] > 0; }

private:
    FacePieces shells_;
    std::vector<double> balance_;
};

}  // namespace

void check_faces(const Mesh& mesh, const std::vector<Index>& faces) {
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces to cut", "choose another mesh");
    for (const Index f : faces)
        if (f >= mesh.num_faces()) fail_usage(fmt::format("face {} is not in the mesh", f), "give faces of this mesh");
}

bool classify_contours(std::vector<Slice>& slices, const Mesh& mesh, bool is_whole_mesh) {
    std::optional<MeshOrientation> cached_orientation;
    const auto orientation = [&] {
        if (!cached_orientation) cached_orientation = mesh_orientation(mesh);
        return *cached_orientation;
    };
    const bool reversed = std::any_of(slices.begin(), slices.end(), has_negative_area) && orientation().inside_out;
    parallel_for(slices.size(), 1, [&](std::size_t i) {
        auto& contours = slices[i].contours;
        if (reversed) std::for_each(contours.begin(), contours.end(), turn_around);
        sort_and_nest(contours);
    });
    const bool closed = is_whole_mesh && std::any_of(slices.begin(), slices.end(), has_outermost_hole) && orientation().closed;
    const double tolerance = on_plane_share * box_diagonal(mesh);
    std::vector<std::vector<char>> wrong(slices.size());
    parallel_for(slices.size(), 1, [&](std::size_t i) {
        const Crossings crossings = find_crossings(slices[i].contours, tolerance);
        wrong[i] = against_nesting(slices[i].contours, crossings, closed);
        slices[i].completeness.doubtful = crossings.doubtful;
    });
    const auto has_wrong = [](const std::vector<char>& verdicts) {
        return std::find(verdicts.begin(), verdicts.end(), 1) != verdicts.end();
    };
    std::optional<WrongShells> shells;
    if (std::any_of(wrong.begin(), wrong.end(), has_wrong)) shells.emplace(mesh, slices, wrong);
    parallel_for(slices.size(), 1, [&](std::size_t i) {
        for (Contour& contour : slices[i].contours)
            if (shells && shells->contains(contour)) turn_around(contour), contour.reversed = true;
        const double doubtful = slices[i].completeness.doubtful;
        slices[i].completeness = completeness(slices[i].contours);
        slices[i].completeness.doubtful = doubtful;
    });
    return reversed;
}

}  // namespace ostraka::detail

#include "ostraka/io/moved.h"

#include "ostraka/core/error.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <utility>

namespace ostraka {

void move_triangles(TriangleSoup& soup, MeshExtras& extras, const Motion& motion) {
    const PreciseMotion move(motion);
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        auto& p = soup.points[v];
        const Vector3d q = move({p[0], p[1], p[2]});
        if (!is_place(q[0], q[1], q[2]))
            fail_input(fmt::format("vertex {}", v), "is moved beyond the largest coordinate, 1e60", "use a smaller scale");
        p = {q[0], q[1], q[2]};
    }
    if (!motion.mirrors()) return;
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    for (std::size_t corner = 0; corner + 2 < extras.corner_texture.size(); corner += 3)
        std::swap(extras.corner_texture[corner + 1], extras.corner_texture[corner + 2]);
    for (auto& tetrahedron : extras.tetrahedra) std::swap(tetrahedron[2], tetrahedron[3]);
}

}  // namespace ostraka

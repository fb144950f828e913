#include "io/formats.h"
#include "io/text_writer.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

namespace {

using Float3 = std::array<float, 3>;

/// Unit normal, zero for a degenerate triangle; scaling prevents overflow for huge and underflow for tiny triangles.
Float3 unit_normal(const std::array<double, 3>& a, const std::array<double, 3>& b, const std::array<double, 3>& c) {
    double u[3], v[3], largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        largest = std::max({largest, std::fabs(u[k]), std::fabs(v[k])});
    }
    if (largest == 0) return {};
    for (std::size_t k = 0; k < 3; ++k) {
        u[k] /= largest;
        v[k] /= largest;
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) return {};
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

/// Whether a reader that numbers vertices by first appearance obtains the vertex numbers of `soup`.
bool order_survives(const TriangleSoup& soup) {
    Index next = 0;
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) {
            if (v > next) return false;
            if (v == next) ++next;
        }
    return next == soup.points.size();
}

/// How far rounding to single precision moves the vertices, compared with the edges.
struct Rounding {
    double largest = 0;    ///< largest distance by which a vertex moves
    double about_own = 0;  ///< upper bound of this distance if the mesh were centred at the origin
    double shortest = 0;   ///< length of the shortest edge that is not zero; 0 if there is none
    [[nodiscard]] bool is_visible() const { return shortest > 0 && largest > 0.01 * shortest; }
    [[nodiscard]] bool is_due_to_place() const { return largest > 4 * about_own; }
};

Rounding rounding_of(const TriangleSoup& soup) {
    Rounding rounding;
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const auto& point : soup.points) {
        double moved = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], point[k]);
            high[k] = std::max(high[k], point[k]);
            moved = std::hypot(moved, static_cast<double>(static_cast<float>(point[k])) - point[k]);
        }
        rounding.largest = std::max(rounding.largest, moved);
    }
    if (rounding.largest == 0) return rounding;
    for (std::size_t k = 0; k < 3; ++k) rounding.about_own = std::hypot(rounding.about_own, (high[k] - low[k]) / 2 * 0x1p-24);
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto &a = soup.points[triangle[k]], &b = soup.points[triangle[(k + 1) % 3]];
            const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
            if (length > 0) shortest = std::min(shortest, length);
        }
    if (std::isfinite(shortest)) rounding.shortest = shortest;
    return rounding;
}

std::string per_cent_of_edge(const Rounding& rounding) {
    return fmt::format("vertices move by up to {:.2g}, {:.2g} % of the shortest edge", rounding.largest,
                       100 * rounding.largest / rounding.shortest);
}

}  // namespace

Notes write_stl(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    if (soup.triangles.size() > std::numeric_limits<std::uint32_t>::max())
        fail_work(file.string(), "STL cannot store this many triangles", "write PLY");
    for (const auto& point : soup.points)
        for (const double x : point)
            if (std::fabs(x) > static_cast<double>(std::numeric_limits<float>::max()))
                fail_work(file.string(), "a coordinate does not fit the single precision of STL",
                          "write PLY, OBJ or OFF, or rescale the mesh");
    const Rounding rounding = rounding_of(soup);
    if (rounding.is_visible() && rounding.is_due_to_place())
        fail_work(
            file.string(),
            fmt::format("the mesh is too far from the origin for the single precision of STL: {}", per_cent_of_edge(rounding)),
            "write PLY, which keeps all digits, or move the mesh to the origin first: ostraka mesh move INPUT OUTPUT --centre "
            "box --transform FILE");
    TextWriter writer(file);
    const bool ascii = options.encoding == Encoding::ascii;
    if (ascii) {
        writer.text(fmt::format("solid {}\n", one_line(options.comment)));
    } else {
        // Not "solid": some readers interpret that as text.
        std::string header = one_line("binary STL; " + options.comment);
        header.resize(80, ' ');
        writer.text(header);
        writer.bytes(static_cast<std::uint32_t>(soup.triangles.size()));
    }
    for (const auto& [a, b, c] : soup.triangles) {
        const Float3 normal = unit_normal(soup.points[a], soup.points[b], soup.points[c]);
        if (ascii) {
            writer.text("facet normal");
            writer.numbers({normal[0], normal[1], normal[2]});
            writer.text("\nouter loop\n");
        } else {
            writer.bytes(normal);
        }
        for (const Index v : {a, b, c}) {
            const auto& p = soup.points[v];
            const Float3 point{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
            if (ascii) {
                writer.text("vertex");
                writer.numbers({point[0], point[1], point[2]});
                writer.character('\n');
            } else {
                writer.bytes(point);
            }
        }
        if (ascii) writer.text("endloop\nendfacet\n");
        else writer.bytes(std::uint16_t{0});
        writer.flush_if_full();
    }
    if (ascii) writer.text("endsolid\n");
    writer.commit();
    Notes notes;
    if (rounding.largest > 0)
        notes.push_back(fmt::format("STL stores coordinates in single precision; they were rounded{}",
                                    rounding.is_visible() ? ": " + per_cent_of_edge(rounding) : ""));
    if (!order_survives(soup))
        notes.emplace_back("STL does not store vertices; they will be numbered by first appearance on reading");
    if (!extras.vertex_colours.empty() || !extras.face_colours.empty()) notes.emplace_back("STL cannot store colours");
    if (!extras.vertex_labels.empty() || !extras.face_labels.empty()) notes.emplace_back("STL cannot store labels");
    if (!extras.corner_texture.empty()) notes.emplace_back("STL cannot store texture coordinates");
    if (!extras.appearance.empty()) notes.emplace_back("STL cannot store materials and images");
    return notes;
}

}  // namespace ostraka::io

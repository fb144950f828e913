#include "ostraka/io/repair.h"

#include "io/repair_steps.h"
#include "io/soup_geometry.h"
#include "io/triangle_tree.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/carry_extras.h"
#include "ostraka/io/wrap.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace ostraka {

using detail::RepairSoup;

namespace {

std::size_t count_of(const detail::Counts& counts, const std::string& name) {
    for (const auto& [key, value] : counts)
        if (key == name) return value;
    return 0;
}

/// Refuses input from which no step can make a surface.
void check_triangles(const TriangleSoup& soup) {
    detail::check_soup(soup);
    if (soup.triangles.empty())
        fail_input("mesh", soup.points.empty() ? "is empty" : fmt::format("has {} points and no faces", soup.points.size()),
                   "give a file with faces; points alone are not a surface");
    for (const auto& t : soup.triangles)
        if (!detail::has_no_area(soup, t)) return;
    fail_input("mesh", "has no face with an area", "check the scale and the precision of the file's coordinates");
}

/// For each new element, the value of the old element in `like`.
void check_extras(const TriangleSoup& soup, const MeshExtras& extras) {
    const auto check = [](std::size_t size, std::size_t count, const char* attribute) {
        if (size != 0 && size != count) fail_input(attribute, fmt::format("has {} entries for {} elements", size, count));
    };
    check(extras.vertex_colours.size(), soup.points.size(), "vertex colours");
    check(extras.vertex_labels.size(), soup.points.size(), "vertex labels");
    check(extras.face_colours.size(), soup.triangles.size(), "face colours");
    check(extras.face_labels.size(), soup.triangles.size(), "face labels");
    check(extras.corner_texture.size(), 3 * soup.triangles.size(), "corner texture");
    check(extras.face_materials.size(), soup.triangles.size(), "face materials");
    for (const NamedValues& column : extras.vertex_values) check(column.values.size(), soup.points.size(), column.name.c_str());
    for (const NamedValues& column : extras.face_values) check(column.values.size(), soup.triangles.size(), column.name.c_str());
}

MeshExtras carry_extras(const MeshExtras& old, const RepairSoup& work) {
    std::vector<Index> corner_like;
    if (!old.corner_texture.empty())
        for (const auto& triangle_corners : work.corner_like)
            corner_like.insert(corner_like.end(), triangle_corners.begin(), triangle_corners.end());
    return carried(old, {&work.vertex_like, &work.face_like, &corner_like});
}

/// Inverts a map new -> old to old -> new; each old element is represented by the element kept for it.
std::vector<Index> inverted(const std::vector<Index>& source, const std::vector<Index>& kept_for) {
    std::vector<Index> map(kept_for.size(), no_index);
    for (std::size_t i = source.size(); i-- > 0;)
        if (source[i] != no_index) map[source[i]] = static_cast<Index>(i);
    for (Index old = 0; old < map.size(); ++old) {
        Index kept = old;
        while (kept_for[kept] != kept) kept = kept_for[kept];
        if (kept != old) map[old] = map[kept];
    }
    return map;
}

Index nearest_corner(const TriangleSoup& soup, Index triangle, const Point& p) {
    Index best = 0;
    for (Index k = 1; k < 3; ++k)
        if (CGAL::squared_distance(p, detail::point(soup, soup.triangles[triangle][k])) <
            CGAL::squared_distance(p, detail::point(soup, soup.triangles[triangle][best])))
            best = k;
    return best;
}

Point middle(const TriangleSoup& soup, Index t) {
    const auto& [a, b, c] = soup.triangles[t];
    return CGAL::centroid(detail::point(soup, a), detail::point(soup, b), detail::point(soup, c));
}

/// Replaces the soup by its wrap; attributes and maps are taken from the nearest triangle and its nearest corner.
void wrap(RepairSoup& work, const TriangleSoup& original, const RepairOptions& options, RepairResult& result) {
    const double size = detail::diagonal(detail::box_of_triangles(work.soup));
    TriangleSoup wrapped = wrap_soup(work.soup, options.wrap_alpha * size, options.wrap_offset * size);
    const detail::TriangleTree old_tree(original), new_tree(wrapped);
    RepairSoup made(wrapped);
    parallel_for(wrapped.points.size(), [&](std::size_t v) {
        const Point p = detail::point(wrapped, static_cast<Index>(v));
        const Index t = old_tree.nearest(p).triangle;
        made.vertex_source[v] = no_index;
        made.vertex_like[v] = original.triangles[t][nearest_corner(original, t, p)];
    });
    parallel_for(wrapped.triangles.size(), [&](std::size_t f) {
        const Index t = old_tree.nearest(middle(wrapped, static_cast<Index>(f))).triangle;
        made.face_source[f] = no_index;
        made.face_like[f] = t;
        for (std::size_t k = 0; k < 3; ++k)
            made.corner_like[f][k] = 3 * t + nearest_corner(original, t, detail::point(wrapped, wrapped.triangles[f][k]));
    });
    result.vertex_map.assign(original.points.size(), no_index);
    result.face_map.assign(original.triangles.size(), no_index);
    parallel_for(original.triangles.size(),
                 [&](std::size_t t) { result.face_map[t] = new_tree.nearest(middle(original, static_cast<Index>(t))).triangle; });
    std::vector<std::uint8_t> used(original.points.size(), 0);
    for (const auto& t : original.triangles)
        for (const Index v : t) used[v] = 1;
    parallel_for(original.points.size(), [&](std::size_t v) {
        if (used[v] == 0) return;
        const Point p = detail::point(original, static_cast<Index>(v));
        const Index t = new_tree.nearest(p).triangle;
        result.vertex_map[v] = wrapped.triangles[t][nearest_corner(wrapped, t, p)];
    });
    result.maps_by_distance = true;
    result.steps.push_back({"wrap", {{"vertices made", wrapped.points.size()}, {"triangles made", wrapped.triangles.size()}}});
    work = std::move(made);
}

/// Notes further changes made by removing self-intersections or wrapping.
void note_losses(const MeshDiagnosis& before, const MeshDiagnosis& after, std::vector<std::string>& notes) {
    if (before.components.size() != after.components.size())
        notes.push_back(
            fmt::format("the number of components changed from {} to {}", before.components.size(), after.components.size()));
    else if (before.closed() && after.closed() && before.euler() != after.euler())
        notes.push_back(
            fmt::format("the number of handles changed: the Euler number was {} and is {}", before.euler(), after.euler()));
    constexpr double visible = 0.01;
    const auto compare = [&](const char* quantity, double old_value, double new_value) {
        if (old_value != 0 && std::abs(new_value - old_value) > visible * std::abs(old_value))
            notes.push_back(fmt::format("the {} changed by {} %, from {} to {}", quantity,
                                        digits(100 * (new_value - old_value) / std::abs(old_value), 2), digits(old_value, 5),
                                        digits(new_value, 5)));
    };
    compare("area", before.area, after.area);
    if (before.closed() && after.closed()) compare("volume", before.volume, after.volume);
}

}  // namespace

RepairResult repair(const TriangleSoup& original, const MeshExtras& extras, const RepairOptions& options) {
    check_options(options, "repair");
    check_triangles(original);
    check_extras(original, extras);
    RepairResult result;
    const auto step = [&](const char* name, detail::Counts counts) -> const detail::Counts& {
        result.steps.push_back({name, std::move(counts)});
        return result.steps.back().counts;
    };
    RepairSoup work(original);
    const double size = detail::diagonal(detail::box_of_triangles(original));
    double crack = 0;
    step("merge points", detail::merge_points(work, {options.merge_distance * size, options.merge_gap}, crack));
    step("drop triangles", detail::drop_invalid_triangles(work));
    if (work.soup.triangles.empty())
        fail_input("mesh", "has no face left after points were merged", "use a smaller --merge-distance or --merge-gap");
    // Coordinates in text files have six digits.
    step("T-junctions", detail::sew_junctions(work, std::max({1e-6 * size, crack, options.merge_distance * size})));
    const auto& orientation = step("orient", detail::orient_patches(work));
    if (count_of(orientation, "edges cut because the surface has one side only") > 0)
        result.notes.emplace_back("a part of the surface is one-sided (a Moebius strip) and was cut open to be oriented");
    step("take apart", detail::separate_nonmanifold(work));
    if (options.keep_largest || options.min_component_share > 0)
        step("drop components", detail::drop_components(work, options.keep_largest, options.min_component_share));
    const auto& degenerate = step("triangles without area", detail::flip_degenerate(work));
    if (count_of(degenerate, "border triangles dropped") > 0) step("take apart again", detail::separate_nonmanifold(work));
    step("turn outwards", detail::orient_outwards(work));
    step("isolated vertices", {{"dropped", work.drop_isolated(options.keep_isolated)}});
    if (options.fill_holes > 0) {
        step("fill holes",
             detail::fill_holes(work, {static_cast<std::size_t>(options.fill_holes), options.fill_holes_size, false}));
        step("turn outwards, once closed", detail::orient_outwards(work));
        const auto& flat = step("fillings without area", detail::flip_degenerate(work));
        if (count_of(flat, "border triangles dropped") > 0) detail::separate_nonmanifold(work);
    }
    if (work.soup.triangles.empty()) fail_input("mesh", "has no face with non-zero area left", "check the file's coordinates");
    if (options.remove_self_intersections || options.wrap) result.before = diagnose(work.soup, {.skip_self_intersections = true});
    if (options.remove_self_intersections) {
        step("self-intersections", detail::remove_self_intersections(work, result.notes));
        work.drop_isolated(options.keep_isolated);
    }
    if (options.wrap) {
        wrap(work, original, options, result);
    } else {
        result.vertex_map = inverted(work.vertex_source, work.merged_into);
        result.face_map = inverted(work.face_source, work.duplicate_of);
    }
    if (try_build_mesh(work.soup, result.mesh).any())
        fail_work("mesh", "could not be made an oriented manifold", "try --wrap, and please report the file");
    result.extras = carry_extras(extras, work);
    result.vertex_source = std::move(work.vertex_source);
    result.face_source = std::move(work.face_source);
    result.after = diagnose(work.soup);
    if (result.before) note_losses(*result.before, result.after, result.notes);
    if (result.after.border_edges > 0) {
        const double crack_fraction = 1.1 * detail::crack_width(work.soup) / size;
        result.notes.emplace_back(crack_fraction > 0
                                      ? fmt::format("cracks remain: most border points have another border point within {} of "
                                                    "the diagonal (join them with --merge-distance {})",
                                                    digits(crack_fraction, 2), digits(crack_fraction, 2))
                                      : "holes remain (close wider or longer ones with --fill-holes-size 1 "
                                        "--fill-holes N, or use --wrap)");
    }
    if (result.after.self_intersections > 0)
        result.notes.emplace_back(options.remove_self_intersections
                                      ? "intersecting triangles remain (use --wrap)"
                                      : "triangles intersect (use --remove-self-intersections or --wrap)");
    return result;
}

namespace {

/// The soup as an STL reader sees it.
TriangleSoup as_stl(const TriangleSoup& soup) {
    TriangleSoup stl_soup;
    std::vector<std::array<double, 3>> rounded = soup.points;
    for (auto& p : rounded)
        for (double& x : p) x = static_cast<double>(static_cast<float>(x));
    const std::vector<Index> place = detail::same_place(rounded);
    std::vector<Index> new_index(soup.points.size(), no_index);
    for (auto t : soup.triangles) {
        for (Index& v : t) {
            Index& index = new_index[place[v]];
            if (index == no_index) {
                index = static_cast<Index>(stl_soup.points.size());
                stl_soup.points.push_back(rounded[v]);
            }
            v = index;
        }
        stl_soup.triangles.push_back(t);
    }
    return stl_soup;
}

/// Moves vertices that coincide in single precision towards the centroid of their triangles; returns their number.
std::size_t move_apart(TriangleSoup& soup, double distance) {
    std::vector<std::array<double, 3>> rounded = soup.points;
    for (auto& p : rounded)
        for (double& x : p) x = static_cast<double>(static_cast<float>(x));
    const std::vector<Index> place = detail::same_place(rounded);
    std::vector<std::uint8_t> shared(soup.points.size(), 0);
    for (Index v = 0; v < place.size(); ++v)
        if (place[v] != v) shared[v] = shared[place[v]] = 1;
    std::vector<Vector> inwards(soup.points.size(), Vector(0, 0, 0));
    for (Index t = 0; t < soup.triangles.size(); ++t)
        for (const Index v : soup.triangles[t])
            if (shared[v] != 0) inwards[v] += middle(soup, t) - detail::point(soup, v);
    std::size_t moved = 0;
    for (Index v = 0; v < inwards.size(); ++v) {
        const double length = std::sqrt(inwards[v].squared_length());
        if (length == 0) continue;
        const Point p = detail::point(soup, v) + distance / length * inwards[v];
        soup.points[v] = {p.x(), p.y(), p.z()};
        ++moved;
    }
    return moved;
}

}  // namespace

void prepare_for_stl(RepairResult& result) {
    MeshDiagnosis stl_diagnosis = diagnose(as_stl(to_soup(result.mesh)));
    if (!stl_diagnosis.manifold() && result.after.manifold()) {
        TriangleSoup soup = to_soup(result.mesh);
        const auto& box = result.after.box;
        double farthest = 0;
        for (int k = 0; k < 3; ++k) farthest = std::max({farthest, std::abs(box.min(k)), std::abs(box.max(k))});
        const double distance =
            std::max(1e-6 * result.after.diagonal, 8 * farthest * static_cast<double>(std::numeric_limits<float>::epsilon()));
        const std::size_t moved = move_apart(soup, distance);
        MeshDiagnosis separated_diagnosis = diagnose(as_stl(soup));
        if (separated_diagnosis.defects().size() < stl_diagnosis.defects().size()) {
            for (Index v = 0; v < soup.points.size(); ++v) result.mesh.point(Vertex(v)) = detail::point(soup, v);
            stl_diagnosis = std::move(separated_diagnosis);
            result.notes.push_back(
                fmt::format("STL merges vertices at the same position: {} copies of vertices were moved apart by {}", moved,
                            digits(distance, 2)));
        }
        if (!stl_diagnosis.manifold())
            result.notes.emplace_back(
                "STL merges vertices at the same position, so that the mesh read from it is not manifold (write PLY)");
    }
    result.after = std::move(stl_diagnosis);
}

void RepairOptions::declare_options(OptionList& list) {
    list("merge-distance", merge_distance, "merge border points closer than this (0: only equal positions)", Range{0, 0.1},
         "share of the diagonal");
    list("merge-gap", merge_gap, "also merge border points across cracks narrower than this width (0: no cracks)", Range{0, 0.5},
         "share of the shortest edge at the points");
    list("keep-isolated", keep_isolated, "keep vertices without a face", Anything{});
    list("keep-largest", keep_largest, "keep only the component with the largest area", Anything{});
    list("min-component-share", min_component_share, "minimum share of the total area of a component that is kept", Range{0, 1},
         "share of the area");
    list("fill-holes", fill_holes, "maximum number of border edges of a hole that is filled (0: no hole is filled)",
         Range{0, 100000});
    list("fill-holes-size", fill_holes_size, "maximum width (diameter of a disc of the same area) of a hole that is filled",
         Range{0, 1}, "share of their component's diagonal");
    list("remove-self-intersections", remove_self_intersections, "remove intersecting triangles and close the gaps", Anything{});
    list("wrap", wrap, "replace the surface by a watertight wrap, which loses details smaller than twice --wrap-alpha",
         Anything{});
    list("wrap-alpha", wrap_alpha, "with --wrap: radius of the ball that fits through openings that the wrap enters",
         Range{0.002, 0.5}, "share of the diagonal");
    list("wrap-offset", wrap_offset, "with --wrap: distance of the wrap from the surface", Range{0.0001, 0.1},
         "share of the diagonal");
}

}  // namespace ostraka

// Surfaces of revolution from the sherds of synthetic vessels, some of them useless: axis, profile, selection of sherds.
#include "breaks.h"
#include "experiments.h"
#include "report.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/synthetic/make_mesh.h"
#include "shatter.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <sstream>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

struct Layout {
    const char* name;
    double noise, erosion;  ///< shares of the diagonal
    double degrees, shift;  ///< standard deviations of each sherd's tilt and position (share of the diagonal)
    int useless;            ///< number of sherds in random positions instead of their own
    bool stranger, tile;    ///< one sherd of another vessel; a flat piece
    double missing;         ///< share of missing sherds
};

/// Distance of the vessel's walls from the template aligned by its axis and height, at most 5 % of the diagonal; only at
/// heights covered by sherds.
double profile_error(const Mesh& whole, const std::vector<Fragment>& truth, const std::vector<bool>& lies,
                     RevolutionTemplate& made) {
    const SurfaceSearch vessel(whole);
    const double diagonal = box_diagonal(whole);
    const Vector3d up = eigen(made.axis.direction);
    Motion lay;
    lay.rotation = Eigen::Quaterniond::FromTwoVectors(up, Vector3d(0, 0, up.z() < 0 ? -1 : 1)).toRotationMatrix();
    const Vector3d foot = lay.rotation * eigen(made.axis.point);
    lay.translation = Vector3d(-foot.x(), -foot.y(), 0);
    std::vector<Point> places;
    std::vector<Vector> normals;
    std::vector<double> areas;
    for (std::size_t k = 0; k < truth.size(); ++k)
        for (const Face f : truth[k].mesh.faces()) {
            const Vector n = area_vector(truth[k].mesh, f);
            const double length = std::sqrt(n.squared_length());
            if (!lies[k] || !(length > 0)) continue;
            // compares with the vessel's own walls
            const auto wall = vessel.closest_compatible(centroid(truth[k].mesh, f), n / length, 0.8, 0.01 * diagonal);
            if (!wall) continue;
            places.push_back(wall->point), normals.push_back(n / length), areas.push_back(length);
        }
    double error = 0;
    for (int round = 0; round < 12; ++round) {
        const Mesh laid = moved(made.mesh, lay);
        const SurfaceSearch surface(laid);
        double squares = 0, area = 0, a = 0, b = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto hit = surface.closest_compatible(places[i], normals[i], 0.7, 0.05 * diagonal);
            const double off = hit ? hit->distance : 0.05 * diagonal;
            squares += areas[i] * off * off, area += areas[i];
            if (!hit) continue;
            const double slope = normals[i].z();
            a += areas[i] * slope * slope, b += areas[i] * slope * (normals[i] * (places[i] - hit->point));
        }
        error = std::sqrt(squares / area) / diagonal;
        if (!(a > 0) || std::abs(b / a) < 1e-5 * diagonal) break;
        lay.translation.z() += b / a;
    }
    return error;
}

}  // namespace

void turned_sherds(const BreakExperiment& options) {
    const std::vector<Layout> layouts{{"as they lay", 0, 0, 0, 0, 0, false, false, 0},
                                      {"noise 0.1 %, worn 0.2 %", 0.001, 0.002, 0, 0, 0, false, false, 0},
                                      {"the same, tilted 2 degrees, shifted 1 %", 0.001, 0.002, 2, 0.01, 0, false, false, 0},
                                      {"the same, half of the sherds", 0.001, 0.002, 2, 0.01, 0, false, false, 0.5},
                                      {"worn; 3 sherds lie anywhere", 0.001, 0.002, 0, 0, 3, false, false, 0},
                                      {"worn; one of another vessel, a flat tile", 0.001, 0.002, 0, 0, 0, true, true, 0},
                                      {"tilted, shifted; 3 anywhere, stranger, tile", 0.001, 0.002, 2, 0.01, 3, true, true, 0}};
    std::ostringstream csv;
    csv << "layout,vessel,sherds,used,partly,left_out,useless_used,axis_degrees,axis_percent,said_degrees,profile_percent\n";
    std::cout
        << "| layout | templates made | sherds used, partly used, of those that belong | of no use, used | axis off: degrees, "
           "% of the diagonal (median, worst) | said: degrees | walls off % of the diagonal (median, worst) | s each "
           "|\n|---|---|---|---|---|---|---|---|\n";
    for (const Layout& layout : layouts) {
        std::size_t made = 0, used = 0, partly = 0, belong = 0, wrong = 0, useless = 0;
        std::vector<double> degrees, percent, said, walls;
        double seconds = 0;
        for (int vessel = 1; vessel <= options.pots; ++vessel) {
            const auto shape_seed = static_cast<std::uint64_t>(options.first + vessel);
            PotOptions shape;
            shape.shape = shape_seed;
            Random random(shape_seed, 91);
            shape.height = random.uniform(12, 22), shape.radius = random.uniform(5, 9), shape.wall = random.uniform(0.4, 0.8);
            const Mesh whole = make_pot(shape);
            const double diagonal = box_diagonal(whole);
            ShatterOptions breaking;
            breaking.pieces = 8 + vessel % 5;
            breaking.noise = layout.noise, breaking.erosion = layout.erosion;
            breaking.seed = 300 + shape_seed;
            std::vector<Sherd> sherds = shatter(whole, breaking);
            if (layout.missing > 0)
                sherds.resize(sherds.size() - static_cast<std::size_t>(layout.missing * static_cast<double>(sherds.size())));
            std::vector<Fragment> fragments;
            std::vector<bool> good;
            const auto add = [&](Mesh mesh, bool belongs) {
                fragments.emplace_back();
                fragments.back().name = std::to_string(fragments.size());
                fragments.back().mesh = std::move(mesh);
                good.push_back(belongs);
            };
            for (const Sherd& one : sherds) add(one.mesh, true);
            const std::vector<Fragment> truth = fragments;
            const auto place = [&](Fragment& one, double angle, double shift) {
                Vector3d middle = Vector3d::Zero();
                for (const Vertex v : one.mesh.vertices()) middle += eigen(one.mesh.point(v));
                middle /= static_cast<double>(one.mesh.number_of_vertices());
                const Vector3d turn = angle * Vector3d(random.normal(), random.normal(), random.normal());
                Motion motion;
                if (turn.norm() > 0) motion.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
                motion.translation =
                    middle - motion.rotation * middle + shift * Vector3d(random.normal(), random.normal(), random.normal());
                one.mesh = moved(one.mesh, motion);
            };
            for (Fragment& one : fragments)
                place(one, layout.degrees * std::numbers::pi / 180 / std::sqrt(2.0), layout.shift * diagonal / std::sqrt(2.0));
            for (int k = 0; k < layout.useless; ++k) {
                const auto which = static_cast<std::size_t>(1 + 2 * k) % truth.size();
                place(fragments[which], 1.5, 0.15 * diagonal);
                good[which] = false;
            }
            if (layout.stranger) {
                PotOptions other = shape;
                other.shape = shape_seed + 5000;
                other.radius *= 0.7;
                ShatterOptions how = breaking;
                how.seed += 7;
                add(shatter(make_pot(other), how)[1].mesh, false);
                place(fragments.back(), 1.5, 0.1 * diagonal);
            }
            if (layout.tile) {
                MakeOptions how;
                how.vertices = 3000;
                Mesh tile = make_mesh(synthetic_object("box"), how).mesh;
                const double size = box_diagonal(tile);
                for (const Vertex v : tile.vertices()) {
                    Vector3d p = eigen(tile.point(v)) * (0.4 * diagonal / size);
                    p.x() = shape.radius + 0.15 * p.x();
                    p.z() += 0.5 * shape.height;
                    tile.point(v) = point_of(p);
                }
                add(std::move(tile), false);
                place(fragments.back(), 0.5, 0.02 * diagonal);
            }
            if (options.write) {
                const Path folder = Path(options.output) / (std::string(1, static_cast<char>('a' + (&layout - layouts.data()))) +
                                                            std::to_string(vessel));
                std::filesystem::create_directories(folder);
                for (const Fragment& one : fragments) write_mesh(folder / (one.name + ".ply"), one.mesh);
            }
            std::vector<const Fragment*> pointers;
            for (const Fragment& one : fragments) pointers.push_back(&one);
            const Stopwatch watch;
            for (Fragment& one : fragments) one.facets = find_facets(one.mesh).of_face;
            RevolutionTemplate turned;
            try {
                turned = template_of_revolution(pointers);
            } catch (const Error& error) {
                std::cerr << layout.name << ", vessel " << shape_seed << ": " << error.what() << '\n';
                continue;
            }
            seconds += watch.seconds().processor;
            ++made;
            std::size_t own_used = 0, own_partly = 0, own_wrong = 0, own_out = 0;
            for (std::size_t k = 0; k < fragments.size(); ++k) {
                const SherdUse use = turned.sherds[k].use;
                if (good[k]) own_used += use == SherdUse::used ? 1 : 0, own_partly += use == SherdUse::partly ? 1 : 0;
                own_out += use == SherdUse::left_out ? 1 : 0;
                own_wrong += !good[k] && use != SherdUse::left_out ? 1 : 0;
                belong += good[k] ? 1 : 0;
                useless += good[k] ? 0 : 1;
                if ((use == SherdUse::left_out) == good[k])
                    std::cerr << layout.name << ", vessel " << shape_seed << ", sherd " << k + 1
                              << (good[k] ? "" : " (of no use)") << ": " << to_string(use) << " " << turned.sherds[k].reason
                              << format(" [disagreement %.1f, on template %.2f, weight %.2f]\n", turned.sherds[k].disagreement,
                                        turned.sherds[k].on_template, turned.sherds[k].weight);
            }
            used += own_used, partly += own_partly, wrong += own_wrong;
            // Aligned with the truth by its own axis, since the layout as a whole may be tilted.
            const Vector3d up = eigen(turned.axis.direction), at = eigen(turned.axis.point);
            degrees.push_back(180 / std::numbers::pi * std::acos(std::min(1.0, std::abs(up.z()))));
            const Vector3d foot = at + up * ((0.5 * shape.height - at.z()) / up.z());
            percent.push_back(100 * foot.head<2>().norm() / diagonal);
            said.push_back(turned.direction_error);
            walls.push_back(100 * profile_error(whole, truth, good, turned));
            csv << '"' << layout.name << "\"," << shape_seed << ',' << fragments.size() << ',' << own_used << ',' << own_partly
                << ',' << own_out << ',' << own_wrong << ',' << degrees.back() << ',' << percent.back() << ',' << said.back()
                << ',' << walls.back() << '\n';
        }
        const auto middle = [](std::vector<double> values) {
            if (values.empty()) return 0.0;
            std::sort(values.begin(), values.end());
            return values[values.size() / 2];
        };
        const auto worst = [](const std::vector<double>& values) {
            return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
        };
        std::cout << "| " << layout.name
                  << format(
                         " | %zu of %d | %zu, %zu, of %zu | %zu of %zu | %.2f, %.2f (%.2f, %.2f) | %.2f | %.2f, %.2f | %.1f |\n",
                         made, options.pots, used, partly, belong, wrong, useless, middle(degrees), middle(percent),
                         worst(degrees), worst(percent), middle(said), middle(walls), worst(walls),
                         made > 0 ? seconds / static_cast<double>(made) : 0)
                  << std::flush;
    }
    write_file(Path(options.output) / "turned-sherds.csv", csv.str());
}

}  // namespace ostraka::experiments

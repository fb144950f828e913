// Sherds of synthetic vessels: placed on the whole vessel, rotated by their fractures; and surfaces of revolution from sherds,
// some of them useless.
#include "boxes.h"
#include "shatter.h"

#include "ostraka/core/error.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

struct VesselOptions {
    std::string output = "experiments-output/breaks";
    int pots = 4, first = 0;
    bool write = false;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables and meshes").positional();
        list("pots", pots, "number of synthetic vessels of each kind", Range{1, 1000});
        list("first", first, "number of vessels to skip", Range{0, 100000});
        list("write", write, "write the sherds too");
    }
};

struct Kind {
    const char* name;
    double erosion, noise;
    bool missing = false, stranger = false;
};

Fragment fragment_of(Sherd sherd, const std::string& name, double wall) {
    Fragment fragment;
    fragment.name = name;
    for (const Face f : sherd.mesh.faces()) {
        const Vector3d n = eigen(area_vector(sherd.mesh, f)), p = eigen(centroid(sherd.mesh, f));
        const bool floor = p.z() < 1.2 * wall,
                   outer = floor ? n.z() < 0 || n.head<2>().dot(p.head<2>()) > std::abs(n.z()) : n.head<2>().dot(p.head<2>()) > 0;
        fragment.facets.push_back(sherd.broken[f] ? Facet::fracture : outer ? Facet::outer : Facet::inner);
    }
    fragment.mesh = std::move(sherd.mesh);
    return fragment;
}

/// The sherds of a vessel, moved at random; those from `belong` on are of another one.
struct BrokenPot {
    Mesh whole;
    std::vector<Fragment> fragments;
    std::vector<Motion> motions;
    std::size_t belong = 0;
    /// A fragment in its true position.
    [[nodiscard]] Mesh home(std::size_t k) const { return moved(fragments[k].mesh, motions[k].inverse()); }
};

BrokenPot break_pot(const Kind& kind, int number) {
    BrokenPot pot;
    PotOptions shape;
    shape.shape = static_cast<std::uint64_t>(number);
    ShatterOptions breaking;
    breaking.pieces = 5 + number % 4;
    breaking.erosion = kind.erosion, breaking.noise = kind.noise;
    breaking.seed = static_cast<std::uint64_t>(100 + number);
    pot.whole = make_pot(shape);
    std::vector<Sherd> sherds = shatter(pot.whole, breaking);
    if (kind.missing) sherds.erase(sherds.begin() + 1);
    pot.belong = sherds.size();
    if (kind.stranger) {
        // From a vessel of the same shape, so that the template does not reject it.
        breaking.seed += 1000;
        sherds.push_back(std::move(shatter(pot.whole, breaking)[1]));
    }
    Random random(static_cast<std::uint64_t>(number), 6);
    for (Sherd& sherd : sherds) {
        pot.fragments.push_back(fragment_of(std::move(sherd), std::to_string(pot.fragments.size() + 1), shape.wall));
        pot.motions.push_back(move_at_random(pot.fragments.back(), random, 20));
    }
    return pot;
}

/// Places fragments on the whole and decides their rotations, as in reconstruct, without the later stages.
std::optional<RotationMatch> place(const BrokenPot& pot, CommonPlacement& placement) {
    placement.fragments.resize(pot.fragments.size());
    for (FragmentPlacement& unplaced : placement.fragments) unplaced.problem = "no landmarks";
    const std::vector<const Fragment*> pointers = pointers_to(pot.fragments);
    const auto searched = place_by_search(pot.whole, pointers, {}, placement.scale, placement.fragments);
    const SurfaceSearch surface(pot.whole);
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        FragmentPlacement& placed = placement.fragments[k];
        if (!placed.problem.empty()) continue;
        placed.pose = align_part(pot.fragments[k].mesh, intact_faces(pot.fragments[k].facets), surface, placed.pose).pose;
    }
    return decide_open_rotations(pot.whole, pointers, searched, placement.fragments);
}

/// Without the rotation about the vertical axis.
Motion without_rotation(const Motion& motion) {
    const Eigen::Matrix3d& r = motion.rotation;
    Motion about_axis;
    about_axis.rotation =
        Eigen::AngleAxisd(std::atan2(r(0, 1) - r(1, 0), r(0, 0) + r(1, 1)), Vector3d::UnitZ()).toRotationMatrix();
    return about_axis.after(motion);
}

struct Counts {
    std::size_t all = 0, strangers = 0;
    Hits placed, carry, decided, together;  ///< placed: well; carry, decided: right
    double overlap = 0, seconds = 0;
};

void judge(const BrokenPot& pot, const CommonPlacement& placement, const std::optional<RotationMatch>& rotations,
           const std::string& kind, int number, Counts& counts, Rows& csv) {
    const double diagonal = box_diagonal(pot.whole);
    const auto back = [&](std::size_t k) { return placement.fragments[k].pose.after(pot.motions[k]); };
    counts.all += pot.fragments.size();
    counts.together.all += pot.belong;
    for (std::size_t k = 0; k < pot.fragments.size(); ++k)
        if (placement.fragments[k].problem.empty())
            counts.placed.add(off_of(pot.home(k), without_rotation(back(k))) < 0.02 * diagonal);
    if (!rotations) return;
    std::vector<std::size_t> size(pot.fragments.size(), 0);
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        if (rotations->group[k] >= 0 && k < pot.belong) ++size[static_cast<std::size_t>(rotations->group[k])];
        counts.overlap = std::max(counts.overlap, 100 * rotations->overlap[k]);
    }
    counts.together.hits += *std::max_element(size.begin(), size.end());
    for (const FractureJoint& joint : rotations->joints) {
        const auto a = static_cast<std::size_t>(joint.first), b = static_cast<std::size_t>(joint.second);
        const Motion off = back(a).inverse().after(back(b));
        const double percent = 100 * off_of(pot.home(b), off) / diagonal;
        const bool strange = a >= pot.belong || b >= pot.belong, good = !strange && percent < 2;
        csv(kind, number, a + 1, b + 1, degrees_of(off), percent, good, joint.carries, joint.contact, joint.rim, joint.share,
            joint.lead, joint.confidence, joint.decided);
        if (!joint.carries) continue;
        counts.carry.add(good);
        if (joint.decided) counts.decided.add(good);
        counts.strangers += joint.decided && strange;
    }
}

/// Synthetic vessels, broken: rotations from fractures with wear, noise, a missing piece, a piece of another vessel.
void broken_pots(const VesselOptions& options) {
    const std::vector<Kind> kinds{{"fresh", 0, 0},
                                  {"noise 0.1 %", 0, 0.001},
                                  {"worn 0.2 %; noise 0.05 %", 0.002, 0.0005},
                                  {"the same; one missing", 0.002, 0.0005, true},
                                  {"the same; one of another vessel", 0.002, 0.0005, false, true},
                                  {"worn 0.4 %; noise 0.1 %", 0.004, 0.001}};
    Rows csv("kind,pot,first,second,degrees,percent,right,carries,contact,rim,share,lead,confidence,decided");
    Table table(
        "kind | sherds placed on the template, of these well, of all | joints that carry: right, of all | decided | of these "
        "right | strangers decided | sherds in one group with the largest, of those that belong % | overlap at most % | s each");
    for (const Kind& kind : kinds) {
        Counts counts;
        for (int number = 1; number <= options.pots; ++number) {
            const BrokenPot pot = break_pot(kind, number);
            CommonPlacement placement;
            const Stopwatch watch;
            const auto rotations = place(pot, placement);
            counts.seconds += watch.seconds().processor;
            judge(pot, placement, rotations, kind.name, number, counts, csv);
        }
        table.row("{} | {}, {} of {} | {} | {} | {} | {} | {:.0f} | {:.1f} | {:.1f}", kind.name, counts.placed.all,
                  counts.placed.hits, counts.all, counts.carry.text(), counts.decided.all, counts.decided.hits, counts.strangers,
                  counts.together.percent(), counts.overlap, counts.seconds / options.pots);
    }
    csv.write(Path(options.output) / "broken-pots.csv");
}

const Registration registered_pots("broken-pots", "made vessels, broken: turns by breaks", broken_pots);

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

/// The sherds of a vessel in a layout, and other pieces.
struct LaidSherds {
    PotOptions shape;
    Mesh whole;
    std::vector<Fragment> truth, fragments;
    std::vector<bool> good;  ///< per fragment: of the vessel, about in its place
};

/// Moves a fragment at random about its middle.
void displace(Fragment& fragment, double angle, double shift, Random& random) {
    Vector3d middle = Vector3d::Zero();
    for (const Point& p : fragment.mesh.points()) middle += eigen(p);
    middle /= static_cast<double>(fragment.mesh.number_of_vertices());
    const Vector3d turn = angle * normal_vector(random);
    Motion motion;
    if (turn.norm() > 0) motion.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    motion.translation = middle - motion.rotation * middle + shift * normal_vector(random);
    fragment.mesh = moved(fragment.mesh, motion);
}

LaidSherds lay_sherds(const Layout& layout, int vessel, std::uint64_t shape_seed) {
    LaidSherds laid;
    PotOptions& shape = laid.shape;
    shape.shape = shape_seed;
    Random random(shape_seed, 91);
    shape.height = random.uniform(12, 22), shape.radius = random.uniform(5, 9), shape.wall = random.uniform(0.4, 0.8);
    laid.whole = make_pot(shape);
    const double diagonal = box_diagonal(laid.whole);
    ShatterOptions breaking;
    breaking.pieces = 8 + vessel % 5;
    breaking.noise = layout.noise, breaking.erosion = layout.erosion;
    breaking.seed = 300 + shape_seed;
    std::vector<Sherd> sherds = shatter(laid.whole, breaking);
    if (layout.missing > 0)
        sherds.resize(sherds.size() - static_cast<std::size_t>(layout.missing * static_cast<double>(sherds.size())));
    const auto add = [&](Mesh mesh, bool good) {
        laid.fragments.emplace_back();
        laid.fragments.back().name = std::to_string(laid.fragments.size());
        laid.fragments.back().mesh = std::move(mesh);
        laid.good.push_back(good);
    };
    for (Sherd& sherd : sherds) add(std::move(sherd.mesh), true);
    laid.truth = laid.fragments;
    for (Fragment& sherd : laid.fragments)
        displace(sherd, layout.degrees * std::numbers::pi / 180 / std::sqrt(2.0), layout.shift * diagonal / std::sqrt(2.0),
                 random);
    for (int k = 0; k < layout.useless; ++k) {
        const auto which = static_cast<std::size_t>(1 + 2 * k) % laid.truth.size();
        displace(laid.fragments[which], 1.5, 0.15 * diagonal, random);
        laid.good[which] = false;
    }
    if (layout.stranger) {
        PotOptions other = shape;
        other.shape = shape_seed + 5000;
        other.radius *= 0.7;
        breaking.seed += 7;
        add(shatter(make_pot(other), breaking)[1].mesh, false);
        displace(laid.fragments.back(), 1.5, 0.1 * diagonal, random);
    }
    if (layout.tile) {
        const Mesh tile = made_mesh("box", 3000);
        const double size = box_diagonal(tile);
        add(warped(tile,
                   [&](const Vector3d& p) {
                       const Vector3d q = p * (0.4 * diagonal / size);
                       return Vector3d(shape.radius + 0.15 * q.x(), q.y(), q.z() + 0.5 * shape.height);
                   }),
            false);
        displace(laid.fragments.back(), 0.5, 0.02 * diagonal, random);
    }
    return laid;
}

struct TemplateCounts {
    std::size_t made = 0, used = 0, partly = 0, belong = 0, wrong = 0, useless = 0;
    std::vector<double> degrees, percent, said, walls;
    double seconds = 0;
};

void judge(const LaidSherds& laid, RevolutionTemplate& turned, const std::string& layout, TemplateCounts& counts, Rows& csv) {
    std::size_t used = 0, partly = 0, wrong = 0, out = 0;
    for (std::size_t k = 0; k < laid.fragments.size(); ++k) {
        const SherdOnProfile& sherd = turned.sherds[k];
        const bool good = laid.good[k], left_out = sherd.use == SherdUse::left_out;
        used += good && sherd.use == SherdUse::used;
        partly += good && sherd.use == SherdUse::partly;
        out += left_out;
        wrong += !good && !left_out;
        ++(good ? counts.belong : counts.useless);
        if (left_out == good)
            fmt::print(stderr, "{}, vessel {}, sherd {}{}: {} {} [disagreement {:.1f}, on template {:.2f}, weight {:.2f}]\n",
                       layout, laid.shape.shape, k + 1, good ? "" : " (of no use)", to_string(sherd.use), sherd.reason,
                       sherd.disagreement, sherd.on_template, sherd.weight);
    }
    ++counts.made;
    counts.used += used, counts.partly += partly, counts.wrong += wrong;
    // Aligned with the truth by its own axis, since the layout as a whole may be tilted.
    const Vector3d up = eigen(turned.axis.direction), at = eigen(turned.axis.point);
    counts.degrees.push_back(180 / std::numbers::pi * std::acos(std::min(1.0, std::abs(up.z()))));
    const Vector3d foot = at + up * ((0.5 * laid.shape.height - at.z()) / up.z());
    counts.percent.push_back(100 * foot.head<2>().norm() / box_diagonal(laid.whole));
    counts.said.push_back(turned.direction_error);
    counts.walls.push_back(100 * profile_error(laid.whole, laid.truth, laid.good, turned));
    csv(layout, laid.shape.shape, laid.fragments.size(), used, partly, out, wrong, counts.degrees.back(), counts.percent.back(),
        counts.said.back(), counts.walls.back());
}

/// Synthetic vessels, broken: surfaces of revolution from sherds that are well placed, badly placed, or unrelated.
void turned_sherds(const VesselOptions& options) {
    const std::vector<Layout> layouts{{"as they lay", 0, 0, 0, 0, 0, false, false, 0},
                                      {"noise 0.1 %, worn 0.2 %", 0.001, 0.002, 0, 0, 0, false, false, 0},
                                      {"the same, tilted 2 degrees, shifted 1 %", 0.001, 0.002, 2, 0.01, 0, false, false, 0},
                                      {"the same, half of the sherds", 0.001, 0.002, 2, 0.01, 0, false, false, 0.5},
                                      {"worn; 3 sherds lie anywhere", 0.001, 0.002, 0, 0, 3, false, false, 0},
                                      {"worn; one of another vessel, a flat tile", 0.001, 0.002, 0, 0, 0, true, true, 0},
                                      {"tilted, shifted; 3 anywhere, stranger, tile", 0.001, 0.002, 2, 0.01, 3, true, true, 0}};
    Rows csv("layout,vessel,sherds,used,partly,left_out,useless_used,axis_degrees,axis_percent,said_degrees,profile_percent");
    Table table(
        "layout | templates made | sherds used, partly used, of those that belong | of no use, used | axis off: degrees, % of "
        "the diagonal (median, worst) | said: degrees | walls off % of the diagonal (median, worst) | s each");
    char letter = 'a';
    for (const Layout& layout : layouts) {
        TemplateCounts counts;
        for (int vessel = 1; vessel <= options.pots; ++vessel) {
            LaidSherds laid = lay_sherds(layout, vessel, static_cast<std::uint64_t>(options.first + vessel));
            for (const Fragment& sherd : laid.fragments)
                if (options.write)
                    write_mesh(Path(options.output) / fmt::format("{}{}", letter, vessel) / (sherd.name + ".ply"), sherd.mesh);
            const Stopwatch watch;
            for (Fragment& sherd : laid.fragments) sherd.facets = find_facets(sherd.mesh).of_face;
            try {
                RevolutionTemplate turned = template_of_revolution(pointers_to(laid.fragments));
                counts.seconds += watch.seconds().processor;
                judge(laid, turned, layout.name, counts, csv);
            } catch (const Error& error) {
                fmt::print(stderr, "{}, vessel {}: {}\n", layout.name, laid.shape.shape, error.what());
            }
        }
        ++letter;
        const auto middle = [](const std::vector<double>& values) { return values.empty() ? 0.0 : upper_median(values); };
        const auto worst = [](const std::vector<double>& values) { return mean_and_max(values).max; };
        table.row("{} | {} of {} | {}, {}, of {} | {} of {} | {:.2f}, {:.2f} ({:.2f}, {:.2f}) | {:.2f} | {:.2f}, {:.2f} | {:.1f}",
                  layout.name, counts.made, options.pots, counts.used, counts.partly, counts.belong, counts.wrong, counts.useless,
                  middle(counts.degrees), middle(counts.percent), worst(counts.degrees), worst(counts.percent),
                  middle(counts.said), middle(counts.walls), worst(counts.walls),
                  counts.made > 0 ? counts.seconds / static_cast<double>(counts.made) : 0);
    }
    csv.write(Path(options.output) / "turned-sherds.csv");
}

const Registration registered_templates("turned-sherds", "made vessels, broken: templates turned from sherds, some of no use",
                                        turned_sherds);

}  // namespace

}  // namespace ostraka::experiments

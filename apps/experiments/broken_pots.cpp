// Places the sherds of synthetic vessels on the whole vessel, and recovers their rotations from the fractures.
#include "sherds.h"

#include "ostraka/reconstruction/reconstruct.h"

#include <cmath>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

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
    for (Sherd& one : sherds) {
        pot.fragments.push_back(fragment_of(std::move(one), std::to_string(pot.fragments.size() + 1), shape.wall));
        pot.motions.push_back(random_motion(random, 20));
        pot.fragments.back().mesh = moved(pot.fragments.back().mesh, pot.motions.back());
    }
    return pot;
}

/// Places fragments on the whole and decides their rotations, as in reconstruct, without the later stages.
std::optional<RotationMatch> place(const BrokenPot& pot, CommonPlacement& placement) {
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        placement.fragments.emplace_back();
        placement.fragments.back().problem = "no landmarks";
    }
    const std::vector<const Fragment*> pointers = pointers_to(pot.fragments);
    const auto searched = place_by_search(pot.whole, pointers, {}, placement.scale, placement.fragments);
    const SurfaceSearch surface(pot.whole);
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        FragmentPlacement& one = placement.fragments[k];
        if (!one.problem.empty()) continue;
        one.pose = align_part(pot.fragments[k].mesh, intact_faces(pot.fragments[k].facets), surface, one.pose).pose;
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
    std::size_t all = 0, placed = 0, well = 0, carry = 0, right = 0, decided = 0, decided_right = 0, strangers = 0, own = 0,
                together = 0;
    double overlap = 0, seconds = 0;
};

void judge(const BrokenPot& pot, const CommonPlacement& placement, const std::optional<RotationMatch>& rotations,
           const std::string& kind, int number, Counts& counts, Rows& csv) {
    const double diagonal = box_diagonal(pot.whole);
    const auto back = [&](std::size_t k) { return placement.fragments[k].pose.after(pot.motions[k]); };
    counts.all += pot.fragments.size();
    counts.own += pot.belong;
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        if (!placement.fragments[k].problem.empty()) continue;
        ++counts.placed;
        counts.well += off_of(pot.home(k), without_rotation(back(k))) < 0.02 * diagonal;
    }
    if (!rotations) return;
    std::vector<std::size_t> size(pot.fragments.size(), 0);
    for (std::size_t k = 0; k < pot.fragments.size(); ++k) {
        if (rotations->group[k] >= 0 && k < pot.belong) ++size[static_cast<std::size_t>(rotations->group[k])];
        counts.overlap = std::max(counts.overlap, 100 * rotations->overlap[k]);
    }
    counts.together += *std::max_element(size.begin(), size.end());
    for (const FractureJoint& joint : rotations->joints) {
        const auto a = static_cast<std::size_t>(joint.first), b = static_cast<std::size_t>(joint.second);
        const Motion off = back(a).inverse().after(back(b));
        const double percent = 100 * off_of(pot.home(b), off) / diagonal;
        const bool strange = a >= pot.belong || b >= pot.belong, good = !strange && percent < 2;
        csv(kind, number, a + 1, b + 1, degrees_of(off), percent, good, joint.carries, joint.contact, joint.rim, joint.share,
            joint.lead, joint.confidence, joint.decided);
        if (!joint.carries) continue;
        ++counts.carry;
        counts.right += good;
        counts.decided += joint.decided;
        counts.decided_right += joint.decided && good;
        counts.strangers += joint.decided && strange;
    }
}

/// Synthetic vessels, broken: rotations from fractures with wear, noise, a missing piece, a piece of another vessel.
void broken_pots(const SherdOptions& options) {
    const std::vector<Kind> kinds{{"fresh", 0, 0},
                                  {"noise 0.1 %", 0, 0.001},
                                  {"worn 0.2 %; noise 0.05 %", 0.002, 0.0005},
                                  {"the same; one missing", 0.002, 0.0005, true},
                                  {"the same; one of another vessel", 0.002, 0.0005, false, true},
                                  {"worn 0.4 %; noise 0.1 %", 0.004, 0.001}};
    Rows csv("kind,pot,first,second,degrees,percent,right,carries,contact,rim,share,lead,confidence,decided");
    Table table(
        "kind | sherds placed on the template, of these well, of all | joints that carry: right, of all | decided | of these "
        "right "
        "| strangers decided | sherds in one group with the largest, of those that belong % | overlap at most % | s each");
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
        table.row("{} | {}, {} of {} | {} of {} | {} | {} | {} | {:.0f} | {:.1f} | {:.1f}", kind.name, counts.placed, counts.well,
                  counts.all, counts.right, counts.carry, counts.decided, counts.decided_right, counts.strangers,
                  percentage(counts.together, counts.own), counts.overlap, counts.seconds / options.pots);
    }
    csv.write(Path(options.output) / "broken-pots.csv");
}

const Registration registered("broken-pots", "made vessels, broken: turns by breaks", broken_pots);

}  // namespace

}  // namespace ostraka::experiments

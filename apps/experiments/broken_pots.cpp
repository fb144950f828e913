// Places the sherds of synthetic vessels on the whole vessel, and recovers their rotations from the fractures.
#include "breaks.h"
#include "experiments.h"
#include "report.h"

#include "ostraka/core/file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "shatter.h"

#include <cmath>
#include <iostream>
#include <sstream>

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

}  // namespace

void broken_pots(const BreakExperiment& options) {
    const std::vector<Kind> kinds{{"fresh", 0, 0},
                                  {"noise 0.1 %", 0, 0.001},
                                  {"worn 0.2 %; noise 0.05 %", 0.002, 0.0005},
                                  {"the same; one missing", 0.002, 0.0005, true},
                                  {"the same; one of another vessel", 0.002, 0.0005, false, true},
                                  {"worn 0.4 %; noise 0.1 %", 0.004, 0.001}};
    std::ostringstream csv;
    csv << "kind,pot,first,second,degrees,percent,right,carries,contact,rim,share,lead,confidence,decided\n";
    std::cout << "| kind | sherds placed on the template, of these well, of all | joints that carry: right, of all | decided | "
                 "of these right | "
                 "strangers decided | sherds in one group with the largest, of those that belong % | overlap at most % | s each "
                 "|\n|---|---|---|---|---|---|---|---|---|\n";
    for (const Kind& kind : kinds) {
        std::size_t all = 0, placed = 0, well = 0, carry = 0, right = 0, decided = 0, decided_right = 0, strangers = 0, own = 0,
                    together = 0;
        double overlap = 0, seconds = 0;
        for (int pot = 1; pot <= options.pots; ++pot) {
            PotOptions shape;
            shape.shape = static_cast<std::uint64_t>(pot);
            ShatterOptions breaking;
            breaking.pieces = 5 + pot % 4;
            breaking.erosion = kind.erosion, breaking.noise = kind.noise;
            breaking.seed = static_cast<std::uint64_t>(100 + pot);
            const Mesh whole = make_pot(shape);
            std::vector<Sherd> sherds = shatter(whole, breaking);
            if (kind.missing) sherds.erase(sherds.begin() + 1);
            const std::size_t belong = sherds.size();
            if (kind.stranger) {
                // From a vessel of the same shape, so that the template does not reject it.
                breaking.seed += 1000;
                std::vector<Sherd> others = shatter(whole, breaking);
                sherds.push_back(std::move(others[1]));
            }
            Random random(static_cast<std::uint64_t>(pot), 6);
            std::vector<Fragment> fragments;
            std::vector<Motion> motions;
            std::vector<const Fragment*> pointers;
            for (Sherd& one : sherds) {
                fragments.push_back(fragment_of(std::move(one), std::to_string(fragments.size() + 1), shape.wall));
                motions.push_back(random_motion(random, 20));
                fragments.back().mesh = moved(fragments.back().mesh, motions.back());
            }
            for (const Fragment& one : fragments) pointers.push_back(&one);
            const Stopwatch watch;
            // As in reconstruct, without the later stages.
            CommonPlacement placement;
            for (std::size_t k = 0; k < fragments.size(); ++k) {
                placement.fragments.emplace_back();
                placement.fragments.back().problem = "no landmarks";
            }
            const auto searched = place_by_search(whole, pointers, {}, placement.scale, placement.fragments);
            const SurfaceSearch surface(whole);
            for (std::size_t k = 0; k < fragments.size(); ++k) {
                FragmentPlacement& one = placement.fragments[k];
                if (!one.problem.empty()) continue;
                std::vector<bool> counts;
                for (const Facet facet : fragments[k].facets) counts.push_back(facet != Facet::fracture);
                one.pose = align_part(fragments[k].mesh, counts, surface, one.pose).pose;
            }
            const auto rotations = decide_open_rotations(whole, pointers, searched, placement.fragments);
            seconds += watch.seconds().processor;
            all += fragments.size();
            for (std::size_t k = 0; k < fragments.size(); ++k) {
                if (!placement.fragments[k].problem.empty()) continue;
                ++placed;
                // Without the rotation about the axis.
                const Motion back = placement.fragments[k].pose.after(motions[k]);
                Motion about_axis;
                about_axis.rotation = Eigen::AngleAxisd(std::atan2(back.rotation(0, 1) - back.rotation(1, 0),
                                                                   back.rotation(0, 0) + back.rotation(1, 1)),
                                                        Vector3d::UnitZ())
                                          .toRotationMatrix();
                const double off = off_of(moved(fragments[k].mesh, motions[k].inverse()), about_axis.after(back));
                well += off < 0.02 * box_diagonal(whole) ? 1 : 0;
            }
            own += belong;
            if (!rotations) continue;
            std::vector<std::size_t> size(fragments.size(), 0);
            for (std::size_t k = 0; k < fragments.size(); ++k) {
                if (rotations->group[k] >= 0 && k < belong) ++size[static_cast<std::size_t>(rotations->group[k])];
                overlap = std::max(overlap, 100 * rotations->overlap[k]);
            }
            together += *std::max_element(size.begin(), size.end());
            for (const BreakJoint& joint : rotations->joints) {
                const auto a = static_cast<std::size_t>(joint.first), b = static_cast<std::size_t>(joint.second);
                const Motion back =
                    placement.fragments[a].pose.after(motions[a]).inverse().after(placement.fragments[b].pose.after(motions[b]));
                const Mesh there = moved(fragments[b].mesh, motions[b].inverse());
                const double degrees = degrees_of(back), percent = 100 * off_of(there, back) / box_diagonal(whole);
                const bool good = a < belong && b < belong && percent < 2;
                csv << '"' << kind.name << "\"," << pot << ',' << a + 1 << ',' << b + 1 << ',' << degrees << ',' << percent << ','
                    << good << ',' << joint.carries << ',' << joint.contact << ',' << joint.rim << ',' << joint.share << ','
                    << joint.lead << ',' << joint.confidence << ',' << joint.decided << '\n';
                if (!joint.carries) continue;
                ++carry;
                right += good ? 1 : 0;
                decided += joint.decided ? 1 : 0;
                decided_right += joint.decided && good ? 1 : 0;
                strangers += joint.decided && (a >= belong || b >= belong) ? 1 : 0;
            }
        }
        std::cout << "| " << kind.name
                  << format(" | %zu, %zu of %zu | %zu of %zu | %zu | %zu | %zu | %.0f | %.1f | %.1f |\n", placed, well, all,
                            right, carry, decided, decided_right, strangers,
                            100.0 * static_cast<double>(together) / static_cast<double>(own), overlap, seconds / options.pots)
                  << std::flush;
    }
    write_file(Path(options.output) / "broken-pots.csv", csv.str());
}

}  // namespace ostraka::experiments

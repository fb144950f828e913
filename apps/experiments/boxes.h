// Boxes of fragments with known positions: objects broken by simulation, and scanned fragments in assembled layout.
#pragma once

#include "harness.h"
#include "scenes.h"

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka::experiments {

struct Box {
    std::string name;
    std::string level;                ///< description of noise and wear; empty if the box was not broken by simulation
    std::vector<Fragment> fragments;  ///< in their true positions; facets known or found
    double diagonal = 0;              ///< of the whole object
    double gap = 0;                   ///< max distance between neighbours
    /// Contact area of each pair as a share of the smaller fragment's fracture surface, [i][j], i < j.
    std::vector<std::vector<double>> contact;
};

enum class FacetChoice { known, found };

struct BoxOptions {
    std::vector<std::string> boxes;
    std::string output;
    int pieces = 8;
    std::uint64_t seed = 0;
    void declare_options(OptionList& list) {
        list("boxes", boxes,
             "pot:SHAPE, plate:SHAPE, stone:SHAPE, made:NAME or a mesh file, to be broken; or a folder of fragments in assembled "
             "layout");
        list("output", output, "output folder");
        list("pieces", pieces, "number of pieces that an object is broken into", Range{2, 100});
        list("seed", seed, "random seed of fractures, noise and wear");
    }
};

/// Calls take(box) for each source with the seeds after `options.seed`; facets(seed) chooses those of a box. Noise and wear
/// derive from the seed (three levels each, wear up to 3 % of a piece's size). Sources that cannot be broken are reported and
/// left out.
void for_each_box(const BoxOptions& options, const std::function<FacetChoice(std::uint64_t)>& facets,
                  const std::function<void(Box&&, std::uint64_t)>& take);

/// Moves a fragment by a uniformly random rotation and a shift of about `far`; returns the motion.
Motion move_at_random(Fragment& fragment, Random& random, double far);
std::vector<const Fragment*> pointers_to(const std::vector<Fragment>& fragments);
/// Length of the diagonal of the bounding box of all fragments together.
double diagonal_of(const std::vector<Fragment>& fragments);

/// Fragments of a folder in assembled layout, in the order of their names.
struct FragmentLayout {
    std::string name;
    std::vector<Fragment> fragments;
    double diagonal = 0, edge = 0;  ///< of all fragments together; the greatest mean edge length
    bool copied = false;            ///< published simulated fractures, whose pieces coincide
};
FragmentLayout read_layout(const std::string& folder, FacetChoice facets);

/// Per face, whether one of the others' surfaces faces it within the distance `reach` and accept(hit, centroid, normal).
template <class Accept>
std::vector<bool> facing(const Mesh& mesh, const std::vector<const SurfaceSearch*>& others, double reach, const Accept& accept) {
    std::vector<bool> result(mesh.number_of_faces(), false);
    for (const Face f : mesh.faces()) {
        const Vector area = area_vector(mesh, f);
        const double length = std::sqrt(area.squared_length());
        if (!(length > 0)) continue;
        const Point place = centroid(mesh, f);
        for (const SurfaceSearch* other : others) {
            const auto hit = other->closest_compatible(place, -area / length, 0.5, reach);
            if (hit && accept(*hit, place, Vector(area / length))) result[f] = true;
        }
    }
    return result;
}
/// All searches but one.
std::vector<const SurfaceSearch*> others_than(std::size_t k, const std::vector<SurfaceSearch>& searches);

}  // namespace ostraka::experiments

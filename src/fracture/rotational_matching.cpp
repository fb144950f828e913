#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include "fracture/rotations.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/mesh/disjoint_sets.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

class RotationMatcher {
public:
    RotationMatcher(const Mesh& vessel, const Vector3d& point, const Vector3d& direction, const std::vector<SherdOnAxis>& sherds,
                    const RotationMatchOptions& options)
        : given_(sherds), options_(options) {
        upright_.rotation = rotation_between(direction, Vector3d::UnitZ()).toRotationMatrix();
        upright_.translation = -(upright_.rotation * point);
        vessel_ = moved(vessel, upright_);
    }

    RotationMatch run() {
        prepare();
        meet_all();
        std::vector<bool> fixed;
        for (const SherdOnAxis& sherd : given_) fixed.push_back(sherd.fixed);
        assembly_ = assemble_rotations(*pairs_, fixed, largest(), options_.beam);
        for (std::size_t k = 0; k < given_.size(); ++k) motions_.push_back(rotated_by(assembly_.rotations[k]));
        join(fixed);
        put_aside(fixed);
        refine(fixed);
        measure();
        for (std::size_t k = 0; k < given_.size(); ++k)
            result_.poses.push_back(upright_.inverse().after(motions_[k].after(upright_.after(given_[k].pose))));
        return std::move(result_);
    }

private:
    void prepare() {
        const std::size_t n = given_.size();
        result_.notes.resize(n);
        sherds_.resize(n);
        std::vector<double> walls;
        for (std::size_t k = 0; k < n; ++k) {
            const Fragment& fragment = *given_[k].fragment;
            const Motion pose = upright_.after(given_[k].pose);
            UprightSherd& sherd = sherds_[k];
            sherd.mesh = moved(fragment.mesh, pose);
            try {
                const double radius = 0.04 * fragment_size(fragment.mesh);
                sherd.side = FractureSide(fragment, radius, options_.frames, options_.samples).moved(pose);
                walls.push_back(2 * sherd.side.fracture.area / sherd.side.rim_length);
            } catch (const Error& error) {  // without a fracture it meets nothing, but it covers area
                if (error.kind() != ErrorKind::input) throw;
                result_.notes[k] = "has no fracture surface that could meet another one";
                sherd.side = FractureSide();
            }
        }
        if (walls.empty()) return;
        wall_ = result_.wall = upper_median(std::move(walls));
    }

    void meet_all() {
        const std::size_t n = given_.size();
        double widest = 0;
        for (const UprightSherd& sherd : sherds_)
            for (const Vertex v : sherd.mesh.vertices())
                widest = std::max(widest, std::hypot(sherd.mesh.point(v).x(), sherd.mesh.point(v).y()));
        if (!(wall_ > 0)) wall_ = 0.1 * widest;
        steps_ = static_cast<int>(std::clamp(2 * pi * widest / (0.15 * wall_), 180.0, 3600.0));
        const SurfaceSearch surface(vessel_);
        const double width = 0.5 * wall_;
        ProfileCells cells(surface, width);
        for (std::size_t k = 0; k < n; ++k) {
            UprightSherd& sherd = sherds_[k];
            std::vector<bool> intact(sherd.mesh.number_of_faces(), true);
            std::vector<Vector> normals;
            double area = 0;
            for (const Face f : sherd.mesh.faces()) {
                const Vector3d normal = eigen(area_vector(sherd.mesh, f));
                normals.push_back(vector_of(normal.norm() > 0 ? normal.normalized() : normal));
                const auto& facets = given_[k].fragment->facets;
                intact[f] = (facets.empty() || facets[f] != Facet::fracture) && normal.norm() > 0;
                if (intact[f]) area += face_area(sherd.mesh, f);
            }
            const double count = std::clamp(area / (0.25 * width * width), 200.0, 20000.0);
            const SurfaceSamples surface_samples = sample_faces(sherd.mesh, normals, intact, static_cast<int>(count));
            double squares = 0;
            for (const Vector3d& p : surface_samples.places) squares += p.head<2>().squaredNorm();
            sherd.radius = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, surface_samples.places.size())));
            sherd.map =
                std::make_unique<RotationMap>(cells, surface_samples, sherd.side.fracture.places, steps_, 2 * width, 0.5 * wall_);
        }
        std::vector<RotationPair> pairs(n * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j) pairs[i * n + j] = meet(sherds_[i], sherds_[j], steps_, wall_, options_);
        pairs_ = std::make_unique<RotationPairs>(n, std::move(pairs));
    }

    /// The joints of the assembly; the maximum spanning tree of them carries it.
    void join(const std::vector<bool>& fixed) {
        const std::size_t n = given_.size();
        std::vector<std::pair<double, FractureJoint>> scored_joints;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j) {
                if (!assembly_.joined[i] || !assembly_.joined[j]) continue;
                const double rotation = assembly_.rotations[j] - assembly_.rotations[i];
                const RotationPair& pair = pairs_->at(i, j);
                const MeetingRotation* meeting = pair.meeting(rotation);
                if (meeting == nullptr || !(pair.value(rotation) > 0)) continue;
                FractureJoint joint;
                joint.first = static_cast<int>(i), joint.second = static_cast<int>(j);
                scored_joints.emplace_back(pair.value(rotation), joint);
            }
        std::stable_sort(scored_joints.begin(), scored_joints.end(),
                         [](const auto& x, const auto& y) { return x.first > y.first; });
        DisjointSets groups(n);
        const auto anchor = std::find(fixed.begin(), fixed.end(), true);
        for (std::size_t k = 0; k < n; ++k)
            if (fixed[k]) groups.unite(static_cast<std::size_t>(anchor - fixed.begin()), k);
        DisjointSets tree = groups;
        for (auto& [value, joint] : scored_joints) {
            joint.carries = tree.unite(static_cast<std::size_t>(joint.first), static_cast<std::size_t>(joint.second));
            result_.joints.push_back(joint);
        }
        std::stable_sort(result_.joints.begin(), result_.joints.end(),
                         [](const FractureJoint& x, const FractureJoint& y) { return x.carries > y.carries; });
        for (FractureJoint& joint : result_.joints)
            if (joint.carries) decide(joint, fixed);
        for (const FractureJoint& joint : result_.joints)
            if (joint.decided) groups.unite(static_cast<std::size_t>(joint.first), static_cast<std::size_t>(joint.second));
        for (std::size_t k = 0; k < n; ++k) result_.group.push_back(static_cast<int>(groups.find(k)));
    }

    /// Rotates all sherds connected to the second sherd against all others.
    void decide(FractureJoint& joint, const std::vector<bool>& fixed) {
        std::vector<bool> side(given_.size(), false);
        side[static_cast<std::size_t>(joint.second)] = true;
        for (bool grown = true; grown;) {
            grown = false;
            const bool anchored = [&] {
                for (std::size_t k = 0; k < side.size(); ++k)
                    if (side[k] && fixed[k]) return true;
                return false;
            }();
            for (std::size_t k = 0; k < side.size(); ++k)
                if (anchored && fixed[k] && !side[k]) side[k] = grown = true;
            for (const FractureJoint& other : result_.joints) {
                if (!other.carries || &other == &joint) continue;
                const auto a = static_cast<std::size_t>(other.first), b = static_cast<std::size_t>(other.second);
                if (side[a] != side[b]) side[a] = side[b] = grown = true;
            }
        }
        const RotationLead lead = rotation_lead(*pairs_, assembly_.rotations, assembly_.joined, side, steps_);
        double fracture[2] = {0, 0};
        for (std::size_t k = 0; k < side.size(); ++k)
            if (assembly_.joined[k]) fracture[side[k] ? 1 : 0] += sherds_[k].side.fracture.area;
        const double minimum = std::min(fracture[0], fracture[1]);
        joint.lead = lead.current > 0 ? std::clamp(1 - lead.best_other / lead.current, 0.0, 1.0) : 0;
        joint.share = minimum > 0 ? std::clamp(lead.current / minimum, 0.0, 2.0) : 0;
        joint.confidence = std::min(1.0, 2 * joint.share) * std::min(1.0, 3 * joint.lead);
        joint.decided = joint.confidence >= options_.min_joint;
    }

    /// A group of several sherds without a decided joint to the largest group stays, with a note. A single sherd stays if it
    /// overlaps nothing; otherwise it moves to where it overlaps least.
    void put_aside(const std::vector<bool>& fixed) {
        const std::size_t n = given_.size();
        std::vector<std::size_t> size(n, 0);
        for (const int g : result_.group) ++size[static_cast<std::size_t>(g)];
        const auto largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
        for (std::size_t k = 0; k < n; ++k) {
            if (fixed[k] || n == 1) continue;
            if (size[static_cast<std::size_t>(result_.group[k])] > 1) {
                if (result_.group[k] != largest && result_.notes[k].empty())
                    result_.notes[k] = "no decided joint connects its group to the largest group";
                continue;
            }
            std::string& note = result_.notes[k];
            if (note.empty()) note = "its fracture surface decides no rotation about the axis";
            std::vector<bool> others(n, true);
            others[k] = false;
            double overlap = shared_area(k, assembly_.rotations), min_overlap = 0;
            const double rotation = least_shared_rotation(*pairs_, assembly_.rotations, others, k, min_overlap);
            const double little = 0.02 * sherds_[k].map->area();
            if (overlap > little && min_overlap < overlap) {
                assembly_.rotations[k] = rotation;
                assembly_.joined[k] = false;
                motions_[k] = rotated_by(rotation);
                overlap = min_overlap;
            }
            note += overlap > little ? "; it overlaps other sherds at every rotation"
                                     : "; it is placed where it overlaps no other sherd";
        }
        std::erase_if(result_.joints, [&](const FractureJoint& joint) {
            return !assembly_.joined[static_cast<std::size_t>(joint.first)] ||
                   !assembly_.joined[static_cast<std::size_t>(joint.second)];
        });
    }

    /// Aligns one sherd after the other with all sherds joined to it, constrained to the template.
    void refine(const std::vector<bool>& fixed) {
        const std::size_t n = given_.size();
        const std::size_t anchor = largest();
        constexpr int sweeps = 4;
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (std::size_t k = 0; k < n; ++k) {
                if (fixed[k] || k == anchor || sherds_[k].side.frames.empty()) continue;
                FractureSide joined_side;
                for (const FractureJoint& joint : result_.joints) {
                    const auto a = static_cast<std::size_t>(joint.first), b = static_cast<std::size_t>(joint.second);
                    if (a != k && b != k) continue;
                    const std::size_t q = a == k ? b : a;
                    if (result_.group[q] != result_.group[k]) continue;
                    const FractureSide side = sherds_[q].side.moved(motions_[q]);
                    joined_side.frames.insert(joined_side.frames.end(), side.frames.begin(), side.frames.end());
                    auto& target = joined_side.fracture;
                    target.places.insert(target.places.end(), side.fracture.places.begin(), side.fracture.places.end());
                    target.normals.insert(target.normals.end(), side.fracture.normals.begin(), side.fracture.normals.end());
                }
                if (joined_side.frames.empty()) continue;
                const FractureTrees trees(Mesh(), joined_side);
                const FractureAligner aligner(trees.target(), sherds_[k].side, wall_, 0.5 * wall_, 1);
                // Starts from the rotation alone, so that offsets do not accumulate over the sweeps.
                const double rotation = rotation_about_axis(motions_[k]);
                motions_[k] = aligner.align(rotated_by(rotation), static_cast<std::size_t>(options_.samples), 16, options_.hold);
            }
    }

    void measure() {
        const std::size_t n = given_.size();
        for (FractureJoint& joint : result_.joints) {
            const auto a = static_cast<std::size_t>(joint.first), b = static_cast<std::size_t>(joint.second);
            const FractureTrees trees(sherds_[a].mesh, sherds_[a].side);
            const FractureAligner aligner(trees.target(), sherds_[b].side, wall_, 0.5 * wall_, 1);
            const PairCandidate fit =
                aligner.judge(motions_[a].inverse().after(motions_[b]), static_cast<std::size_t>(options_.samples), 0.6);
            joint.rotation = 180 / pi * wrapped(rotation_about_axis(motions_[b]) - rotation_about_axis(motions_[a]));
            joint.contact = fit.contact, joint.rim = fit.rim, joint.residual = fit.residual, joint.score = fit.score;
        }
        std::vector<double> rotations;
        for (const Motion& motion : motions_) rotations.push_back(rotation_about_axis(motion));
        for (std::size_t k = 0; k < n; ++k) {
            const double area = sherds_[k].map->area();
            result_.overlap.push_back(area > 0 ? std::min(1.0, shared_area(k, rotations) / area) : 0);
        }
    }

    /// The first of the sherds that cover the largest area.
    [[nodiscard]] std::size_t largest() const {
        const auto smaller = [](const UprightSherd& a, const UprightSherd& b) { return a.map->area() < b.map->area(); };
        return static_cast<std::size_t>(std::max_element(sherds_.begin(), sherds_.end(), smaller) - sherds_.begin());
    }
    /// Area of a sherd that other sherds cover too.
    [[nodiscard]] double shared_area(std::size_t k, const std::vector<double>& rotations) const {
        double area = 0;
        for (std::size_t q = 0; q < given_.size(); ++q)
            if (q != k) area += pairs_->at(q, k).shared_at(RotationPairs::between(q, k, rotations[q], rotations[k]));
        return area;
    }

    const std::vector<SherdOnAxis>& given_;
    const RotationMatchOptions& options_;
    Motion upright_;  ///< maps the axis to the vertical axis through the origin
    Mesh vessel_;
    double wall_ = 0;
    int steps_ = 0;
    std::vector<UprightSherd> sherds_;
    std::unique_ptr<RotationPairs> pairs_;
    RotationAssembly assembly_;
    std::vector<Motion> motions_;  ///< per sherd, relative to its given pose, in the upright frame
    RotationMatch result_;
};

}  // namespace

RotationMatch match_rotations(const Mesh& vessel, const Vector3d& point, const Vector3d& direction,
                              const std::vector<SherdOnAxis>& sherds, const RotationMatchOptions& options) {
    check_options(options, "rotations by fractures");
    if (sherds.empty()) fail_usage("there are no sherds", "give one or more");
    if (!(direction.norm() > 0)) fail_usage("the axis has no direction", "give a vector that is not zero");
    return RotationMatcher(vessel, point, direction.normalized(), sherds, options).run();
}

void RotationMatchOptions::declare_options(OptionList& list) {
    list("turns", rotations,
         "determination of unknown rotations about a vessel's axis from the fracture surfaces: auto (where the rotation is "
         "unknown) or never",
         Choices{"auto", "never"});
    list("turn-frames", frames, "number of local frames along the rim of each fracture surface", Range{4, 5000});
    list("turn-samples", samples, "number of sample points on each fracture surface", Range{50, 1e6});
    list("turn-candidates", candidates, "number of rotations of two sherds, best first, that are refined", Range{1, 1000});
    list("turn-beam", beam, "beam width of the search over assemblies of all sherds", Range{1, 100000});
    list("turn-hold", hold, "weight of the template relative to the fracture surfaces for a sherd's position", Range{0, 1000});
    list("min-joint", min_joint, "minimum confidence of a joint; with a lower confidence the joint is undecided", Range{0, 1});
}

}  // namespace ostraka

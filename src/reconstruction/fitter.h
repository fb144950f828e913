// One fit, level by level, over one mesh of the template.
#pragma once

#include "reconstruction/level_system.h"
#include "reconstruction/match_search.h"

#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/template_cage.h"

#include <memory>
#include <vector>

namespace ostraka {

/// The levels of a fit over one mesh of the template.
class Fitter {
public:
    /// Lengths are in the template's unit. All outlive it.
    Fitter(LevelSystem& system, const MatchSearch& search, MatchSearch::Labels labels,
           std::vector<CorrespondenceConstraint> correspondences, double diagonal, const NonRigidOptions& options);

    /// Solves for the points of a cage instead; `weights` outlive it, a row for each vertex.
    void use_cage(const CageWeights& weights, const Points& cage);
    [[nodiscard]] const Points& cage() const { return cage_; }

    void start_at(Points points) { current_ = std::move(points); }
    [[nodiscard]] const Points& rest() const { return rest_; }
    [[nodiscard]] const Points& current() const { return current_; }

    /// Smoothing length of a level.
    static double smoothing(const NonRigidOptions& options, int level, double diagonal);

    /// The levels from `first` to before `end`, from where the vertices are now.
    void run(int first, int end, NonRigidFit& fit);
    /// Where the vertices are on the fragments from where they are now.
    const std::vector<VertexMatch>& match(double search_radius, NonRigidFit& fit);

    /// Point-to-plane steps over the points of the cage (Chen and Medioni 1992), each as short as it can be where vertices are
    /// matched: so the surface is met as nearly as the cage can, which levels with a smoothing do not. Vertices that are not
    /// matched are held where the levels left them.
    /// At most 4000 vertices are looked at, evenly over their list.
    void polish(double search_radius, double smoothing, NonRigidFit& fit);

    /// How the surroundings of each vertex have rotated.
    [[nodiscard]] std::vector<Eigen::Matrix3d> rotations() const { return local_rotations(rings_, rest_, current_); }

private:
    /// False where the system has no solution.
    bool step_to_planes(const Points& level_points, double smoothing);

    /// What a vertex adds to a point-to-plane step: to the plane of its match, and to the place where it is held.
    void add_plane(Eigen::Index v, const Points& level_points, double smoothing, Eigen::Ref<Eigen::VectorXd> plane_row,
                   Eigen::Ref<Eigen::VectorXd> place_row, Eigen::VectorXd& right) const;
    void record_residual(NonRigidFit::Level& record) const;
    static double interpolated(const NonRigidOptions& options, int level, double first, double last);

    /// Where few matches came or went since the weights were last set, they stay, and with them the factorisation: who lost its
    /// match is held where it is, who found one waits.
    [[nodiscard]] bool matches_unchanged() const;
    [[nodiscard]] bool slides() const { return options_.counterparts == NonRigidOptions::Counterparts::sliding; }

    /// Where the match of a vertex draws it: to the place itself, or to the nearest one to which it may slide from there.
    [[nodiscard]] Eigen::Vector3d target_of(std::size_t i) const;

    /// In units of mean areas: of its area, and where it is held by a curve of a part of a strip beside it, as outlines are.
    [[nodiscard]] double weight_of_match(std::size_t i, double smoothing) const;

    /// Vertices that slide take some solutions to come to rest: each solution draws them to the tangent planes from where they
    /// are (a majorisation of the distance from the plane). In the space of a cage one is as dear as a match, and point-to-plane
    /// steps follow at the end.
    void solve(double smoothing, double transition, bool new_level);
    void solve_once(double smoothing, double transition, bool new_level);

    /// What a patch of the smoothing's size would weigh: of a landmark the whole, of an outline the share of its length. Where
    /// vertices slide, positions along outlines guide coarse levels alone: they say which place of a part belongs to which, to
    /// about the distance of landmarks from their true places, and from there each slides.
    [[nodiscard]] double weight_of(const CorrespondenceConstraint& correspondence, double smoothing) const;
    [[nodiscard]] double correspondence_weight(std::size_t vertex, double smoothing) const;
    /// Where a vertex's match and its correspondences draw it together: sums of squares about several places are one about their
    /// mean.
    [[nodiscard]] Eigen::Vector3d combined_target(std::size_t vertex, double smoothing, const Eigen::Vector3d& match) const;

    /// Rest displacements rotated with the surroundings of each vertex, and where vertices slide, scaled with what of them was
    /// observed; what was not, with all that was.
    void rotate_displacements();

    LevelSystem& system_;
    const Mesh& mesh_;
    const MatchSearch& search_;
    MatchSearch::Labels labels_;
    std::vector<std::vector<CorrespondenceConstraint>> correspondences_;  ///< of each vertex
    double diagonal_;
    const NonRigidOptions& options_;
    const Points& rest_;
    Points current_, start_, displacement_;  ///< start: of the level
    const Rings& rings_;
    Solver* solver_ = nullptr;
    const CageWeights* weights_ = nullptr;  ///< in cage space
    Points cage_rest_, cage_;
    std::unique_ptr<CageSpaceSolver> through_cage_;
    std::vector<VertexMatch> matches_;
    std::vector<Slide> slides_;         ///< of each match
    std::vector<bool> weighted_;        ///< vertices whose match weighs in the factorisation
    std::vector<double> match_weight_;  ///< and how much
};

}  // namespace ostraka

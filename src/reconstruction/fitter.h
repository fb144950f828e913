// The levels of a fit over one mesh of the template.
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
           const std::vector<CorrespondenceConstraint>& correspondences, double diagonal, const NonRigidOptions& options);

    /// Solves for the points of a cage instead; `weights` (one row per vertex) must outlive it.
    void use_cage(const CageWeights& weights, const Points& cage);
    [[nodiscard]] const Points& cage() const { return cage_; }

    void start_at(Points points) { current_ = std::move(points); }
    [[nodiscard]] const Points& rest() const { return rest_; }
    [[nodiscard]] const Points& current() const { return current_; }

    /// Smoothing length of a level.
    static double smoothing(const NonRigidOptions& options, int level, double diagonal);

    /// Solves the levels from `first` to before `end`, starting from the current positions.
    void run(int first, int end, NonRigidFit& fit);
    /// Matches of the vertices on the fragments from their current positions.
    const std::vector<VertexMatch>& match(double search_radius, NonRigidFit& fit);

    /// Point-to-plane steps over the points of the cage (Chen and Medioni 1992), with minimal displacement of matched vertices:
    /// the result is as close to the surface as the cage permits, unlike that of levels with smoothing. Unmatched vertices keep
    /// their positions after the levels. Uses at most 4000 vertices, evenly spread over their list.
    void polish(double search_radius, double smoothing, NonRigidFit& fit);

    /// Rotations of the surroundings of each vertex.
    [[nodiscard]] std::vector<Eigen::Matrix3d> rotations() const { return local_rotations(rings_, rest_, current_); }

private:
    /// False if the system has no solution.
    bool step_to_planes(const Points& level_points, double smoothing);

    /// Adds the terms of a vertex to a point-to-plane step: the plane of its match, and its anchor.
    void add_plane(Eigen::Index v, const Points& level_points, double smoothing, Eigen::Ref<Eigen::VectorXd> plane_row,
                   Eigen::Ref<Eigen::VectorXd> place_row, Eigen::VectorXd& right) const;
    void record_residual(NonRigidFit::Level& record) const;
    static double interpolated(const NonRigidOptions& options, int level, double first, double last);

    /// If only few matches appeared or disappeared since the weights were set, weights and factorisation are kept: a vertex that
    /// lost its match keeps its position, a new match is deferred.
    [[nodiscard]] bool matches_unchanged() const;
    [[nodiscard]] bool slides() const { return options_.counterparts == NonRigidOptions::Counterparts::sliding; }

    /// The target of a vertex's match: the matched point, or the nearest point to which the vertex may slide.
    [[nodiscard]] Eigen::Vector3d target_of(std::size_t i) const;

    /// Weight of a match in units of mean areas: that of the vertex's area, and for a vertex on a curve that of a strip along the
    /// curve, as for outlines.
    [[nodiscard]] double weight_of_match(std::size_t i, double smoothing) const;

    /// Number of solves per match. Sliding vertices need several solves to converge: each attracts them to the tangent planes
    /// from their current positions (a majorisation of the distance from the plane). In the space of a cage a solve is as
    /// expensive as a match, and point-to-plane steps follow at the end.
    void solve(double smoothing, double transition, bool new_level);
    void solve_once(double smoothing, double transition, bool new_level);

    /// Weight of a patch of the smoothing's size: for a landmark all of it, for an outline the share of its length. If vertices
    /// slide, positions along outlines are used in coarse levels only: they determine correspondences of parts to within the
    /// distance of landmarks from their true positions, from which vertices slide.
    [[nodiscard]] double weight_of(const CorrespondenceConstraint& correspondence, double smoothing) const;
    [[nodiscard]] double correspondence_weight(std::size_t vertex, double smoothing) const;
    /// The common target of a vertex's match and correspondences: the weighted mean of the targets, which minimises the sum of
    /// squares.
    [[nodiscard]] Eigen::Vector3d combined_target(std::size_t vertex, double smoothing, const Eigen::Vector3d& match) const;

    /// Rest displacements rotated with the surroundings of each vertex, and if vertices slide, scaled with their observed
    /// surroundings; unobserved vertices with the mean over all observed ones.
    void rotate_displacements();

    LevelSystem& system_;
    const Mesh& mesh_;
    const MatchSearch& search_;
    MatchSearch::Labels labels_;
    std::vector<std::vector<CorrespondenceConstraint>> correspondences_;  ///< correspondence constraints of each vertex
    double diagonal_;
    const NonRigidOptions& options_;
    const Points& rest_;
    Points current_, start_, displacement_;  ///< start: positions at the start of the level
    const Rings& rings_;
    Solver* solver_ = nullptr;
    const CageWeights* weights_ = nullptr;  ///< in cage space
    Points cage_rest_, cage_;
    std::unique_ptr<CageSpaceSolver> through_cage_;
    std::vector<VertexMatch> matches_;
    std::vector<Slide> slides_;         ///< slide of each match
    std::vector<bool> weighted_;        ///< whether the match of a vertex has a weight in the factorisation
    std::vector<double> match_weight_;  ///< weight of each match
};

}  // namespace ostraka

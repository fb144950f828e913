// Non-rigid fit over one mesh of the template: one of the levels of detail on which a fit is solved.
#pragma once

#include "reconstruction/level_system.h"
#include "reconstruction/match_search.h"

#include "ostraka/reconstruction/fit.h"
#include "ostraka/reconstruction/template_cage.h"

#include <memory>
#include <vector>

namespace ostraka {

/// Solves the levels of a non-rigid fit on one mesh of the template.
class Fitter {
public:
    /// `diagonal`: diagonal of the template; all lengths are in the template's unit. `system`, `search` and `options` must
    /// outlive the fitter.
    Fitter(LevelSystem& system, const MatchSearch& search, MatchSearch::Labels labels,
           const std::vector<CorrespondenceConstraint>& correspondences, double diagonal, const NonRigidOptions& options);

    /// From now on solves for the vertices of a cage instead of the mesh; `weights` (one row per vertex of the mesh) must outlive
    /// the fitter.
    void use_cage(const CageWeights& weights, const Points& cage);
    [[nodiscard]] const Points& cage() const { return cage_; }  ///< current positions of the cage's vertices

    /// Sets the current positions of the mesh's vertices.
    void start_at(Points points) { current_ = std::move(points); }
    [[nodiscard]] const Points& rest() const { return rest_; }        ///< positions of the mesh's vertices at rest
    [[nodiscard]] const Points& current() const { return current_; }  ///< current positions of the mesh's vertices

    /// Smoothing length of a level; `diagonal`: diagonal of the template.
    static double smoothing(const NonRigidOptions& options, int level, double diagonal);

    /// Solves the levels from `first` to before `end`, starting from the current positions; adds their records to `fit`.
    void run(int first, int end, NonRigidFit& fit);
    /// Matches the vertices at their current positions with points on the fragments.
    const std::vector<VertexMatch>& match(double search_radius, NonRigidFit& fit);

    /// Point-to-plane steps over the vertices of the cage (Chen and Medioni 1992), with minimal displacement of matched vertices:
    /// the result is as close to the surface as the cage permits, unlike the result of levels with smoothing. Unmatched vertices
    /// keep the positions that they have after the levels. Uses at most 4000 vertices, evenly spread over the list of vertices.
    void polish(double search_radius, double smoothing, NonRigidFit& fit);

    /// Rotation of the neighbourhood of each vertex from rest to the current positions.
    [[nodiscard]] std::vector<Eigen::Matrix3d> rotations() const { return local_rotations(rings_, rest_, current_); }

private:
    /// One point-to-plane step over the vertices of the cage; returns false if the linear system has no solution.
    bool step_to_planes(const Points& level_points, double smoothing);

    /// Adds the equations of a vertex to a point-to-plane step: the plane of its match, and the position to which it is
    /// attracted.
    void add_plane(Eigen::Index v, const Points& level_points, double smoothing, Eigen::Ref<Eigen::VectorXd> plane_row,
                   Eigen::Ref<Eigen::VectorXd> place_row, Eigen::VectorXd& right) const;
    /// Writes the number of matches and their root mean square distance to the record of a level.
    void record_residual(NonRigidFit::Level& record) const;
    /// Value for a level, interpolated geometrically from the first to the last level.
    static double interpolated(const NonRigidOptions& options, int level, double first, double last);

    /// True if only few vertices gained or lost a match since the weights were set. Then weights and factorisation are kept: a
    /// vertex that lost its match keeps its position, and a new match is deferred.
    [[nodiscard]] bool matches_unchanged() const;
    /// Whether vertices may slide from their matches.
    [[nodiscard]] bool slides() const { return options_.counterparts == NonRigidOptions::Counterparts::sliding; }

    /// Target of vertex `i`: the matched point, or the nearest point to which the vertex may slide from its match.
    [[nodiscard]] Eigen::Vector3d target_of(std::size_t i) const;

    /// Weight of the match of vertex `i` in units of the mean vertex area: the area around the vertex, or for a vertex on a curve
    /// the area of a strip along the curve, as for outlines.
    [[nodiscard]] double weight_of_match(std::size_t i, double smoothing) const;

    /// Solves a level several times for the current matches. Sliding vertices need several solves to converge: each solve
    /// attracts them to the tangent planes of their matches from their current positions (a majorisation of the distance from the
    /// plane). In cage space a solve is as expensive as matching, and point-to-plane steps follow at the end.
    void solve(double smoothing, double transition, bool new_level);
    /// Solves the level once for the current matches.
    void solve_once(double smoothing, double transition, bool new_level);

    /// Weight of a correspondence: the area of a patch as large as the smoothing length for a landmark, and for a point of an
    /// outline the share that corresponds to its length. If vertices slide, positions along outlines are used in coarse levels
    /// only: they determine the correspondence of parts as exactly as the landmarks are placed, and vertices slide from there.
    [[nodiscard]] double weight_of(const CorrespondenceConstraint& correspondence, double smoothing) const;
    /// Sum of the weights of all correspondences of a vertex.
    [[nodiscard]] double correspondence_weight(std::size_t vertex, double smoothing) const;
    /// Common target of the match and the correspondences of a vertex: the weighted mean of the targets, which minimises the sum
    /// of weighted squared distances.
    [[nodiscard]] Eigen::Vector3d combined_target(std::size_t vertex, double smoothing, const Eigen::Vector3d& match) const;

    /// Updates the target Laplacian displacements: the rest displacements, rotated with the neighbourhood of each vertex. If
    /// vertices slide, the displacements are also scaled with the observed change of size around the vertex, and at unobserved
    /// vertices with the mean change over all observed vertices.
    void rotate_displacements();

    LevelSystem& system_;
    const Mesh& mesh_;
    const MatchSearch& search_;
    MatchSearch::Labels labels_;                                          ///< labels that restrict the matches
    std::vector<std::vector<CorrespondenceConstraint>> correspondences_;  ///< correspondence constraints of each vertex
    double diagonal_;                                                     ///< diagonal of the template
    const NonRigidOptions& options_;
    const Points& rest_;
    /// Current positions; positions at the start of the level; target Laplacian displacements.
    Points current_, start_, displacement_;
    const Rings& rings_;
    Solver* solver_ = nullptr;              ///< solver of the current level
    const CageWeights* weights_ = nullptr;  ///< weights of the cage's vertices; null: the unknowns are the mesh's vertices
    Points cage_rest_, cage_;               ///< rest positions and current positions of the cage's vertices
    std::unique_ptr<CageSpaceSolver> through_cage_;  ///< solver over the cage; null: solve over the mesh
    std::vector<VertexMatch> matches_;               ///< match of each vertex
    std::vector<Slide> slides_;                      ///< for each vertex, directions in which it may slide from its match
    std::vector<bool> weighted_;                     ///< for each vertex, whether its match has a weight in the factorisation
    std::vector<double> match_weight_;               ///< for each vertex, the weight of its match
};

}  // namespace ostraka

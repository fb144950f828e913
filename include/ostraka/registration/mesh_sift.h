// Salient points of a surface with local descriptors, and their matches with salient points of another surface.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

struct SiftOptions {
    double size = 0;             ///< reference length for the scales, in the mesh's unit; 0: the square root of the mesh's area
    double first_scale = 0.015;  ///< standard deviation (sigma) of the first smoothing level, as a share of the reference length
    int scales = 7;              ///< number of smoothing levels
    int per_octave = 3;          ///< number of smoothing levels over which sigma doubles
    double border = 1;           ///< min distance of a feature from the border, in multiples of sigma
    /// Min |sigma (H' - H)| of a feature, where H and H' are the mean curvatures at successive smoothing levels.
    double contrast = 0.01;
    /// Further peaks in the histogram of directions yield features if their height is at least this share of the highest peak.
    double second_direction = 0.8;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A salient point with a direction in its tangent plane. A salient point with several directions yields several features.
struct Feature {
    Index vertex = no_index;  ///< vertex of the mesh at the salient point
    /// Position, normal and tangent direction on the smoothed surface; orthogonal unit vectors.
    Eigen::Vector3d point, normal, direction;
    double scale = 0;  ///< sigma of the feature's smoothing level, in the mesh's unit
};

/// Features of a surface with their descriptors. A descriptor consists of nine discs around the feature, each with a histogram
/// of the shape index and a histogram of the slant angle (8 bins each).
struct FeatureSet {
    /// Number of discs, bins of a histogram, and rows of `descriptors`.
    static constexpr int discs = 9, bins = 8, length = discs * 2 * bins;
    std::vector<Feature> features;  ///< features in the order of the columns of `descriptors`
    Eigen::MatrixXf descriptors;    ///< one column of 144 rows per feature; zero for a disc that is mostly beyond the border
    double size = 0;                ///< reference length for the scales
};

/// MeshSIFT features of a mesh (Smeets, Keustermans, Vandermeulen and Suetens, "meshSIFT: local surface features for 3D face
/// recognition under expression variations and partial data", 2013). The smoothing levels are the surface smoothed by the heat
/// equation; a vertex is salient where sigma (H' - H), the change of mean curvature from one level to the next, is larger or
/// smaller than at the neighbouring vertices on the same and the two adjacent levels. Directions of a feature are the peaks of
/// the histogram of the normals projected to the tangent plane (within 9 sigma, weighted by area, length and a Gaussian of 4.5
/// sigma). Discs have radius 3.75 sigma, one disc in the middle and eight around it at 4.5 sigma; shape index is weighted by
/// curvedness, slant angle by the projected normal; each histogram is normalised to length 1 and clipped at 1 / sqrt(8).
/// Neighbours are projected to the tangent plane with their straight-line distances, since heads are rigid. The result is the
/// same for any number of threads. Throws Error (usage) for options out of range, Error (input) for a mesh without area.
FeatureSet mesh_sift(const Mesh& mesh, const SiftOptions& options = {});

/// A feature of surface `a` and the feature of surface `b` with the most similar descriptor.
struct FeatureMatch {
    Index a = 0, b = 0;           ///< indices of the features in the two sets
    double angle = 0, ratio = 0;  ///< angle between the two descriptors, radians; ratio of this angle to the second smallest one
};
struct MatchOptions {
    double ratio = 0.8;  ///< max ratio of the smallest angle between descriptors to the second smallest; 1 accepts every match
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};
/// For each feature of `a`, the feature of `b` whose descriptor has the smallest angle with its descriptor, if the match passes
/// the ratio test.
std::vector<FeatureMatch> match_features(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options = {});

}  // namespace ostraka

// Salient points of a surface with local descriptors, and their matches on another surface.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

struct SiftOptions {
    double size = 0;             ///< reference length of the scales; 0 = the square root of the mesh's area
    double first_scale = 0.015;  ///< sigma of the first smoothing
    int scales = 7;              ///< number of smoothing levels
    int per_octave = 3;          ///< number of levels over which sigma doubles
    double border = 1;           ///< no features within this many sigma of the border
    double contrast = 0.01;      ///< min |sigma (H' - H)| of a feature
    double second_direction = 0.8;

    void describe(OptionList& visit);
};

/// A salient point with a direction in its tangent plane. A point with several directions yields several features.
struct Feature {
    Index vertex = no_index;
    Eigen::Vector3d point, normal, direction;  ///< on the smoothed surface; orthogonal unit vectors
    double scale = 0;                          ///< sigma, in the mesh's unit
};

/// One column of `descriptors` per feature: nine discs of 8 bins of shape index and 8 of slant angle each.
struct FeatureSet {
    static constexpr int discs = 9, bins = 8, length = discs * 2 * bins;
    std::vector<Feature> features;
    Eigen::MatrixXf descriptors;  ///< 144 x features; zero for a disc that is mostly beyond the border
    double size = 0;              ///< reference length of the scales
};

/// MeshSIFT (Smeets, Keustermans, Vandermeulen and Suetens, "meshSIFT: local surface features for 3D face recognition under
/// expression variations and partial data", 2013). Levels are the surface smoothed by the heat equation; a vertex is salient
/// where sigma (H' - H), the change of mean curvature from one level to the next, is larger or smaller than at its neighbours
/// on its own and the two adjacent levels. Directions are the peaks of the histogram of the normals projected to the tangent
/// plane (within 9 sigma, weighted by area, length and a Gaussian of 4.5 sigma). Discs have radius 3.75 sigma, one in the
/// middle and eight around it at 4.5 sigma; shape index is weighted by curvedness, slant angle by the projected normal; each
/// histogram is normalised to length 1 and clipped at 1 / sqrt(8). Neighbours are projected to the tangent plane with their
/// straight-line distances, since heads are rigid. Same result for any number of threads. Throws Error (usage) for options out
/// of range, Error (input) for a mesh without area.
FeatureSet mesh_sift(const Mesh& mesh, const SiftOptions& options = {});

struct FeatureMatch {
    Index a = 0, b = 0;
    double angle = 0, ratio = 0;
};
struct MatchOptions {
    double ratio = 0.8;  ///< max ratio of the smallest angle to the second smallest; 1 accepts every nearest feature
    void describe(OptionList& visit);
};
/// For each feature of `a`, the feature of `b` at the smallest angle, if it passes the ratio test.
std::vector<FeatureMatch> match_features(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options = {});

}  // namespace ostraka

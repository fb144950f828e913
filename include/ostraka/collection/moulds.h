// Which heads come from the same mould: similarities of all pairs, and groups.
#pragma once

#include "ostraka/collection/object_part.h"
#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/registration/align.h"
#include "ostraka/registration/consistent.h"
#include "ostraka/registration/mesh_sift.h"
#include "ostraka/stats/clustering.h"
#include "ostraka/stats/inference.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace ostraka {

struct CompareOptions {
    SiftOptions features;
    MatchOptions matches;
    double loose_ratio = 0.9;  ///< ratio of the matches among which consistent ones are searched
    ConsistentOptions consistent;
    AlignOptions align;

    void describe(OptionList& visit);
};

/// A head prepared for comparison.
struct PreparedHead {
    FeatureSet features;
    AlignSurface surface;
};
/// Computes features and surface samples. Throws Error (input) if the mesh has no area or fewer than three salient points.
PreparedHead prepare_head(const Mesh& mesh, const CompareOptions& options);

/// Matrices over all pairs of heads. Entry (i, j) counts matches from i to j; the diagonal compares a head with itself.
struct MouldMatrices {
    std::vector<std::string> names;
    Eigen::MatrixXd matches, consistent;  ///< counts, not symmetric
    Eigen::MatrixXd registration;         ///< distances, symmetric, 0 on the diagonal
    Eigen::MatrixXd scale;                ///< size of j divided by size of i, from their registration
};

/// Compares every pair. Pairs whose results are in `store` are not compared again. The results of a head are stored as soon as
/// it has been compared with all later heads. If the store has a share, only the heads of the share are compared with the later
/// heads. The matrices do not depend on the number of threads.
MouldMatrices compare_heads(const std::vector<std::string>& names, const std::vector<PreparedHead>& heads,
                            const CompareOptions& options, const ResultStore& store = ResultStore(),
                            const std::vector<std::string>& checksums = {});

/// The heads of a collection, prepared for comparison.
struct PreparedCollection {
    std::vector<std::size_t> objects;  ///< indices, in the collection, of the objects that could be prepared
    std::vector<std::string> names, checksums;
    std::vector<PreparedHead> heads;
    std::vector<ObjectResult> results;  ///< one per object of the collection; objects that failed carry their problem
    CompareOptions options;             ///< with the size that was used
    std::string waits_for;  ///< "sizes" or "features" of other shares that are not available yet: then there are no heads
};

/// Reads the meshes, or the selected parts of them, removes the faces with one of the labels `leave_out`, keeps the largest
/// connected piece, and computes the features. If the options give no size, it is the median of the square roots of the areas,
/// rounded to the nearest power of 1.1 so that adding a head seldom changes it. Features are kept in `store`, sizes in its part
/// "sizes". If the store has a share, the sizes of the share are computed first, its features once all sizes are available, and
/// the heads once all features are. Throws the errors of `for_each_object`.
PreparedCollection prepare_collection(const Collection& collection, const CompareOptions& options,
                                      const std::vector<int>& leave_out, const ResultStore& store,
                                      const ObjectParts& parts = ObjectParts());

/// Names of the similarities: "matches", "consistent", "registration", "combined".
std::vector<std::string> mould_similarities();

/// Distances in [0, 1], symmetric, 0 on the diagonal. Counts: s_ij over s_ii, d = 1 - s (thesis, 3.3.1), averaged over d_ij and
/// d_ji. Registration: d / (d + m), where m is the median over all pairs. Combined: the mean of consistent and registration.
/// Throws Error (usage) for an unknown name.
Eigen::MatrixXd mould_distances(const MouldMatrices& matrices, const std::string& similarity);

struct GroupOptions {
    enum class Method { linkage, dbscan, embedding } method = Method::linkage;
    std::string epsilon = "nested";
    int expected_size = 0;  ///< expected number of heads per mould, for knn; 0: square root of the number of heads
    int dimensions = 3;     ///< dimensions of the embedding

    void describe(OptionList& visit);
};

struct MouldGroups {
    std::vector<int> labels;  ///< one per head: 0, 1, ... by decreasing group size
    double epsilon = 0;       ///< the chosen value
    double silhouette =
        0;  ///< mean over the heads, from the distances that were grouped; of the best grouping if no grouping is clear
    bool clear = false;  ///< whether the silhouette is at least 0.2 (0.7 in the embedding)
    std::vector<double> head_silhouettes;
    Eigen::MatrixXd coordinates;  ///< coordinates of the embedding, scaled so that the largest distance is 1
    Linkage tree;                 ///< tree of the grouping: average linkage; single linkage for the other methods
};
/// Groups heads by a matrix of distances; a single object forms one group. Throws Error (usage) if an option is out of range,
/// Error (input) if the matrix is not a distance matrix.
MouldGroups group_heads(const Eigen::MatrixXd& distances, const GroupOptions& options = {});

/// Stability of the groups when subsets of the heads are grouped again in the same way (Hennig 2007), indexed by group.
std::vector<ClusterStability> group_stability(const Eigen::MatrixXd& distances, const MouldGroups& groups,
                                              const GroupOptions& options, const StabilityOptions& stability = {});

/// Size of each head relative to the mean of its group, from the scales of the registrations within the group (mean
/// logarithms). Values below 1 mark smaller heads, such as later generations of casts of casts. 1 for a head that is alone in
/// its group.
std::vector<double> relative_sizes(const MouldMatrices& matrices, const std::vector<int>& labels);

}  // namespace ostraka

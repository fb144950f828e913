// Finds heads that come from the same mould: similarities of all pairs of heads, and groups of heads.
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

/// Options of `compare_heads`.
struct CompareOptions {
    SiftOptions features;  ///< detection and description of salient points
    MatchOptions matches;  ///< matching of salient points
    /// Geometrically consistent matches are selected from the matches with a distance ratio (see MatchOptions) up to this
    /// value.
    double loose_ratio = 0.9;
    ConsistentOptions consistent;  ///< selection of geometrically consistent matches
    AlignOptions align;            ///< registration of two heads

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Features and surface samples of a head, computed once for all comparisons.
struct PreparedHead {
    FeatureSet features;
    AlignSurface surface;
};
/// Computes the features and surface samples of a head. Throws Error (input) if the mesh has no area or fewer than three salient
/// points.
PreparedHead prepare_head(const Mesh& mesh, const CompareOptions& options);

/// Comparison of all pairs of heads. Entry (i, j) of a matrix compares head i with head j; the diagonal compares a head with
/// itself.
struct MouldMatrices {
    std::vector<std::string> names;  ///< names of the heads, in the order of rows and columns
    /// Number of matches, and of consistent matches, from head i to head j; not symmetric.
    Eigen::MatrixXd matches, consistent;
    Eigen::MatrixXd registration;  ///< distance of the registered surfaces; symmetric, 0 on the diagonal
    Eigen::MatrixXd scale;         ///< size of head j divided by size of head i, from the registration of the two heads
};

/// Compares every pair of heads. Pairs whose results are in `store` are not compared again. The results of a head are stored as
/// soon as the head has been compared with all later heads. If the store works on a shard of the objects, only the heads of the
/// shard are compared with the later heads. The matrices do not depend on the number of threads.
MouldMatrices compare_heads(const std::vector<std::string>& names, const std::vector<PreparedHead>& heads,
                            const CompareOptions& options, const ResultStore& store = ResultStore(),
                            const std::vector<std::string>& checksums = {});

/// The heads of a collection, prepared for comparison.
struct PreparedCollection {
    std::vector<std::size_t> objects;           ///< indices (in the collection) of the objects that could be prepared
    std::vector<std::string> names, checksums;  ///< name and checksum of each prepared object
    std::vector<PreparedHead> heads;            ///< one per prepared object
    /// One per object of the collection; the result of an object that failed states the problem.
    std::vector<ObjectResult> results;
    CompareOptions options;  ///< the options used, including the computed feature size
    /// Name of the intermediate results of other shards ("sizes" or "features") that are not available yet; `heads` is then
    /// empty. Empty if nothing is missing.
    std::string waits_for;
};

/// Reads the meshes (or selected parts of the meshes), removes the faces with one of the labels `leave_out`, keeps the largest
/// connected component, and computes the features. If the options give no feature size, the size is the median of the square
/// roots of the areas, rounded to the nearest power of 1.1 so that adding a head seldom changes the size. Features are kept in
/// `store`, sizes in the store's part "sizes". If the store works on a shard of the objects, the sizes of the shard are computed
/// first, the features of the shard once all sizes are available, and the heads once all features are available. Throws the
/// errors of `for_each_object`.
PreparedCollection prepare_collection(const Collection& collection, const CompareOptions& options,
                                      const std::vector<int>& leave_out, const ResultStore& store,
                                      const ObjectParts& parts = ObjectParts());

/// Names of the similarities: "matches", "consistent", "registration", "combined".
std::vector<std::string> mould_similarity_names();

/// Distances between heads, in [0, 1], symmetric, 0 on the diagonal. Similarities that are counts c (matches, consistent): d_ij =
/// 1 - c_ij / c_ii (thesis, 3.3.1), averaged over d_ij and d_ji. "registration": r / (r + m), where r is the registration
/// distance and m its median over all pairs. "combined": the mean of the distances "consistent" and "registration". Throws Error
/// (usage) for an unknown name.
Eigen::MatrixXd mould_distances(const MouldMatrices& matrices, const std::string& similarity);

/// Options of `group_heads`.
struct GroupOptions {
    enum class Method { linkage, dbscan, embedding } method = Method::linkage;  ///< clustering method
    std::string epsilon =
        "nested";           ///< max distance between neighbours in a group: a number, or the name of a rule that computes it
    int expected_size = 0;  ///< expected number of heads per mould, for knn; 0: square root of the number of heads
    int dimensions = 3;     ///< number of dimensions of the spectral embedding

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Groups of heads.
struct MouldGroups {
    /// For each head: index of its group; groups are numbered 0, 1, ... by decreasing size.
    std::vector<int> labels;
    double epsilon = 0;  ///< max distance between neighbours in a group that was used
    /// Mean silhouette of the heads, computed from the distances that were grouped. If no candidate grouping is distinct: the
    /// largest mean silhouette of all candidates.
    double silhouette = 0;
    bool clear = false;  ///< true if the groups are distinct: the silhouette is at least 0.2 (method embedding: 0.7)
    std::vector<double> head_silhouettes;  ///< silhouette of each head
    /// Coordinates of the heads in the embedding, one row per head, scaled so that the largest distance is 1.
    Eigen::MatrixXd coordinates;
    /// Dendrogram of the heads: average linkage for method linkage, single linkage for the other methods.
    Linkage tree;
};
/// Groups heads by a matrix of distances; a single object forms one group. Throws Error (usage) if an option is out of range,
/// Error (input) if the matrix is not a distance matrix.
MouldGroups group_heads(const Eigen::MatrixXd& distances, const GroupOptions& options = {});

/// Stability of each group when random subsets of the heads are grouped again in the same way (Hennig 2007).
std::vector<ClusterStability> group_stability(const Eigen::MatrixXd& distances, const MouldGroups& groups,
                                              const GroupOptions& options, const StabilityOptions& stability = {});

/// Size of each head relative to the mean of its group, from the scales of the registrations within the group (mean logarithms).
/// A size below 1 marks a smaller head, such as a later generation of casts of casts. The size of a head that is alone in its
/// group is 1.
std::vector<double> relative_sizes(const MouldMatrices& matrices, const std::vector<int>& labels);

}  // namespace ostraka

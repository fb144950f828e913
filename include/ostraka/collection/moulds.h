// Which heads come from one mould: similarities of all pairs, and groups.
#pragma once

#include "ostraka/collection/object_part.h"
#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
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
    double loose_ratio = 0.9;  ///< ratio of the matches among which consistent ones are looked for
    ConsistentOptions consistent;
    AlignOptions align;

    void describe(OptionList& visit);
};

/// A head made ready to be compared.
struct PreparedHead {
    FeatureSet features;
    AlignSurface surface;
};
/// Throws Error (input) for a mesh without area or with fewer than three salient points.
PreparedHead prepare_head(const Mesh& mesh, const CompareOptions& options);

/// Matrices over all pairs of heads. Row i, column j: matches from i to j; the diagonal is a head with itself.
struct MouldMatrices {
    std::vector<std::string> names;
    Eigen::MatrixXd matches, consistent;  ///< counts, not symmetric
    Eigen::MatrixXd registration;         ///< distances, symmetric, 0 on the diagonal
    Eigen::MatrixXd scale;                ///< size of j over size of i in their registration
};

/// Compares every pair; pairs whose results are kept in `store` are not compared again. Results are kept for each head as soon as
/// it was compared with all after it. With a store of a share, only its heads are compared with those after them. Same matrices
/// for any number of threads.
MouldMatrices compare_heads(const std::vector<std::string>& names, const std::vector<PreparedHead>& heads,
                            const CompareOptions& options, const ResultStore& store = ResultStore(),
                            const std::vector<std::string>& checksums = {});

/// The heads of a collection, made ready.
struct PreparedCollection {
    std::vector<std::size_t> objects;  ///< of the collection, those that could be made ready
    std::vector<std::string> names, checksums;
    std::vector<PreparedHead> heads;
    std::vector<ObjectResult> results;  ///< of all objects; those that could not are reported with their problem
    CompareOptions options;             ///< with the size that was used
    std::string waits_for;              ///< "sizes" or "features" of other shares that are not there yet: no heads
};

/// Reads the meshes, or the parts of them that are meant, without the faces that bear one of the labels `leave_out` (of what is
/// left, the largest piece), and finds their features. Without a size in the options it is the median of the square roots of the
/// areas, to the nearest power of 1.1, so that another head seldom changes it. Features are kept in `store`, sizes in its part
/// "sizes". With a store of a share, the sizes of the share are made first; its features once all sizes are there, and heads once
/// all features are. Throws as `for_each_object`.
PreparedCollection prepare_collection(const Collection& collection, const CompareOptions& options,
                                      const std::vector<int>& leave_out, const ResultStore& store,
                                      const ObjectParts& parts = ObjectParts());

/// "matches", "consistent", "registration", "combined".
std::vector<std::string> mould_similarities();

/// Distances in [0, 1], symmetric, 0 on the diagonal. Counts: s_ij over s_ii, d = 1 - s (thesis, 3.3.1), the mean of d_ij and
/// d_ji. Registration: d / (d + m) with the median m of all pairs. Combined: the mean of consistent and registration. Throws
/// Error (usage) for another name.
Eigen::MatrixXd mould_distances(const MouldMatrices& matrices, const std::string& similarity);

struct GroupOptions {
    enum class Method { linkage, dbscan, embedding } method = Method::linkage;
    std::string epsilon = "nested";
    int expected_size = 0;  ///< heads of one mould that are expected, for knn; 0: the square root of the number of heads
    int dimensions = 3;     ///< of the embedding

    void describe(OptionList& visit);
};

struct MouldGroups {
    std::vector<int> labels;  ///< 0, 1, ... by falling size
    double epsilon = 0;       ///< as it was chosen
    double silhouette =
        0;               ///< mean over the heads, for the distances that were grouped; of the best groups, where none are clear
    bool clear = false;  ///< silhouette of at least 0.2, or 0.7 in the embedding
    std::vector<double> head_silhouettes;
    Eigen::MatrixXd coordinates;  ///< embedding, the largest distance scaled to 1
    Linkage tree;                 ///< of what was grouped: average linkage, single linkage for the other methods
};
/// Groups by a matrix of distances; one object is one group. Throws Error (usage) for options out of range, Error (input) for a
/// matrix that is none of distances.
MouldGroups group_heads(const Eigen::MatrixXd& distances, const GroupOptions& options = {});

/// How the groups fare when parts of the heads are grouped anew in the same way (Hennig 2007); by the number of the group.
std::vector<ClusterStability> group_stability(const Eigen::MatrixXd& distances, const MouldGroups& groups,
                                              const GroupOptions& options, const StabilityOptions& stability = {});

/// Sizes of the heads against the mean of their group, by the scales of the registrations within it (mean logarithms): below 1
/// the smaller ones, as later generations of casts of casts are. 1 for who is alone.
std::vector<double> relative_sizes(const MouldMatrices& matrices, const std::vector<int>& labels);

}  // namespace ostraka

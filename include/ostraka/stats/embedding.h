// Coordinates from a matrix of similarities or distances.
#pragma once

#include <Eigen/Core>

namespace ostraka {

struct Embedding {
    Eigen::MatrixXd coordinates;  ///< one row per sample; the columns are unit eigenvectors
    Eigen::VectorXd eigenvalues;  ///< one per column, by decreasing magnitude
};

/// The eigenvectors of the `dimensions` eigenvalues of largest magnitude (of equal magnitudes the positive one first); fewer if
/// the matrix has fewer rows. Signs: the entry of largest magnitude, the first of equal ones (to 1e-9), is positive. For equal
/// eigenvalues the basis of their eigenspace is arbitrary. Throws Error (input) for a matrix that is empty, not finite or not
/// symmetric to 1e-9 of its largest entry, Error (usage) for dimensions below 1.
Embedding spectral_embedding(const Eigen::MatrixXd& symmetric, int dimensions);

/// Principal components of samples: rows projected onto the `dimensions` directions of largest variance, signs as above.
struct PrincipalComponents {
    Eigen::MatrixXd scores;      ///< one row per sample
    Eigen::MatrixXd directions;  ///< one unit column per component
    Eigen::VectorXd variances;   ///< divisor n - 1 (0 for a single sample)
    Eigen::RowVectorXd mean;
    double total_variance = 0;  ///< total over all directions
};
/// Throws Error (input) for no sample or values that are not finite, Error (usage) for dimensions below 1.
PrincipalComponents principal_components(const Eigen::MatrixXd& samples, int dimensions);

}  // namespace ostraka

// Low-dimensional coordinates of samples: spectral embedding of a matrix, and principal components.
#pragma once

#include <Eigen/Core>

namespace ostraka {

/// Coordinates of samples by the eigenvectors of a matrix.
struct Embedding {
    Eigen::MatrixXd coordinates;  ///< one row per sample; the columns are unit eigenvectors
    Eigen::VectorXd eigenvalues;  ///< eigenvalue of each column, by decreasing magnitude
};

/// The eigenvectors of the `dimensions` eigenvalues of largest magnitude (among equal magnitudes, positive eigenvalues first);
/// fewer eigenvectors if the matrix has fewer rows. The sign of an eigenvector is such that its entry of largest magnitude (the
/// first of several equal to 1e-9) is positive. For equal eigenvalues the basis of their eigenspace is arbitrary. Throws Error
/// (input) for a matrix that is empty, not finite or not symmetric to 1e-9 of its largest entry, Error (usage) for dimensions
/// below 1.
Embedding spectral_embedding(const Eigen::MatrixXd& symmetric, int dimensions);

/// Principal components of samples: rows projected onto the directions of largest variance; signs as for spectral_embedding.
struct PrincipalComponents {
    Eigen::MatrixXd scores;      ///< one row per sample, one column per component
    Eigen::MatrixXd directions;  ///< one unit column per component
    Eigen::VectorXd variances;   ///< variance of each component, divisor n - 1 (0 for a single sample)
    Eigen::RowVectorXd mean;     ///< mean of the samples
    double total_variance = 0;   ///< sum of the variances over all directions
};
/// Principal components of the rows of `samples` for at most `dimensions` directions. Throws Error (input) for no sample or
/// values that are not finite, Error (usage) for dimensions below 1.
PrincipalComponents principal_components(const Eigen::MatrixXd& samples, int dimensions);

}  // namespace ostraka

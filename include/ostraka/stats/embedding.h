// Coordinates from a matrix of similarities or distances.
#pragma once

#include <Eigen/Core>

namespace ostraka {

struct Embedding {
    Eigen::MatrixXd coordinates;  ///< a row a sample; the columns are eigenvectors of length 1
    Eigen::VectorXd eigenvalues;  ///< of the columns, by falling magnitude
};

/// The eigenvectors of the `dimensions` eigenvalues of largest magnitude (a positive one before a negative one that is as large);
/// fewer where the matrix has fewer rows. Signs: the entry of largest magnitude, the first of equal ones (to 1e-9), is positive.
/// Where eigenvalues are equal, any basis of their space may come. Throws Error (input) for a matrix that is empty, not finite or
/// not symmetric to 1e-9 of its largest entry, Error (usage) for dimensions below 1.
Embedding spectral_embedding(const Eigen::MatrixXd& symmetric, int dimensions);

/// Principal components of samples: rows are projected on the `dimensions` directions of largest variance, signs as above.
struct PrincipalComponents {
    Eigen::MatrixXd scores;      ///< a row a sample
    Eigen::MatrixXd directions;  ///< a column a component, of length 1
    Eigen::VectorXd variances;   ///< n - 1 below the line (0 for one sample)
    Eigen::RowVectorXd mean;
    double total_variance = 0;  ///< of all directions
};
/// Throws Error (input) for no sample or values that are not finite, Error (usage) for dimensions below 1.
PrincipalComponents principal_components(const Eigen::MatrixXd& samples, int dimensions);

}  // namespace ostraka

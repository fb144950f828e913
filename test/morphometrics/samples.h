// Samples of landmarks for tests.
#pragma once

#include "ostraka/morphometrics/shape_sample.h"
#include "ostraka/stats/random.h"

#include <Eigen/Geometry>

#include <string>

namespace ostraka::test {

/// A random configuration of normally distributed landmarks; in two dimensions z is 0.
inline Landmarks random_configuration(Random& random, int landmarks, int dimension, double deviation = 1) {
    Landmarks x = Landmarks::Zero(landmarks, 3);
    for (Eigen::Index k = 0; k < landmarks; ++k)
        for (int c = 0; c < dimension; ++c) x(k, c) = deviation * random.normal();
    return x;
}

/// The configuration in another place, pose and size.
inline Landmarks moved(const Landmarks& x, Random& random, int dimension) {
    Eigen::Matrix3d rotation = Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    if (dimension == 3)
        rotation = rotation * Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    Eigen::RowVector3d place(random.normal(), random.normal(), dimension == 3 ? random.normal() : 0);
    return ((random.uniform(0.5, 2) * x * rotation.transpose()).rowwise() + 10 * place).eval();
}

/// Specimens that differ from one mean by independent noise, in random poses.
inline ShapeSample random_sample(std::uint64_t seed, int specimens, int landmarks, int dimension, double noise) {
    Random random(seed);
    ShapeSample sample;
    sample.dimension = dimension;
    const Landmarks mean = random_configuration(random, landmarks, dimension);
    for (int k = 0; k < landmarks; ++k) sample.landmarks.push_back("L" + std::to_string(k + 1));
    for (int s = 0; s < specimens; ++s) {
        sample.specimens.push_back("s" + std::to_string(s + 1));
        sample.configurations.push_back(
            moved(mean + random_configuration(random, landmarks, dimension, noise), random, dimension));
    }
    return sample;
}

}  // namespace ostraka::test

// Uncertainty of a pose that was found by point-to-plane registration.
#pragma once

#include "registration/trimmed_registration.h"

#include "ostraka/registration/mesh_registration.h"

#include <vector>

namespace ostraka::detail {

/// Uncertainty of the pose under which these pairs were found, about the origin, with the scale if `scaled`. Lengths should be of
/// the order of 1. The covariance is H^-1 M H^-1 with the normal equations H; M is the sum of g g^T over the cells of a grid with
/// the gradient g of the pairs of a cell, so that residuals within a cell may be correlated in any way (Liang and Zeger 1986). If
/// independent residuals give more, these are used. Motions that the pairs do not determine are counted and left out.
RegistrationUncertainty pose_uncertainty(const std::vector<PlanePair>& pairs, bool scaled);

}  // namespace ostraka::detail

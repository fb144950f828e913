// Sums of many numbers without loss (Neumaier 1974).
#pragma once

#include <cmath>

namespace ostraka {

class CompensatedSum {
public:
    CompensatedSum& operator+=(double x) {
        const double next = sum_ + x;
        lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
        sum_ = next;
        return *this;
    }
    [[nodiscard]] double value() const { return sum_ + lost_; }

private:
    double sum_ = 0, lost_ = 0;
};

}  // namespace ostraka

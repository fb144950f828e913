// Time measurement.
#pragma once

#include <chrono>

namespace ostraka {

/// Measures the time since its construction.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Adds the seconds between construction and destruction of this object to a sum.
class ScopedSeconds {
public:
    explicit ScopedSeconds(double& sum) : sum_(sum) {}  ///< `sum` must outlive this object
    ~ScopedSeconds() { sum_ += watch_.seconds(); }
    ScopedSeconds(const ScopedSeconds&) = delete;
    ScopedSeconds& operator=(const ScopedSeconds&) = delete;

private:
    double& sum_;
    Stopwatch watch_;
};

}  // namespace ostraka

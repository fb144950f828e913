// Measurement and number formatting for the experiments.
#pragma once

#include <chrono>
#include <ctime>
#include <optional>
#include <string>

namespace ostraka::experiments {

/// Formats like printf.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// Wall time, and processor time of all threads; the latter is unaffected by other load if there is one thread.
struct Seconds {
    double wall = 0, processor = 0;
    Seconds& operator+=(const Seconds& other) {
        wall += other.wall;
        processor += other.processor;
        return *this;
    }
    friend Seconds operator+(Seconds a, const Seconds& b) { return a += b; }
};

class Stopwatch {
public:
    [[nodiscard]] Seconds seconds() const {
        return {std::chrono::duration<double>(Clock::now() - begin_).count(),
                static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC};
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
    std::clock_t processor_ = std::clock();
};

/// Peak memory of the process since construction, minus the memory at construction.
class PeakMemory {
public:
    PeakMemory();
    /// Empty if the system does not report it.
    [[nodiscard]] std::optional<double> megabytes() const;

private:
    std::optional<double> before_;
};

}  // namespace ostraka::experiments

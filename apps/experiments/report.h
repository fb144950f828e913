// What the experiments measure with, and how they write numbers down.
#pragma once

#include <chrono>
#include <ctime>
#include <optional>
#include <string>

namespace ostraka::experiments {

/// As printf.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// On the wall, and of the processor over all threads: what a busy machine does not stretch, if there is one thread.
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

/// Memory that the process had at most since this was made, above what it had then.
class PeakMemory {
public:
    PeakMemory();
    /// Nothing where the system does not tell.
    [[nodiscard]] std::optional<double> megabytes() const;

private:
    std::optional<double> before_;
};

}  // namespace ostraka::experiments

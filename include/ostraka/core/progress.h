// A progress bar on a terminal; silent elsewhere.
#pragma once

#include <atomic>
#include <string>

namespace ostraka {

/// Shows `label` and a share of `total` on standard error, if that is a terminal and progress is not switched off.
/// `advance` may be called from any thread; drawing happens at most ten times a second.
class Progress {
public:
    Progress(std::string label, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::size_t steps = 1);

    static void switch_off();  ///< --quiet

private:
    std::string label_;
    std::size_t total_;
    std::atomic<std::size_t> done_{0};
    std::atomic<long long> last_drawn_{0};
    bool shown_;
};

}  // namespace ostraka

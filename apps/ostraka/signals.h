// Handles the signals that end the program.
#pragma once

#include <functional>
#include <memory>

namespace ostraka::app {

/// During its lifetime, SIGINT, SIGTERM and SIGHUP call the function given to `stop`, on a separate thread. The process exits
/// immediately with code 130 if it has not ended 0.7 s later, at a second signal, or if no function was given: temporary files,
/// scratch folders and child processes are removed, complete files remain. Create it before other threads, which inherit the
/// blocked signals.
class Signals {
public:
    Signals();
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    void stop(std::function<void()> function) const;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;  ///< shared with the thread, which may live longer
};

}  // namespace ostraka::app

// The signals that end a program.
#pragma once

#include <functional>
#include <memory>

namespace ostraka::app {

/// While it lives, SIGINT, SIGTERM and SIGHUP call what `stop` was given, on a thread of its own. Where the program does not end
/// within 0.7 s after that, at a second signal, and where nothing was given yet, the process ends at once with exit code 130:
/// temporary files, scratch folders and started programs go, complete files stay. To be made before other threads, which inherit
/// that the signals are not theirs.
class Signals {
public:
    Signals();
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    void stop(std::function<void()> how) const;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;  ///< with the thread, which may outlive this
};

}  // namespace ostraka::app

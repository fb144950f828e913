#include "signals.h"

#include "command_line.h"

#include "ostraka/execution/child_process.h"
#include "ostraka/files/file.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

namespace ostraka::app {

namespace {

constexpr timespec grace_period{0, 700'000'000};

[[noreturn]] void end_process() {
    abandon_outputs();
    kill_children();
    constexpr std::string_view message = "ostraka: cancelled (incomplete outputs are removed)\n";
    static_cast<void>(::write(2, message.data(), message.size()) == 0);
    std::_Exit(cancelled);
}

}  // namespace

struct Signals::Shared {
    std::mutex mutex;
    std::function<void()> stop;
    bool is_over = false;

    void wait(const sigset_t& signals) {
        int signal = 0;
        sigwait(&signals, &signal);
        if (!begin_to_stop()) end_process();
        sigtimedwait(&signals, nullptr, &grace_period);
        const std::lock_guard lock(mutex);
        if (!is_over) end_process();
    }
    bool begin_to_stop() {
        const std::lock_guard lock(mutex);
        if (stop) stop();
        return stop || is_over;
    }
};

Signals::Signals() : shared_(std::make_shared<Shared>()) {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals, signal);
    struct sigaction hang_up {};  // SIGHUP is ignored under nohup
    if (::sigaction(SIGHUP, nullptr, &hang_up) != 0 || hang_up.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([shared = shared_, signals] { shared->wait(signals); }).detach();
}

Signals::~Signals() {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = {};
    shared_->is_over = true;
}

void Signals::stop(std::function<void()> function) const {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = std::move(function);
}

}  // namespace ostraka::app

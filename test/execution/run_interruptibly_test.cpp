// Work that cannot be interrupted is left alone when its caller is cancelled.
#include "ostraka/execution/run_interruptibly.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace ostraka;

TEST(RunApart, ReturnsTheResult) {
    const auto sum = [](std::vector<int> numbers) {
        return run_interruptibly_on(std::move(numbers), [](std::vector<int>& values) {
            values.push_back(std::accumulate(values.begin(), values.end(), 0));
        });
    };
    EXPECT_EQ(sum({1, 2, 3}).back(), 6);
    Watch watch;
    const WatchScope scope(&watch);
    EXPECT_EQ(sum({1, 2, 3}).back(), 6);
}

TEST(RunApart, RethrowsErrors) {
    Watch watch;
    const WatchScope scope(&watch);
    EXPECT_THROW(run_interruptibly([] { fail_input("mesh", "is odd"); }), Error);
    EXPECT_THROW(run_interruptibly([] { throw std::logic_error("odd"); }), std::logic_error);
}

TEST(RunApart, AbandonsCancelledWork) {
    Watch watch;
    const WatchScope scope(&watch);
    std::promise<void> may_end;
    const auto has_ended = std::make_shared<std::promise<void>>();
    struct Held {
        std::shared_ptr<std::promise<void>> ended;
        explicit Held(std::shared_ptr<std::promise<void>> promise) : ended(std::move(promise)) {}
        ~Held() { ended->set_value(); }
        Held(const Held&) = delete;
        Held& operator=(const Held&) = delete;
    };
    auto held = std::make_shared<Held>(has_ended);
    auto ready = std::make_shared<std::shared_future<void>>(may_end.get_future().share());
    std::atomic<bool> is_told = false;
    try {
        run_interruptibly([held = std::move(held), ready, &watch, &is_told] {
            watch.cancel();
            ready->wait();
            try {
                check_cancelled();  // its own watch reports it too
            } catch (const Error& error) {
                is_told = error.kind() == ErrorKind::cancelled;
            }
        });
        FAIL() << "it was not cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
    may_end.set_value();
    has_ended->get_future().wait();  // its resources are released
    EXPECT_TRUE(is_told);
}

TEST(RunApart, UsesTheSameNumberOfThreads) {
    Watch watch;
    const WatchScope scope(&watch);
    const int thread_count = threads();
    int apart = 0;
    set_threads(3);
    run_interruptibly([&] { apart = threads(); });
    set_threads(thread_count);
    EXPECT_EQ(apart, 3);
}

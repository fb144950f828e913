#include "ostraka/execution/parallel.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/files/transaction.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>

namespace ostraka {

void set_threads(int threads) {
    if (threads < 0 || threads > 1024) fail_usage("option threads is " + std::to_string(threads), "use 0 (all) to 1024");
    omp_set_num_threads(threads == 0 ? omp_get_num_procs() : threads);
}

int threads() { return omp_get_max_threads(); }

void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    block = std::max<std::size_t>(block, 1);
    const auto blocks = static_cast<long long>((count + block - 1) / block);
    std::exception_ptr first;
    std::atomic<long long> first_block = std::numeric_limits<long long>::max();
    Watch* const watch = current_watch();
    OutputTransaction* const transaction = current_transaction();
    const WriteScope* const scope = WriteScope::current();
#pragma omp parallel for schedule(dynamic, 1) if (blocks > 1)
    for (long long b = 0; b < blocks; ++b) {
        if (b > first_block) continue;  // an earlier block has failed: the result of this one is not needed
        const std::size_t begin = static_cast<std::size_t>(b) * block;
        try {
            const WatchScope watched(watch);
            const TransactionScope written(transaction);
            const WriteScope::ScopeGuard within(scope);
            check_cancelled();
            body(begin, std::min(count, begin + block));
        } catch (...) {
#pragma omp critical(ostraka_first_exception)
            if (b < first_block) {
                first_block = b;
                first = std::current_exception();
            }
        }
    }
    if (first) std::rethrow_exception(first);
}

}  // namespace ostraka

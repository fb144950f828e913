#include "ostraka/algebra/cholesky.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/run_interruptibly.h"

#include <dlfcn.h>
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <string>

namespace ostraka {

namespace {

/// A function that the BLAS in use may export, or nullptr.
template <class Function>
Function* blas_function(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
}

bool comes_from_openblas(const char* function) {
    Dl_info library_info{};
    if (::dladdr(::dlsym(RTLD_DEFAULT, function), &library_info) == 0 || library_info.dli_fname == nullptr) return false;
    std::error_code code;
    return std::filesystem::weakly_canonical(library_info.dli_fname, code).string().find("openblas") != std::string::npos;
}

/// OpenBLAS built without threads, as in the distribution's packages, gives wrong results when several threads call it
/// concurrently: they share its buffers. If it is the BLAS or LAPACK in use, calls are serialised.
std::unique_lock<std::mutex> serialise_blas_calls() {
    static const bool is_needed = [] {
        auto* const parallel = blas_function<int()>("openblas_get_parallel");
        return (comes_from_openblas("dgemm_") || comes_from_openblas("dpotrf_")) && (parallel == nullptr || parallel() == 0);
    }();
    static std::mutex mutex;
    return is_needed ? std::unique_lock(mutex) : std::unique_lock<std::mutex>();
}

/// A threaded BLAS may sum in a different order for a different number of threads; OpenBLAS is restricted to one thread.
void use_one_thread() {
    if (auto* const set_threads = blas_function<void(int)>("openblas_set_num_threads")) set_threads(1);
}

}  // namespace

struct SparseCholesky::State {
    cholmod_common common;
    cholmod_factor* factor = nullptr;
    cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;

    State() {
        use_one_thread();
        cholmod_start(&common);
        common.print = 0;
        common.final_ll = 1;  // supernodal if the factorisation is large enough (CHOLMOD_AUTO), else simplicial; always L L^T
        common.quick_return_if_not_posdef = 1;
    }
    ~State() {
        forget();
        cholmod_finish(&common);
    }
    void forget() {
        cholmod_free_factor(&factor, &common);
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&work_y, &common);
        cholmod_free_dense(&work_e, &common);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void check(bool done, const char* step) const {
        if (done) return;
        const bool memory = common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE;
        throw Error(ErrorKind::failure, "solver",
                    std::string(step) + (memory ? " needs more memory than is available" : " failed"),
                    memory ? "solve through a cage, or a coarser mesh" : "");
    }
};

namespace {

/// View of the lower triangle of a square matrix in compressed columns; without `values`, of its pattern.
cholmod_sparse view(std::size_t size, std::size_t entries, const int* columns, const int* rows, const double* values) {
    cholmod_sparse view{};
    view.nrow = view.ncol = size;
    view.nzmax = entries;
    view.p = const_cast<int*>(columns);
    view.i = const_cast<int*>(rows);
    view.x = const_cast<double*>(values);
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    return view;
}
cholmod_sparse view(const LowerTriangle& matrix) {
    return view(static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.nonZeros()), matrix.outerIndexPtr(),
                matrix.innerIndexPtr(), matrix.valuePtr());
}

/// Unknowns with more neighbours than this degrade the ordering; eliminated last, each costs one row of the factor.
double dense_degree(Eigen::Index n) { return std::max(16.0, 10 * std::sqrt(static_cast<double>(n))); }

/// The elimination order. The sparse part is ordered by nested dissection (METIS), or by minimum degree where that is equally
/// good and much faster.
std::vector<int> elimination_order(const LowerTriangle& matrix, cholmod_common& common, bool& done) {
    const auto n = static_cast<int>(matrix.rows());
    std::vector<int> degree(n, 0);
    for (int j = 0; j < n; ++j)
        for (LowerTriangle::InnerIterator entry(matrix, j); entry; ++entry) {
            ++degree[j];
            ++degree[entry.row()];
        }
    std::vector<int> sparse, dense, index(n, -1);
    for (int i = 0; i < n; ++i) {
        if (degree[i] > dense_degree(n)) {
            dense.push_back(i);
        } else {
            index[i] = static_cast<int>(sparse.size());
            sparse.push_back(i);
        }
    }
    std::vector<int> columns{0}, rows;
    columns.reserve(sparse.size() + 1);
    for (const int j : sparse) {
        for (LowerTriangle::InnerIterator entry(matrix, j); entry; ++entry)
            if (index[entry.row()] >= 0) rows.push_back(index[entry.row()]);
        columns.push_back(static_cast<int>(rows.size()));
    }
    cholmod_sparse pattern = view(sparse.size(), rows.size(), columns.data(), rows.data(), nullptr);
    std::vector<int> order(sparse.size());
    done = true;
    if (!sparse.empty()) {
        constexpr std::size_t small = 1000;
        static std::mutex random;  // METIS uses the random number generator of the process, which it seeds itself
        const std::lock_guard lock(random);
        done = sparse.size() < small ? cholmod_amd(&pattern, nullptr, 0, order.data(), &common) != 0
                                     : cholmod_metis(&pattern, nullptr, 0, 1, order.data(), &common) != 0;
    }
    for (int& i : order) i = sparse[i];
    order.insert(order.end(), dense.begin(), dense.end());
    return order;
}

}  // namespace

/// Calls work(state, matrix). CHOLMOD cannot be interrupted: long calls use run_interruptibly with a copy of the matrix. If
/// cancelled, the factor is discarded.
template <class Work>
void SparseCholesky::work_on(const LowerTriangle& matrix, Work work) {
    constexpr Eigen::Index large = 20000;
    if (matrix.rows() < large) return work(*state_, matrix);
    using Job = std::pair<std::unique_ptr<State>, LowerTriangle>;
    try {
        Job job = run_interruptibly_on(Job(std::move(state_), matrix), [work](Job& data) { work(*data.first, data.second); });
        state_ = std::move(job.first);
    } catch (...) {
        state_ = std::make_unique<State>();
        throw;
    }
}

SparseCholesky::SparseCholesky() : state_(std::make_unique<State>()) {}
SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::analyse(const LowerTriangle& matrix) {
    state_->forget();
    if (matrix.rows() == 0) return;
    work_on(matrix, [](State& state, const LowerTriangle& lower) {
        bool done = true;
        std::vector<int> order = elimination_order(lower, state.common, done);
        state.check(done, "ordering the unknowns");
        state.common.nmethods = 1;
        state.common.method[0].ordering = CHOLMOD_GIVEN;
        cholmod_sparse a = view(lower);
        state.factor = cholmod_analyze_p(&a, order.data(), nullptr, 0, &state.common);
        state.check(state.factor != nullptr, "the symbolic factorisation");
    });
}

bool SparseCholesky::factor(const LowerTriangle& matrix) {
    if (matrix.rows() == 0) return true;
    if (state_->factor == nullptr) analyse(matrix);
    const auto is_done = std::make_shared<bool>(false);
    work_on(matrix, [is_done](State& state, const LowerTriangle& lower) {
        cholmod_sparse a = view(lower);
        const auto lock = serialise_blas_calls();
        *is_done = cholmod_factorize(&a, state.factor, &state.common) != 0;
    });
    const bool done = *is_done;
    if (state_->common.status == CHOLMOD_NOT_POSDEF || (done && state_->factor->minor < state_->factor->n)) return false;
    state_->check(done, "the factorisation");
    return true;
}

double SparseCholesky::reciprocal_condition() const {
    return state_->factor == nullptr ? 1 : cholmod_rcond(state_->factor, &state_->common);
}

double SparseCholesky::entries() const { return state_->factor == nullptr ? 0 : static_cast<double>(state_->factor->xsize); }

void SparseCholesky::solve(Eigen::MatrixXd& columns) {
    if (columns.rows() == 0) return;
    cholmod_dense b{};
    b.nrow = b.d = static_cast<std::size_t>(columns.rows());
    b.ncol = static_cast<std::size_t>(columns.cols());
    b.nzmax = b.nrow * b.ncol;
    b.x = columns.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    const auto lock = serialise_blas_calls();
    const bool done = cholmod_solve2(CHOLMOD_A, state_->factor, &b, nullptr, &state_->solution, nullptr, &state_->work_y,
                                     &state_->work_e, &state_->common) != 0;
    state_->check(done, "solving");
    std::copy_n(static_cast<const double*>(state_->solution->x), columns.size(), columns.data());
}

}  // namespace ostraka

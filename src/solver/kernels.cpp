#include "solver/kernels.h"

// Eight separate sums and no fused operations give the same bits for every vector width.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define OSTRAKA_EACH_WIDTH __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define OSTRAKA_EACH_WIDTH
#endif

namespace ostraka::solver {

namespace {
using Lanes = double __attribute__((vector_size(64), aligned(8)));
constexpr int lanes = 8;
}  // namespace

OSTRAKA_EACH_WIDTH void add_rows(const double* m, Eigen::Index rows, Eigen::Index stride, const double* d, double* out) {
    const Eigen::Index chunks = stride / lanes;
    const auto* const d0 = reinterpret_cast<const Lanes*>(d);
    const auto* const d1 = reinterpret_cast<const Lanes*>(d + stride);
    const auto* const d2 = reinterpret_cast<const Lanes*>(d + 2 * stride);
    for (Eigen::Index r = 0; r < rows; ++r, m += stride, out += 3) {
        const auto* const row = reinterpret_cast<const Lanes*>(m);
        Lanes a0 = {}, a1 = {}, a2 = {};
        for (Eigen::Index j = 0; j < chunks; ++j) {
            const Lanes value = row[j];
            a0 += value * d0[j];
            a1 += value * d1[j];
            a2 += value * d2[j];
        }
        out[0] += ((a0[0] + a0[4]) + (a0[2] + a0[6])) + ((a0[1] + a0[5]) + (a0[3] + a0[7]));
        out[1] += ((a1[0] + a1[4]) + (a1[2] + a1[6])) + ((a1[1] + a1[5]) + (a1[3] + a1[7]));
        out[2] += ((a2[0] + a2[4]) + (a2[2] + a2[6])) + ((a2[1] + a2[5]) + (a2[3] + a2[7]));
    }
}

OSTRAKA_EACH_WIDTH void add_sums(const double* m, Eigen::Index rows, Eigen::Index stride, const double* p, double* sum) {
    const Eigen::Index chunks = stride / lanes;
    auto* const s0 = reinterpret_cast<Lanes*>(sum);
    auto* const s1 = reinterpret_cast<Lanes*>(sum + stride);
    auto* const s2 = reinterpret_cast<Lanes*>(sum + 2 * stride);
    Eigen::Index r = 0;
    for (; r + 4 <= rows; r += 4, m += 4 * stride, p += 12) {
        const auto* const m0 = reinterpret_cast<const Lanes*>(m);
        const auto* const m1 = reinterpret_cast<const Lanes*>(m + stride);
        const auto* const m2 = reinterpret_cast<const Lanes*>(m + 2 * stride);
        const auto* const m3 = reinterpret_cast<const Lanes*>(m + 3 * stride);
        for (Eigen::Index j = 0; j < chunks; ++j) {
            const Lanes a = m0[j], b = m1[j], c = m2[j], e = m3[j];
            s0[j] += (p[0] * a + p[3] * b) + (p[6] * c + p[9] * e);
            s1[j] += (p[1] * a + p[4] * b) + (p[7] * c + p[10] * e);
            s2[j] += (p[2] * a + p[5] * b) + (p[8] * c + p[11] * e);
        }
    }
    for (; r < rows; ++r, m += stride, p += 3) {
        const auto* const row = reinterpret_cast<const Lanes*>(m);
        for (Eigen::Index j = 0; j < chunks; ++j) {
            s0[j] += p[0] * row[j];
            s1[j] += p[1] * row[j];
            s2[j] += p[2] * row[j];
        }
    }
}

}  // namespace ostraka::solver

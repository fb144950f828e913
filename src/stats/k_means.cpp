#include "ostraka/stats/k_means.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"
#include "stats/check_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Restart {
    std::vector<int> labels;
    Rows centres;
    double cost = 0;
    int iterations = 0;
    bool converged = false;
};

/// k-means++ initialisation: each further centre is a sample drawn with probability proportional to its squared distance from
/// the chosen centres.
Rows first_centres(const Rows& samples, Eigen::Index clusters, Random& random) {
    const Eigen::Index n = samples.rows();
    Rows centres(clusters, samples.cols());
    centres.row(0) = samples.row(static_cast<Eigen::Index>(random.below(static_cast<std::size_t>(n))));
    std::vector<double> nearest(static_cast<std::size_t>(n), std::numeric_limits<double>::infinity());
    for (Eigen::Index k = 1; k < clusters; ++k) {
        double sum = 0;
        for (Eigen::Index i = 0; i < n; ++i) {
            double& d = nearest[static_cast<std::size_t>(i)];
            d = std::min(d, (samples.row(i) - centres.row(k - 1)).squaredNorm());
            sum += d;
        }
        double remaining = random.uniform() * sum;
        Eigen::Index chosen = -1;
        for (Eigen::Index i = 0; i < n; ++i) {
            const double d = nearest[static_cast<std::size_t>(i)];
            if (d == 0) continue;
            chosen = i;
            if ((remaining -= d) < 0) break;
        }
        centres.row(k) = samples.row(std::max<Eigen::Index>(chosen, 0));
    }
    return centres;
}

/// Assigns every sample to its nearest centre, ties to the first. Returns whether a label changed.
bool assign(const Rows& samples, Restart& run, std::vector<double>& distances) {
    bool changed = false;
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
        double minimum = std::numeric_limits<double>::infinity();
        int best = 0;
        for (Eigen::Index k = 0; k < run.centres.rows(); ++k)
            if (const double d = (samples.row(i) - run.centres.row(k)).squaredNorm(); d < minimum)
                minimum = d, best = static_cast<int>(k);
        int& label = run.labels[static_cast<std::size_t>(i)];
        changed = changed || label != best;
        label = best;
        distances[static_cast<std::size_t>(i)] = minimum;
    }
    return changed;
}

/// Assigns to each empty cluster the sample that is farthest from its centre.
bool refill(Restart& run, std::vector<double>& distances) {
    std::vector<std::size_t> counts(static_cast<std::size_t>(run.centres.rows()));
    for (const int label : run.labels) ++counts[static_cast<std::size_t>(label)];
    bool any_refilled = false;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        if (counts[k] > 0) continue;
        const auto farthest = static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin());
        if (distances[farthest] == 0) break;  // every sample lies on its centre
        --counts[static_cast<std::size_t>(run.labels[farthest])];
        ++counts[k];
        run.labels[farthest] = static_cast<int>(k);
        distances[farthest] = 0;
        any_refilled = true;
    }
    return any_refilled;
}

void move_centres(const Rows& samples, Restart& run) {
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(run.centres.rows());
    Rows sums = Rows::Zero(run.centres.rows(), run.centres.cols());
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
        const int label = run.labels[static_cast<std::size_t>(i)];
        sums.row(label) += samples.row(i);
        counts[label] += 1;
    }
    for (Eigen::Index k = 0; k < sums.rows(); ++k)
        if (counts[k] > 0) run.centres.row(k) = sums.row(k) / counts[k];
}

Restart run_once(const Rows& samples, Eigen::Index clusters, int iterations, Random random) {
    Restart run;
    run.centres = first_centres(samples, clusters, random);
    run.labels.assign(static_cast<std::size_t>(samples.rows()), -1);
    std::vector<double> distances(run.labels.size());
    while (run.iterations < iterations && !run.converged) {
        ++run.iterations;
        const bool changed = assign(samples, run, distances), moved = refill(run, distances);
        run.converged = !changed && !moved;
        move_centres(samples, run);
    }
    for (Eigen::Index i = 0; i < samples.rows(); ++i)
        run.cost += (samples.row(i) - run.centres.row(run.labels[static_cast<std::size_t>(i)])).squaredNorm();
    return run;
}

/// The samples about their mean, scaled by a power of two to at most 1, so that squares neither overflow nor underflow.
struct Normalised {
    Rows samples;
    Eigen::RowVectorXd centre;
    double unit = 1;

    explicit Normalised(const Eigen::MatrixXd& input) {
        centre = input.row(0);
        for (Eigen::Index i = 0; i < input.rows(); ++i)
            centre += (input.row(i) - input.row(0)) / static_cast<double>(input.rows());
        samples = input.rowwise() - centre;
        const double largest = samples.cwiseAbs().maxCoeff();
        if (!std::isfinite(largest)) fail_input("samples", "the range of the values is too large", "use another unit");
        int exponent = 0;
        (void)std::frexp(largest, &exponent);
        unit = largest > 0 ? std::ldexp(1.0, std::min(exponent, 1000)) : 1;
        samples /= unit;
    }
};

Restart best_of(const Rows& samples, int clusters, const KMeansOptions& options) {
    const auto count = static_cast<Eigen::Index>(std::min(static_cast<std::size_t>(clusters), distinct_rows(samples)));
    std::vector<Restart> runs(static_cast<std::size_t>(count == 1 ? 1 : options.restarts));
    parallel_for(runs.size(), 1,
                 [&](std::size_t r) { runs[r] = run_once(samples, count, options.iterations, Random(options.seed, r)); });
    return std::move(*std::min_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; }));
}

/// Sorts the clusters by size.
void sort_clusters(Restart& run) {
    const auto count = static_cast<std::size_t>(run.centres.rows());
    std::vector<std::size_t> sizes(count), first(count, run.labels.size()), order(count);
    for (std::size_t i = 0; i < run.labels.size(); ++i) {
        const auto k = static_cast<std::size_t>(run.labels[i]);
        ++sizes[k];
        first[k] = std::min(first[k], i);
    }
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : first[a] < first[b]; });
    std::vector<int> name(count);
    Rows centres(run.centres.rows(), run.centres.cols());
    for (std::size_t k = 0; k < count; ++k) {
        name[order[k]] = static_cast<int>(k);
        centres.row(static_cast<Eigen::Index>(k)) = run.centres.row(static_cast<Eigen::Index>(order[k]));
    }
    for (int& label : run.labels) label = name[static_cast<std::size_t>(label)];
    run.centres = std::move(centres);
}

}  // namespace

KMeansResult k_means(const Eigen::MatrixXd& samples, const KMeansOptions& options) {
    check_options(options, "k-means");
    require_samples(samples, "k-means");
    const Normalised framed(samples);
    Restart run = best_of(framed.samples, options.clusters, options);
    sort_clusters(run);
    return {std::move(run.labels), (framed.unit * run.centres).rowwise() + framed.centre, run.cost * framed.unit * framed.unit,
            run.iterations, run.converged};
}

Eigen::MatrixXd standardised(const Eigen::MatrixXd& samples) {
    require_samples(samples, "samples");
    Eigen::MatrixXd result(samples.rows(), samples.cols());
    for (Eigen::Index j = 0; j < samples.cols(); ++j) {
        const Normalised column(Eigen::MatrixXd(samples.col(j)));
        const bool same = (samples.col(j).array() == samples(0, j)).all();
        const double square = column.samples.squaredNorm() / std::max<double>(1, static_cast<double>(samples.rows() - 1));
        if (same || square == 0) result.col(j).setZero();
        else result.col(j) = column.samples / std::sqrt(square);
    }
    return result;
}

void KMeansOptions::declare_options(OptionList& list) {
    list("clusters", clusters, "number of clusters", Range{1, 100000});
    list("restarts", restarts, "number of initialisations of k-means; the best result is kept", Range{1, 100000});
    list("iterations", iterations, "maximum number of iterations of k-means", Range{1, 1000000});
    list("seed", seed, "random seed", Range{0, 1e18});
}

void ClusterCountOptions::declare_options(OptionList& list) {
    list("max-clusters", max_clusters, "maximum number of clusters that --criterion tries", Range{1, 10000});
    list("criterion", criterion, "criterion that proposes the number of clusters", Choices{"silhouette", "gap"});
    list("references", references, "number of reference sets of the gap statistic", Range{2, 100000});
    list("restarts", k_means.restarts, "number of initialisations of k-means; the best result is kept", Range{1, 100000});
    list("iterations", k_means.iterations, "maximum number of iterations of k-means", Range{1, 1000000});
    list("seed", k_means.seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka

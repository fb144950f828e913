#include "ostraka/stats/clustering.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/disjoint_sets.h"
#include "stats/check_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {

namespace {

void check_neighbourhood(double epsilon, int minimum) {
    if (!(epsilon >= 0)) fail_usage("the search radius of DBSCAN is " + std::to_string(epsilon), "use a distance of at least 0");
    if (minimum < 1) fail_usage("the minimum number of neighbours is " + std::to_string(minimum), "use at least 1");
}

}  // namespace

std::vector<int> dbscan(const Eigen::MatrixXd& samples, double epsilon, int minimum) {
    check_neighbourhood(epsilon, minimum);
    require_samples(samples, "DBSCAN");
    const Eigen::MatrixXd columns = samples.transpose();
    const auto n = static_cast<std::size_t>(samples.rows());
    const auto distance = [&](std::size_t i, std::size_t j) {
        return (columns.col(static_cast<Eigen::Index>(i)) - columns.col(static_cast<Eigen::Index>(j))).stableNorm();
    };
    constexpr int unvisited = -2, noise = -1;
    std::vector<int> labels(n, unvisited);
    const auto neighbours = [&](std::size_t i) {
        std::vector<std::size_t> neighbour_indices;
        for (std::size_t j = 0; j < n; ++j)
            if (j == i || distance(i, j) <= epsilon) neighbour_indices.push_back(j);
        return neighbour_indices;
    };
    const auto min_neighbours = static_cast<std::size_t>(minimum);
    int clusters = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (labels[i] != unvisited) continue;
        std::vector<std::size_t> reached = neighbours(i);
        if (reached.size() < min_neighbours) {
            labels[i] = noise;
            continue;
        }
        const int label = labels[i] = clusters++;
        for (std::size_t next = 0; next < reached.size(); ++next) {
            const std::size_t j = reached[next];
            if (labels[j] == noise) labels[j] = label;
            if (labels[j] != unvisited) continue;
            labels[j] = label;
            const std::vector<std::size_t> neighbours_of_j = neighbours(j);
            if (neighbours_of_j.size() < min_neighbours) continue;
            for (const std::size_t k : neighbours_of_j)
                if (labels[k] < 0) reached.push_back(k);
        }
    }
    return labels;
}

Eigen::MatrixXd distance_matrix(const Eigen::MatrixXd& samples) {
    require_samples(samples, "distances");
    const Eigen::MatrixXd columns = samples.transpose();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(samples.rows(), samples.rows());
    for (Eigen::Index i = 0; i < samples.rows(); ++i)
        for (Eigen::Index j = 0; j < i; ++j) result(i, j) = result(j, i) = (columns.col(i) - columns.col(j)).stableNorm();
    return result;
}

double volume_epsilon(const Eigen::MatrixXd& samples, int minimum) {
    check_neighbourhood(0, minimum);
    require_samples(samples, "DBSCAN");
    // The ball of radius r in d dimensions has volume pi^(d/2) r^d / Gamma(d/2 + 1); computed in logarithms to avoid overflow.
    double log_volume = 0;
    int dimensions = 0;
    for (Eigen::Index j = 0; j < samples.cols(); ++j)
        if (const double extent = samples.col(j).maxCoeff() - samples.col(j).minCoeff(); extent > 0) {
            log_volume += std::log(extent);
            ++dimensions;
        }
    if (dimensions == 0) return 0;
    const double d = dimensions, n = static_cast<double>(samples.rows());
    return std::exp((log_volume + std::log(minimum) + std::lgamma(d / 2 + 1) - std::log(n) - d / 2 * std::log(pi)) / d);
}

Linkage linkage(const Eigen::MatrixXd& distances, LinkageMethod method) {
    require_symmetric(distances, true, "linkage");
    const Eigen::Index n = distances.rows();
    Eigen::MatrixXd cluster_distances = (distances + distances.transpose()) / 2;
    std::vector<double> sizes(static_cast<std::size_t>(n), 1.0);
    std::vector<bool> is_merged(static_cast<std::size_t>(n));
    struct Step {
        Eigen::Index a, b;
        double height;
    };
    std::vector<Step> steps;
    std::vector<Eigen::Index> chain;
    for (Eigen::Index start = 0; static_cast<Eigen::Index>(steps.size()) + 1 < n;) {
        if (chain.empty()) {
            while (is_merged[static_cast<std::size_t>(start)]) ++start;
            chain.push_back(start);
        }
        const Eigen::Index last = chain.back(), previous = chain.size() > 1 ? chain[chain.size() - 2] : -1;
        // The nearest other cluster; ties keep the previous cluster of the chain, so that chains end.
        Eigen::Index nearest = previous;
        double minimum = previous < 0 ? std::numeric_limits<double>::infinity() : cluster_distances(last, previous);
        for (Eigen::Index j = 0; j < n; ++j)
            if (j != last && !is_merged[static_cast<std::size_t>(j)] && cluster_distances(last, j) < minimum)
                minimum = cluster_distances(last, j), nearest = j;
        if (nearest != previous) {
            chain.push_back(nearest);
            continue;
        }
        chain.resize(chain.size() - 2);
        const Eigen::Index a = std::min(last, previous), b = std::max(last, previous);
        steps.push_back({a, b, minimum});
        const double na = sizes[static_cast<std::size_t>(a)], nb = sizes[static_cast<std::size_t>(b)];
        for (Eigen::Index j = 0; j < n; ++j) {
            if (j == a || j == b || is_merged[static_cast<std::size_t>(j)]) continue;
            const double da = cluster_distances(a, j), db = cluster_distances(b, j);
            cluster_distances(a, j) = cluster_distances(j, a) = method == LinkageMethod::single ? std::min(da, db)
                                                                : method == LinkageMethod::complete
                                                                    ? std::max(da, db)
                                                                    : (na * da + nb * db) / (na + nb);
        }
        sizes[static_cast<std::size_t>(a)] += nb;
        is_merged[static_cast<std::size_t>(b)] = true;
    }
    std::stable_sort(steps.begin(), steps.end(), [](const Step& x, const Step& y) { return x.height < y.height; });

    Linkage tree;
    tree.samples = static_cast<int>(n);
    std::vector<int> cluster(static_cast<std::size_t>(n)), size(static_cast<std::size_t>(n), 1);
    std::iota(cluster.begin(), cluster.end(), 0);
    DisjointSets sets(static_cast<std::size_t>(n));
    for (const Step& step : steps) {
        const std::size_t a = sets.find(static_cast<std::size_t>(step.a)), b = sets.find(static_cast<std::size_t>(step.b));
        const int merged_size = size[a] + size[b];
        tree.merges.push_back({std::min(cluster[a], cluster[b]), std::max(cluster[a], cluster[b]), step.height, merged_size});
        sets.unite_into(a, b);
        size[a] = merged_size;
        cluster[a] = static_cast<int>(n) + static_cast<int>(tree.merges.size()) - 1;
    }
    return tree;
}

std::vector<int> cut_at(const Linkage& tree, double height) {
    std::size_t merges = 0;
    while (merges < tree.merges.size() && tree.merges[merges].height <= height) ++merges;
    const auto n = static_cast<std::size_t>(tree.samples);
    std::vector<int> parent(n + merges, -1);
    for (std::size_t m = 0; m < merges; ++m) {
        parent[static_cast<std::size_t>(tree.merges[m].first)] = static_cast<int>(n + m);
        parent[static_cast<std::size_t>(tree.merges[m].second)] = static_cast<int>(n + m);
    }
    // Parents have larger indices than their children.
    std::vector<int> top(parent.size());
    for (std::size_t i = parent.size(); i-- > 0;)
        top[i] = parent[i] < 0 ? static_cast<int>(i) : top[static_cast<std::size_t>(parent[i])];
    std::vector<int> label(parent.size(), -1), result(n);
    int count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        int& name = label[static_cast<std::size_t>(top[i])];
        if (name < 0) name = count++;
        result[i] = name;
    }
    return result;
}

std::vector<int> leaf_order(const Linkage& tree) {
    std::vector<int> order;
    std::vector<int> pending;
    if (tree.samples > 0) pending.push_back(tree.merges.empty() ? 0 : tree.samples + static_cast<int>(tree.merges.size()) - 1);
    CancelCheck check;
    while (!pending.empty()) {
        check();
        const int cluster = pending.back();
        pending.pop_back();
        if (cluster < tree.samples) {
            order.push_back(cluster);
            continue;
        }
        const Merge& merge = tree.merges[static_cast<std::size_t>(cluster - tree.samples)];
        pending.push_back(merge.second);
        pending.push_back(merge.first);
    }
    return order;
}

}  // namespace ostraka

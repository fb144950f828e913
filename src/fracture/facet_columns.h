// Features of patches put together, and samples of a surface found by place.
#pragma once

#include "ostraka/fracture/facet_evidence.h"
#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace ostraka {

/// A column a feature, each with its name.
class FeatureColumns {
public:
    explicit FeatureColumns(std::size_t rows) : rows_(rows) {}
    template <class Of>
    void add(const std::string& name, Of&& of) {
        names.push_back(name);
        auto& column = columns_.emplace_back(rows_);
        for (std::size_t r = 0; r < rows_; ++r) {
            const double value = of(r);
            column[r] = static_cast<float>(std::isfinite(value) ? std::clamp(value, -1e6, 1e6) : 1e6);
        }
    }
    [[nodiscard]] FeatureTable table() const {
        FeatureTable result;
        result.columns = columns_.size();
        result.values.reserve(rows_ * columns_.size());
        for (std::size_t r = 0; r < rows_; ++r)
            for (const auto& column : columns_) result.values.push_back(column[r]);
        return result;
    }
    std::vector<std::string> names;

private:
    std::size_t rows_;
    std::vector<std::vector<float>> columns_;
};

/// Radii of neighbourhoods, the smallest first: shares of the fragment's size, or what its mesh resolves.
constexpr std::size_t scale_count = 4;
std::array<double, scale_count> facet_scales(const FacetGraph& graph);

/// 12 000 of them, the same for the same mesh.
SurfaceSamples surface_samples(const Mesh& mesh, const FacetGraph& graph);

/// Every so many samples, found by where they are.
class SampleTree {
public:
    SampleTree(const SurfaceSamples& samples, std::size_t stride);
    /// So many samples that a ball of the radius holds about a hundred.
    static SampleTree for_radius(const FacetGraph& graph, const SurfaceSamples& samples, double radius);
    /// Indices of samples within the radius.
    void within(const Point& place, double radius, std::vector<Index>& found) const;

private:
    PointTree tree_;
    std::size_t stride_;
};

/// Means of values of patches over the samples within the radius of each whose patches face about the same way.
std::vector<double> mean_about(const FacetEvidence& evidence, const SampleTree& tree, double radius,
                               const std::vector<double>& values);

}  // namespace ostraka

// Feature columns of patches, and samples of a surface by position.
#pragma once

#include "ostraka/fracture/facet_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace ostraka {

/// One named column per feature.
class FeatureColumns {
public:
    explicit FeatureColumns(std::size_t rows) : rows_(rows) {}
    template <class Value>
    void add(const std::string& name, Value&& value_of) {
        names.push_back(name);
        auto& column = columns_.emplace_back(rows_);
        for (std::size_t r = 0; r < rows_; ++r) {
            const double value = value_of(r);
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

constexpr std::size_t scale_count = 4;

/// 12 000 samples, deterministic for a mesh.
PatchSamples patch_samples(const Mesh& mesh, const FacetGraph& graph);

/// Uses a subset of the samples in which about eighty lie within the radius of a point.
Neighbourhoods neighbourhoods(const FacetGraph& graph, const PatchSamples& samples, double radius);
/// Radii as shares of the fragment's size, or the resolution of its mesh.
std::array<Neighbourhoods, scale_count> neighbourhoods(const FacetGraph& graph, const PatchSamples& samples);

/// Values from which the part features are computed, one per patch; `jagged`: one per contact.
struct PatchValues {
    std::vector<double> rough, bent, side;  ///< at the middle scale
    std::vector<double> grain;              ///< fine share of the roughness: smallest against middle scale
    std::vector<double> ruffle;             ///< deviation of the face normals from the filtered normal, as a logarithm
    std::vector<bool> over_wall;
    std::vector<double> jagged;  ///< deviation of the sharp edge near a contact from a line, 0 to 1
};
/// Columns that describe the part of each patch. `part`: see convex_parts.
void add_part_columns(FeatureColumns& columns, const std::string& name, const FacetEvidence& evidence, const PatchValues& values,
                      const std::vector<std::size_t>& part);

/// Context features: log odds of the patches around each patch.
FeatureColumns context_columns(const FacetEvidence& evidence, const std::vector<double>& log_odds);

/// The share of the area with a smaller value, for each value.
std::vector<double> area_ranks(const std::vector<double>& values, const std::vector<double>& areas);
/// The quantile of the values, weighted by area: `share` of the area lies below it.
double area_quantile(const std::vector<double>& values, const std::vector<double>& areas, double share);
/// Logarithm of a share, finite at 0.
inline double feature_level(double x) { return std::log10(1e-4 + x); }

/// Means of patch values over the samples around each patch with similar normals.
std::vector<double> neighbourhood_means(const FacetEvidence& evidence, std::size_t scale, const std::vector<double>& values);

}  // namespace ostraka

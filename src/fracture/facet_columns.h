// Feature columns of patches, and samples of a surface by position.
#pragma once

#include "ostraka/fracture/facet_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace ostraka {

/// A table of features that is filled column by column; each column has a name.
class FeatureColumns {
public:
    explicit FeatureColumns(std::size_t rows) : rows_(rows) {}
    /// Appends a column with the value value_of(r) in each row r; values that are not finite become 1e6.
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
    std::vector<std::string> names;  ///< names of the columns

private:
    std::size_t rows_;
    std::vector<std::vector<float>> columns_;
};

constexpr std::size_t scale_count = 4;  ///< number of neighbourhood radii

/// Twelve thousand samples of the surface; the same samples for the same mesh.
PatchSamples patch_samples(const Mesh& mesh, const FacetGraph& graph);

/// Neighbourhoods of one radius, with a subset of the samples so that about eighty lie within the radius of a point.
Neighbourhoods neighbourhoods(const FacetGraph& graph, const PatchSamples& samples, double radius);
/// Neighbourhoods of each patch at all radii. The radii are fractions of the fragment's size, but not below the resolution of its
/// mesh.
std::array<Neighbourhoods, scale_count> neighbourhoods(const FacetGraph& graph, const PatchSamples& samples);

/// Values from which the features of parts are computed, one per patch unless stated otherwise.
struct PatchValues {
    /// At the middle radius: roughness; spread of the normals; mean height over the tangent plane (negative: convex).
    std::vector<double> rough, bent, side;
    /// Fine fraction of the roughness: at the smallest radius relative to the middle radius.
    std::vector<double> grain;
    std::vector<double> ruffle;   ///< deviation of the face normals from the filtered normal, as a logarithm
    std::vector<bool> over_wall;  ///< true: the patch lies over a wall
    /// Per contact: deviation from a straight line of the sharp edge near the contact, 0 to 1.
    std::vector<double> jagged;
};
/// Adds columns that describe the part of each patch. `part`: for each patch, the index of its part (convex_parts).
void add_part_columns(FeatureColumns& columns, const std::string& name, const FacetEvidence& evidence, const PatchValues& values,
                      const std::vector<std::size_t>& part);

/// Columns of context features, computed from the log odds of the patches around each patch.
FeatureColumns context_columns(const FacetEvidence& evidence, const std::vector<double>& log_odds);

/// For each value: the fraction of the area that has smaller values.
std::vector<double> area_ranks(const std::vector<double>& values, const std::vector<double>& areas);
/// Quantile of the values weighted by area: the fraction `share` of the area has smaller values.
double area_quantile(const std::vector<double>& values, const std::vector<double>& areas, double share);
/// Decimal logarithm of a fraction, finite at 0.
inline double feature_level(double x) { return std::log10(1e-4 + x); }

/// For each patch: mean of the patch values over the samples around the patch whose normals are similar. `scale`: index of the
/// radius.
std::vector<double> neighbourhood_means(const FacetEvidence& evidence, std::size_t scale, const std::vector<double>& values);

}  // namespace ostraka

// Features of patches put together, and samples of a surface found by place.
#pragma once

#include "ostraka/fracture/facet_evidence.h"

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

constexpr std::size_t scale_count = 4;

/// 12 000 of them, the same for the same mesh.
PatchSamples patch_samples(const Mesh& mesh, const FacetGraph& graph);

/// Of all samples so few that about eighty lie within the radius of a place.
Neighbourhoods neighbourhoods(const FacetGraph& graph, const PatchSamples& samples, double radius);
/// Radii as shares of the fragment's size, or what its mesh resolves.
std::array<Neighbourhoods, scale_count> neighbourhoods(const FacetGraph& graph, const PatchSamples& samples);

/// What parts are told by, of each patch; `jagged` of each contact.
struct PatchValues {
    std::vector<double> rough, bent, side;  ///< in the middle scale
    std::vector<double> grain;   ///< how much of the roughness is fine: that of the smallest scale against the middle one
    std::vector<double> ruffle;  ///< how far the mesh's faces turn from the filtered normal, as a logarithm
    std::vector<bool> over_wall;
    std::vector<double> jagged;  ///< how far the sharp edge about a contact is from a line, 0 to 1
};
/// Columns that tell of each patch what its part is like. `part`: see convex_parts.
void add_part_columns(FeatureColumns& columns, const std::string& name, const FacetEvidence& evidence, const PatchValues& values,
                      const std::vector<std::size_t>& part);

/// What log odds of the patches say of the surroundings of each.
FeatureColumns context_columns(const FacetEvidence& evidence, const std::vector<double>& log_odds);

/// The share of the area below each value.
std::vector<double> area_ranks(const std::vector<double>& values, const std::vector<double>& areas);
/// The value below which `share` of the area lies.
double area_quantile(const std::vector<double>& values, const std::vector<double>& areas, double share);
/// Logarithm of a share that may vanish.
inline double feature_level(double x) { return std::log10(1e-4 + x); }

/// Means of values of patches over the samples about each that face about the same way.
std::vector<double> mean_about(const FacetEvidence& evidence, std::size_t scale, const std::vector<double>& values);

}  // namespace ostraka

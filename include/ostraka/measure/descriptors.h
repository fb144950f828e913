// Descriptors of an annotation: sizes, box, centroid, curvature, thickness, statistics of maps.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/fields/thickness.h"

#include <memory>

namespace ostraka {

/// A quantity with its name and the exponent of its length unit.
struct Quantity {
    std::string name;
    std::vector<double> values;
    bool is_list = false;  ///< written as a list, even with one value
    int power = 0;         ///< 1 for a length, 2 for an area, -1 for a curvature; 0 if dimensionless or in `unit`
    std::string unit;      ///< for quantities that are no power of a length, e.g. "rad"
};

/// The unit of a quantity if lengths are in `unit`: "mm^2", "1/mm"; empty if `unit` is.
std::string unit_of(const Quantity& quantity, const std::string& unit);

/// A map for statistics: one value per vertex.
struct NamedMap {
    std::string name;
    std::vector<double> values;
    std::string unit;
};

struct DescriptorOptions {
    bool curvature = false;  ///< statistics of mean and Gaussian curvature
    bool thickness = false;  ///< statistics of the shape diameter
    CurvatureOptions curvature_options;
    ThicknessOptions thickness_options;

    void describe(OptionList& visit);
};

/// Computes quantities of annotations on one mesh, which must outlive it. Fields on the whole mesh (curvature, thickness) are
/// computed once, on demand. Not thread-safe.
class DescriptorSearch {
public:
    explicit DescriptorSearch(const Mesh& mesh, DescriptorOptions options = {});
    ~DescriptorSearch();
    DescriptorSearch(const DescriptorSearch&) = delete;
    DescriptorSearch& operator=(const DescriptorSearch&) = delete;

    /// Announces annotations that will be queried: free ones share one mesh, cut along the curves of all.
    void expect(const AnnotationSet& set);

    /// One quantity by its name; nothing if the name is unknown or undefined for this type of annotation. Names for regions:
    /// area, perimeter, circularity (P^2 / A), volume and volume bound (see solid.h), centroid (of the surface), solid
    /// centroid, box sides, box centre, box axes (oriented box, the longest side first), mean curvature integral, Gaussian
    /// curvature integral; for lines: length.
    std::optional<Quantity> find(const Annotation& annotation, const std::string& name);

    /// All known quantities, and the requested statistics "mean curvature median", "thickness mean" and so on: mean, deviation,
    /// median, 5 and 95 per cent. Throws Error (input), naming annotation and map, for a map of the wrong length or with values
    /// that are not finite on the annotation, and for an annotation without elements. Statistics on points and lines use equal
    /// weights.
    std::vector<Quantity> describe(const Annotation& annotation, const std::vector<NamedMap>& maps = {});

    /// The fields themselves, per vertex.
    const Curvature& curvature();
    /// Per face; NaN if undefined.
    const std::vector<double>& thickness();

private:
    const Mesh& mesh_;
    DescriptorOptions options_;
    struct Cache;
    std::unique_ptr<Cache> cache_;
};

/// Writes quantities into an annotation as descriptors: those of the same name are replaced, others get new ids.
void store(Annotation& annotation, const std::vector<Quantity>& quantities, const std::string& unit);

}  // namespace ostraka

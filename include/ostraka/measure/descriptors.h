// Descriptors of an annotation: sizes, box, centroid, curvature, thickness, statistics of maps.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/fields/thickness.h"

#include <memory>

namespace ostraka {

/// A named quantity: one number or a list of numbers.
struct Quantity {
    std::string name;            ///< name of the quantity
    std::vector<double> values;  ///< one number, or the entries of a list
    bool is_list = false;        ///< true: `values` is written as a list even if there is only one value
    /// Exponent of the unit of length: 1 length, 2 area, -1 curvature; 0 if the quantity is dimensionless or its unit is in
    /// `unit`.
    int power = 0;
    std::string unit;  ///< unit of quantities that are not a power of a length, e.g. "rad"; else empty
};

/// The unit of a quantity if lengths are in `unit`: for example "mm^2" or "1/mm"; empty if `unit` is empty.
std::string unit_of(const Quantity& quantity, const std::string& unit);

/// Values on the vertices of a mesh, for the computation of statistics.
struct NamedMap {
    std::string name;            ///< name of the map
    std::vector<double> values;  ///< one value per vertex
    std::string unit;            ///< unit of the values
};

/// Options of DescriptorSearch.
struct DescriptorOptions {
    bool curvature = false;              ///< true: add statistics of mean and Gaussian curvature
    bool thickness = false;              ///< true: add statistics of the thickness (shape diameter)
    CurvatureOptions curvature_options;  ///< used if `curvature` is true
    ThicknessOptions thickness_options;  ///< used if `thickness` is true

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Computes quantities of annotations on one mesh. The mesh must outlive this object. Fields on the whole mesh (curvature,
/// thickness) are computed once, on demand. Not thread-safe.
class DescriptorSearch {
public:
    explicit DescriptorSearch(const Mesh& mesh, DescriptorOptions options = {});
    ~DescriptorSearch();
    DescriptorSearch(const DescriptorSearch&) = delete;
    DescriptorSearch& operator=(const DescriptorSearch&) = delete;

    /// Announces the annotations for which quantities will be computed. The mesh is then cut along the curves of all free
    /// annotations of the set at once.
    void prepare(const AnnotationSet& set);

    /// Computes the quantity of this name; none if the name is unknown or not defined for annotations of this type. Names for
    /// regions: area, perimeter, circularity (P^2 / A), volume and volume bound (see solid.h), centroid (of the surface), solid
    /// centroid, box sides, box centre, box axes (oriented box, the longest side first), mean curvature integral, Gaussian
    /// curvature integral. Name for lines: length.
    std::optional<Quantity> find(const Annotation& annotation, const std::string& name);

    /// All known quantities of an annotation, and the requested statistics of fields and maps (mean, deviation, median, quantiles
    /// at 5 and 95 per cent), named "thickness mean", "mean curvature median" and so on. Throws Error (input), naming annotation
    /// and map, for a map of the wrong length or with values that are not finite on the annotation, and for an annotation without
    /// elements. Statistics on points and lines use equal weights.
    std::vector<Quantity> describe(const Annotation& annotation, const std::vector<NamedMap>& maps = {});

    /// Remarks on the volume of a region: bodies that are inside out or overlap, cavities that are oriented outwards.
    std::vector<std::string> remarks(const Annotation& annotation);

    /// Mean and Gaussian curvature of the whole mesh, per vertex.
    const Curvature& curvature();
    /// Thickness of the whole mesh, per face; NaN if undefined.
    const std::vector<double>& thickness();

private:
    const Mesh& mesh_;
    DescriptorOptions options_;
    struct Cache;
    std::unique_ptr<Cache> cache_;
};

/// Writes quantities into an annotation as descriptors: a descriptor of the same name is replaced, and a new descriptor gets a
/// new id. `unit`: unit of length.
void store(Annotation& annotation, const std::vector<Quantity>& quantities, const std::string& unit);

}  // namespace ostraka

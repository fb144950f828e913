#include "ostraka/measure/descriptors.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/oriented_box.h"
#include "ostraka/measure/solid.h"
#include "ostraka/mesh/ids.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

const std::vector<std::string>& region_quantities() {
    static const std::vector<std::string> names{"area",
                                                "perimeter",
                                                "circularity",
                                                "volume",
                                                "volume bound",
                                                "centroid",
                                                "solid centroid",
                                                "box sides",
                                                "box centre",
                                                "box axes",
                                                "mean curvature integral",
                                                "Gaussian curvature integral"};
    return names;
}

Quantity number(const std::string& name, double value, int power, const std::string& unit = {}) {
    return {name, {value}, false, power, unit};
}

Quantity list_quantity(const std::string& name, std::vector<double> values, int power) {
    return {name, std::move(values), true, power, {}};
}

std::vector<double> coordinates(const Point& p) { return {p.x(), p.y(), p.z()}; }

void add_statistics(std::vector<Quantity>& quantities, const std::string& name, const Statistics& s, int power,
                    const std::string& unit = {}) {
    quantities.push_back(number(name + " mean", s.mean, power, unit));
    quantities.push_back(number(name + " deviation", s.deviation, power, unit));
    quantities.push_back(number(name + " median", s.median, power, unit));
    quantities.push_back(number(name + " 5 %", s.percentile_5, power, unit));
    quantities.push_back(number(name + " 95 %", s.percentile_95, power, unit));
}

}  // namespace

std::string unit_of(const Quantity& quantity, const std::string& unit) {
    if (quantity.power == 0) return quantity.unit;
    if (unit.empty()) return {};
    const int power = std::abs(quantity.power);
    const std::string text = power == 1 ? unit : unit + '^' + std::to_string(power);
    return quantity.power > 0 ? text : "1/" + text;
}

struct DescriptorSearch::Cache {
    std::optional<CurvatureIntegrals> integrals;
    std::optional<Curvature> curvature;
    std::optional<std::vector<double>> thickness;

    /// Caches the box of the last region: its three quantities are queried one after the other.
    const OrientedBox& box_of(const Mesh& mesh, const Annotation& annotation) {
        if (boxed_faces_ != annotation.faces) {
            std::vector<std::array<double, 3>> points;
            for (const Index v : touched_vertices(mesh, annotation)) {
                const Point& p = mesh.point(Vertex(v));
                points.push_back({p.x(), p.y(), p.z()});
            }
            box_ = oriented_box(points);
            boxed_faces_ = annotation.faces;
        }
        return box_;
    }

    /// Caches the solid of the last region, like its box.
    const BodyVolume& solid_of(const Mesh& mesh, const Annotation& annotation) {
        if (!solid_ || solid_faces_ != annotation.faces) {
            solid_ = body_volume(mesh, annotation.faces);
            solid_faces_ = annotation.faces;
        }
        return *solid_;
    }

    /// The mesh cut along the curves of free annotations, with a search for quantities on it.
    struct Cut {
        AnnotationSet requested_annotations;
        CutMesh object;
        std::unique_ptr<DescriptorSearch> search;
        /// The annotation along the edges of the cut mesh; null if the mesh is not cut along this annotation.
        [[nodiscard]] const Annotation* along_edges(const Annotation& annotation) const {
            const Annotation* requested = requested_annotations.find(annotation.id);
            if (requested == nullptr || requested->curves != annotation.curves || requested->faces != annotation.faces)
                return nullptr;
            return object.annotations.find(annotation.id);
        }
    };
    const Cut& cut_of(const Mesh& mesh, const Annotation& annotation) {
        if (cut_ && cut_->along_edges(annotation) != nullptr) return *cut_;
        AnnotationSet requested_annotations;
        requested_annotations.annotations = std::move(expected);
        expected.clear();
        const Annotation* requested_annotation = requested_annotations.find(annotation.id);
        if (requested_annotation == nullptr || requested_annotation->curves != annotation.curves ||
            requested_annotation->faces != annotation.faces)
            requested_annotations.annotations = {annotation};
        CutMesh object = cut_along_curves({mesh, requested_annotations});
        cut_ = std::make_unique<Cut>(Cut{std::move(requested_annotations), std::move(object), nullptr});
        cut_->search = std::make_unique<DescriptorSearch>(cut_->object.mesh);
        return *cut_;
    }
    std::vector<Annotation> expected;  ///< free annotations to be queried: the mesh is cut along all at once

private:
    std::vector<Index> boxed_faces_;
    OrientedBox box_;
    std::vector<Index> solid_faces_;
    std::optional<BodyVolume> solid_;
    std::unique_ptr<Cut> cut_;
};

DescriptorSearch::DescriptorSearch(const Mesh& mesh, DescriptorOptions options)
    : mesh_(mesh), options_(options), cache_(std::make_unique<Cache>()) {
    check_options(options_, "descriptors");
}
DescriptorSearch::~DescriptorSearch() = default;

void DescriptorSearch::prepare(const AnnotationSet& set) {
    for (const Annotation& annotation : set.annotations) {
        if (!is_free(annotation)) continue;
        cache_->expected.push_back(annotation);
        cache_->expected.back().attributes.clear();
    }
}

const Curvature& DescriptorSearch::curvature() {
    if (!cache_->curvature) cache_->curvature = ostraka::curvature(mesh_, options_.curvature_options);
    return *cache_->curvature;
}

const std::vector<double>& DescriptorSearch::thickness() {
    if (!cache_->thickness) cache_->thickness = ostraka::thickness(mesh_, options_.thickness_options);
    return *cache_->thickness;
}

std::optional<Quantity> DescriptorSearch::find(const Annotation& annotation, const std::string& name) {
    if (annotation.type == AnnotationType::line && name == "length") return number(name, length_of(mesh_, annotation), 1);
    if (annotation.type != AnnotationType::region) return std::nullopt;
    const auto& faces = annotation.faces;
    if (name == "area") return number(name, measure_region(mesh_, annotation).area, 2);
    if (name == "perimeter") return number(name, measure_region(mesh_, annotation).perimeter, 1);
    if (name == "circularity") return number(name, measure_region(mesh_, annotation).circularity(), 0);
    if (is_free(annotation)) {
        const auto quantity_name = std::find(region_quantities().begin(), region_quantities().end(), name);
        if (quantity_name == region_quantities().end()) return std::nullopt;
        const Cache::Cut& cut = cache_->cut_of(mesh_, annotation);
        return cut.search->find(*cut.along_edges(annotation), name);
    }
    if (faces.empty()) return std::nullopt;
    if (name == "volume") return number(name, cache_->solid_of(mesh_, annotation).volume, 3);
    if (name == "volume bound") return number(name, cache_->solid_of(mesh_, annotation).volume_bound, 3);
    if (name == "solid centroid") return list_quantity(name, coordinates(cache_->solid_of(mesh_, annotation).centroid), 1);
    if (name == "centroid") return list_quantity(name, coordinates(surface_centroid(mesh_, faces)), 1);
    if (name == "box sides" || name == "box centre" || name == "box axes") {
        const OrientedBox& box = cache_->box_of(mesh_, annotation);
        if (name == "box sides") return list_quantity(name, {box.sides.begin(), box.sides.end()}, 1);
        if (name == "box centre") return list_quantity(name, {box.centre.begin(), box.centre.end()}, 1);
        std::vector<double> axes;
        for (const auto& axis : box.axes) axes.insert(axes.end(), axis.begin(), axis.end());
        return list_quantity(name, axes, 0);
    }
    if (name == "mean curvature integral" || name == "Gaussian curvature integral") {
        if (!cache_->integrals) cache_->integrals = curvature_integrals(mesh_);
        const RegionCurvature sum = region_curvature(mesh_, *cache_->integrals, faces);
        return name.front() == 'm' ? number(name, sum.mean_integral, 1) : number(name, sum.gaussian_integral, 0, "rad");
    }
    return std::nullopt;
}

std::vector<std::string> DescriptorSearch::remarks(const Annotation& annotation) {
    if (annotation.type != AnnotationType::region || is_free(annotation) || annotation.faces.empty()) return {};
    return cache_->solid_of(mesh_, annotation).remarks;
}

std::vector<Quantity> DescriptorSearch::describe(const Annotation& annotation, const std::vector<NamedMap>& maps) {
    std::vector<Quantity> result;
    const std::string annotation_name = name_of(annotation);
    // A free annotation is described on the mesh cut along its curves, with the values of the original mesh.
    const Cache::Cut* cut = is_free(annotation) ? &cache_->cut_of(mesh_, annotation) : nullptr;
    const Mesh& mesh = cut == nullptr ? mesh_ : cut->object.mesh;
    const Annotation& edge_annotation = cut == nullptr ? annotation : *cut->along_edges(annotation);
    const std::vector<Index> vertices = touched_vertices(mesh, edge_annotation);
    if (vertices.empty()) fail_input(annotation_name, "has no elements to describe", "select elements first");
    const bool region = annotation.type == AnnotationType::region;
    if (annotation.type == AnnotationType::line) result.push_back(*find(annotation, "length"));
    if (region)
        for (const std::string& name : region_quantities()) result.push_back(*find(annotation, name));
    const auto map_statistics = [&](const std::vector<double>& map_values, const std::string& where,
                                    UndefinedValues treatment = UndefinedValues::refused) {
        if (map_values.size() != mesh_.number_of_vertices())
            fail_input(where, fmt::format("has {} values for {} vertices", map_values.size(), mesh_.number_of_vertices()),
                       "give one value for each of the vertices");
        const std::vector<double> values = cut == nullptr ? map_values : cut->object.vertex_values(mesh_, map_values);
        if (region) return vertex_statistics(mesh, values, edge_annotation.faces, where, treatment);
        std::vector<double> annotation_values;
        for (const Index v : vertices) {
            if (std::isnan(values[v]) && treatment == UndefinedValues::skipped) continue;
            if (!std::isfinite(values[v]))
                fail_input(where, fmt::format("the value of vertex {} is not a finite number", v), "correct the map");
            annotation_values.push_back(values[v]);
        }
        if (annotation_values.empty()) fail_input(where, "has no value on the annotation", "choose another annotation");
        return statistics(annotation_values, std::vector<double>(annotation_values.size(), 1), where);
    };
    if (options_.curvature) {
        // A part of the border has no curvature, and no statistics of it.
        const auto add_curvature = [&](const char* name, const std::vector<double>& values, int power) {
            const std::vector<double> own = cut == nullptr ? values : cut->object.vertex_values(mesh_, values);
            const bool any = std::any_of(vertices.begin(), vertices.end(), [&](Index v) { return !std::isnan(own[v]); });
            if (any) add_statistics(result, name, map_statistics(values, annotation_name, UndefinedValues::skipped), power);
        };
        add_curvature("mean curvature", curvature().mean, -1);
        add_curvature("Gaussian curvature", curvature().gaussian, -2);
    }
    if (options_.thickness && region) {
        std::vector<double> values, weights;
        double total_area = 0, measured_area = 0;
        for (const Index face : edge_annotation.faces) {
            const double area = face_area(mesh, Face(face)),
                         value = thickness()[cut == nullptr ? face : cut->object.face_origin[face]];
            total_area += area;
            if (!std::isfinite(value)) continue;
            measured_area += area;
            values.push_back(value);
            weights.push_back(area);
        }
        if (!values.empty()) add_statistics(result, "thickness", statistics(values, weights, annotation_name), 1);
        // Share of the region with a thickness: rays may leave an open mesh without a hit.
        result.push_back(number("thickness share", total_area > 0 ? measured_area / total_area : 0, 0));
    }
    for (const NamedMap& map : maps)
        add_statistics(result, map.name, map_statistics(map.values, fmt::format("{}, map '{}'", annotation_name, map.name)), 0,
                       map.unit);
    return result;
}

void store(Annotation& annotation, const std::vector<Quantity>& quantities, const std::string& unit) {
    for (const Quantity& quantity : quantities) {
        auto attribute = std::find_if(annotation.attributes.begin(), annotation.attributes.end(),
                                      [&](const Attribute& a) { return a.descriptor() != nullptr && a.name == quantity.name; });
        if (attribute == annotation.attributes.end()) {
            const int id = next_free_id(annotation.attributes);
            annotation.attributes.emplace_back();
            attribute = annotation.attributes.end() - 1;
            attribute->id = id;
            attribute->name = quantity.name;
        }
        auto& descriptor = attribute->value.emplace<Descriptor>();
        descriptor.values = quantity.values;
        descriptor.is_list = quantity.is_list;
        descriptor.unit = unit_of(quantity, unit);
    }
}

void DescriptorOptions::declare_options(OptionList& list) {
    list("curvature", curvature, "compute statistics of the mean and Gaussian curvature at the vertices");
    list("thickness", thickness, "compute statistics of the thickness of the object under the faces (shape diameter)");
    curvature_options.declare_options(list);
    thickness_options.declare_options(list);
}

}  // namespace ostraka

#include "ostraka/reconstruction/fragment_file.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/fracture/facet_graph.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/surface_colour.h"
#include "ostraka/mesh/orientation.h"
#include "ostraka/transfer/moved_annotations.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Adds the file name to errors about its contents.
template <class Work>
auto with_file_name(const Path& file, Work&& work) {
    try {
        return work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        fail_input(fmt::format("{}, {}", file.string(), error.where()), error.problem(), error.remedy());
    }
}

/// The mean colour of each face, from its image and its own colours; empty without either.
std::vector<Colour> face_colours_of(const MeshFile& file, const std::string& where) {
    std::vector<Colour> colours;
    if (!has_colours(file.extras)) return colours;
    const SurfaceColour surface(file.mesh, file.extras, where);
    colours.resize(file.mesh.number_of_faces());
    parallel_for(colours.size(), 1024, [&](std::size_t f) {
        const Face face(static_cast<Index>(f));
        const auto light = surface.at(face, {1.0 / 3, 1.0 / 3, 1.0 / 3}, std::sqrt(face_area(file.mesh, face)));
        colours[f] = {srgb_from_linear(light[0]), srgb_from_linear(light[1]), srgb_from_linear(light[2]), 255};
    });
    return colours;
}

}  // namespace

FragmentFile read_fragment(const Path& file, const FragmentFileOptions& options) {
    check_options(options, "fragment");
    FragmentFile result;
    Fragment& fragment = result.fragment;
    fragment.name = file.stem().string();
    result.inputs.push_back(file);
    if (const std::optional<PointCloud> cloud = read_point_cloud(file)) {
        result.points = true;
        result.notes = cloud->notes;
        CloudSurface surface = with_file_name(file, [&] { return reconstruct_surface(*cloud, options.cloud); });
        result.notes.insert(result.notes.end(), surface.notes.begin(), surface.notes.end());
        fragment.mesh = std::move(surface.mesh);
    } else {
        MeshFile mesh = read_mesh(file);
        for (std::string& note : manifold_notes(mesh)) result.notes.push_back(std::move(note));
        result.face_colours = face_colours_of(mesh, file.string());
        fragment.mesh = std::move(mesh.mesh);
    }
    using FacetSource = FragmentFileOptions::FacetSource;
    bool annotated = false;
    const Path annotation_file = file.parent_path() / (fragment.name + ".ant.json");
    if (result.points && file_exists(annotation_file))
        result.notes.push_back(fmt::format(
            "{} is not read: annotations beside points do not describe the surface reconstructed from them; give a mesh",
            annotation_file.filename().string()));
    if (!result.points && file_exists(annotation_file)) {
        AnnotationSet set = read_annotations(annotation_file, fragment.mesh);
        result.inputs.push_back(annotation_file);
        std::swap(fragment.annotations.annotations, set.annotations);
        fragment.annotations.unit = set.unit;
        const auto& annotations = fragment.annotations.annotations;
        annotated = options.facets != FacetSource::none &&
                    std::any_of(annotations.begin(), annotations.end(),
                                [](const Annotation& annotation) { return named_facet(annotation).has_value(); });
    }
    if (is_inside_out(fragment.mesh)) {
        static_cast<AnnotatedMesh&>(fragment) = turned_over(AnnotatedMeshView(fragment));
        result.notes.emplace_back("is inside out: its faces were turned over in memory (ostraka mesh repair corrects the file)");
    }
    const bool by_shape = options.facets == FacetSource::automatic ||
                          (options.facets == FacetSource::either && !annotated && (result.points || !has_opening(fragment.mesh)));
    result.facets_from = annotated && by_shape ? "shape and annotations"
                         : annotated           ? "annotations"
                         : by_shape            ? "shape"
                                               : "nowhere";
    if (by_shape) {
        result.found = with_file_name(file, [&] { return find_facets(fragment.mesh, options.finding); });
        fragment.facets = result.found.of_face;
        constexpr double min_confidence = 0.5;
        for (const FacetSegment& segment : result.found.segments)
            if (segment.facet == Facet::fracture && segment.confidence <= min_confidence)
                for (const Index f : segment.faces) fragment.facets[f] = Facet::outer;
    }
    if (annotated) {
        const auto from_file = [&](Facet other) {
            return with_file_name(annotation_file, [&] { return facets_of(fragment, other); });
        };
        std::vector<Facet> stated = from_file(Facet::outer);
        if (by_shape) {
            // Faces without an annotation differ between the two results.
            const std::vector<Facet> with_fracture = from_file(Facet::fracture);
            for (std::size_t f = 0; f < stated.size(); ++f)
                if (stated[f] == with_fracture[f]) fragment.facets[f] = stated[f];
        } else {
            fragment.facets = std::move(stated);
        }
    }
    return result;
}

AnnotationSet facet_annotations(const Facets& facets, const std::string& unit) {
    AnnotationSet set;
    set.unit = unit;
    for (const Facet facet : {Facet::outer, Facet::inner, Facet::fracture}) {
        Annotation annotation;
        annotation.id = static_cast<int>(facet);
        annotation.tag = to_string(facet);
        annotation.type = AnnotationType::region;
        annotation.colour = facet == Facet::outer   ? std::array{213, 160, 90}
                            : facet == Facet::inner ? std::array{86, 150, 210}
                                                    : std::array{190, 40, 40};
        double area = 0, confidence = 0;
        for (const FacetSegment& segment : facets.segments) {
            if (segment.facet != facet) continue;
            annotation.faces.insert(annotation.faces.end(), segment.faces.begin(), segment.faces.end());
            area += segment.area;
            confidence += segment.area * segment.confidence;
        }
        if (annotation.faces.empty()) continue;
        std::sort(annotation.faces.begin(), annotation.faces.end());
        Quantity surface, certainty;
        surface.name = "area";
        surface.values = {area};
        surface.power = 2;
        certainty.name = "confidence";
        certainty.values = {area > 0 ? confidence / area : 0};
        store(annotation, {surface, certainty}, unit);
        set.annotations.push_back(std::move(annotation));
    }
    return set;
}

void update_facet_annotations(AnnotationSet& set, const Facets& facets) {
    AnnotationSet updated = facet_annotations(facets, set.unit);
    std::erase_if(set.annotations, [&](Annotation& old) {
        const std::optional<Facet> facet = named_facet(old);
        if (!facet) return false;
        const auto match = std::find_if(updated.annotations.begin(), updated.annotations.end(),
                                        [&](const Annotation& annotation) { return annotation.tag == to_string(*facet); });
        if (match == updated.annotations.end()) return true;
        std::vector<Quantity> quantities;
        for (const Attribute& attribute : match->attributes) {
            Quantity quantity;
            quantity.name = attribute.name;
            quantity.values = attribute_values(attribute).values;
            quantity.power = attribute.name == "area" ? 2 : 0;
            quantities.push_back(quantity);
        }
        if (old.faces != match->faces)
            for (Attribute& attribute : old.attributes)
                if (Descriptor* descriptor = attribute.descriptor()) descriptor->stale = true;
        if (old.faces != match->faces) old.curves.clear();
        old.faces = std::move(match->faces);
        old.all = false;
        store(old, quantities, set.unit);
        updated.annotations.erase(match);
        return false;
    });
    for (Annotation& annotation : updated.annotations) {
        if (set.find(annotation.id) != nullptr) annotation.id = free_id(set);
        set.annotations.push_back(std::move(annotation));
    }
}

void FragmentFileOptions::declare_options(OptionList& list) {
    list("facets", facets,
         "classification of outer, inner and fracture surface: annotated: from annotations; auto: from the shape, overridden by "
         "annotations; either: from annotations if there are any, otherwise from the shape of closed meshes; none: everything is "
         "outer surface",
         Choices{"either", "annotated", "auto", "none"});
    finding.declare_options(list);
    cloud.declare_options(list);
}

}  // namespace ostraka

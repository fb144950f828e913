#include "ostraka/collection/object_part.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/part.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/select/scalars.h"
#include "ostraka/slicing/sliced_object.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Heights above the origin of the frame.
struct Band {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// Maximum width of a neck, as a fraction of the largest widths below and above it.
constexpr double max_neck = 0.8;

Band find_tube(const SlicedObject& cut) {
    const Tube tube = tubular_part(cut.stack(), cut.descriptors);
    if (!tube.found) fail_input("mesh", "no tubular part was found: " + tube.reason, "annotate the part and name it instead");
    const std::vector<double> heights = cut.sorted_heights();
    return {heights.at(tube.first), heights.at(tube.last)};
}

Band above_neck(const SlicedObject& cut) {
    const std::size_t n = cut.slices.size();
    std::vector<double> radius(n), below(n, 0), above(n, 0);
    for (std::size_t i = 0; i < n; ++i)
        radius[i] = std::isfinite(cut.descriptors[i].equivalent_radius) ? cut.descriptors[i].equivalent_radius : 0;
    for (std::size_t i = 1; i < n; ++i) below[i] = std::max(below[i - 1], radius[i - 1]);
    for (std::size_t i = n - 1; i-- > 0;) above[i] = std::max(above[i + 1], radius[i + 1]);
    double minimum = max_neck;
    std::optional<std::size_t> neck;
    for (std::size_t i = n / 2; i < n; ++i) {
        const double relative_radius = radius[i] / std::min(below[i], above[i]);
        if (radius[i] > 0 && relative_radius < minimum) minimum = relative_radius, neck = i;
    }
    if (!neck)
        fail_input("mesh", "has no neck in its upper half where a top could be cut off",
                   "annotate the part and name it instead, or give the upward direction by --up");
    return {cut.slices[*neck].height, std::numeric_limits<double>::infinity()};
}

/// Attributes errors of the work to the file.
template <class Work>
auto with_file_context(const Path& file, const Work& work) {
    try {
        return work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        throw Error(error.kind(), file.filename().string(), error.problem(), error.remedy());
    }
}

/// The part of the mesh within the band, cut through the faces.
Mesh cut_band(const Mesh& mesh, const SliceFrame& frame, const Band& band, std::vector<Index>& origin) {
    const auto halfspace = [&](double height, double side) {
        const Vector place = (frame.origin - CGAL::ORIGIN) + height * frame.normal, normal = side * frame.normal;
        const auto vector_text = [](const Vector& v) {
            return "[" + digits(v.x()) + "," + digits(v.y()) + "," + digits(v.z()) + "]";
        };
        return R"({"halfspace":{"point":)" + vector_text(place) + R"(,"normal":)" + vector_text(normal) + "}}";
    };
    std::string sides;
    if (std::isfinite(band.low)) sides += halfspace(band.low, 1);
    if (std::isfinite(band.high)) sides += (sides.empty() ? "" : ",") + halfspace(band.high, -1);
    const Json recipe = parse_json(
        R"({"format":"ostraka-recipe","version":1,"annotations":[{"id":0,"tag":"part","type":"region","outline":"free",)"
        R"("select":{"intersection":[)" +
            sides + "]}}]}",
        "the part");
    CutPart part = cut_out_part({mesh, apply_recipe(recipe, mesh, {}, "the part")}, {0});
    for (const Index f : part.faces) origin.push_back(part.whole ? part.whole->face_origin[f] : f);
    return std::move(part.mesh);
}

/// The largest segment by thickness, cut out along its edges.
CutPart largest_segment(const Mesh& mesh) {
    const std::vector<Index> numbers = segment(mesh, thickness(mesh), {});
    AnnotationSet set;
    Annotation& region = set.annotations.emplace_back();
    region.tag = "segment 0";
    for (Index f = 0; f < numbers.size(); ++f)
        if (numbers[f] == 0) region.faces.push_back(f);
    return cut_out_part({mesh, set}, {0});
}

}  // namespace

void PartOptions::declare_options(OptionList& list) {
    list("annotation", annotations, "ids or tags (with a vocabulary also narrower concepts) of the regions to analyse").words();
    list("without", without,
         "ids or tags of regions that are left out of the analysis, such as beard; objects without such a region are allowed")
        .words();
    list("proposed", proposed,
         "analyse a detected part instead of annotated regions: the tubular part (tube) or the part above the neck (top), from "
         "slices perpendicular to the upward direction, or the largest segment by thickness (segment)",
         Choices{"none", "tube", "top", "segment"});
}

ObjectParts::ObjectParts(PartOptions options, TagMatcher words, std::string words_checksum)
    : options_(std::move(options)), words_(std::move(words)), checksum_(std::move(words_checksum)) {
    if (options_.proposed != PartOptions::Proposal::none && !(options_.annotations.empty() && options_.without.empty()))
        fail_usage("--proposed is given with --annotation or --without", "use either a detected part or an annotated one");
}

bool ObjectParts::whole() const {
    return options_.proposed == PartOptions::Proposal::none && options_.annotations.empty() && options_.without.empty();
}

std::vector<std::string> ObjectParts::key() const {
    if (whole()) return {};
    std::vector<std::string> key{"part 1", checksum_};
    for (const auto& [name, value] : declare_options(options_)) key.push_back(name + "=" + value);
    return key;
}

ObjectPart ObjectParts::read(const CollectionObject& object, const std::optional<std::array<double, 3>>& up) const {
    if (object.mesh.empty()) fail_input(object.name, "has landmarks but no mesh", "give a mesh, or leave the object out");
    MeshFile file = read_mesh(object.mesh);
    ObjectPart part;
    std::optional<AnnotationSet> set;
    const bool selects_annotations = !options_.annotations.empty() || !options_.without.empty();
    try {
        if (!object.annotations.empty()) set = read_annotations(object.annotations, file.mesh);
    } catch (const Error& error) {
        if (selects_annotations || error.kind() == ErrorKind::cancelled) throw;
        part.annotations_error = std::current_exception();
    }
    if (set) part.up = set->up;
    std::vector<Index> origin;  // faces of the mesh in the file
    if (selects_annotations) {
        if (!set)
            fail_input(object.mesh.filename().string(), "has no annotations that could name its parts",
                       fmt::format("put {}.ant.json next to it, or leave the object out", object.mesh.stem().string()));
        const std::string where = object.annotations.filename().string();
        std::vector<std::size_t> regions, left_out;
        const auto add = [&](const std::string& name, bool needed, std::vector<std::size_t>& regions_to) {
            for (const std::size_t i : needed ? words_.require(*set, name, where) : words_.find(*set, name))
                if (set->annotations[i].type == AnnotationType::region) regions_to.push_back(i);
        };
        const auto is_annotated = [&](const std::string& name) { return !words_.find(*set, name).empty(); };
        // One of several names is enough.
        const bool any_annotated = std::any_of(options_.annotations.begin(), options_.annotations.end(), is_annotated);
        for (const std::string& name : options_.annotations) add(name, !any_annotated, regions);
        for (const std::string& name : options_.without) add(name, false, left_out);
        if (regions.empty() && !options_.annotations.empty())
            fail_input(where, fmt::format("no annotation '{}' is a region", printable(options_.annotations.front(), 60)),
                       "annotate the surface of the part as a region");
        CutPart cut = with_file_context(object.annotations, [&] { return cut_out_part({file.mesh, *set}, regions, left_out); });
        for (const Index f : cut.faces) origin.push_back(cut.whole ? cut.whole->face_origin[f] : f);
        part.mesh = std::move(cut.mesh);
    } else if (options_.proposed == PartOptions::Proposal::segment) {
        CutPart cut = with_file_context(object.mesh, [&] { return largest_segment(file.mesh); });
        origin = std::move(cut.faces);
        part.mesh = std::move(cut.mesh);
    } else if (options_.proposed != PartOptions::Proposal::none) {
        if (!up && part.annotations_error) std::rethrow_exception(part.annotations_error);
        const std::array<double, 3> up_direction = up ? *up : part.up.value_or(std::array<double, 3>{0, 0, 1});
        part.mesh = with_file_context(object.mesh, [&] {
            const SliceFrame frame = slice_frame(Point(0, 0, 0), Vector(up_direction[0], up_direction[1], up_direction[2]));
            const auto [lowest, highest] = height_range(file.mesh, frame);
            const SlicedObject cut = slice_parallel(file.mesh, frame, slice_heights(lowest, highest, 100));
            return cut_band(file.mesh, frame, options_.proposed == PartOptions::Proposal::tube ? find_tube(cut) : above_neck(cut),
                            origin);
        });
    } else {
        part.mesh = std::move(file.mesh);
        part.face_labels = std::move(file.extras.face_labels);
        return part;
    }
    if (!file.extras.face_labels.empty())
        for (const Index f : origin) part.face_labels.push_back(file.extras.face_labels[f]);
    return part;
}

}  // namespace ostraka

// measure describe: descriptors of annotations.
#include "operations/measure/measured_object.h"

#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/surface_colour.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

struct MeasureDescribe final : Operation {
    void declare(Parameters& p) override {
        object.declare(p);
        p.input_option("map", Kind::values, maps, "NAME=FILE: a map: one value per vertex (.npy, or text, one number per line)")
            .many()
            .named();
        p.options("annotation", chosen, "id or tag of an annotation to describe; repeatable; all annotations if left out");
        options.declare_options(p.options);
        p.options("colours", colours,
                  "describe the colours of regions too: mean and spread in CIELAB, mean as sRGB, range of the lightness");
        p.report.table("annotations", integer("id"), text("tag"), any("quantities"));
        p.report.text_table("", {"id", "tag", "quantity", "value", "unit"});
    }

    void run(Context&, Report& report) override {
        const Mesh& mesh = object.mesh->mesh;
        const std::vector<NamedMap> named_maps = read_maps(mesh);
        AnnotationSet set = object.read(report);
        if (colours && !has_colours(object.mesh->extras))
            fail_input(object.mesh.file(), "has neither an image nor colours",
                       "leave out --colours, or give the file with its image");
        if (!object.annotations && chosen.empty())
            report.note("the whole object is described; --annotations FILE describes its parts");
        DescriptorSearch search(mesh, options);
        search.prepare(set);
        report.empty_table("annotations");
        report.empty_table("");
        for (Annotation* annotation : selected(set)) {
            std::vector<Quantity> quantities = quantities_of(*annotation, search, named_maps);
            for (const std::string& remark : search.remarks(*annotation))
                report.note(fmt::format("volume of {}: {}", name_of(*annotation), remark));
            if (colours && annotation->type == AnnotationType::region) add_colours({mesh, set}, *annotation, quantities);
            store(*annotation, quantities, set.unit);
            report_result(report, *annotation, quantities, set.unit);
        }
        object.write(std::move(set));
    }

    [[nodiscard]] std::vector<NamedMap> read_maps(const Mesh& mesh) const {
        std::vector<NamedMap> named_maps;
        for (std::size_t i = 0; i < maps.size(); ++i) {
            const NamedMap& map = named_maps.emplace_back(NamedMap{maps.label(i), maps.get(i), {}});
            if (map.values.size() != mesh.number_of_vertices())
                fail_input(maps.file(i),
                           fmt::format("has {} values for {} vertices", map.values.size(), mesh.number_of_vertices()),
                           "give one value for each vertex of the mesh");
        }
        return named_maps;
    }

    /// The selected annotations, without duplicates; all if none is selected.
    [[nodiscard]] std::vector<Annotation*> selected(AnnotationSet& set) const {
        std::vector<Annotation*> selection;
        for (const auto& name : chosen)
            if (Annotation* annotation = &object.require_annotation(set, name);
                std::find(selection.begin(), selection.end(), annotation) == selection.end())
                selection.push_back(annotation);
        if (chosen.empty())
            for (Annotation& annotation : set.annotations) selection.push_back(&annotation);
        return selection;
    }

    /// Computes the quantities; errors about a map name its file.
    [[nodiscard]] std::vector<Quantity> quantities_of(const Annotation& annotation, DescriptorSearch& search,
                                                      const std::vector<NamedMap>& named_maps) const {
        try {
            return in_file(object.file(), [&] { return search.describe(annotation, named_maps); });
        } catch (const Error& error) {
            for (std::size_t i = 0; i < named_maps.size(); ++i)
                if (error.where().ends_with(fmt::format("map '{}'", named_maps[i].name)))
                    throw Error(error.kind(), fmt::format("{}, at {}", maps.file(i), error.where()), error.problem(),
                                error.remedy());
            throw;
        }
    }

    /// Adds the colours of a region.
    void add_colours(AnnotatedMeshView annotated, const Annotation& region, std::vector<Quantity>& quantities) const {
        const ColourMeasures measures = measure_colour(annotated, region, object.mesh->extras, object.mesh.file());
        const auto& [red, green, blue] = measures.mean_rgb;
        quantities.push_back({"colour mean (CIELAB)", {measures.mean.begin(), measures.mean.end()}, true, 0, {}});
        quantities.push_back({"colour spread (CIELAB)", {measures.spread}, false, 0, {}});
        quantities.push_back({"colour mean (sRGB)", {double(red), double(green), double(blue)}, true, 0, {}});
        quantities.push_back({"lightness 10 to 90 %", {measures.lightness_low, measures.lightness_high}, true, 0, {}});
    }

    static void report_result(Report& report, const Annotation& annotation, const std::vector<Quantity>& quantities,
                              const std::string& unit) {
        auto& allocator = report.allocator();
        JsonValue quantity_entries(rapidjson::kArrayType);
        for (const Quantity& quantity : quantities) {
            std::string text;
            const bool axes = quantity.name == "box axes" && quantity.values.size() == 9;  // three vectors
            for (std::size_t i = 0; i < quantity.values.size(); ++i)
                text += fmt::format("{}{}{}{}", text.empty() ? "" : " ", axes && i % 3 == 0 ? "(" : "",
                                    number(quantity.values[i], 6), axes && i % 3 == 2 ? ")" : "");
            JsonValue item = json_object(allocator, "name", quantity.name);
            if (quantity.is_list) add_members(item, allocator, "value", quantity.values);
            else add_members(item, allocator, "value", quantity.values.front());
            add_members(item, allocator, "unit", unit_of(quantity, unit));
            quantity_entries.PushBack(item, allocator);
            report.row("", {annotation.id, annotation.tag, quantity.name, text, unit_of(quantity, unit)});
        }
        report.row("annotations")("id", annotation.id)("tag", annotation.tag)("quantities", std::move(quantity_entries));
    }

    MeasuredObject object;
    ValuesInput maps;
    std::vector<std::string> chosen;
    DescriptorOptions options;
    bool colours = false;
};

}  // namespace

std::unique_ptr<Operation> make_measure_describe() { return make<MeasureDescribe>(); }

}  // namespace ostraka

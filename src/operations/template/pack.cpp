// template pack
#include "operations/template/inspection.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

struct TemplatePack final : Operation {
    void declare(Parameters& p) override {
        p.output("output", Kind::template_package, output, "template to write (.template.json)");
        const auto part = [&](const char* role, Kind kind, const char* help) -> Slot& {
            return p.input_option(role, kind, parts[role], help);
        };
        part("mesh", Kind::mesh, "mesh").needed = true;
        part("annotations", Kind::annotations, "annotations of the mesh (.ant.json)");
        part("graph", Kind::graph, "relationships among the annotations (.graph.json)");
        part("cage", Kind::cage, "closed cage around the mesh; repeatable, from coarse to fine").words();
        part("coordinates", Kind::coordinates, "coordinates of the mesh in a cage (.npy), once per cage").words();
        part("vocabulary", Kind::vocabulary, "vocabulary that the annotations use (.vocabulary.json, .ttl, .rdf)");
        part("rules", Kind::rules, "rules of the class (.rules.json)");
        part("ranges", Kind::text, "ranges of the measures of the class (JSON)");
        part("landmarks", Kind::landmarks, "landmarks of the template (.ant.json)");
        p.options("class", object_class, "class of the object; by default the class in the annotations");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm); by default the unit of the annotations");
        up.declare(p, "upward direction; by default the upward direction of the annotations");
        p.options("copy", copy, "copy the files into the folder of the template");
        options.declare_options(p.options);
        declare_template(p.report, true);
    }

    void check() const override {
        if (copy && output.file().empty())
            fail_usage("there is no folder to copy the parts to", "give the template's file, or leave out --copy");
    }

    /// Whether the existing file is a part of the template that is rewritten.
    [[nodiscard]] bool is_packed(const Path& template_path, const Path& part) const {
        if (!file_exists(template_path)) return false;
        const auto parts_before = read_template(template_path, options).contents;
        return std::any_of(parts_before.begin(), parts_before.end(),
                           [&](const PackagedFile& packaged) { return same_place(packaged.file, part); });
    }

    void run(Context& context, Report& report) override {
        const Path template_path(output.file()),
            folder = template_path.has_parent_path() ? template_path.parent_path() : Path(".");
        TemplateFile file{object_class, unit, up.value(), {}};
        std::vector<Path> inputs, outputs{template_path};
        std::map<Path, Path> copies;  // copy -> original
        for (const std::string& role : template_roles())
            for (std::size_t i = 0; i < parts[role].size(); ++i) {
                const Path part = inputs.emplace_back(parts[role].path(i));
                const Path target = copy ? folder / part.filename() : part;
                if (!same_place(target, part) && copies.emplace(target, part).first->second != part)
                    fail_usage(fmt::format("two parts are called '{}'", part.filename().string()), "rename one of the files");
                file.contents.push_back({role, part_name(folder, target), part, sha256_of_file(part)});
            }
        for (const auto& [target, part] : copies) {
            if (file_exists(target) && sha256_of_file(target) != sha256_of_file(part) && !is_packed(template_path, target))
                fail_usage(fmt::format("another file is called '{}'", target.string()),
                           "rename it, or the part " + part.string());
            outputs.push_back(target);
        }
        check_outputs(inputs, outputs);
        // Parse the file as readers will: names that lead out of the folder are rejected here.
        if (!template_path.empty())
            static_cast<void>(template_from_json(template_to_json(file, {}), folder, template_path.string(), options));
        Template package;
        context.record([&] { package = load_template(file, options); });
        // Properties of the object that are not given are taken from the annotations.
        if (package.annotations) {
            if (file.object_class.empty()) file.object_class = package.annotations->object_class;
            if (file.unit.empty()) file.unit = package.annotations->unit;
            if (!file.up) file.up = package.annotations->up;
            package.file = file;
        }
        add_template(report, package, true);
        if (!package.sound()) return report.note("nothing is written: correct the defects first");
        for (const auto& [target, part] : copies) write_file(target, read_file(part));
        output.write(std::move(package));
    }

    TemplateOutput output;
    std::map<std::string, FileInput> parts;  ///< by role
    std::string object_class, unit;
    DirectionOption up;
    bool copy = false;
    TemplateOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_template_pack() { return make<TemplatePack>(); }

}  // namespace ostraka

#include "operations/file_attribute.h"

#include "ostraka/files/safe_path.h"
#include "ostraka/mesh/ids.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

Path folder_of(const std::string& file) { return resolved(std::filesystem::absolute(Path(file)).parent_path()); }

}  // namespace

void FileAttribute::declare(Parameters& p, const std::string& name) {
    p.output_option(
        "annotations-out", Kind::annotations, output_,
        "annotations to write (.ant.json), with a new attribute that refers to the output file and stores the file's checksum");
    p.options("name", name_, fmt::format("name of the attribute in --annotations-out; \"{}\" if left out", name));
    p.report.values(integer("annotation"), text("attribute"));
}

void FileAttribute::check(const Slot& file, const std::string& ending) const {
    if (!output_ && !name_.empty()) fail_usage("--name without --annotations-out", "name the annotations to write");
    if (!output_) return;
    if (!file) fail_usage("--annotations-out without --output", "name the file that the attribute refers to");
    if (file.sources.front().file.empty() || output_.sources.front().file.empty()) return;  // in memory
    if (extension(file.file()) != ending)
        fail_usage(fmt::format("'{}' cannot be the value of an attribute", printable(file.file(), 60)),
                   "end its name in " + ending);
    if (!is_inside(Path(file.file()), folder_of(output_.file())))
        fail_usage(
            fmt::format("'{}' lies outside of the folder of '{}'", printable(file.file(), 60), printable(output_.file(), 60)),
            "write both to one folder: annotations name files relative to themselves");
}

void FileAttribute::write(AnnotationSet set, int holder, const Slot& file, const Value& value, const MeshInput& mesh,
                          Report& report) const {
    Annotation& annotation = *set.find(holder);
    const std::string attribute_name = name_.empty() ? value.name : name_;
    auto& attributes = annotation.attributes;
    auto place = std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& attribute) {
        return attribute.name == attribute_name && attribute.descriptor() != nullptr;
    });
    if (place == attributes.end()) {
        Attribute attribute;
        attribute.id = next_free_id(attributes);
        attribute.name = attribute_name;
        place = attributes.insert(attributes.end(), std::move(attribute));
    }
    auto& descriptor = place->value.emplace<Descriptor>();
    descriptor.unit = value.unit;
    descriptor.sha256 = value.sha256;
    const Source& source = file.sources.front();
    descriptor.file = source.file.empty() || output_.sources.front().file.empty()
                          ? Path(file.file()).filename().string()
                          : resolved(source.file).lexically_relative(folder_of(output_.file())).string();
    report("annotation", annotation.id)("attribute", attribute_name);
    report.line(fmt::format("{} has the attribute '{}' in '{}'", name_of(annotation), printable(attribute_name, 60),
                            printable(descriptor.file, 60)));
    output_.write(std::move(set), mesh->mesh, mesh.file());
}

}  // namespace ostraka

// An attribute whose value is a file written by the same operation: a map, an axis.
#pragma once

#include "operations/operations.h"

namespace ostraka {

/// The options `--annotations-out` and `--name`, and the attribute they request.
class FileAttribute {
public:
    /// `name`: default name of the attribute, for the help text.
    void describe(Parameters& p, const std::string& name);
    explicit operator bool() const { return static_cast<bool>(output_); }
    /// File of the annotations to write.
    [[nodiscard]] std::string file() const { return output_.file(); }
    /// Throws Error (usage) if `file` is not written, does not end in `ending`, or lies outside the folder of the annotations,
    /// or if --name is given without --annotations-out.
    void check(const Slot& file, const std::string& ending) const;
    /// Adds the attribute to the annotation with id `holder`, replacing a descriptor of the same name, and writes the
    /// annotations. `file` is written by the same call with the checksum `value.sha256`; `value` also holds the unit, and the
    /// default name.
    struct Value {
        std::string name, unit, sha256;
    };
    void write(AnnotationSet set, int holder, const Slot& file, const Value& value, const MeshInput& mesh, Report& report) const;

private:
    AnnotationsOutput output_;
    std::string name_;
};

}  // namespace ostraka

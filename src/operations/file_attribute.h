// An attribute whose value is a file that the same operation writes: a map, an axis.
#pragma once

#include "operations.h"

namespace ostraka {

/// The options `--annotations-out` and `--name`, and the attribute that they ask for.
class FileAttribute {
public:
    /// `name`: of the attribute where --name is not given, for the help text.
    void describe(Parameters& p, const std::string& name);
    explicit operator bool() const { return static_cast<bool>(output_); }
    /// The annotations to write.
    [[nodiscard]] std::string file() const { return output_.file(); }
    /// Throws Error (usage) where the file is not written, does not end in `ending`, or lies outside of the folder of the
    /// annotations, and for --name without --annotations-out.
    void check(const Slot& file, const std::string& ending) const;
    /// Gives the annotation `holder` the attribute, in place of a descriptor of the same name, and writes the annotations. `file`
    /// is written by the same call, with bytes of this checksum; `value` has the unit, and the name where --name is not given.
    struct Value {
        std::string name, unit, sha256;
    };
    void write(AnnotationSet set, int holder, const Slot& file, const Value& value, const MeshInput& mesh, Report& report) const;

private:
    AnnotationsOutput output_;
    std::string name_;
};

}  // namespace ostraka

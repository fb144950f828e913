// An attribute whose value is a file written by the same operation: a map, an axis.
#pragma once

#include "operations/operations.h"

namespace ostraka {

/// The options `--annotations-out` and `--name`, and the attribute that they add to an annotation.
class FileAttribute {
public:
    /// Declares the two options. `name`: default name of the attribute, for the help text.
    void declare(Parameters& p, const std::string& name);
    /// True if `--annotations-out` is given.
    explicit operator bool() const { return static_cast<bool>(output_); }
    /// Name of the annotation file to write.
    [[nodiscard]] std::string file() const { return output_.file(); }
    /// Checks the options before any work starts. Throws Error (usage) if `file`, the attribute's value, is not written by the
    /// call, does not end in `ending`, or lies outside the folder of the annotations, or if --name is given without
    /// --annotations-out.
    void check(const Slot& file, const std::string& ending) const;
    /// Checksum and unit of the attribute's file.
    struct Value {
        std::string name, unit, sha256;  ///< default name of the attribute; unit of its values; SHA-256 of its file
    };
    /// Adds the attribute to the annotation with id `holder`, replacing a descriptor of the same name, and writes the
    /// annotations. `file` is the attribute's value, written by the same call.
    void write(AnnotationSet set, int holder, const Slot& file, const Value& value, const MeshInput& mesh, Report& report) const;

private:
    AnnotationsOutput output_;
    std::string name_;  ///< value of --name; empty: the default name
};

}  // namespace ostraka

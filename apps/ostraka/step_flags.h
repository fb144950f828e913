// The flags of 'annotation select': one step of a recipe.
#pragma once

#include "command.h"

#include "ostraka/annotation/annotation.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka::app {

/// Flags that say what is selected; exactly one of them, or an expression.
struct Tools {
    std::string expression;  ///< as recipes have it
    std::string rectangle, polygon, box, sphere, halfspace, nearest, segments, threshold;
    std::vector<std::string> path, lasso, brush, vertices, component;
    std::vector<int> faces, labels;
    bool all = false;
};

/// All that the flags say of a step.
struct StepFlags {
    Tools tools;
    // how
    bool through = false, closed = false, stroke = false, invert = false;
    std::string seed, metric = "euclidean", frame = "mesh";
    double radius = -1;
    std::optional<double> above, below;
    double scale = 0, smoothing = 0.26;
    bool quantiles = false;
    int grow = 0, shrink = 0;
    // the camera
    std::string camera_text, view = "30,20", up, projection = "orthographic", size = "1200x900";
    double zoom = 1;
    // what for
    std::string type, tag, colour, action = "make";
    std::optional<int> id;

    void add_to(CLI::App& command);

    /// The step, taken on this set. Throws Error (usage) for flags that make no step.
    [[nodiscard]] Json step(const AnnotationSet& set) const;

private:
    using Alloc = JsonAllocator&;
    [[nodiscard]] JsonValue camera(Alloc a) const;
    [[nodiscard]] JsonValue pick(const std::string& text, const std::string& flag, Alloc a) const;
    [[nodiscard]] JsonValue picks(const std::vector<std::string>& list, const std::string& flag, Alloc a) const;
    [[nodiscard]] JsonValue tool(Alloc a) const;
    [[nodiscard]] JsonValue threshold(Alloc a) const;
    [[nodiscard]] JsonValue expression(Alloc a) const;
    [[nodiscard]] std::string type_of_tool() const;
    [[nodiscard]] int id_for(const AnnotationSet& set) const;
    [[nodiscard]] JsonValue colour_for(const AnnotationSet& set, Alloc a) const;
};

}  // namespace ostraka::app

// One step of a recipe, specified by options.
#pragma once

#include "operations/operations.h"

namespace ostraka {

/// The options that specify a step.
struct SelectStep {
    // tools; exactly one is given
    std::string expression;  ///< a selection in the JSON form of recipes
    bool all = false;
    std::vector<double> rectangle, polygon, box, sphere, halfspace, nearest;
    std::string threshold, component;
    std::optional<int> segment;
    std::vector<std::string> path, lasso, brush, vertices;
    std::vector<int> faces, labels;
    // modifiers
    bool through = false, closed = false, stroke = false, invert = false, quantiles = false;
    std::string seed, like, metric = "euclidean", frame = "mesh";
    std::optional<double> radius, above, below, tolerance, smallest;
    std::vector<double> lightness, chroma, hue;
    std::optional<int> blur;
    double scale = 0, smoothing = 0.26;
    int grow = 0, shrink = 0;
    // camera
    std::string camera_text, view = "30,20", up, projection = "orthographic", size = "1200x900";
    double zoom = 1;
    // resulting annotation
    std::string tag, action = "make";
    std::optional<std::string> type, outline, painted;
    std::vector<int> colour;
    std::optional<int> id;

    void declare_options(OptionList& list);
    /// Returns the step to apply to this set. Throws Error (usage) if the options do not specify a valid step.
    [[nodiscard]] Json step(const AnnotationSet& set) const;
};

}  // namespace ostraka

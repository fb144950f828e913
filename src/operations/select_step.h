// One step of a recipe, given by options.
#pragma once

#include "operations.h"

namespace ostraka {

/// All that the options say of a step.
struct SelectStep {
    // tools, of which exactly one is given
    std::string expression;  ///< as recipes have it
    bool all = false;
    std::vector<double> rectangle, polygon, box, sphere, halfspace, nearest;
    std::string threshold, component;
    std::optional<int> segment;
    std::vector<std::string> path, lasso, brush, vertices;
    std::vector<int> faces, labels;
    // how
    bool through = false, closed = false, stroke = false, invert = false, quantiles = false;
    std::string seed, metric = "euclidean", frame = "mesh";
    std::optional<double> radius, above, below;
    double scale = 0, smoothing = 0.26;
    int grow = 0, shrink = 0;
    // the camera
    std::string camera_text, view = "30,20", up, projection = "orthographic", size = "1200x900";
    double zoom = 1;
    // what for
    std::string tag, action = "make";
    std::optional<std::string> type, outline;
    std::vector<int> colour;
    std::optional<int> id;

    void describe(OptionList& visit);
    /// The step, taken on this set. Throws Error (usage) for options that make no step.
    [[nodiscard]] Json step(const AnnotationSet& set) const;
};

}  // namespace ostraka
